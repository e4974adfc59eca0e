"""Cases: every exact value again at 50 digits, every method on every case, and faults that must be found."""

from __future__ import annotations

import dataclasses
import itertools
import json
import math
import pickle

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from radiokit.facts.errors import UnknownNameError
from radiokit.facts.estimate import Estimate
from radiokit.facts.verdict import Evidence, Outcome
from radiokit.measure.statistics import sidak
from radiokit.measure.twin import ulps
from radiokit.worlds.cases.catalogue import case, list_cases
from radiokit.worlds.shading import shade

CASES = [case(name) for name in list_cases()]
PAIRS = [(item, method) for item in CASES for method in item.methods]
LEVEL = sidak(1e-3, len(PAIRS))


# --- the exact values, again ---


def deg(x):
    return mpmath.radians(mpf(x))


def phong(n, theta_deg):
    """∫ (n + 2)/2π cosⁿα cosθ dω in rings about the mirror direction, each clipped by the horizon."""
    tilt = deg(theta_deg)

    def ring(a):
        p, q = mpmath.cos(tilt) * mpmath.cos(a), mpmath.sin(tilt) * mpmath.sin(a)
        if p >= q or q == 0:
            return 2 * mpmath.pi * p
        edge = mpmath.acos(-p / q)
        return 2 * (p * edge + q * mpmath.sin(edge))

    bends = [0, mpmath.pi / 2 - tilt, mpmath.pi / 2] if tilt else [0, mpmath.pi / 2]
    return (
        (n + 2) / (2 * mpmath.pi) * mpmath.quad(lambda a: mpmath.cos(a) ** n * ring(a) * mpmath.sin(a), bends)
    )


def ggx_one(theta_deg):
    """∫ μi/(μi + μo) dμi, by quadrature of the Lommel–Seeliger form."""
    mu = mpmath.cos(deg(theta_deg))
    return mpmath.quad(lambda x: x / (x + mu), [0, 0.1, 1])


def gauss(n):
    """Gauss–Legendre on [0, 1] by Newton's method, in the working precision."""
    for k in range(n):
        x = mpmath.cos(mpmath.pi * (k + mpf(3) / 4) / (n + mpf(1) / 2))
        for _ in range(8):
            before, now = mpf(1), x
            for j in range(2, n + 1):
                before, now = now, ((2 * j - 1) * x * now - (j - 1) * before) / j
            slope = n * (x * now - before) / (x * x - 1)
            x -= now / slope
        yield (1 + x) / 2, 1 / ((1 - x * x) * slope * slope)


def ggx_by_slope(alpha, theta_deg, n):
    """Albedo of GGX in the slope of the half vector, ρ(cosφ, sinφ), up to the horizon ρ = e^y.

    E = ∫ α²/π(α² + ρ²)² · G₂ · (1 + ρ sinh y) ρ dρ dφ, with sinh y = tanθo cosφ.
    """
    a, theta = mpf(alpha), deg(theta_deg)
    tan_o, cos_o = mpmath.tan(theta), mpmath.cos(theta)
    reach = mpmath.asinh(tan_o)
    lambda_o = (mpmath.sqrt(1 + a * a * tan_o**2) - 1) / 2
    nodes = list(gauss(n))
    total = mpf(0)
    for k in range(n):
        s = mpmath.pi * (k + mpf(1) / 2) / n
        y = reach * mpmath.cos(s)
        rise, edge = mpmath.sinh(y), mpmath.exp(y)
        turn = reach * mpmath.cosh(y) * mpmath.sin(s) / mpmath.sqrt(tan_o**2 - rise**2)  # dφ/ds
        length = mpmath.asinh(edge / a)
        for x, w in nodes:
            t = length * x * (2 - x)
            rho = a * mpmath.sinh(t)
            mu = cos_o * (edge - rho) * (rho + 1 / edge) / (1 + rho * rho)
            lambda_i = (mpmath.sqrt(1 + a * a * (1 / mu**2 - 1)) - 1) / 2
            value = rho * (1 + rho * rise) / (a * a + rho * rho) ** 2 / (1 + lambda_o + lambda_i)
            total += w * value * turn * a * mpmath.cosh(t) * length * 2 * (1 - x)
    return total * a * a * 2 / n


def ggx_by_angle(alpha, theta_deg, n):
    """The same albedo in the angles of the incident direction: other coordinates, other rule."""
    a, theta = mpf(alpha), deg(theta_deg)
    cos_o, sin_o = mpmath.cos(theta), mpmath.sin(theta)
    lambda_o = (mpmath.sqrt(1 + (a * sin_o / cos_o) ** 2) - 1) / 2
    ring = [mpmath.cos(mpmath.pi * (k + mpf(1) / 2) / n) for k in range(n)]
    total = mpf(0)
    for x, w in gauss(n):
        c, s = mpmath.cos(x * mpmath.pi / 2), mpmath.sin(x * mpmath.pi / 2)
        lambda_i = (mpmath.sqrt(1 + (a * s / c) ** 2) - 1) / 2
        inner = mpf(0)
        for cosine in ring:
            up = (cos_o + c) ** 2 / (2 + 2 * (sin_o * s * cosine + cos_o * c))
            inner += 1 / ((1 - up) + a * a * up) ** 2
        total += w * inner * s / (1 + lambda_o + lambda_i)
    return total * mpmath.pi * a * a / (4 * n * cos_o)


