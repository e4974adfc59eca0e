"""Light truth: irradiances and solid angles as textbooks print them, for as many digits as their loss takes.

Every function takes multiple-precision numbers and is written from its source, not from radiokit's kernel,
which has another form: what cancels here is outrun by the working precision.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

__all__ = [
    "angles_of_polygon",
    "cosine_disk",
    "disk_irradiance",
    "disk_solid_angle",
    "lambert_sum",
    "moment",
    "rectangle_corners",
    "sky_irradiance",
    "sphere_irradiance",
    "sphere_solid_angle",
    "spot_intensity",
]

Vector = Sequence[Any]


def dot(a: Vector, b: Vector) -> Any:
    """Return the inner product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> list[Any]:
    """Return the cross product."""
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a: Vector) -> list[Any]:
    """Return the vector over its length."""
    import mpmath

    length = mpmath.sqrt(dot(a, a))
    return [x / length for x in a]


def minus(a: Vector, b: Vector) -> list[Any]:
    """Return the difference."""
    return [x - y for x, y in zip(a, b, strict=True)]


# --- the sphere ---


def sphere_solid_angle(center: Vector, radius: Any, position: Vector) -> Any:
    """Return 2π(1 − cosσ)."""
    import mpmath

    v = minus(center, position)
    return 2 * mpmath.pi * (1 - mpmath.sqrt(1 - radius**2 / dot(v, v)))


def sphere_irradiance(center: Vector, radius: Any, position: Vector, normal: Vector) -> Any:
    """Return E/L of a sphere that the horizon may cut.

    Source: Lagarde, de Rousiers (2014), Moving Frostbite to PBR, section 4.7.3 and listing 7, after Snyder.
    """
    import mpmath

    v = minus(center, position)
    c = dot(unit(normal), unit(v))
    share = radius**2 / dot(v, v)
    if c * abs(c) >= share:
        return mpmath.pi * share * c
    if c * abs(c) <= -share:
        return mpmath.mpf(0)
    sine = mpmath.sqrt(1 - c * c)
    x = mpmath.sqrt(1 / share - 1)
    y = -x * c / sine
    rise = sine * mpmath.sqrt(1 - y * y)
    return (c * mpmath.acos(y) - x * rise) * share + mpmath.atan(rise / x)


# --- the disk ---


def disk_irradiance(center: Vector, normal: Vector, radius: Any, position: Vector, facing: Vector) -> Any:
    """Return E/L of a disk that the horizon may cut: −½∮ n·(r × dr)/r² along its arc and its chord.

    The arc's integrand is a ratio of first harmonics, with the primitive of any table of integrals.
    """
    import mpmath

    v, m, n = minus(center, position), unit(normal), unit(facing)
    depth = dot(v, m)
    if depth >= 0:
        return mpmath.mpf(0)
    e = minus(v, [depth * x for x in m])
    e = unit(e if any(e) else cross(m, [1, 0, 0] if abs(m[0]) < 0.7 else [0, 1, 0]))
    f = cross(m, e)
    height, p, q = dot(n, v), radius * dot(n, e), radius * dot(n, f)
    rise = mpmath.hypot(p, q)
    if height <= -rise:
        return mpmath.mpf(0)
    whole = height >= rise
    middle, half = (mpmath.mpf(0), mpmath.pi) if whole else (mpmath.atan2(q, p), mpmath.acos(-height / rise))
    d, b = dot(v, v) + radius**2, 2 * radius * dot(v, e)
    weights = radius * dot(n, m), dot(n, cross(v, f)), -dot(n, cross(v, e))
    slant = mpmath.sqrt((d - b) * (d + b))

    def primitive(psi: Any) -> Any:
        turns = mpmath.floor((psi + mpmath.pi) / (2 * mpmath.pi))
        s, c = mpmath.sin(psi / 2 - mpmath.pi * turns), mpmath.cos(psi / 2 - mpmath.pi * turns)
        plain = 2 / slant * (mpmath.atan2((d - b) / slant * s, c) + mpmath.pi * turns)
        if not b:
            return weights[0] * plain + (weights[1] * mpmath.sin(psi) - weights[2] * mpmath.cos(psi)) / d
        cosine = (psi - d * plain) / b
        sine = -mpmath.log(d + b * mpmath.cos(psi)) / b
        return weights[0] * plain + weights[1] * cosine + weights[2] * sine

    ends = (middle - half, middle + half)
    if whole:
        total = 2 * mpmath.pi / slant * weights[0]
        total += weights[1] * (2 * mpmath.pi - d * 2 * mpmath.pi / slant) / b if b else 0
        return -radius * total / 2
    total = radius * (primitive(ends[1]) - primitive(ends[0]))
    last, first = (
        [x + radius * (mpmath.cos(psi) * y + mpmath.sin(psi) * z) for x, y, z in zip(v, e, f, strict=True)]
        for psi in (ends[1], ends[0])
    )
    chord = cross(last, first)
    length = mpmath.sqrt(dot(chord, chord))
    total += mpmath.atan2(length, dot(last, first)) * dot(n, chord) / length
    return -total / 2


