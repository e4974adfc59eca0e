"""Structures: misconceptions seen in the whole array: swapped, unclamped, shifted, repeated, lost answers."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

from radiokit.faces.diagnosis.misconception import Guess, Misconception, structural
from radiokit.faces.diagnosis.problem import ROUNDING, Problem

__all__ = ["ENTRIES"]

FEWEST = 3
"""How many answers it takes to see a structure."""


def _swapped(problem: Problem) -> Iterable[Guess]:
    given = problem.given
    if "wi" not in given or "wo" not in given:
        return
    if callable(problem.variants):
        yield Guess(problem.variant(wi=given["wo"], wo=given["wi"]))
    # Without the reference's function: where both (a, b) and (b, a) are among the inputs.
    pairs = np.hstack([given["wi"], given["wo"]]).round(12) + 0.0
    rows = {row.tobytes(): index for index, row in enumerate(pairs)}
    partner = [rows.get(np.roll(row, 3).tobytes()) for row in pairs]
    if all(index is not None for index in partner):
        yield Guess(problem.reference[np.array(partner, dtype=int)])


def _angle_scaled(problem: Problem) -> Iterable[Guess]:
    if callable(problem.variants) and "theta" in problem.given:
        for scale, detail in ((180 / np.pi, "degrees"), (np.pi / 180, "converted twice")):
            yield Guess(problem.variant(theta=scale * problem.given["theta"]), detail=detail)


def _unclamped(problem: Problem) -> Iterable[Guess]:
    dark = problem.reference == 0
    wrong = dark & ~problem.close(problem.reference)
    if wrong.any() and np.count_nonzero(~dark) >= FEWEST:
        negative = bool(np.all(problem.answer[wrong] < 0))
        yield Guess(np.where(dark, problem.answer, problem.reference), detail="< 0" if negative else "> 0")


def _sorted(problem: Problem) -> Iterable[Guess]:
    if problem.answer.size >= FEWEST:
        values = problem.reference
        for detail, order in (("ascending", np.sort(values)), ("descending", np.sort(values)[::-1])):
            yield Guess(order, detail=detail)


def _reversed(problem: Problem) -> Iterable[Guess]:
    if problem.answer.size >= FEWEST:
        yield Guess(problem.reference[::-1])


def _shifted(problem: Problem) -> Iterable[Guess]:
    size = problem.answer.size
    for step in (1, -1, 2, -2):
        if size >= FEWEST + 2:
            yield Guess(np.roll(problem.reference, step), detail=f"{step:+d}")
            kept = np.roll(problem.reference, step)
            edge = slice(0, step) if step > 0 else slice(step, None)
            kept[edge] = problem.answer[edge]
            yield Guess(kept, detail=f"{step:+d}")


def _permuted(problem: Problem) -> Iterable[Guess]:
    if problem.answer.size >= FEWEST and not problem.sampled:
        values = np.empty_like(problem.reference)
        values[np.argsort(problem.answer, kind="stable")] = np.sort(problem.reference)
        yield Guess(values)


def _constant(problem: Problem) -> Iterable[Guess]:
    small = float(np.max(np.abs(problem.answer), initial=0.0)) <= ROUNDING * problem.scale
    if small and np.any(problem.answer != problem.answer[0]):
        return  # beside the reference it only looks like one number
    if problem.answer.size >= FEWEST and problem.varies(problem.reference):
        weights = 1 / np.maximum(problem.error, 1e-300) ** 2 if np.all(problem.error > 0) else None
        yield Guess(np.full_like(problem.answer, np.average(problem.answer, weights=weights)))


def _offset(problem: Problem) -> Iterable[Guess]:
    varies = problem.varies(problem.reference) and problem.varies(problem.answer)
    if problem.answer.size >= FEWEST and varies:
        offset = float(np.median(problem.answer - problem.reference))
        # The offset must stand out of the reference's rounding, or cancellation invents it.
        if abs(offset) > 10 * float(np.max(problem.tolerance(problem.reference))):
            yield Guess(problem.reference + offset, detail=f"{offset:+.4g}")


def _seeds(problem: Problem) -> Iterable[Guess]:
    seeds = problem.inputs.get("seed")
    if seeds is None or not problem.sampled or np.unique(seeds).size < FEWEST:
        return
    repeated = np.all(problem.answer == problem.answer[0]) and np.all(
        problem.reference == problem.reference[0]
    )
    if repeated and np.all(problem.error > 0):
        yield Guess(problem.answer.copy())


def _listed(indices: npt.NDArray[np.intp]) -> str:
    return "[" + ", ".join(map(str, indices[:5])) + (", ..." if indices.size > 5 else "") + "]"


def _not_finite(problem: Problem) -> Iterable[Guess]:
    if problem.lost.size:
        yield Guess(problem.answer.copy(), detail=_listed(problem.lost))


def _scattered(problem: Problem) -> Iterable[Guess]:
    close = problem.close(problem.reference)
    if 0.8 <= close.mean() < 1 and np.count_nonzero(close & (problem.reference != 0)) >= FEWEST:
        where = problem.index[~close]
        yield Guess(np.where(close, problem.reference, problem.answer), detail=_listed(where))


ENTRIES: tuple[Misconception, ...] = (
    structural(
        "directions-swapped",
        _swapped,
        "You swapped wi and wo: wi points to the light, wo to the viewer.",
        "Вы перепутали wi и wo: wi направлен на источник, wo — на наблюдателя.",
        needs=("wi", "wo"),
    ),
    structural(
        "angle-unit",
        _angle_scaled,
        "The angle reached the function in a wrong unit: it takes radians, once converted.",
        "Угол попал в функцию не в тех единицах: нужны радианы, пересчитанные один раз.",
        needs=("theta",),
        pairs=True,
    ),
    structural(
        "horizon-not-clamped",
        _unclamped,
        "Below the horizon the answer is 0, and yours is not: take max(0, cos θ), or 0 where cos θ ≤ 0.",
        "Под горизонтом ответ равен 0, а у вас нет: возьмите max(0, cos θ) или 0 там, где cos θ ≤ 0.",
    ),
    structural(
        "sorted",
        _sorted,
        "You sorted the answers: keep them in the order of the inputs.",
        "Вы отсортировали ответы: оставьте их в порядке входов.",
    ),
    structural(
        "reversed",
        _reversed,
        "Your answers are in reverse order.",
        "Ваши ответы идут в обратном порядке.",
    ),
    structural(
        "shifted",
        _shifted,
        "Your answers are shifted against the inputs: an index is off by one or two.",
        "Ваши ответы сдвинуты относительно входов: индекс ошибочен на один или два.",
        prior=0.5,
    ),
    structural(
        "permuted",
        _permuted,
        "Your answers are the right ones in another order.",
        "Ваши ответы верны, но стоят в другом порядке.",
        prior=0.05,
    ),
    structural(
        "constant-answer",
        _constant,
        "Your answer is the same for all inputs: it does not depend on what is asked.",
        "Ваш ответ одинаков для всех входов: он не зависит от того, что спрашивают.",
        prior=0.05,
    ),
    structural(
        "offset",
        _offset,
        "Your answer is off by the same amount everywhere: a term is added or left out, such as an "
        "ambient one.",
        "Ваш ответ всюду отличается на одно и то же число: слагаемое лишнее или забыто, например фоновое.",
        prior=0.5,
    ),
    structural(
        "seed-reused",
        _seeds,
        "Your sampled answers are identical for different seeds: use the generator that you are given.",
        "Ваши случайные ответы одинаковы при разных seed: берите тот генератор, который вам дан.",
        needs=("seed",),
        seen=True,
    ),
    structural(
        "not-finite",
        _not_finite,
        "Some of your answers are NaN or infinite, as from 0/0, the root or logarithm of a negative number: "
        "these are their indices.",
        "Некоторые ваши ответы — NaN или бесконечность, как от 0/0, корня или логарифма "
        "отрицательного числа: "
        "вот их номера.",
        seen=True,
    ),
    structural(
        "wrong-at-few",
        _scattered,
        "Your answer is right at most inputs and wrong at a few, perhaps special cases: these are "
        "their indices.",
        "Ваш ответ верен почти всюду и неверен на нескольких входах, возможно особых: вот их номера.",
        prior=0.02,
    ),
)