def sky(tilt_deg):
    """ρ/π times the integral over longitude and latitude of the lune that both horizons bound."""
    latitude = mpmath.quad(lambda x: mpmath.cos(x) ** 2, [-mpmath.pi / 2, mpmath.pi / 2])
    return latitude * (1 - mpmath.sin(deg(tilt_deg) - mpmath.pi / 2)) / (2 * mpmath.pi)


def lobe_of_sky(law, tilt_deg):
    """ρE/π for ρ = ½ in rings about the zenith: the law L(cosθ) times what a slope sees of each ring."""
    tilt = deg(tilt_deg)

    def ring(theta):
        a, b = mpmath.sin(theta) * mpmath.sin(tilt), mpmath.cos(theta) * mpmath.cos(tilt)
        edge = mpmath.pi if b >= a else mpf(0) if b <= -a else mpmath.acos(-b / a)
        return law(mpmath.cos(theta)) * mpmath.sin(theta) * 2 * (a * mpmath.sin(edge) + b * edge)

    bend = abs(mpmath.pi / 2 - tilt)
    ends = [0, bend, mpmath.pi / 2] if tilt and tilt_deg != "90" else [0, mpmath.pi / 2]
    return mpmath.quad(ring, ends) / (2 * mpmath.pi)


def ggx_one_under(law, theta_deg, low=0, share=1):
    """∫ L(μ) μ/(μ + μo) dμ from ``low`` to 1, or over the share of the azimuth that is lit."""
    mu = mpmath.cos(deg(theta_deg))
    return share * mpmath.quad(lambda x: law(x) * x / (x + mu), [low, (low + mpf(1)) / 4 + low / 2, 1])


def phong_zenith(law, low=0, share=1):
    """∫ (n + 2) L(μ) μⁿ⁺¹ dμ for n = 10."""
    return share * mpmath.quad(lambda x: 12 * law(x) * x**11, [low, 1])


def octant(tilt_deg):
    """ρ/π ∫ 2 (cosθ cosβ − sinθ cosφ sinβ)⁺ dω over an octant; the horizon is at cotθ = cosφ tanβ."""
    tilt = deg(tilt_deg)

    def meridian(phi):
        edge = mpmath.atan2(mpmath.cos(tilt), mpmath.cos(phi) * mpmath.sin(tilt))
        down, out = mpmath.sin(edge) ** 2 / 2, (edge - mpmath.sin(edge) * mpmath.cos(edge)) / 2
        return mpmath.cos(tilt) * down - mpmath.sin(tilt) * mpmath.cos(phi) * out

    return mpmath.quad(meridian, [0, mpmath.pi / 2]) / mpmath.pi


def spot_law(cosine, outer_deg):
    """The smooth step of a cone whose intensity is full on the axis alone."""
    t = max(mpf(0), (cosine - mpmath.cos(deg(outer_deg))) / (1 - mpmath.cos(deg(outer_deg))))
    return t * t * (3 - 2 * t)


def overcast(c):
    return (1 + 2 * c) / 3


def series(reflectance):
    """Σ ρᵏ for the binary number that the float is."""
    return mpmath.nsum(lambda k: mpf(reflectance) ** k, [0, mpmath.inf])


def sphere(reflectances, shares, first):
    """The irradiance Σ fⱼBⱼ in a diffuse sphere whose parts' exitances solve Bᵢ = Mᵢ + ρᵢ Σ fⱼBⱼ."""
    rho, f = [mpf(r) for r in reflectances], [mpf(share) for share in shares]
    n = len(rho)
    system = mpmath.matrix(n, n)
    for i, j in itertools.product(range(n), repeat=2):
        system[i, j] = (i == j) - rho[i] * f[j]
    exitance = mpmath.lu_solve(system, mpmath.matrix(first))
    return sum(f[j] * exitance[j] for j in range(n))


def three_ports():
    """The lamp emits π W/m² from 2 % of the sphere."""
    return sphere(["0.9", "0.2", "0.4", "0"], ["0.94", "0.02", "0.03", "0.01"], [0, mpmath.pi, 0, 0])


def lamps_on_floor():
    """Σ cosθ/d² at (0, 0, −1) for the four lamps, from their places."""
    places = (("0.6", "0", "-0.2"), ("-0.6", "0", "-0.2"), ("0", "0.3", "-0.6"), ("0", "0", "0.5"))
    total = mpf(0)
    for x, y, z in places:
        height = mpf(z) + 1
        total += height / (mpf(x) ** 2 + mpf(y) ** 2 + height**2) ** mpf("1.5")
    return total


def facing(x, y):
    """Howell's C-11, of equal parallel rectangles x by y at distance 1."""
    p, q = 1 + x * x, 1 + y * y
    return 2 / (mpmath.pi * x * y) * (
        mpmath.log(p * q / (1 + x * x + y * y)) / 2
        + x * mpmath.sqrt(q) * mpmath.atan(x / mpmath.sqrt(q))
        + y * mpmath.sqrt(p) * mpmath.atan(y / mpmath.sqrt(p))
        - x * mpmath.atan(x)
        - y * mpmath.atan(y)
    )  # fmt: skip


