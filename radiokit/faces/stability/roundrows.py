"""Round rows: the closed forms of spheres and disks: cut by the horizon, tiny, huge and all but touched."""

from __future__ import annotations

import math
import zlib
from typing import Any

import numpy as np

from radiokit.contracts.emitter import Emitter, emitter
from radiokit.faces.stability import lighttruth as truth
from radiokit.faces.stability.lights import Case, LightRow
from radiokit.facts.directions import unit
from radiokit.worlds.scene import Receiver

__all__ = ["generator", "received", "rows"]

_RANDOM = 24


def generator(name: str) -> np.random.Generator:
    """Return the row's own source of random configurations, always the same."""
    return np.random.default_rng(zlib.crc32(name.encode()))


def received(light: Emitter, position: Any, normal: Any) -> Any:
    """Return a light's closed-form irradiance."""
    receiver = Receiver(normal, position)
    return light.irradiance_at(receiver.origin, receiver.axis)


def rows() -> tuple[LightRow, ...]:
    """Return the rows."""
    return (
        LightRow(
            name="sphere irradiance",
            truth="Lagarde, de Rousiers (2014), the cut sphere by acos and atan",
            kernel=lambda *x: received(_sphere(x), x[5:8], x[8:11]),
            exact=lambda *x: x[4] * truth.sphere_irradiance(x[:3], x[3], x[5:8], x[8:11]),
            textbook=_sphere_irradiance_textbook,
            cases=_sphere_cases(),
        ),
        LightRow(
            name="sphere solid angle",
            truth="2π(1 − cosσ)",
            kernel=lambda *x: _sphere((*x[:4], 1.0)).solid_angle(np.array(x[4:7])),
            exact=lambda *x: truth.sphere_solid_angle(x[:3], x[3], x[4:7]),
            textbook=_cone_textbook,
            cases=tuple((label, (*x[:4], *x[5:8])) for label, x in _sphere_cases()),
        ),
        LightRow(
            name="sphere flux",
            truth="πL · 4πR²",
            kernel=lambda r, radiance: _sphere((0.0, 0.0, 0.0, r, radiance)).flux(),
            exact=lambda r, radiance: 4 * _pi() ** 2 * r**2 * radiance,
            cases=_pairs(),
        ),
        LightRow(
            name="disk irradiance",
            truth="½∮ n·(r × dr)/r², its primitive along arc and chord",
            kernel=lambda *x: received(_disk(x), x[8:11], x[11:14]),
            exact=lambda *x: x[7] * truth.disk_irradiance(x[:3], x[3:6], x[6], x[8:11], x[11:14]),
            cases=_disk_cases(),
        ),
        LightRow(
            name="disk solid angle",
            truth="Paxton (1959), complete elliptic integrals",
            kernel=lambda *x: _disk((*x[:7], 1.0)).solid_angle(np.array(x[7:10])),
            exact=lambda *x: truth.disk_solid_angle(x[:3], x[3:6], x[6], x[7:10]),
            cases=tuple((label, (*x[:7], *x[8:11])) for label, x in _disk_cases()),
        ),
        LightRow(
            name="cosine disk irradiance",
            truth="2πL (1 − cosⁿ⁺²σ)/(n + 2), on the axis",
            kernel=lambda h, r, n, radiance, x, z: received(
                emitter("disk", center=(0, 0, h), normal=(0, 0, -1), radius=r, radiance=radiance, exponent=n),
                (0, 0, 0),
                (x, 0, z),
            ),
            exact=lambda h, r, n, radiance, x, z: radiance * truth.cosine_disk(h, r, n, z / _hypot(x, z)),
            cases=_cosine_cases(),
        ),
        LightRow(
            name="disk flux",
            truth="2πL/(n + 2) · πR²",
            kernel=lambda r, radiance, n: emitter(
                "disk", center=(0, 0, 0), normal=(0, 0, 1), radius=r, radiance=radiance, exponent=n
            ).flux(),
            exact=lambda r, radiance, n: 2 * _pi() ** 2 * r**2 * radiance / (n + 2),
            cases=tuple((f"{label}, n {n:g}", (*x, n)) for label, x in _pairs() for n in (0.0, 0.3, 1e6)),
        ),
    )


def _pi() -> Any:
    import mpmath

    return +mpmath.pi


def _hypot(x: Any, z: Any) -> Any:
    import mpmath

    return mpmath.hypot(x, z)


def _sphere(x: tuple[float, ...]) -> Emitter:
    return emitter("sphere", center=x[:3], radius=x[3], radiance=x[4])


def _disk(x: tuple[float, ...]) -> Emitter:
    return emitter("disk", center=x[:3], normal=x[3:6], radius=x[6], radiance=x[7])


def _pairs() -> tuple[Case, ...]:
    return tuple(
        (f"R {r:g}, L {power:g}", (r, power)) for r in (1e-90, 0.3, 7e80) for power in (0.7, 1e-9, 3e12)
    )


def _cone_textbook(cx: float, cy: float, cz: float, r: float, px: float, py: float, pz: float) -> float:
    distance = math.dist((cx, cy, cz), (px, py, pz))
    return 2 * math.pi * (1 - math.cos(math.asin(r / distance)))