def disk_solid_angle(center: Vector, normal: Vector, radius: Any, position: Vector) -> Any:
    """Return Ω of a disk by complete elliptic integrals of the first and third kind.

    Source: Paxton (1959), Solid angle calculation for a circular disk, doi:10.1063/1.1716590.
    """
    import mpmath

    v, m = minus(center, position), unit(normal)
    depth = -dot(v, m)
    if depth <= 0:
        return mpmath.mpf(0)
    offset = mpmath.sqrt(abs(dot(v, v) - depth * depth))
    if offset < radius * mpmath.sqrt(mpmath.eps):
        return 2 * mpmath.pi * (1 - depth / mpmath.hypot(depth, radius))
    wide = depth**2 + (offset + radius) ** 2
    n, k = 4 * offset * radius / (offset + radius) ** 2, 4 * offset * radius / wide
    first = mpmath.ellipk(k)
    third = mpmath.mpf(0)
    if offset != radius:
        third = (radius - offset) / (radius + offset) * mpmath.ellippi(n, k)
    inside = (mpmath.sign(radius - offset) + 1) * mpmath.pi
    return inside - 2 * depth / mpmath.sqrt(wide) * (first + third)


def cosine_disk(distance: Any, radius: Any, exponent: Any, cosine: Any) -> Any:
    """Return E/L of a disk of radiance ∝ cosⁿ on a receiver on its axis: 2π(1 − cosⁿ⁺²σ)/(n + 2) cosθ."""
    import mpmath

    edge = distance / mpmath.hypot(distance, radius)
    return 2 * mpmath.pi * cosine * (1 - edge ** (exponent + 2)) / (exponent + 2)


# --- polygons ---


def clipped(points: list[Any], normal: Vector) -> list[Any]:
    """Return the part of a polygon above the plane through the origin."""
    kept = []
    for here, after in zip(points, points[1:] + points[:1], strict=True):
        high, low = dot(here, normal), dot(after, normal)
        if high >= 0:
            kept.append(here)
        if high * low < 0:
            kept.append([(high * b - low * a) / (high - low) for a, b in zip(here, after, strict=True)])
    return kept if any(dot(p, normal) > 0 for p in kept) else []


def lambert_sum(vertices: list[Vector], position: Vector, normal: Vector) -> Any:
    """Return E/L of a polygon's front: Lambert's sum with arcs by acos, as it was first printed."""
    import mpmath

    n = unit(normal)
    points = [unit(p) for p in clipped([minus(v, position) for v in vertices], n)]
    total = mpmath.mpf(0)
    for a, b in zip(points, points[1:] + points[:1], strict=True):
        side = cross(a, b)
        length = mpmath.sqrt(dot(side, side))
        if length:
            total -= mpmath.acos(max(-1, min(1, dot(a, b)))) * dot(n, side) / length / 2
    return max(total, mpmath.mpf(0))


def angles_of_polygon(vertices: list[Vector], position: Vector) -> Any:
    """Return Ω of a polygon's front: the sum of its spherical angles less (N − 2)π, by Girard."""
    import mpmath

    points = [unit(minus(v, position)) for v in vertices]
    total = -(len(points) - 2) * mpmath.pi
    for before, here, after in zip(points[-1:] + points[:-1], points, points[1:] + points[:1], strict=True):
        first, second = (unit(minus(p, [dot(p, here) * x for x in here])) for p in (before, after))
        turn = mpmath.acos(max(-1, min(1, dot(first, second))))
        total += turn if dot(here, cross(first, second)) >= 0 else 2 * mpmath.pi - turn
    value = total % (4 * mpmath.pi)
    return value if value < 2 * mpmath.pi else mpmath.mpf(0)