def aside(h, w):
    """Howell's C-14, of rectangles of depths w and h at a common edge of length 1."""
    a, b = h * h, w * w
    logs = (
        mpmath.log((1 + a) * (1 + b) / (1 + a + b))
        + b * mpmath.log(b * (1 + a + b) / ((1 + b) * (a + b)))
        + a * mpmath.log(a * (1 + a + b) / ((1 + a) * (a + b)))
    )
    far = mpmath.sqrt(a + b)
    angles = w * mpmath.atan(1 / w) + h * mpmath.atan(1 / h) - far * mpmath.atan(1 / far)
    return (angles + logs / 4) / (mpmath.pi * w)


def highlight(alpha, theta_deg):
    """f cosθ E⊥ at the mirror pair, factor by factor from the model's definition."""
    a, theta = mpf(alpha), deg(theta_deg)
    density = 1 / (mpmath.pi * a * a)
    masking = (mpmath.sqrt(1 + (a * mpmath.tan(theta)) ** 2) - 1) / 2
    shadowed = 1 / (1 + 2 * masking)
    return density * shadowed / (4 * mpmath.cos(theta) ** 2) * 2 * mpmath.cos(theta)


def under_disk(radius, depth, offset):
    """ρ/π ∫ cos⁴/a² dA in rings about the disk's centre, the angle by hand."""
    a, b = mpf(depth), mpf(offset)

    def ring(t):  # ∫ dφ/(s + 2bρ cosφ)² = 2π s/(s² − 4b²ρ²)^(3/2), in t = (ρ/R)²
        square = t * mpf(radius) ** 2
        s = a * a + b * b + square
        return s / (s * s - 4 * b * b * square) ** mpf(1.5) * (a * mpf(radius)) ** 2

    return mpmath.quad(ring, [0, *[mpf(10) ** k for k in range(-9, 0)], 1]) / 2


def under_sphere(sine, elevation_deg):
    """ρ/π ∫ cosθ dω in rings about the way to the centre, each clipped by the horizon."""
    e = deg(elevation_deg)

    def ring(a):
        p, q = mpmath.sin(e) * mpmath.cos(a), mpmath.cos(e) * mpmath.sin(a)
        if p >= q:
            return 2 * mpmath.pi * p * mpmath.sin(a)
        edge = mpmath.acos(-p / q) if p > -q else mpf(0)
        return 2 * (p * edge + q * mpmath.sin(edge)) * mpmath.sin(a)

    end = mpmath.asin(sine)
    breaks = [0, abs(e), end] if 0 < abs(e) < end else [0, end]
    return mpmath.quad(ring, breaks) / (2 * mpmath.pi)


def wall_beside_disk():
    """ρ/π ∫∫ a x/r⁴ dA, x the way along the wall's normal, in strips across it."""

    def strip(t):
        x, half = 3 + mpmath.sin(t), mpmath.cos(t)
        s = mpmath.sqrt(x * x + 4)
        return 2 * x * half * (half / (s * s * (s * s + half * half)) + mpmath.atan(half / s) / s**3)

    return mpmath.quad(strip, [-mpmath.pi / 2, 0, mpmath.pi / 2]) / (2 * mpmath.pi)


def wall_under_disk():
    """The same 1 m below a disk's centre, in half rings, over which ∫ cosφ dφ is 2."""
    return mpmath.quad(lambda rho: 2 * rho**2 / (rho**2 + 1) ** 2, [0, 1]) / (2 * mpmath.pi)


def phong_cone(cosine_squared):
    """∫ 12 cos¹¹α sinα dα up to the light's edge."""
    edge = mpmath.acos(mpmath.sqrt(cosine_squared))
    return mpmath.quad(lambda a: 12 * mpmath.cos(a) ** 11 * mpmath.sin(a), [0, edge])


ROUND = {
    "lambert-under-disk": lambda: under_disk(1, 1, 0),
    "lambert-under-disk-tiny": lambda: under_disk(mpf(10) ** -6, 1, 0),
    "lambert-under-disk-huge": lambda: under_disk(1e4, 1, 0),
    "lambert-under-disk-off-axis": lambda: under_disk(1, 2, 3),
    "lambert-under-disk-below-its-edge": lambda: under_disk(1, mpf(1) / 2, 1),
    "lambert-under-disk-tilted": lambda: under_disk(1, 2, 0) * mpmath.sqrt(2) / 2,
    "lambert-wall-beside-disk": wall_beside_disk,
    "lambert-wall-under-disk": wall_under_disk,
    "lambert-under-cos2-disk": lambda: mpmath.quad(lambda t: mpf(1) / 2 / (1 + t) ** 3, [0, 1]),
    "phong-10-under-disk": lambda: phong_cone(mpf("0.8")),
    "phong-10-under-sphere": lambda: phong_cone(mpf("0.64")),
    "phong-10-under-sphere-at-mirror": lambda: phong_cone(mpf("0.91")) / 2,
    "mirror-under-sphere": lambda: mpf(0.9),
    **{
        f"lambert-under-sphere-at-{text}": lambda r=r: under_sphere(1 / mpf(r), 90)
        for text, r in (("1.001m", 1.001), ("2m", 2.0), ("100m", 100.0), ("1000km", 1e6))
    },
    "lambert-under-sphere-30deg-above-horizon": lambda: under_sphere(mpf("0.3"), 30),
    "lambert-under-sphere-10deg-above-horizon": lambda: under_sphere(mpf("0.5"), 10),
    "lambert-under-sphere-in-horizon": lambda: under_sphere(mpf("0.5"), 0),
    "lambert-under-sphere-10deg-below-horizon": lambda: under_sphere(mpf("0.5"), -10),
    "lambert-wall-beside-sphere": lambda: under_sphere(1 / (1 + mpf(2) ** -20), 0),
}