def _sphere_irradiance_textbook(*x: float) -> float:
    v = np.array(x[:3]) - x[5:8]
    distance = float(np.linalg.norm(v))
    share = (x[3] / distance) ** 2
    c = float(v @ x[8:11]) / distance
    if c * c >= share:
        return math.pi * share * max(c, 0.0) * x[4]
    slant, sine = math.sqrt(1 / share - 1), math.sqrt(1 - c * c)
    y = -slant * c / sine
    rise = sine * math.sqrt(1 - y * y)
    return ((c * math.acos(y) - slant * rise) * share + math.atan(rise / slant)) * x[4]


def _sphere_cases() -> tuple[Case, ...]:
    """Centre, radius, radiance, position, normal."""
    up, here = (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)
    tilted = (0.0, 0.6, 0.8)
    found: list[Case] = [
        ("overhead", (0.0, 0.0, 4.0, 1.0, 1.0, *here, *up)),
        ("aside", (3.0, -1.0, 2.0, 1.0, 1.5, *here, *tilted)),
        ("tiny", (0.3, 0.4, 1.0, 1e-8, 1.0, *here, *up)),
        ("tiny, cut in half", (3.0, 0.0, 0.0, 1e-8, 1.0, *here, *up)),
        ("tiny, far from the origin", (1e7 + 0.25, 3.0, 2.0, 1e-3, 1.0, 1e7, 3.5, 1.0, *up)),
        ("of a hundredth of a millionth of a radian, aslant", (1.0, 2e-9, 5e-9, 1e-8, 1.0, *here, *up)),
        ("huge", (0.0, 3e7, 9e8, 8.9e8, 1.0, *here, *tilted)),
        ("huge, a hair off", (0.0, 0.0, 1e8 + 2**-20, 1e8, 1.0, *here, *tilted)),
        ("centre in the horizon", (2.0, 0.0, 0.0, 1.0, 1.0, *here, *up)),
        ("centre below the horizon", (2.0, 0.0, -0.5, 1.0, 1.0, *here, *up)),
        ("the horizon touches from below", (2.0, 0.0, 1.0, 1.0, 1.0, *here, *up)),
        ("the horizon touches from above", (2.0, 0.0, -1.0, 1.0, 1.0, *here, *up)),
        ("all but wholly seen", (2.0, 0.0, 1 - 2.0**-45, 1.0, 1.0, *here, *up)),
        ("grazing", (100.0, 0.0, 1e-6, 1e-6, 1.0, *here, *up)),
        ("hair outside, facing", (0.0, 0.0, 1 + 2.0**-40, 1.0, 1.0, *here, *up)),
        ("hair outside, along", (1 + 2.0**-40, 0.0, 0.0, 1.0, 1.0, *here, *up)),
        ("hair outside, away", (0.6 + 2.0**-40, 0.0, -0.8, 1.0, 1.0, *here, *up)),
        ("an ulp outside", (1 + 2.0**-52, 0.0, 0.0, 1.0, 1.0, *here, *tilted)),
        ("an ulp outside, away", (2.0**-20, 0.0, -1 - 2.0**-52, 1.0, 1.0, *here, *up)),
        ("small numbers", (2e-140, 0.0, 1e-141, 1e-140, 1.0, *here, *up)),
        ("large numbers", (2e140, 0.0, -1e139, 1e140, 1.0, *here, *up)),
    ]
    found += [
        (f"sliver of 2^-{k}", (3.0, 0.0, -1 + 2.0**-k, 1.0, 1.0, *here, *up)) for k in (3, 10, 20, 30, 40, 50)
    ]
    found += [
        (f"sliver of 2^-{k}, tiny", (3.0, 0.0, (-1 + 2.0**-k) * 2.0**-30, 2.0**-30, 1.0, *here, *up))
        for k in (3, 10, 20, 30, 40)
    ]
    rng = generator("sphere")
    for k in range(_RANDOM):
        radius, position = (
            float(10 ** rng.uniform(-6, 6)),
            10 ** rng.uniform(-3, 3) * unit(rng.normal(size=3)),
        )
        distance = radius * (1 + 10 ** rng.uniform(-12, 6))
        normal, aside = unit(rng.normal(size=(2, 3)))
        lift = min(radius, distance) * rng.uniform(-1, 1)
        across = unit(aside - (aside @ normal) * normal)
        center = position + lift * normal + math.sqrt(max(distance**2 - lift**2, 0.0)) * across
        if math.dist(center, position) > radius:
            found.append((f"random {k}", tuple(map(float, (*center, radius, 1.0, *position, *normal)))))
    return tuple(found)


