"""Assignment 3: light from points, spheres and windows on a surface; Monte Carlo with an honest error."""

from __future__ import annotations

from radiokit.faces.grading.assignment import Assignment
from radiokit.faces.grading.assignments._shading.estimates import FURNACE, GLOSSY, WINDOW
from radiokit.faces.grading.assignments._shading.lights import DIRECT_LIGHT, SPHERE_IRRADIANCE
from radiokit.faces.grading.assignments._shading.samplers import COSINE_SAMPLE, LOBE_SAMPLE
from radiokit.faces.grading.assignments._shading.weight import MIS_WEIGHT

__all__ = ["ASSIGNMENT"]

ASSIGNMENT = Assignment(
    name="shading",
    title={"en": "Assignment 3: shading and Monte Carlo", "ru": "Задание 3: расчёт освещения и Монте-Карло"},
    intro={
        "en": "What a point of a surface sends to the viewer: first a sum over point lights, then an "
        "integral over large ones, by quadrature and by Monte Carlo. Every estimate comes with its standard "
        "error, and the error is judged as well as the value. Write each function under the name that is "
        "given; NumPy is there. Loops are allowed, and arrays are faster.",
        "ru": "Сколько света точка поверхности посылает наблюдателю: сначала сумма по точечным источникам, "
        "затем интеграл по протяжённым — квадратурой и методом Монте-Карло. К каждой оценке прилагается "
        "стандартная ошибка, и проверяется не только значение, но и ошибка. Пишите функции под указанными "
        "именами; NumPy доступен. Циклы разрешены, но с массивами быстрее.",
    },
    questions=(
        DIRECT_LIGHT,
        SPHERE_IRRADIANCE,
        FURNACE,
        COSINE_SAMPLE,
        LOBE_SAMPLE,
        GLOSSY,
        WINDOW,
        MIS_WEIGHT,
    ),
)