def partial_eclipse():
    """ρ/π ∫ cosθ dω in rings about the normal, less the azimuths that the other sphere hides."""
    sun, moon = mpmath.asin(mpf(1) / 4), mpmath.asin(mpf("0.5") / mpmath.sqrt(mpf("4.16")))
    aside = mpmath.atan(mpf(1) / 5)

    def ring(theta):
        across = mpmath.sin(theta) * mpmath.sin(aside)
        edge = (mpmath.cos(moon) - mpmath.cos(theta) * mpmath.cos(aside)) / across
        hidden = mpmath.acos(min(edge, mpf(1)))
        return 2 * (mpmath.pi - hidden) * mpmath.cos(theta) * mpmath.sin(theta)

    return mpmath.quad(ring, [moon - aside, sun]) / (2 * mpmath.pi)  # the zenith is dark


SHADOWS = {
    "lambert-in-total-eclipse": lambda: mpf(0),
    "lambert-in-annular-eclipse": lambda: under_sphere(mpf(1) / 4, 90) - under_sphere(mpf(1) / 5, 90),
    "lambert-in-partial-eclipse": partial_eclipse,
    "phong-10-in-annular-eclipse": lambda: phong_cone(mpf("0.9375")) - phong_cone(mpf("0.96")),
    "mirror-in-annular-eclipse": lambda: mpf(0),
    "lambert-under-disk-behind-disk": lambda: under_disk(1, 2, 0) - under_disk(mpf(1) / 4, 1, 0),
    "lambert-under-disk-behind-speck": lambda: under_disk(1, 2, 0) - under_disk(mpf(10) ** -6, 1, 0),
    "lambert-under-sky-behind-disk": lambda: sky("0") - under_disk(1, 1, 0),
    "lambert-under-sky-beside-ball": lambda: sky("0") - under_sphere(mpf(1) / 2, 0),
    "lambert-under-sky-behind-two-balls": lambda: (
        sky("0")
        - under_sphere(mpf(1) / 2, 90)
        - under_sphere(mpf(1) / 4, mpmath.degrees(mpmath.asin(mpf(3) / 5)))
    ),
    "lambert-under-overcast-sky-behind-ball": lambda: mpmath.quad(
        lambda t: overcast(mpmath.cos(t)) * mpmath.sin(t) * mpmath.cos(t), [deg(30), deg(90)]
    ),
    "lambert-under-point-behind-ball": lambda: mpf(0),
    "lambert-under-point-beside-ball": lambda: mpf(1) / 2 / mpmath.pi,
}


def dot(a, b):
    return mpmath.fsum(x * y for x, y in zip(a, b, strict=True))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def above(points, n):
    """The part of a polygon on the side of n."""
    heights, found = [dot(p, n) for p in points], []
    for k, (p, h) in enumerate(zip(points, heights, strict=True)):
        if (heights[k - 1] > 0) != (h > 0):
            share = heights[k - 1] / (heights[k - 1] - h)
            found.append([a + share * (b - a) for a, b in zip(points[k - 1], p, strict=True)])
        if h > 0:
            found.append(p)
    return found


def rings(points, pole, ring):
    """−∮ ring(cosθ, sinθ, direction across) dφ along a polygon's edges, about a pole."""
    size = mpmath.sqrt(dot(pole, pole))
    z = [x / size for x in pole]
    x = cross([1, 0, 0] if abs(z[0]) < 0.7 else [0, 1, 0], z)
    size = mpmath.sqrt(dot(x, x))
    x = [c / size for c in x]
    y = cross(z, x)
    local = [[dot(p, axis) for axis in (x, y, z)] for p in points]
    total = mpf(0)
    for p, q in zip(local, local[1:] + local[:1], strict=True):
        start, n = mpmath.atan2(p[1], p[0]), cross(p, q)
        turn = mpmath.atan2(n[2], p[0] * q[0] + p[1] * q[1])
        if abs(turn) < mpf(10) ** (5 - mpmath.mp.dps):
            continue  # along a meridian

        def along(s, start=start, n=n):
            c, d = mpmath.cos(start + s), mpmath.sin(start + s)
            cot = -(n[0] * c + n[1] * d) / n[2]
            sine = 1 / mpmath.sqrt(1 + cot * cot)
            return ring(cot * sine, sine, [c * a + d * b for a, b in zip(x, y, strict=True)])

        size = max(abs(along(turn * k / 4)) for k in range(5))
        total -= size * mpmath.quad(lambda s, f=along, size=size: f(s) / size, mpmath.linspace(0, turn, 5))
    return total


def numbers(vectors):
    return [[mpf(x) for x in v] for v in vectors]


def decimal(direction):
    """The direction as a case states it: (0.6, 0, 0.8) is of length 1 exactly."""
    return [mpf(repr(x)) for x in direction]


def shadow(*lights, normal=(0.0, 0.0, 1.0)):
    """ρ/π times the area of the lights' shadow on the base of the hemisphere (Nusselt's analogue)."""
    n = decimal(normal)
    parts = [above(numbers(vertices), n) for vertices in lights]
    return sum(rings(p, n, lambda c, s, w: s * s / 2) for p in parts if p) / (2 * mpmath.pi)