def _disk_cases() -> tuple[Case, ...]:
    """Centre, normal, radius, radiance, position, the receiver's normal."""
    up, here, down = (0.0, 0.0, 1.0), (0.0, 0.0, 0.0), (0.0, 0.0, -1.0)
    tilted, wall = (0.6, 0.0, 0.8), (1.0, 0.0, 0.0)
    found: list[Case] = [
        ("on the axis", (0.0, 0.0, 2.0, *down, 1.0, 1.0, *here, *up)),
        ("on the axis, aslant", (0.0, 0.0, 2.0, *down, 1.0, 1.0, *here, *tilted)),
        ("off the axis", (3.0, 1.0, 2.0, *down, 1.0, 1.0, *here, *up)),
        ("any pose", (1.0, -2.0, 2.0, -1.0, 1.0, -3.0, 1.5, 2.0, *here, *tilted)),
        ("any pose, cut", (1.0, -2.0, 0.25, -1.0, 1.0, -3.0, 1.5, 2.0, *here, *tilted)),
        ("upright, cut in half", (2.0, 0.0, 0.0, -1.0, 0.0, 0.0, 1.0, 1.0, *here, *up)),
        ("upright, touching the horizon", (2.0, 0.0, 1.0, -1.0, 0.0, 0.0, 1.0, 1.0, *here, *up)),
        ("tiny", (0.3, 0.4, 1.0, 0.1, 0.0, -1.0, 1e-8, 1.0, *here, *up)),
        ("tiny, cut", (1.0, 0.0, 0.0, -1.0, 0.0, 0.5, 1e-8, 1.0, *here, *up)),
        ("tiny, far from the origin", (1e7 + 0.5, 2.0, 3.0, *down, 1e-3, 1.0, 1e7, 2.25, 1.0, *up)),
        ("far", (2e8, 1e8, 3e8, *down, 1.0, 1.0, *here, *up)),
        ("huge", (10.0, 0.0, 1.0, 0.0, 1e-3, -1.0, 1e4, 1.0, *here, *tilted)),
        ("huge, cut", (10.0, 0.0, 1.0, *down, 1e8, 1.0, *here, *wall)),
        ("grazing", (3.0, 0.0, 1e-9, *down, 2.0, 1.0, *here, *up)),
        ("grazing and far", (1e6, 0.0, 1e-3, *down, 2.0, 1.0, *here, *up)),
        ("close to its plane, inside", (0.5, 0.0, 1e-9, *down, 1.0, 1.0, *here, *up)),
        ("close to its plane, inside, cut", (0.5, 0.0, 1e-9, *down, 1.0, 1.0, *here, *tilted)),
        ("close to its rim, outside", (1 + 2.0**-30, 0.0, 2.0**-30, *down, 1.0, 1.0, *here, *up)),
        ("close to its rim, inside", (1 - 2.0**-30, 0.0, 2.0**-31, *down, 1.0, 1.0, *here, *up)),
        ("under its rim", (1.0, 0.0, 2.0**-30, *down, 1.0, 1.0, *here, *up)),
        ("under its rim, cut", (1.0, 0.0, 2.0**-30, *down, 1.0, 1.0, *here, *wall)),
        ("from behind", (0.0, 0.0, 2.0, *up, 1.0, 1.0, *here, *up)),
        ("in its plane", (3.0, 0.0, 0.0, *down, 1.0, 1.0, *here, *up)),
        ("below the horizon", (0.0, 0.0, -2.0, *up, 1.0, 1.0, *here, *up)),
        ("small numbers", (3e-90, 1e-90, 2e-90, *down, 1e-90, 1.0, *here, *up)),
        ("large numbers", (3e90, 1e90, 2e90, *down, 1e90, 1.0, *here, *tilted)),
    ]
    found += [
        (f"sliver of 2^-{k}", (3.0, 0.5, -1 + 2.0**-k, -1.0, 0.0, 0.0, 1.0, 1.0, *here, *up))
        for k in (3, 10, 20, 30, 40)
    ]
    found += [
        (f"all but whole by 2^-{k}", (3.0, 0.5, 1 - 2.0**-k, -1.0, 0.0, 0.0, 1.0, 1.0, *here, *up))
        for k in (10, 30, 45)
    ]
    rng = generator("disk")
    for k in range(_RANDOM):
        radius, position = (
            float(10 ** rng.uniform(-4, 4)),
            10 ** rng.uniform(-2, 2) * unit(rng.normal(size=3)),
        )
        m, n = unit(rng.normal(size=(2, 3)))
        towards = unit(rng.normal(size=3)) * radius * 10 ** rng.uniform(-1, 3)
        m = -m if m @ towards > 0 else m
        found.append(
            (f"random {k}", tuple(map(float, (*position + towards, *m, radius, 1.0, *position, *n))))
        )
    return tuple(found)


def _cosine_cases() -> tuple[Case, ...]:
    """Distance, radius, n, radiance, and the receiver's normal in the xz plane."""
    sizes = ((2.0, 1.0), (1.0, 1e-6), (1e-6, 1.0), (3.0, 1e-90), (1e60, 1e61))
    return tuple(
        (f"h {h:g}, R {r:g}, n {n:g}, normal {normal}", (h, r, n, 1.5, *normal))
        for h, r in sizes
        for n in (0.5, 1.0, 10.0, 1e4)
        for normal in ((0.0, 1.0), (2.0**-60, 1.0) if r > h else (1e-3, 1.0))
        if h > r or normal[0] == 0.0
    )
