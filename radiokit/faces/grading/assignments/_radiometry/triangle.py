"""Triangle: the solid angle of a triangle, distant or all around the eye."""

from __future__ import annotations

from typing import Any

import numpy as np

from radiokit.faces.grading.assignments._radiometry.common import (
    COUNT,
    FloatArray,
    directions,
    powers,
    put_together,
    turned,
)
from radiokit.facts.directions import dot
from radiokit.physics import polygon

__all__ = ["QUESTION"]


def _triangle(a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
    """Return what radiokit's polygon gives from whichever side is its front."""
    eye = np.zeros(3)
    found = [
        max(polygon.solid_angle(corners, eye).value, polygon.solid_angle(corners[::-1], eye).value)
        for corners in np.stack((a, b, c), axis=1)
    ]
    return np.array(found, dtype=float)


def _corners(rng: np.random.Generator, width: FloatArray, distance: FloatArray) -> dict[str, Any]:
    """Return triangles of an angular radius [rad] about random axes, at distances, wound either way."""
    count = len(width)
    axis, spin = directions(rng, count), rng.uniform(0, 2 * np.pi, count)
    right = turned(rng, axis, np.full(count, np.pi / 2))
    up = np.cross(axis, right)
    way = rng.permutation(np.where(np.arange(count) % 2, 1.0, -1.0))
    found = {}
    for k, name in enumerate("abc"):
        phi = spin + way * (2 * np.pi * k / 3 + rng.uniform(-0.5, 0.5, count))
        aside = np.cos(phi)[:, None] * right + np.sin(phi)[:, None] * up
        ray = np.cos(width)[:, None] * axis + np.sin(width)[:, None] * aside
        found[name] = ray * (distance * (1 + rng.uniform(-0.4, 0.4, count) * np.minimum(1, width)))[:, None]
    return found


def _triangles(rng: np.random.Generator) -> dict[str, Any]:
    return _corners(rng, rng.uniform(0.2, 0.8, COUNT), rng.uniform(1, 5, COUNT))


def _hard_triangles(rng: np.random.Generator) -> dict[str, Any]:
    width = np.concatenate((powers(rng, -7, -3, COUNT // 2), rng.uniform(1.2, 1.55, COUNT // 2)))
    return _corners(rng, width, powers(rng, -3, 3, len(width)))


def _signed(a: FloatArray, b: FloatArray, c: FloatArray, *, quadrant: bool = True) -> FloatArray:
    """Return the formula with the sign of the winding, or without the quadrant."""
    la, lb, lc = (np.linalg.norm(each, axis=-1) for each in (a, b, c))
    volume = dot(a, np.cross(b - a, c - a))
    below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb
    result: FloatArray = 2 * (np.arctan2(volume, below) if quadrant else np.arctan(np.abs(volume) / below))
    return result


def _by_formula(a: FloatArray, b: FloatArray, c: FloatArray, *, pairs: tuple[int, int, int]) -> FloatArray:
    """Return twice the arctangent, where the dot products a·b, b·c, c·a have lengths so paired, 0 for a."""
    corners = (a, b, c)
    lengths = [np.sqrt(dot(corner, corner)) for corner in corners]
    below = lengths[0] * lengths[1] * lengths[2]
    for k, length in enumerate(pairs):
        below = below + dot(corners[k], corners[(k + 1) % 3]) * lengths[length]
    result: FloatArray = 2 * np.arctan2(np.abs(dot(a, np.cross(b - a, c - a))), below)
    return result


def _flat(a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
    result: FloatArray = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=-1)
    return result


def _flat_over_square(a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
    middle = (a + b + c) / 3
    result: FloatArray = _flat(a, b, c) / dot(middle, middle)
    return result


def _flat_projected(a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
    middle, across = (a + b + c) / 3, np.cross(b - a, c - a)
    result: FloatArray = 0.5 * np.abs(dot(across, middle)) / np.linalg.norm(middle, axis=-1) ** 3
    return result


QUESTION = put_together(
    "triangle_solid_angle(a, b, c)",
    title={"en": "Solid angle of a triangle", "ru": "Телесный угол треугольника"},
    text={
        "en": r"""
Return the solid angle [sr] of a triangle that is seen from the origin, by the formula of Van Oosterom and
Strackee (1983),
$$\tan\frac{\Omega}{2} = \frac{|\mathbf a \cdot (\mathbf b \times \mathbf c)|}
{abc + (\mathbf a \cdot \mathbf b)\,c + (\mathbf b \cdot \mathbf c)\,a + (\mathbf c \cdot \mathbf a)\,b} ,$$
where $a = |\mathbf a|$ and so on.

- `a`, `b`, `c`: the corners [m], arrays `(N, 3)`, in either winding; the answer has shape `(N,)`.

The answer is never negative: from 0 to $2\pi$. **Hard inputs:** small and distant triangles (down to
$10^{-7}$ of their distance), where the triple product of the corners loses all digits and that of the
differences $\mathbf b - \mathbf a$, $\mathbf c - \mathbf a$ does not; and triangles all around the eye,
whose $\Omega$ is above $\pi$: mind the quadrant. The relative error is to be $10^{-9}$.
""",
        "ru": r"""
Найдите телесный угол [ср], под которым треугольник виден из начала координат, по формуле Ван Остерома и
Страки (Van Oosterom, Strackee, 1983)
$$\operatorname{tg}\frac{\Omega}{2} = \frac{|\mathbf a \cdot (\mathbf b \times \mathbf c)|}
{abc + (\mathbf a \cdot \mathbf b)\,c + (\mathbf b \cdot \mathbf c)\,a + (\mathbf c \cdot \mathbf a)\,b} ,$$
где $a = |\mathbf a|$ и так далее.

- `a`, `b`, `c`: вершины [м], массивы `(N, 3)`, обход любой; ответ имеет форму `(N,)`.

Ответ неотрицателен: от 0 до $2\pi$. **Трудные входы:** малые далёкие треугольники (размером
до $10^{-7}$ расстояния), где смешанное произведение самих вершин теряет все цифры, а произведение
с разностями $\mathbf b - \mathbf a$, $\mathbf c - \mathbf a$ — нет; и треугольники вокруг глаза, у которых
$\Omega$ больше $\pi$: следите за четвертью. Относительная ошибка не должна превышать $10^{-9}$.
""",
    },
    reference=_triangle,
    ordinary=_triangles,
    hard=_hard_triangles,
    terms=lambda a, b, c: np.ones(len(a)),
    variants={
        "sign-of-winding": _signed,
        "quadrant-lost": lambda a, b, c: _signed(a, b, c, quadrant=False),
        "quadrant-folded": lambda a, b, c: np.abs(_signed(a, b, c, quadrant=False)),
        "fraction-upside-down": lambda a, b, c: np.pi - _triangle(a, b, c),
        "lengths-exchanged": lambda a, b, c: _by_formula(a, b, c, pairs=(0, 1, 2)),
        "lengths-exchanged-otherwise": lambda a, b, c: _by_formula(a, b, c, pairs=(1, 2, 0)),
        "area-for-solid-angle": _flat,
        "area-over-distance-squared": _flat_over_square,
        "small-angle": _flat_projected,
    },
    credit={"sign-of-winding": 0.5, "halved": 0.5},
    hints={
        "sign-of-winding": {
            "en": "Your answer is negative for triangles wound the other way: take the absolute value",
            "ru": "Для треугольников с обратным обходом ответ отрицателен: возьмите модуль",
        },
        "quadrant-lost": {
            "en": "The denominator is negative where Ω > π: arctan loses the quadrant, arctan2 keeps it",
            "ru": "При Ω > π знаменатель отрицателен: arctan теряет четверть, arctan2 её сохраняет",
        },
        "quadrant-folded": {
            "en": "The denominator is negative where Ω > π: |arctan| gives 2π − Ω there, arctan2 gives Ω",
            "ru": "При Ω > π знаменатель отрицателен: |arctan| даёт там 2π − Ω, а arctan2 даёт Ω",
        },
        "fraction-upside-down": {
            "en": "Your fraction is upside down: it is arctan2(numerator, denominator)",
            "ru": "Дробь перевёрнута: нужно arctan2(числитель, знаменатель)",
        },
        **{
            name: {
                "en": "In the denominator each dot product goes with the length of the third corner: (a·b) c",
                "ru": "В знаменателе скалярное произведение умножают на длину третьего вектора: (a·b) c",
            }
            for name in ("lengths-exchanged", "lengths-exchanged-otherwise")
        },
        "area-for-solid-angle": {
            "en": "You gave the area of the triangle [m²]: a solid angle is an area on the unit sphere",
            "ru": "Вы дали площадь треугольника [м²]: телесный угол — это площадь на единичной сфере",
        },
        "area-over-distance-squared": {
            "en": "A/d² holds for a small area that faces the eye: this one is neither small nor facing",
            "ru": "A/d² верно для малой площадки, перпендикулярной лучу: здесь она и не мала, и наклонена",
        },
        "small-angle": {
            "en": "A cos θ/d² holds for a small area only: this triangle is not small",
            "ru": "A cos θ/d² верно лишь для малой площадки: этот треугольник не мал",
        },
        "halved": {
            "en": "The formula gives tan(Ω/2): the arctangent is half of the solid angle",
            "ru": "Формула даёт tg(Ω/2): арктангенс равен половине телесного угла",
        },
        "imprecise": {
            "en": "the corners of a distant triangle are nearly equal: use differences of corners",
            "ru": "вершины далёкого треугольника почти равны: возьмите разности вершин",
        },
    },
)