def lobe(vertices, n, wo):
    """(n + 2)/2π ∫ cosⁿα cosθ dω in rings about the mirror direction, in the light and above the horizon."""
    w = decimal(wo)
    mirror = [-w[0], -w[1], w[2]]
    points = above(above(numbers(vertices), [0, 0, 1]), mirror)

    def ring(cosine, sine, across):
        rest = mpmath.betainc(mpf(3) / 2, mpf(n + 1) / 2, 0, sine * sine) / 2
        return mirror[2] * (1 - cosine ** (n + 2)) / (n + 2) + across[2] * rest

    return (n + 2) / (2 * mpmath.pi) * rings(points, mirror, ring)


def level(points):
    """A light at height 1 that shines down, from corners counter-clockwise as seen from above."""
    return [(x, y, 1.0) for x, y in reversed(points)]


def block(x0, x1, y0, y1):
    return level([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])


def wall(low, high):
    return [(1, 1, low), (1, -1, low), (1, -1, high), (1, 1, high)]


_STAR = [(4, 0), (1, 1), (0, 4), (-1, 1), (-4, 0), (-1, -1), (0, -4), (1, -1)]
STAR = level([(x / 4, y / 4) for x, y in _STAR])
ELL = level([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)])
PANEL = block(-0.5, 1.5, -1, 1)
POLYGONS = {
    **{
        f"lambert-under-square-of-{text}": lambda a=a: shadow(block(-a, a, -a, a))
        for text, a in (("2µm", 1e-6), ("2cm", 0.01), ("50cm", 0.25), ("2m", 1.0), ("20km", 1e4),
                        ("200000km", 1e8))
    },
    "lambert-under-ell": lambda: (2 * shadow(block(-2, 2, -1, 1)) - shadow(block(-1, 1, -1, 1))) / 4,
    "lambert-under-octant": lambda: mpf(1) / 8,
    "lambert-beside-wall": lambda: shadow(wall(-1, 1)),
    "lambert-under-light-behind": lambda: mpf(0),
    "lambert-in-plane-of-light": lambda: mpf(0),
    "lambert-in-box-of-light": lambda: mpf(1) / 2,
    "lambert-under-square-tilted-a-little": lambda: shadow(PANEL, normal=(0.28, 0, 0.96)),
    "lambert-under-square-tilted-much": lambda: shadow(PANEL, normal=(0.6, 0.64, 0.48)),
    "lambert-under-square-tilted-upright": lambda: shadow(PANEL, normal=(1, 0, 0)),
    "lambert-under-square-tilted-down": lambda: shadow(PANEL, normal=(0.6, 0, -0.8)),
    "lambert-under-star": lambda: shadow(STAR),
    "lambert-under-triangle-cut": lambda: shadow([(1, -1, -1), (1, 0, 1.5), (1, 2, -0.5)]),
    "lambert-under-triangle-touching-horizon": lambda: shadow([(1, 0, 0), (1, -0.5, 1), (1, 0.5, 1)]),
    "lambert-under-sliver": lambda: shadow([(-1, -0.5, 1), (0, 0.25 + 2.0**-20, 1), (1, 1, 1)]),
    "lambert-beside-skirting": lambda: shadow(wall(0, 2.0**-10)),
    "lambert-under-half-of-square": lambda: shadow(block(-1, 1, -1, 1)) / 2,
    "lambert-under-square-behind-square": lambda: shadow(block(-1, 1, -1, 0.5), block(-1, 0.5, 0.5, 1)),
    "lambert-under-square-below-wall": lambda: shadow(block(-1, 1, -1, 1)),
    "lambert-in-courtyard": lambda: shadow(block(-1, 1, -1, 1)),
    **{f"phong-{n}-under-octant": lambda: mpf(1) / 4 for n in (1, 20, 200)},
    "phong-1-under-square": lambda: lobe(PANEL, 1, (-0.6, 0, 0.8)),
    "phong-20-under-square": lambda: lobe(PANEL, 20, (0.6, 0, 0.8)),
    "phong-200-under-square": lambda: lobe(PANEL, 200, (0, 0.6, 0.8)),
    "phong-50-under-ell": lambda: lobe(ELL, 50, (-0.48, -0.6, 0.64)),
    "phong-10-under-wall": lambda: lobe(wall(-1, 1), 10, (-0.96, 0, 0.28)),
}  # fmt: skip


