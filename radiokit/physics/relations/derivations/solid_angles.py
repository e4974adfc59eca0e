"""Solid angles: of an element in polar coordinates, of a cone, a rectangle and a triangle."""

from __future__ import annotations

from sympy import Derivative, Integral, atan, cos, pi, sin, sqrt, tan

from radiokit.physics.relations.derivation import Derivation
from radiokit.physics.relations.notation import HALF, SR, Notation
from radiokit.physics.relations.sources import ISO_SPACE, OOSTEROM, WALSH, at
from radiokit.physics.relations.steps import follows, premise

__all__ = ["DERIVATIONS"]


def _element() -> Derivation:
    n = Notation()
    r = n.symbol("r", "m", "distance")
    theta, phi = n.angle("θ", "from the pole"), n.angle("φ", "azimuth")
    x, y, z = (n.symbol(name, "m", "of a point of the sphere", of=(theta, phi), real=True) for name in "xyz")
    dtheta = n.differential("dθ", "rad", order=HALF)
    dphi = n.differential("dφ", "rad", order=HALF)
    along = n.differential("ds_θ", "m", "side along θ", order=HALF)
    across = n.differential("ds_φ", "m", "side along φ", order=HALF)
    dA, dw = n.differential("dA", "m^2", "on the sphere"), n.differential("dω", "sr")
    point = (x(theta, phi), y(theta, phi), z(theta, phi))

    def length(angle: object) -> object:
        return sqrt(sum(Derivative(part, angle) ** 2 for part in point))

    return Derivation(
        name="solid-angle-element",
        title="The solid angle of an element in polar coordinates",
        statement="dω = sinθ dθ dφ (in sr).",
        notation=n,
        steps=(
            premise(point[0], r * sin(theta) * cos(phi), "a point of the sphere", "x"),
            premise(point[1], r * sin(theta) * sin(phi), "a point of the sphere", "y"),
            premise(point[2], r * cos(theta), "a point of the sphere", "z"),
            premise(along, length(theta) * dtheta, "how far the point moves with θ"),
            premise(across, length(phi) * dphi, "how far the point moves with φ"),
            premise(dA, along * across, "the two ways are perpendicular"),
            premise(dw, SR * dA / r**2, "definition of the solid angle"),
            follows(along, r * dtheta, "differentiated", "x", "y", "z"),
            follows(across, r * sin(theta) * dphi, "differentiated", "x", "y", "z"),
            follows(dA, r**2 * sin(theta) * dtheta * dphi, "both put in", "ds_θ", "ds_φ"),
            follows(dw, SR * sin(theta) * dtheta * dphi, "r² cancels", "dA"),
        ),
        source=at(ISO_SPACE, "item 3-8"),
        tags=("solid angle", "lecture"),
    )


def _cone() -> Derivation:
    n = Notation()
    theta, phi = n.angle("θ", "from the axis"), n.angle("φ", "azimuth")
    alpha = n.angle("α", "half-angle of the cone", within=(0.1, 3.0))
    cone = n.symbol("Ω", "sr", "of the cone")
    return Derivation(
        name="solid-angle-of-cone",
        title="The solid angle of a cone",
        statement="Ω = 2π(1 − cosα) = 4π sin²(α/2) sr; the whole sphere is 4π sr, a hemisphere 2π sr.",
        notation=n,
        steps=(
            premise(
                cone,
                Integral(SR * sin(theta), (theta, 0, alpha), (phi, 0, 2 * pi)),
                "∫ dω, dω = Ω₀ sinθ dθ dφ",
            ),
            follows(cone, 2 * pi * SR * Integral(sin(theta), (theta, 0, alpha)), "nothing depends on φ"),
            follows(cone, 2 * pi * SR * (1 - cos(alpha)), "the integral of the sine"),
            follows(cone, 4 * pi * SR * sin(alpha / 2) ** 2, "the half-angle, which does not cancel"),
        ),
        source=at(ISO_SPACE, "item 3-8"),
        tags=("solid angle", "lecture"),
    )


