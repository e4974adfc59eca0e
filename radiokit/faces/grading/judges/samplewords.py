"""Sample words: what feedback says of estimators and samplers, in English and Russian."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from radiokit.faces.diagnosis.catalogue import CATALOGUE
from radiokit.faces.grading.words import Words, sentence

__all__ = ["PLAIN", "SENTENCES", "SLIPS", "line", "slip", "tell"]

PLAIN = ("horizon-not-clamped",)
"""Misconceptions whose detail says no more than their words."""

LONGEST = 320
"""How many characters a line should have at most."""

SENTENCES: Mapping[str, Words] = {
    "unbiased": {
        "en": "right: no bias over {runs} runs, and the error falls as 1/√N",
        "ru": "верно: по результатам запусков ({runs}) смещения нет, ошибка убывает как 1/√N",
    },
    "honest": {
        "en": "right: the standard errors are the spread between seeds",
        "ru": "верно: стандартные ошибки отвечают разбросу между разными seed",
    },
    "exact": {
        "en": "right: every sample gives the exact value, and the error says so",
        "ru": "верно: каждый отсчёт даёт точное значение, и ошибка это отражает",
    },
    "pair": {
        "en": "the function {function} must return two numbers: return value, standard_error",
        "ru": "функция {function} должна возвращать два числа: return value, standard_error",
    },
    "not-a-number": {
        "en": "gives value {value} and standard error {error} at {inputs}",
        "ru": "даёт значение {value} и стандартную ошибку {error} при {inputs}",
    },
    "negative-error": {
        "en": "gives the standard error {error} at {inputs}: it is at least 0",
        "ru": "даёт стандартную ошибку {error} при {inputs}: она не бывает отрицательной",
    },
    "biased": {
        "en": "biased: the mean of {runs} runs is {ratio} times what is right",
        "ru": "оценка смещена: среднее по {runs} запускам равно верному, умноженному на {ratio}",
    },
    "biased-shown": {
        "en": "biased: at {inputs} the mean of {runs} runs is {value}, right is {right}",
        "ru": "оценка смещена: при {inputs} среднее по {runs} запускам равно {value}, верно {right}",
    },
    "ratio": {
        "en": "the ratio of the error that is given to the true one is about {ratio}",
        "ru": "отношение заявленной ошибки к истинной — около {ratio}",
    },
    "noise": {
        "en": "the deviation of one sample is {ratio} times the value",
        "ru": "отношение отклонения одного отсчёта к значению — около {ratio}",
    },
    "wrong-value": {
        "en": "the value is so far off that no standard error is honest",
        "ru": "значение настолько неверно, что никакая стандартная ошибка не будет честной",
    },
    "efficient": {
        "en": "right: the variance is {ratio} of what uniform directions give",
        "ru": "верно: дисперсия составляет {ratio} от дисперсии при равномерных направлениях",
    },
    "no-variance": {
        "en": "right: there is no variance at all",
        "ru": "верно: дисперсии нет совсем",
    },
    "inefficient": {
        "en": "the variance is {ratio} of what uniform directions give, and at most {most} is asked for",
        "ru": "дисперсия составляет {ratio} от дисперсии при равномерных направлениях, а требуется не более "
        "{most}",
    },
    "slow": {
        "en": "a sample takes so long that uniform directions give the same error sooner",
        "ru": "отсчёт вычисляется так долго, что равномерные направления дали бы ту же ошибку быстрее",
    },
    "biased-first": {
        "en": "efficiency counts only where the value is right",
        "ru": "эффективность имеет смысл, только если значение верно",
    },
    "step-samples": {
        "en": "for the same seed, the deviations at {samples} and {more} samples are always in the ratio √2",
        "ru": "при одном и том же seed отклонения при {samples} и {more} отсчётах всегда относятся как √2",
    },
    "step-inputs": {
        "en": "for the same seed, the deviations at different inputs are always in the same ratio",
        "ru": "при одном и том же seed отклонения для разных входных данных всегда в одном отношении",
    },
    "sampled": {
        "en": "right: {samples} directions follow the density that is asked for",
        "ru": "верно: направления ({samples}) распределены с заданной плотностью",
    },
    "directions-shape": {
        "en": "the function {function} returns an array of shape {shape} where {expected} is right",
        "ru": "функция {function} возвращает массив формы {shape}, а верна форма {expected}",
    },
    "directions-finite": {
        "en": "the function {function} gives NaN or inf for {bad} of {count} inputs, as at {inputs}",
        "ru": "функция {function} даёт NaN или inf на {bad} из {count} входов, например при {inputs}",
    },
    "not-unit": {
        "en": "directions are not of unit length: {length} at {inputs}",
        "ru": "направления не единичной длины: {length} при {inputs}",
    },
    "below": {
        "en": "{bad} of {count} directions lie below the horizon, z < 0",
        "ru": "под горизонтом (z < 0) лежат {bad} из {count} направлений",
    },
    "no-match": {
        "en": "the directions do not follow the density that is asked for (chi-square test)",
        "ru": "распределение направлений не соответствует заданной плотности (критерий хи-квадрат)",
    },
    "consistent": {
        "en": "they do follow the density that {function} gives, but it is not the one asked for",
        "ru": "они распределены с той плотностью, которую даёт {function}, но задана другая",
    },
    "cosine": {
        "en": "the mean of z is {value}, right is {right}",
        "ru": "среднее значение z равно {value}, верно {right}",
    },
    "density": {
        "en": "right: the density agrees, and its integral over the hemisphere is 1",
        "ru": "верно: плотность совпадает с заданной, её интеграл по полусфере равен 1",
    },
    "density-wrong": {
        "en": "the density is wrong at {bad} of {count} directions; its integral over the hemisphere is "
        "{integral}",
        "ru": "плотность неверна для {bad} из {count} направлений; её интеграл по полусфере равен {integral}",
    },
    "density-negative": {
        "en": "the function {function} gives a negative density",
        "ru": "функция {function} даёт отрицательную плотность",
    },
    "density-zero": {
        "en": "the function {function} gives 0 for a direction that was sampled",
        "ru": "функция {function} даёт 0 для направления, попавшего в выборку",
    },
    "weights": {
        "en": "the mean of f/p over the samples is {value}, right is {right}: samples and density disagree",
        "ru": "среднее f/p по выборке равно {value}, верно {right}: выборка и плотность не согласованы",
    },
    "forged": {
        "en": "the mean of f/p is right, but not where f is weighed by z or x: samples and density disagree",
        "ru": "среднее f/p верно, но не с весом z или x: выборка и плотность не согласованы",
    },
}
"""What the two judges say."""

SLIPS: Mapping[str, Words] = {
    "not-repeatable": {
        "en": "The same seed gives another answer when asked again: make the generator from the seed, "
        "rng = np.random.default_rng(seed), and take all random numbers from it.",
        "ru": "При том же seed второй вызов даёт другой ответ: создайте генератор из seed, "
        "rng = np.random.default_rng(seed), и берите все случайные числа из него.",
    },
    "seed-reused": {
        "en": "Your answers are the same for all seeds: make the generator from the seed that you are given, "
        "rng = np.random.default_rng(seed).",
        "ru": "Ваши ответы одинаковы при всех seed: создавайте генератор из того seed, который передан, "
        "rng = np.random.default_rng(seed).",
    },
    "not-sampled": {
        "en": "The value is exact, but nothing is sampled: estimate it with the random numbers of the seed.",
        "ru": "Значение точное, но выборки нет: оцените его по случайным числам, взятым из seed.",
    },
    "noise-invented": {
        "en": "Your value is a known number with noise added, and no mean of samples: average the integrand, "
        "divided by the density, over random samples.",
        "ru": "Ваше значение — известное число с добавленным шумом, а не среднее по отсчётам: усредняйте "
        "подынтегральную функцию, делённую на плотность, по случайным отсчётам.",
    },
    "too-many-samples": {
        "en": "Even for a single sample you give a standard error, and a right one, though one sample has no "
        "spread: draw as many samples as you are asked for, and no more.",
        "ru": "Вы даёте стандартную ошибку даже для одного отсчёта, причём верную, хотя у одного отсчёта "
        "разброса нет: берите столько отсчётов, сколько задано, и не больше.",
    },
    "noise-only": {
        "en": "The values scatter so widely between seeds that they say nothing of what is asked for.",
        "ru": "При разных seed значения разбросаны так сильно, что ничего не говорят об искомой величине.",
    },
    "sample-repeated": {
        "en": "All samples of a run are the same one: make the generator once, before the loop, not anew "
        "for each sample.",
        "ru": "Все отсчёты одного запуска совпадают: создайте генератор один раз, до цикла, а не заново для "
        "каждого отсчёта.",
    },
    "samples-ignored": {
        "en": "Four times as many samples leave the error as it is: use the number of samples that you are "
        "given.",
        "ru": "При вчетверо большем числе отсчётов ошибка не меняется: используйте то число отсчётов, "
        "которое передано.",
    },
    "error-not-falling": {
        "en": "Four times as many samples should halve the error, and here it falls more slowly.",
        "ru": "При вчетверо большем числе отсчётов ошибка должна уменьшиться вдвое, а она убывает медленнее.",
    },
    "deviation-for-error": {
        "en": "Your standard error is the deviation σ of one sample: that of the mean is σ/√N.",
        "ru": "Ваша стандартная ошибка — это отклонение σ одного отсчёта: у среднего она равна σ/√N.",
    },
    "variance-for-error": {
        "en": "Your standard error is the variance of the mean, σ²/N: take its square root.",
        "ru": "Ваша стандартная ошибка — это дисперсия среднего σ²/N: извлеките корень.",
    },
    "sample-variance-for-error": {
        "en": "Your standard error is the variance σ² of one sample: that of the mean is σ/√N.",
        "ru": "Ваша стандартная ошибка — это дисперсия одного отсчёта σ²: у среднего ошибка равна σ/√N.",
    },
    "error-divided-by-samples": {
        "en": "You divided σ by N: the standard error of the mean is σ/√N.",
        "ru": "Вы разделили σ на N: стандартная ошибка среднего равна σ/√N.",
    },
    "error-of-sum": {
        "en": "Your standard error is that of the sum, σ√N: that of the mean is σ/√N.",
        "ru": "Ваша стандартная ошибка относится к сумме, σ√N: у среднего она равна σ/√N.",
    },
    "interval-for-error": {
        "en": "Your standard error is about twice too large, as half of a 95 % interval is: give σ/√N "
        "itself.",
        "ru": "Ваша стандартная ошибка примерно вдвое больше, как полуширина интервала 95 %: нужна сама "
        "σ/√N.",
    },
    "error-zero": {
        "en": "Your standard error is 0, and yet different seeds give different values.",
        "ru": "Ваша стандартная ошибка равна 0, хотя при разных seed значения различны.",
    },
    "error-too-small": {
        "en": "Your standard error is too small: the values differ more between seeds than it says.",
        "ru": "Ваша стандартная ошибка занижена: между разными seed значения расходятся сильнее.",
    },
    "error-too-large": {
        "en": "Your standard error is too large: the values differ less between seeds than it says.",
        "ru": "Ваша стандартная ошибка завышена: между разными seed значения расходятся слабее.",
    },
    "inefficient": {
        "en": "Sample the directions that matter most: in proportion to the lobe.",
        "ru": "Выбирайте чаще те направления, которые дают наибольший вклад: пропорционально лепестку.",
    },
    "rows-mixed": {
        "en": "A direction must follow from its own row of u alone: u in another order must give the same "
        "directions in that order.",
        "ru": "Направление должно определяться только своей строкой u: если переставить строки u, так же "
        "переставятся и направления.",
    },
    "u-unused": {
        "en": "One of the two random numbers changes nothing: use u[:, 0] and u[:, 1], each once.",
        "ru": "Одно из двух случайных чисел ни на что не влияет: используйте u[:, 0] и u[:, 1], каждое один "
        "раз.",
    },
    "u-torn": {
        "en": "Neighbouring u give directions far apart: the map from the square to the directions should be "
        "continuous, or stratified samples lose their use.",
        "ru": "Близким u отвечают далёкие направления: отображение квадрата в направления должно быть "
        "непрерывным, иначе стратифицированная выборка теряет смысл.",
    },
    "error-first": {
        "en": "You returned the standard error first: return value, standard_error.",
        "ru": "Вы вернули сначала стандартную ошибку, а нужно: return value, standard_error.",
    },
    "part-only": {
        "en": "A part of the hemisphere is never sampled, at all azimuths: look at the range of θ.",
        "ru": "Часть полусферы никогда не попадает в выборку при любом азимуте: проверьте, какие значения "
        "принимает θ.",
    },
    "quarter-only": {
        "en": "A part of the hemisphere is never sampled: the azimuth must run over the whole of 2π.",
        "ru": "Часть полусферы никогда не попадает в выборку: азимут должен пробегать все 2π.",
    },
    "uniform-instead": {
        "en": "This is uniform over the hemisphere, with the density 1/2π, and not what is asked for.",
        "ru": "Это равномерное распределение по полусфере с плотностью 1/2π, а нужно другое.",
    },
    "root-forgotten": {
        "en": "The samples crowd at the pole: a square root is missing in the radius, r = √u.",
        "ru": "Отсчёты сгущаются у полюса: в радиусе забыт корень, r = √u.",
    },
    "pdf-not-normalised": {
        "en": "The density is right up to a factor: its integral over the hemisphere must be 1.",
        "ru": "Плотность верна с точностью до множителя: её интеграл по полусфере должен быть равен 1.",
    },
}
"""Slips that only sampling knows, beside the catalogue; a question's own hint comes first."""

_KNOWN = {entry.name: {"en": entry.en, "ru": entry.ru} for entry in CATALOGUE}


def tell(language: str, key: str, **values: Any) -> str:
    """Return a sentence.

    >>> tell("ru", "no-variance")
    'верно: дисперсии нет совсем'
    """
    return SENTENCES[key][language].format(**values)


def slip(language: str, name: str, hints: Mapping[str, Mapping[str, str]]) -> str:
    """Return what is said of a slip: the question's own hint, or this file's, or the catalogue's.

    >>> slip("en", "error-of-sum", {})
    'Your standard error is that of the sum, σ√N: that of the mean is σ/√N.'
    """
    for known in (hints, SLIPS, _KNOWN):
        if name in known:
            return known[name][language]
    return name


def line(*sentences: str) -> str:
    """Return one line of sentences, the first one anyway and each further one while there is room for it.

    >>> line("one thing", "Another.", "")
    'One thing. Another.'
    """
    text = ""
    for each in filter(None, sentences):
        more = f"{text} {sentence(each)}".strip()
        if not text or len(more) <= LONGEST:
            text = more
    return text