EXACT = {
    **ROUND,
    **SHADOWS,
    "lambert-in-furnace": lambda: mpf(1) / 2,
    "mirror-in-furnace": lambda: mpf(0.9),
    **{f"phong-10-in-furnace-at-{t}deg": lambda t=t: phong(10, t) for t in (0, 30, 60, 80)},
    **{f"ggx-1-in-furnace-at-{t}deg": lambda t=t: ggx_one(t) for t in (0, 30, 60, 80, 89)},
    "lambert-under-irradiance-pi": lambda: 2 * mpmath.quad(lambda mu: mu, [0, 1]),
    **{
        f"lambert-under-sky-tilted-{t}deg": lambda t=t: sky(t)
        for t in ("0", "30", "60", "90", "120", "150", "179.9", "180")
    },
    **{
        f"lambert-under-point-at-{text}": lambda r=r: mpf(0.5) / mpmath.pi * 3 / mpf(r) ** 2
        for text, r in (("1mm", 1e-3), ("1m", 1.0), ("50m", 50.0), ("1000km", 1e6))
    },
    **{
        f"lambert-under-sun-at-{t}deg": lambda t=t: max(mpf(0), 500 / mpmath.pi * mpmath.cos(deg(t)))
        for t in ("0", "60", "89.999", "90.001", "180")
    },
    "lambert-under-three-lights": lambda: (
        mpf("0.6") / mpmath.pi * (mpf(8) / 25 * mpf("0.8") + 2 * mpf("0.6"))
    ),
    "ggx-1-under-point": lambda: mpf(8) / 25 * mpf("0.8") / (2 * mpmath.pi * mpf("1.6")),
    **{f"ggx-{a}-highlight-at-{t}deg": lambda a=a, t=t: highlight(a, t)
       for a, t in (("0.3", 60), ("0.01", 45), ("0.1", 89))},
    **{f"lambert-under-overcast-sky-tilted-{t}deg": lambda t=t: lobe_of_sky(overcast, t)
       for t in ("0", "30", "60", "90", "150")},
    **{f"lambert-under-linear-sky-tilted-{t}deg": lambda t=t: lobe_of_sky(lambda c: 3 - 2 * c, t)
       for t in ("0", "45", "90")},
    **{f"lambert-under-quadratic-sky-tilted-{t}deg": lambda t=t: lobe_of_sky(lambda c: 1 + (c + c * c) / 2, t)
       for t in ("0", "60", "120")},
    **{f"lambert-between-sky-and-ground-tilted-{t}deg": lambda t=t: (
           lobe_of_sky(lambda c: 1, t) + lobe_of_sky(lambda c: mpf(1) / 5, str(180 - int(t))))
       for t in ("0", "45", "90", "135")},
    "mirror-under-overcast-sky": lambda: mpf("0.9") * overcast(mpf(1) / 2),
    "phong-10-under-overcast-sky": lambda: phong_zenith(overcast),
    **{f"ggx-1-under-overcast-sky-at-{t}deg": lambda t=t: ggx_one_under(overcast, t) for t in (0, 60)},
    "ggx-1-under-quadratic-sky": lambda: ggx_one_under(lambda c: c * c, 60),
    "lambert-in-furnace-map": lambda: mpf(1) / 2,
    "lambert-under-bright-cell": lambda: (
        mpmath.quad(lambda a: mpmath.cos(a) * mpmath.sin(a), [deg(45), deg(90)])
    ),
    "phong-10-under-bright-cell": lambda: phong_zenith(lambda c: 8, mpmath.cos(deg(45)), mpf(1) / 8),
    "ggx-1-under-bright-cell": lambda: (
        ggx_one_under(lambda c: 1, 60) - ggx_one_under(lambda c: 1, 60, mpmath.cos(deg(45)))
    ),
    **{f"lambert-under-bright-octant-tilted-{t}deg": lambda t=t: octant(t) for t in (0, 30, 60)},
    "lambert-on-axis-of-spot": lambda: mpf(5) / 8 / mpmath.pi * spot_law(mpf(1), 45),
    "lambert-in-falloff-of-spot": lambda: spot_law(mpf("0.8"), 90) / 5 * mpf("0.8") / (2 * mpmath.pi),
    "lambert-outside-of-spot": lambda: spot_law(mpf("0.6"), 45),
    "ggx-1-in-falloff-of-spot": lambda: (
        spot_law(mpf("0.8"), 90) / 5 * mpf("0.8") / (2 * mpmath.pi * mpf("1.6"))
    ),
    **{f"lambert-{place}-of-luminaire": lambda cd=cd: (
           mpf(cd) / 683 / 2 * mpmath.cos(deg(45)) / (2 * mpmath.pi))
       for place, cd in (("in-right-lobe", 1366), ("in-left-lobe", 1366), ("between-lobes", 683))},
    "lambert-at-nadir-of-luminaire": lambda: mpf(0),
    "ggx-1-in-lobe-of-luminaire": lambda: (
        mpmath.cos(deg(45)) / (2 * mpmath.pi * (1 + mpmath.cos(deg(45))))
    ),
    **{f"lambert-enclosure-{r}": lambda r=r: series(float(r)) for r in ("0.1", "0.5", "0.9")},
    "box-of-equal-walls": lambda: sphere(["0.6"], ["1"], [1]),
    "sphere-of-mixed-wall": lambda: sphere(["0.7"], ["1"], [1]),
    "spectral-sphere": lambda: sphere(["0.2"], ["1"], [1]),
    "sphere-with-emitting-wall": lambda: sphere(["0.5"], ["1"], [mpf("0.5")]),
    "furnace-box": lambda: mpf(1),
    "furnace-box-of-mirrors-and-paint": lambda: mpf(1),
    "sphere-with-lamp-at-centre": lambda: sphere(["0.5"], ["1"], [mpmath.pi / 2]) / mpmath.pi,
    "sphere-with-four-lamps": lambda: (
        (lamps_on_floor() * 45 * mpmath.pi / 208 + sphere(["0.5"], ["1"], [4 * 45 * mpmath.pi / 416]))
        / 2 / mpmath.pi
    ),
    "sphere-with-four-lamps-on-average": lambda: sphere(["0.5"], ["1"], [mpmath.pi / 2]) / mpmath.pi,
    "integrating-sphere-one-port": lambda: (
        (1 + sphere(["0.95", "0"], ["0.98", "0.02"], [mpf("0.95"), 0])) / (4 * mpmath.pi**2)
    ),
    "integrating-sphere-two-ports": lambda: (
        sphere(["0.5", "0", "0"], ["0.96", "0.02", "0.02"], [mpf("0.5") / mpf("0.96"), 0, 0])
        / (4 * mpmath.pi**2)
    ),
    "integrating-sphere-three-ports": lambda: three_ports() / mpmath.pi,
    "integrating-sphere-sample": lambda: mpf("0.4") * three_ports() / mpmath.pi,
    "integrating-sphere-0.99": lambda: mpf("0.99") / (4 * mpmath.pi**2) * (
        1 + sphere(["0.99", "0"], ["0.97", "0.03"], [mpf("0.99"), 0])
    ),
    "blackbody-cavity": lambda: sphere(["0.3", "0"], ["0.9", "0.1"], [mpf("0.7"), 0]),
    "black-box-opposite-wall": lambda: facing(mpf(3) / 2, mpf(4) / 2),
    "black-box-next-wall": lambda: aside(mpf(3) / 4, mpf(2) / 4),
}  # fmt: skip
NUMERIC = {
    "ggx-0.3-in-furnace-at-60deg": ("0.3", 60, 40),
    "ggx-0.05-in-furnace-at-89deg": ("0.05", 89, 70),
}


