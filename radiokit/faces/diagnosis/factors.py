"""Factors: misconceptions whose factor varies with an input: a cosine, a distance, a density, an exponent."""

from __future__ import annotations

import math
from itertools import permutations

import numpy as np

from radiokit.faces.diagnosis.misconception import Misconception, varying
from radiokit.faces.diagnosis.problem import Array

__all__ = ["ENTRIES"]


def _normalisations(n: Array) -> dict[str, Array]:
    """Return the ratios of two normalisations of Phong's and Blinn's lobes.

    Source: Giesen (2009), Phong and Blinn-Phong normalization factors; (n+2)/(8π) is Walter et al. (2007).
    """
    known = {
        "no normalisation": np.ones_like(n),
        "(n+1)/(2π)": (n + 1) / (2 * math.pi),
        "(n+2)/(2π)": (n + 2) / (2 * math.pi),
        "(n+2)/(4π)": (n + 2) / (4 * math.pi),
        "(n+2)/(8π)": (n + 2) / (8 * math.pi),
        "(n+8)/(8π)": (n + 8) / (8 * math.pi),
        "(n+2)(n+4)/(8π(2^(-n/2)+n))": (n + 2) * (n + 4) / (8 * math.pi * (np.exp2(-n / 2) + n)),
    }
    # Those that begin alike, with n + 2, differ by a constant that has entries of its own.
    alike = {name for name in known if name.startswith("(n+2)/")}
    return {
        f"{used} ≠ {meant}": known[used] / known[meant]
        for used, meant in permutations(known, 2)
        if not {used, meant} <= alike
    }


def _half(wi: Array, wo: Array, n: Array | None = None) -> dict[str, Array]:
    length = np.sqrt(np.sum((wi + wo) ** 2, axis=-1))
    powers = {"": np.ones_like(length)} if n is None else {"": np.ones_like(length), "^n": n}
    lengths = {"|wi+wo|": length, "|wi+wo|/2": length / 2}
    return {f"{base}{mark}": lengths[base] ** power for base in lengths for mark, power in powers.items()}


def _half_power(wi: Array, wo: Array, n: Array) -> dict[str, Array]:
    return {name: values for name, values in _half(wi, wo, n).items() if name.endswith("^n")}


