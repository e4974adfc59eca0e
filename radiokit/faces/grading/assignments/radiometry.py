"""Assignment 1: solid angle, flux, the inverse square, the cosine law, radiance, and photometry."""

from __future__ import annotations

from typing import Any

import numpy as np

from radiokit.faces.grading.assignment import Assignment
from radiokit.faces.grading.question import Part, Question
from radiokit.faces.grading.values import Values

__all__ = ["ASSIGNMENT"]


def _lamps(rng: np.random.Generator) -> dict[str, Any]:
    return {
        "intensity": rng.uniform(1, 100, 40),
        "distance": rng.uniform(0.2, 5, 40),
        "theta": rng.uniform(0, 1.5, 40),
    }


def _irradiance(intensity: Any, distance: Any, theta: Any) -> Any:
    return intensity * np.cos(theta) / distance**2


ASSIGNMENT = Assignment(
    name="radiometry",
    title={"en": "Assignment 1: radiometry", "ru": "Задание 1: радиометрия"},
    intro={"en": "Radiometry.", "ru": "Радиометрия."},
    questions=(
        Question(
            signature="irradiance(intensity, distance, theta)",
            points=2,
            title={"en": "Irradiance from a point light", "ru": "Освещённость от точечного источника"},
            text={"en": "...", "ru": "..."},
            parts=(Part(name="ordinary", judge=Values(inputs=_lamps, reference=_irradiance)),),
        ),
    ),
)
