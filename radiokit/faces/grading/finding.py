"""Finding: what a judge of one part of a question says, and what a judge must be able to do."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, Protocol

import numpy as np

from radiokit.contracts.bsdf import BSDF
from radiokit.faces.grading.isolation.protocol import Array
from radiokit.faces.grading.isolation.result import Result

__all__ = ["Callee", "Finding", "Judge", "Mode"]

Mode = Literal["batch", "single", "row", "scalar"]


@dataclass(frozen=True, kw_only=True)
class Finding:
    """What was found about one part of a question.

    Parameters
    ----------
    share : float
        What share of the part's points is earned, in [0, 1].
    text : str
        One line for the student.
    diagnosis : str
        The misconception that explains it, by its name; empty where none is known.
    confidence : float
        How sure that is, in [0, 1].
    measured : mapping
        Numbers that differ from run to run, as times do; they are shown, never compared or scored.
    """

    share: float
    text: str
    diagnosis: str = ""
    confidence: float = 0.0
    measured: Mapping[str, float] = field(default_factory=dict)


class Callee(Protocol):
    """A student's function, wherever it runs."""

    @property
    def name(self) -> str:
        """Its name."""
        ...

    def call(self, *arrays: Array, mode: Mode = "batch", outputs: int = 1, seed: int | None = None) -> Result:
        """Call it; whatever it does, a result comes back."""
        ...

    def bsdf(self, parameters: Mapping[str, Any] | None = None) -> BSDF:
        """Return it as a BSDF, with its parameters by name, or by position where it has other names."""
        ...

    def other(self, name: str) -> Callee:
        """Return another function of the same submission."""
        ...


class Judge(Protocol):
    """What says how right a function is.

    One of your own may also have ``diagnoses``, what it finds beside ``rk.grading.list_diagnoses()``;
    ``needs``, the further functions without which it judges nothing; and ``rehearse(question, rng)``, which
    raises where its own inputs or references are wrong.
    """

    def judge(
        self,
        callee: Callee,
        rng: np.random.Generator,
        *,
        language: str,
        hints: Mapping[str, Mapping[str, str]],
        shown: bool,
    ) -> Finding:
        """Judge a function.

        ``rng`` is this student's own for this part; ``hints`` are further sentences by misconception;
        ``shown`` says whether the student may see right values.
        """
        ...