def _rectangle() -> Derivation:
    n = Notation()
    a, b, d = n.symbol("a", "m", "side"), n.symbol("b", "m", "side"), n.symbol("d", "m", "distance")
    x, y = n.symbol("x", "m", "in the rectangle"), n.symbol("y", "m", "in the rectangle")
    corner = n.symbol("Ω", "sr", "seen from above a corner")
    slant = sqrt(d**2 + x**2 + y**2)
    inner = a / ((d**2 + y**2) * sqrt(a**2 + d**2 + y**2))
    return Derivation(
        name="solid-angle-of-rectangle",
        title="The solid angle of a rectangle",
        statement="Above a corner, Ω = atan(a b / (d √(a² + b² + d²))) sr; on the axis, four of them.",
        assumptions=("the point is at the distance d from the plane, above the corner",),
        notation=n,
        steps=(
            premise(
                corner,
                Integral(SR * d / slant**3, (x, 0, a), (y, 0, b)),
                "dω = Ω₀ cosθ dA/r², with cosθ = d/r",
            ),
            follows(
                corner,
                Integral(SR * d * inner, (y, 0, b)),
                "along x",
                antiderivative=(x, SR * d * x / ((d**2 + y**2) * slant)),
            ),
            follows(
                corner,
                SR * atan(a * b / (d * sqrt(a**2 + b**2 + d**2))),
                "along y",
                antiderivative=(y, SR * atan(a * y / (d * sqrt(a**2 + d**2 + y**2)))),
            ),
        ),
        source=WALSH,
        tags=("solid angle",),
    )


def _triangle() -> Derivation:
    n = Notation()
    excess = n.angle("E", "the spherical excess, in radians", within=(0.1, 1.0))
    a, b = n.angle("a", "side of the spherical triangle"), n.angle("b", "side of the spherical triangle")
    A, B, C = (n.angle(name, "of the spherical triangle") for name in "ABC")
    total = n.angle("Σ", "half the sum of A and B", within=(0.3, 1.2))
    omega = n.symbol("Ω", "sr", "of the triangle")
    triple = n.symbol("D", "1", "(v₁ × v₂)·v₃ of the unit vectors to the corners")
    cosine = n.symbol("k", "1", "cosine of the side opposite to C", real=True, within=(0.1, 0.9))
    ratio = cos((a - b) / 2) / cos((a + b) / 2)
    p, q, t = tan(a / 2), tan(b / 2), tan(C / 2)
    halves = tuple(
        step
        for angle, half in ((a, p), (b, q), (C, t))
        for step in (
            follows(sin(angle), 2 * half / (1 + half**2), f"the sine of {angle} by its half"),
            follows(cos(angle), (1 - half**2) / (1 + half**2), f"the cosine of {angle} by its half"),
        )
    )
    names = tuple(step.name for step in halves)
    return Derivation(
        name="solid-angle-of-triangle",
        title="The solid angle of a triangle",
        statement="tan(Ω/2) = v₁·(v₂ × v₃) / (1 + v₁·v₂ + v₂·v₃ + v₃·v₁) for unit vectors to the corners.",
        assumptions=("v₁·v₂ = cos a, v₁·v₃ = cos b, and C is the angle at v₁",),
        notation=n,
        steps=(
            premise(omega, SR * excess, "Girard: the area on the unit sphere is the excess"),
            premise(excess, 2 * total + C - pi, "definition of the excess, Σ = (A + B)/2"),
            premise(A, 2 * total - B, "definition of Σ"),
            premise(tan(total), ratio / tan(C / 2), "Napier's analogy", "Napier"),
            premise(cosine, cos(a) * cos(b) + sin(a) * sin(b) * cos(C), "the cosine rule"),
            premise(triple, sin(a) * sin(b) * sin(C), "the volume of the three unit vectors"),
            follows(
                tan(omega / (2 * SR)), tan(total + C / 2 - pi / 2), "half the excess", "Ω", "E", label="t"
            ),
            follows(
                tan(omega / (2 * SR)), (tan(total) * t - 1) / (tan(total) + t), "of a sum, less a right angle"
            ),
            follows(tan(omega / (2 * SR)), (ratio - 1) / (ratio / t + t), "put in", "Napier"),
            follows(ratio, (1 + p * q) / (1 - p * q), "cosines of a sum and a difference", label="ratio"),
            follows(
                tan(omega / (2 * SR)), 2 * p * q * t / (1 + t**2 + p * q * (1 - t**2)), "put in", "ratio"
            ),
            *halves,
            follows(
                tan(omega / (2 * SR)),
                triple / (1 + cos(a) + cos(b) + cosine),
                "the half angles once more",
                "D",
                "k",
                *names,
            ),
        ),
        source=at(OOSTEROM, "equation 8"),
        tags=("solid angle",),
    )


DERIVATIONS = (_element(), _cone(), _rectangle(), _triangle())