def rectangle_corners(center: Vector, normal: Vector, width: Any, height: Any, up: Vector) -> list[Vector]:
    """Return the corners of a rectangle, counter-clockwise as seen from its front."""
    m = unit(normal)
    right = unit(cross(up, m))
    top = cross(m, right)
    return [
        [c + x * width / 2 * a + y * height / 2 * b for c, a, b in zip(center, right, top, strict=True)]
        for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))
    ]


def moment(vertices: list[Vector], axis: Vector, exponent: Any, normal: Vector | None) -> Any:
    """Return ∫ (a·ω)ⁿ [n·ω] dω over a polygon's front, in rings about the axis, by quadrature in azimuth."""
    import mpmath

    a = unit(axis)
    points = clipped([list(v) for v in vertices], a)
    n = None if normal is None else unit(normal)
    points = points if n is None else clipped(points, n)
    x = unit(cross([1, 0, 0] if abs(a[0]) < 0.7 else [0, 1, 0], a))
    y = cross(a, x)
    local = [[dot(p, w) for w in (x, y, a)] for p in points]
    edges = []
    for p, q in zip(local, local[1:] + local[:1], strict=True):
        side = cross(p, q)
        edges.append((mpmath.atan2(p[1], p[0]), side, mpmath.atan2(side[2], p[0] * q[0] + p[1] * q[1])))
    # Rings from the axis to an edge: nothing is left at the axis unless the polygon is about it.
    around = -mpmath.fsum(turn for _, _, turn in edges) > 1

    def ring(phi: Any, cosine: Any) -> Any:
        if n is None:
            return (around - cosine ** (exponent + 1)) / (exponent + 1)
        aside = mpmath.cos(phi) * dot(x, n) + mpmath.sin(phi) * dot(y, n)
        rest = mpmath.betainc(mpmath.mpf(3) / 2, (exponent + 1) / mpmath.mpf(2), 0, 1 - cosine**2) / 2
        return dot(a, n) * (1 - cosine ** (exponent + 2)) / (exponent + 2) + aside * rest

    total = mpmath.mpf(0)
    for start, side, turn in edges:
        if not turn:
            continue

        def along(s: Any, start: Any = start, side: Any = side) -> Any:
            slope = -(side[0] * mpmath.cos(start + s) + side[1] * mpmath.sin(start + s)) / side[2]
            return ring(start + s, slope / mpmath.sqrt(1 + slope * slope))

        total -= relative_quad(along, mpmath.linspace(0, turn, 5))
    return total


# --- skies and points ---


def sky_irradiance(law: Callable[[Any], Any], zenith: Vector, normal: Vector) -> Any:
    """Return E of a sky of radiance ``law`` (cosθ), in rings about its zenith that the horizon cuts."""
    import mpmath

    c = dot(unit(zenith), unit(normal))
    sine = mpmath.sqrt(max(1 - c * c, mpmath.mpf(0)))

    def ring(theta: Any) -> Any:
        up, across = c * mpmath.cos(theta), sine * mpmath.sin(theta)
        weight = law(mpmath.cos(theta)) * mpmath.sin(theta)
        if up >= across:
            return 2 * mpmath.pi * up * weight
        if up <= -across:
            return mpmath.mpf(0)
        edge = mpmath.acos(-up / across)
        return 2 * (up * edge + across * mpmath.sin(edge)) * weight

    bend, end = abs(mpmath.atan2(c, sine)), mpmath.pi / 2
    total = relative_quad(ring, [bend, end]) if sine else mpmath.mpf(0)
    return total + (relative_quad(ring, [mpmath.mpf(0), bend]) if c > 0 else 0)


def spot_intensity(towards: Vector, axis: Vector, inner: Any, outer: Any) -> Any:
    """Return the share of I that a spot light sends along a direction: the smoothstep in cosθ."""
    import mpmath

    c = dot(unit(towards), unit(axis))
    edge, full = mpmath.cos(outer), mpmath.cos(inner)
    if c >= full:
        return mpmath.mpf(1)
    if c <= edge:
        return mpmath.mpf(0)
    t = (c - edge) / (full - edge)
    return t * t * (3 - 2 * t)


def relative_quad(function: Callable[[Any], Any], ends: list[Any]) -> Any:
    """Integrate on a scale on which mpmath's absolute tolerance is a relative one."""
    import mpmath

    first, last = ends[0], ends[-1]
    width = last - first
    if not width:
        return mpmath.mpf(0)
    tried = [function(first + width * k / 8) for k in range(1, 8)]
    size = max(map(abs, tried)) or mpmath.mpf(1)
    places = [(x - first) / width for x in ends]
    return size * width * mpmath.quad(lambda t: function(first + width * t) / size, places)