def test_every_case_is_derived_again():
    assert {item.name for item in CASES} == EXACT.keys() | NUMERIC.keys() | POLYGONS.keys()


@pytest.mark.parametrize("name", sorted(EXACT))
def test_exact_values_at_50_digits(name):
    with mpmath.workdps(50):
        truth = EXACT[name]()
        if abs(truth) < mpf(10) ** -45:
            assert case(name).exact == 0.0
        else:
            assert ulps(case(name).exact, truth) <= 4


@pytest.mark.parametrize("name", sorted(POLYGONS))
def test_polygons_at_30_digits(name):
    """By their shadows and by rings about the mirror direction: no sum over edges of the cases' formula."""
    with mpmath.workdps(30):
        truth = POLYGONS[name]()
        assert ulps(case(name).exact, truth) <= 4
        quoted = case(name).derivation.rsplit(" 0.", 1)
        if len(quoted) == 2:
            assert abs(truth - mpf("0." + quoted[1].rstrip("."))) < mpf(10) ** -21


@pytest.mark.parametrize("name", sorted(NUMERIC))
def test_integrated_values_at_20_digits(name):
    """The numbers of the microfacet cases, from the model's definition; this is how they were found."""
    alpha, theta_deg, n = NUMERIC[name]
    with mpmath.workdps(24):
        truth = ggx_by_slope(alpha, theta_deg, n)
        assert ulps(case(name).exact, truth) <= 1
        digits = case(name).derivation.rsplit("0.", 1)[1].rstrip(".")
        assert abs(truth - mpf("0." + digits)) < mpf(10) ** -18


def test_two_coordinates_give_one_albedo():
    with mpmath.workdps(24):
        assert abs(ggx_by_angle(0.3, 60, 90) - ggx_by_slope(0.3, 60, 40)) < mpf(10) ** -16
        mu = mpf(1) / 2
        assert abs(ggx_by_slope(1, 60, 30) - (1 - mu * mpmath.log((1 + mu) / mu))) < mpf(10) ** -18


# --- every method on every case ---


@pytest.mark.parametrize(("item", "method"), PAIRS, ids=lambda x: getattr(x, "name", x))
def test_every_method_finds_the_exact_value(item, method, seed):
    verdict = item.verdict(method, seed, samples=60_000, level=LEVEL)
    assert verdict.outcome is Outcome.HOLDS, str(verdict)
    assert verdict.estimate.converged
    assert verdict.evidence is (Evidence.BOUNDED if verdict.estimate.is_bound else Evidence.MEASURED)
    if method == "quadrature":
        assert verdict.estimate.error <= 1e-8 * max(item.exact, 1e-300) or item.exact == 0.0
    json.dumps(verdict.to_json(), allow_nan=False)


@pytest.mark.parametrize("item", CASES, ids=lambda x: x.name)
def test_a_case_is_complete(item):
    assert item.methods
    assert item.run().converged  # by its first, best method
    assert pickle.loads(pickle.dumps(item)) is item
    assert item.unit == "W/m^2/sr"
    for text in (item.title, item.setup, item.derivation, item.source.title, item.tags):
        assert text
    assert item.derivation.count("$") % 2 == 0
    assert item.derivation.count("{") == item.derivation.count("}")
    data = json.loads(json.dumps(item.to_json(), allow_nan=False))
    assert data["methods"] == list(item.methods)
    for text in (str(item), item._repr_markdown_()):
        assert item.name in text
        assert repr(item.exact) in text
    if item.scene is not None:
        auto = shade(
            item.scene.f,
            item.scene.emitters,
            item.scene.wo,
            normal=item.scene.normal,
            position=item.scene.position,
            occluders=item.scene.occluders,
        )
        assert auto.converged
        assert auto.is_bound
        assert item.judge(auto).ok


def test_names_and_methods_are_looked_up():
    assert list_cases() == sorted(list_cases())
    with pytest.raises(UnknownNameError, match="did you mean 'lambert-in-furnace'"):
        case("lambert-in-furnac")
    with pytest.raises(UnknownNameError, match="Known: closed form, mc-bsdf, mc-light, mis, qmc, quadrature"):
        case("lambert-in-furnace").run("sum")


