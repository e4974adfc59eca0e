"""Entry: one line of the lecture as data: what is printed, how it is read, and which checks decide."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol

from radiokit.facts.errors import ParameterError
from radiokit.facts.verdict import Verdict

__all__ = ["TITLES", "Check", "Entry", "Word"]


class Word(StrEnum):
    """What a check of the printed line, and one of its condition or correction, together say."""

    HOLDS = "holds"
    CONDITIONAL = "holds only if"
    MISPRINT = "misprint"
    WRONG = "wrong"
    UNDECIDED = "undecided"


class Check(Protocol):
    """Decides about a line."""

    @property
    def how(self) -> str:
        """Which means it is, for a reader, such as ``"dimension checker"``."""

    def judge(self, printed: str) -> Verdict:
        """Return what is found on ``printed``."""


@dataclass(frozen=True, kw_only=True)
class Entry:
    """One line of the lecture. It holds no verdict: the checks give it.

    Parameters
    ----------
    name : str
        As ``lecture_claims()[name]`` takes it.
    slide : int
        Which one, counted by titles from 1.
    printed : str
        Verbatim: the formula's LaTeX, or the sentence.
    sentence : str
        The Russian text beside a formula, verbatim.
    english, russian : str
        What it means.
    checks : tuple of Check
        They decide about the printed line as it stands. All must hold.
    condition, condition_ru : str
        What must be added for the line to hold; ``amended`` shows that it then does.
    corrected : str
        What the line should be: LaTeX, or a sentence; ``amended`` shows that this holds.
    amended : tuple of Check
        They decide about the line with the condition, or about the corrected one.
    derivation, case : str
        The names of the derivation and of the closed-form case that belong to it.
    """

    name: str
    slide: int
    printed: str
    english: str
    russian: str
    checks: tuple[Check, ...]
    sentence: str = ""
    condition: str = ""
    condition_ru: str = ""
    corrected: str = ""
    amended: tuple[Check, ...] = ()
    derivation: str = ""
    case: str = ""

    def __post_init__(self) -> None:
        if not 1 <= self.slide <= len(TITLES):
            raise ParameterError("slide", self.slide, f"from 1 to {len(TITLES)}")
        if bool(self.condition or self.corrected) != bool(self.amended):
            raise ParameterError(
                "amended", self.amended, "given with a condition or a correction, and only then"
            )
        if bool(self.condition) != bool(self.condition_ru) or (self.condition and self.corrected):
            raise ParameterError("condition", self.condition, "in both languages, and without a correction")

    @property
    def title(self) -> str:
        """The slide's title."""
        return TITLES[self.slide - 1]

    @property
    def as_read(self) -> Word:
        """What the reading expects the checks to say."""
        if self.corrected:
            return Word.MISPRINT
        return Word.CONDITIONAL if self.condition else Word.HOLDS


TITLES = (
    "Свет как энергия. Радиометрия. BRDF",
    "На прошлой лекции",
    "На лекции",
    "Как получить фотореалистичное изображение?",
    "Моделирование и расчет сцены",
    "Свет: дуальность",
    "Фотоэлектрический эффект",
    "Геометрическая оптика",
    "Волновая природа света: явления",
    "Волновая природа света: дифракция и интерференция",
    "Волновая природа света: поляризация",
    "Поляризация: пример",
    "Геометрическая оптика: итоги",
    "Радиометрия",
    "Радиометрия: особенности",
    "Радиометрия: предположения",
    "Радиометрия: недостатки",
    "Радиометрия: основные термины",
    "Световая энергия (radiant energy)",
    "Световой поток (flux)",
    "Световой поток (flux): как измерить?",
    "Полный световой поток",
    "Телесный угол",
    "Сила света (intensity)",
    "Освещенность и светимость",
    "Энергетическая освещенность (irradiance)",
    "Связь освещенности и «косинуса»",
    "Энергетическая светимость (radiant exitance)",
    "Яркость (radiance)",
    "Исходящее и входящее излучение",
    "Свойства излучения",
    "Выражение излучения через другие единицы",
    "Фотометрия и фотометрические единицы",
    "Взаимодействие света и материала",
    "Типы взаимодействия света и материала",
    "Отражение и ДФО",
    "ДФО: определение",
    "ДФО (2)",
    "ДФО (3)",
    "Свойства ДФО",
    "Свойства ДФО: обратимость",
    "Свойства ДФО: сохранение энергии",
    "Примеры ДФО: диффузное отражение",
    "Примеры ДФО: зеркальное отражение",
    "ДФП",
    "Расчет излучения точки поверхности",
    "Расчет излучения точки поверхности: дискретный случай",
    "Ограничения модели ДФР",
    "Итоги",
    "Задание 1",
)
"""The titles of the slides, in order."""
