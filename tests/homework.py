"""An instructor's own assignment, for the tests of what is made from one: two questions, two hidden parts."""

from __future__ import annotations

import numpy as np

import radiokit as rk


def lamps(rng):
    return {
        "intensity": rng.uniform(1, 100, 20),
        "distance": rng.uniform(0.2, 5, 20),
        "theta": rng.uniform(0.1, 1.4, 20),
    }


def irradiance(intensity, distance, theta):
    return intensity * np.cos(theta) / distance**2


def cone(half_angle):
    return 4 * np.pi * np.sin(half_angle / 2) ** 2


ASSIGNMENT = rk.grading.Assignment(
    name="homework",
    title={"en": "Homework", "ru": "Домашнее задание"},
    intro={"en": "Two functions; $E = I/r^2$.", "ru": "Две функции; $E = I/r^2$."},
    questions=(
        rk.grading.Question(
            signature="irradiance(intensity, distance, theta)",
            points=2,
            title={"en": "A lamp", "ru": "Лампа"},
            text={"en": "The irradiance [W m⁻²].", "ru": "Освещённость [Вт/м²]."},
            parts=(
                rk.grading.Part(name="ordinary", judge=rk.grading.Values(inputs=lamps, reference=irradiance)),
            ),
            seconds=2.0,
        ),
        rk.grading.Question(
            signature="cone(half_angle)",
            points=3,
            title={"en": 'The "cone" of \\(ω\\)', "ru": "Конус"},
            text={"en": "Its solid angle [sr].", "ru": "Телесный угол [ср]."},
            parts=(
                rk.grading.Part(
                    name="ordinary",
                    judge=rk.grading.Values(
                        inputs=lambda rng: {"half_angle": rng.uniform(0.5, 3, 20)}, reference=cone
                    ),
                ),
                rk.grading.Part(
                    name="hard",
                    judge=rk.grading.Values(
                        inputs=lambda rng: {"half_angle": rng.uniform(3e-6, 3e-5, 20)}, reference=cone
                    ),
                    visibility="hidden",
                ),
            ),
            seconds=2.0,
        ),
    ),
    limits=rk.grading.Limits(seconds=2.0, load_seconds=6.0),
)