ENTRIES: tuple[Misconception, ...] = (
    varying(
        "cosine-forgotten",
        lambda cosine: 1 / cosine,
        "You forgot the cosine: light that falls at θ is spread over an area 1/cos θ as large.",
        "Вы забыли косинус: свет, падающий под углом θ, ложится на площадь в 1/cos θ раз большую.",
        needs=("cosine",),
    ),
    varying(
        "cosine-twice",
        lambda cosine: cosine,
        "You have the cosine once too often, or squared: a BSDF's value does not hold it already.",
        "У вас лишний косинус или его квадрат: в значение BSDF он не входит.",
        needs=("cosine",),
    ),
    varying(
        "sine-for-cosine",
        lambda sine, cosine: sine / cosine,
        "You have sin θ where cos θ belongs: θ is measured from the normal, not from the surface.",
        "У вас sin θ вместо cos θ: угол θ отсчитывают от нормали, а не от поверхности.",
        needs=("sine", "cosine"),
    ),
    varying(
        "sine-forgotten",
        lambda sine: 1 / sine,
        "You forgot sin θ in dω = sin θ dθ dφ.",
        "Вы забыли sin θ в dω = sin θ dθ dφ.",
        needs=("sine",),
    ),
    varying(
        "sine-twice",
        lambda sine: sine,
        "You have sin θ once too often: dω = sin θ dθ dφ holds it once.",
        "У вас лишний sin θ: в dω = sin θ dθ dφ он входит один раз.",
        needs=("sine",),
    ),
    varying(
        "degrees-for-radians",
        lambda theta, cosine, sine: {
            "cos": np.cos(np.degrees(theta)) / cosine,
            "max(0, cos)": np.maximum(np.cos(np.degrees(theta)), 0) / cosine,
            "sin": np.sin(np.degrees(theta)) / sine,
        },
        "You gave degrees to a function that takes radians: convert by numpy.radians first.",
        "Вы подали градусы функции, которая ждёт радианы: сначала пересчитайте через numpy.radians.",
        needs=("theta", "cosine", "sine"),
    ),
    varying(
        "distance-not-squared",
        lambda distance: distance,
        "You divided by the distance and not by its square: irradiance falls as 1/d².",
        "Вы разделили на расстояние, а не на его квадрат: освещённость убывает как 1/d².",
        needs=("distance",),
    ),
    varying(
        "distance-forgotten",
        lambda distance: distance**2,
        "You forgot the square of the distance: irradiance falls as 1/d².",
        "Вы забыли квадрат расстояния: освещённость убывает как 1/d².",
        needs=("distance",),
    ),
    varying(
        "distance-cubed",
        lambda distance: 1 / distance,
        "You divided by the distance once too often, as an unnormalised vector to the light does: "
        "the law is 1/d².",
        "Вы лишний раз разделили на расстояние, как бывает с ненормированным вектором на источник: "
        "закон — 1/d².",
        needs=("distance",),
    ),
    varying(
        "distance-squared-twice",
        lambda distance: 1 / distance**2,
        "You divided by the square of the distance once too often: irradiance falls as 1/d², and radiance "
        "does not fall at all.",
        "Вы лишний раз разделили на квадрат расстояния: освещённость убывает как 1/d², а яркость не убывает "
        "вовсе.",
        needs=("distance",),
    ),
    varying(
        "distance-doubled",
        lambda distance: {"1/2": distance / 2, "2": 2 * distance},
        "You have twice the distance where its square belongs: it is d**2, not d*2.",
        "У вас удвоенное расстояние вместо его квадрата: нужно d**2, а не d*2.",
        needs=("distance",),
        pairs=False,
    ),
    varying(
        "intensity-for-irradiance",
        lambda distance, cosine: distance**2 / cosine,
        "You gave the intensity where the irradiance is asked: E = I cos θ/d².",
        "Вы дали силу света вместо освещённости: E = I cos θ/d².",
        needs=("distance", "cosine"),
        pairs=False,
    ),
    varying(
        "intensity-for-radiance",
        lambda area, cosine: area * cosine,
        "You gave the intensity where the radiance is asked: L = I/(A cos θ).",
        "Вы дали силу света вместо яркости: L = I/(A cos θ).",
        needs=("area", "cosine"),
        pairs=False,
    ),
    varying(
        "flux-for-irradiance",
        lambda area: area,
        "You did not divide by the area: the flux is given where the irradiance or exitance is asked.",
        "Вы не разделили на площадь: дан поток вместо освещённости или светимости.",
        needs=("area",),
    ),
    varying(
        "solid-angle-forgotten",
        lambda solid_angle: 1 / solid_angle,
        "You forgot the solid angle Δω: each term of the sum is L cos θ Δω.",
        "Вы забыли телесный угол Δω: каждое слагаемое суммы — это L cos θ Δω.",
        needs=("solid_angle",),
    ),
    varying(
        "solid-angle-twice",
        lambda solid_angle: solid_angle,
        "You multiplied by the solid angle Δω once too often.",
        "Вы лишний раз умножили на телесный угол Δω.",
        needs=("solid_angle",),
    ),
    varying(
        "pdf-forgotten",
        lambda pdf: pdf,
        "You did not divide by the pdf: a sample's weight is f/p.",
        "Вы не разделили на плотность вероятности: вес отсчёта — это f/p.",
        needs=("pdf",),
    ),
    varying(
        "pdf-divided-twice",
        lambda pdf: 1 / pdf,
        "You divided by the pdf twice: a weight that a sampler returns holds it already.",
        "Вы разделили на плотность вероятности дважды: вес, который даёт выборка, её уже содержит.",
        needs=("pdf",),
    ),
    varying(
        "pdf-multiplied",
        lambda pdf: pdf**2,
        "You multiplied by the pdf where you should divide by it.",
        "Вы умножили на плотность вероятности, а надо разделить.",
        needs=("pdf",),
    ),
    varying(
        "pdf-of-area",
        lambda distance, cosine_light: {
            "d²/cos θ'": distance**2 / cosine_light,
            "cos θ'/d²": cosine_light / distance**2,
        },
        "Your pdf is per area of the light where one per solid angle is asked, or the reverse: p_ω = "
        "p_A d²/cos θ'.",
        "Ваша плотность — на площадь источника, а нужна на телесный угол, или наоборот: p_ω = p_A d²/cos θ'.",
        needs=("distance", "cosine_light"),
        pairs=False,
    ),
    varying(
        "light-cosine-forgotten",
        lambda cosine_light: 1 / cosine_light,
        "You forgot the cosine at the light, cos θ': dω = cos θ' dA/d².",
        "Вы забыли косинус у источника, cos θ': dω = cos θ' dA/d².",
        needs=("cosine_light",),
    ),
    varying(
        "sum-for-mean",
        lambda samples: samples,
        "You did not divide by the number of samples N: the estimate is the mean, not the sum.",
        "Вы не разделили на число отсчётов N: оценка — это среднее, а не сумма.",
        needs=("samples",),
    ),
    varying(
        "divided-by-samples-twice",
        lambda samples: 1 / samples,
        "You divided by the number of samples N once too often.",
        "Вы лишний раз разделили на число отсчётов N.",
        needs=("samples",),
    ),
    varying(
        "one-sample-off",
        lambda samples: {
            "N-1": samples / (samples - 1),
            "N+1": samples / (samples + 1),
        },
        "You divided a sum of N samples by another number than N.",
        "Вы разделили сумму N отсчётов не на N.",
        needs=("samples",),
        pairs=False,
    ),
    varying(
        "lobe-normalisation",
        _normalisations,
        "You normalised the lobe of Phong or Blinn with another factor than is asked (yours ≠ the "
        "one asked).",
        "Вы нормировали лепесток Фонга или Блинна не тем множителем (ваш ≠ нужный).",
        needs=("exponent",),
    ),
    varying(
        "viewer-cosine-forgotten",
        lambda wo: 1 / wo[:, 2],
        "You forgot the cosine at the viewer, cos θo.",
        "Вы забыли косинус со стороны наблюдателя, cos θo.",
        needs=("wo",),
    ),
    varying(
        "viewer-cosine-twice",
        lambda wo: wo[:, 2],
        "You have the cosine at the viewer, cos θo, once too often, or in place of a division by it.",
        "У вас лишний косинус со стороны наблюдателя, cos θo, или нет деления на него.",
        needs=("wo",),
    ),
    varying(
        "microfacet-denominator",
        lambda wi, wo: {
            "4 cos θi cos θo": 4 * wi[:, 2] * wo[:, 2],
            "cos θi cos θo": wi[:, 2] * wo[:, 2],
        },
        "You forgot the denominator of a microfacet BRDF, or a part of it: f = D·G·F/(4 cos θi cos θo).",
        "Вы забыли знаменатель микрофасетной BRDF или его часть: f = D·G·F/(4 cos θi cos θo).",
        needs=("wi", "wo"),
        pairs=False,
    ),
    varying(
        "pdf-of-half-vector",
        # wo·h = |wi + wo|/2, so that 4 wo·h = 2 |wi + wo|.
        lambda wi, wo: 2 * np.linalg.norm(wi + wo, axis=-1),
        "Your pdf is that of the half vector: per solid angle of wi it is p(h)/(4 wo·h).",
        "Ваша плотность относится к полувектору: на телесный угол wi она равна p(h)/(4 wo·h).",
        needs=("wi", "wo"),
        pairs=False,
    ),
    varying(
        "half-vector-not-normalised",
        _half,
        "You did not normalise the half vector: h = (wi + wo)/|wi + wo|.",
        "Вы не нормировали полувектор: h = (wi + wo)/|wi + wo|.",
        needs=("wi", "wo"),
        pairs=False,
    ),
    varying(
        "half-vector-not-normalised-in-lobe",
        _half_power,
        "You did not normalise the half vector, and its length was raised to the power n: h = (wi + "
        "wo)/|wi + wo|.",
        "Вы не нормировали полувектор, и его длина возведена в степень n: h = (wi + wo)/|wi + wo|.",
        needs=("wi", "wo", "exponent"),
        pairs=False,
    ),
)