def test_a_case_of_ones_own_survives_a_process_boundary():
    mine = dataclasses.replace(case("mirror-in-furnace"), name="mine")
    again = pickle.loads(pickle.dumps(mine))
    assert (again.name, again.exact, again.run().value) == ("mine", 0.9, 0.9)


def test_the_same_seed_gives_the_same_answer(seed):
    item = case("ggx-0.3-in-furnace-at-60deg")
    assert item.run("mis", seed, samples=1000).value == item.run("mis", seed, samples=1000).value


# --- what a judge must find ---


def student(item, rng, n=40_000, *, cosine=True, density=1 / (2 * np.pi)):
    """Another renderer: uniform samples of the hemisphere, written without radiokit's integrators."""
    height, turn = rng.random(n), 2 * np.pi * rng.random(n)
    radius = np.sqrt(1 - height**2)
    wi = np.stack([radius * np.cos(turn), radius * np.sin(turn), height], axis=-1)
    (light,) = item.scene.emitters
    values = item.scene.f(wi, np.array(item.scene.wo)) * light.radiance / density
    values = values * height if cosine else values
    return Estimate(values.mean(), values.std(ddof=1) / math.sqrt(n), "statistical", n, method="student")


FURNACES = ["lambert-in-furnace", "phong-10-in-furnace-at-60deg", "ggx-1-in-furnace-at-80deg"]
PLANTED_LEVEL = sidak(1e-3, len(FURNACES))


@pytest.mark.parametrize("name", FURNACES)
def test_a_right_renderer_is_accepted(name, rng):
    assert case(name).judge(student(case(name), rng), level=PLANTED_LEVEL).ok


@pytest.mark.parametrize(("name", "fault"), list(itertools.product(FURNACES, ["cosine", "density", "scale"])))
def test_a_planted_wrong_renderer_is_rejected(name, fault, rng):
    item = case(name)
    wrong = {
        "cosine": lambda: student(item, rng, cosine=False),
        "density": lambda: student(item, rng, density=1 / np.pi),
        "scale": lambda: student(item, rng).scaled(1.1),
    }[fault]()
    verdict = item.judge(wrong, level=PLANTED_LEVEL)
    assert verdict.outcome is Outcome.VIOLATED
    assert verdict.evidence is Evidence.REFUTED
    assert verdict.p_value < PLANTED_LEVEL
    assert verdict.witness.values["exact"] == item.exact
    assert verdict.witness.directions["wo"] == item.scene.wo


JUDGED = [
    (Estimate(0.5, 0.0, "rounding"), Outcome.HOLDS),
    (Estimate(0.5 + 1e-16, 0.0, "rounding"), Outcome.HOLDS),
    (Estimate(0.501, 0.002, "truncation"), Outcome.HOLDS),
    (Estimate(0.501, 0.0005, "truncation"), Outcome.VIOLATED),
    (Estimate(0.501, 0.0005, "truncation", converged=False), Outcome.VIOLATED),
    (Estimate(0.501, 0.002, "truncation", converged=False), Outcome.INCONCLUSIVE),
    (Estimate(0.7, 0.5, "truncation"), Outcome.INCONCLUSIVE),
    (Estimate(0.51, 0.01, "statistical"), Outcome.HOLDS),
    (Estimate(0.51, 0.001, "statistical"), Outcome.VIOLATED),
    (Estimate(0.51, 0.01, "statistical", converged=False), Outcome.INCONCLUSIVE),
    (Estimate(0.6, 0.1, "statistical"), Outcome.INCONCLUSIVE),
    (Estimate(0.0, 0.0, "statistical"), Outcome.INCONCLUSIVE),
    (Estimate(0.6, 0.0, "statistical"), Outcome.VIOLATED),
    (Estimate(math.nan, 0.0, "statistical"), Outcome.VIOLATED),
    (Estimate(math.inf, 0.0, "truncation"), Outcome.VIOLATED),
    (Estimate(np.array([0.5, 0.6]), np.array([0.01, 0.01]), "truncation"), Outcome.VIOLATED),
    (Estimate(np.array([0.5, 0.501]), np.array([0.01, 0.01]), "truncation"), Outcome.HOLDS),
]


@pytest.mark.parametrize(("estimate", "outcome"), JUDGED, ids=str)
def test_verdicts(estimate, outcome):
    verdict = case("lambert-in-furnace").judge(estimate)
    assert verdict.outcome is outcome
    assert (verdict.witness is not None) == (outcome is Outcome.VIOLATED)
    json.dumps(verdict.to_json(), allow_nan=False)


def test_darkness_is_judged_too():
    night = case("lambert-under-sky-tilted-180deg")
    assert night.exact == 0.0
    assert night.judge(Estimate(0.0, 0.0, "statistical")).ok
    assert night.judge(Estimate(1e-3, 0.0, "rounding")).outcome is Outcome.VIOLATED
    assert night.judge(Estimate(1e-3, 1e-3, "statistical")).outcome is Outcome.INCONCLUSIVE


def test_one_sample_that_carries_the_variance_settles_nothing():
    note = "one sample carries 60 % of the variance: the standard error may be far off"
    doubtful = Estimate(0.5, 0.001, "statistical", note=note)
    assert case("lambert-in-furnace").judge(doubtful).outcome is Outcome.INCONCLUSIVE
