"""Extended sources: the irradiance from a disk, a sphere, a sky, a rectangle, a polygon, a plane."""

from __future__ import annotations

from sympy import Integral, Limit, S, Sum, atan, cos, oo, pi, sin, sqrt

from radiokit.physics.lengths import HOWELL
from radiokit.physics.relations.derivation import Derivation
from radiokit.physics.relations.notation import SR, Notation
from radiokit.physics.relations.sources import ARVO, LAMBERT, WALSH, at
from radiokit.physics.relations.steps import follows, premise

__all__ = ["DERIVATIONS"]

_UNIFORM = "the source has the same radiance everywhere and in all directions"


def _disk() -> Derivation:
    n = Notation()
    light, arriving = n.quantity("L", "radiance", "of the disk"), n.quantity("E", "irradiance")
    theta, phi, mu = n.angle("θ", "from the normal"), n.angle("φ", "azimuth"), n.symbol("μ", "1", "cosθ")
    R, d = n.symbol("R", "m", "radius of the disk"), n.symbol("d", "m", "distance on the axis")
    edge = d / sqrt(R**2 + d**2)
    alpha = n.angle("α", "half-angle of the disk")
    return Derivation(
        name="irradiance-under-disk",
        title="The irradiance under a disk",
        statement="E = π L sin²α = π L R²/(R² + d²) (π in sr).",
        assumptions=(_UNIFORM, "the receiver is on the axis and faces the disk"),
        notation=n,
        steps=(
            premise(
                arriving,
                Integral(light * cos(theta) * SR * sin(theta), (theta, 0, alpha), (phi, 0, 2 * pi)),
                "E = ∫ L cosθ dω over the disk",
            ),
            premise(cos(alpha), edge, "the edge of the disk", "edge"),
            follows(
                arriving,
                2 * pi * SR * light * Integral(cos(theta) * sin(theta), (theta, 0, alpha)),
                "nothing depends on the azimuth",
            ),
            follows(
                arriving,
                2 * pi * SR * light * Integral(mu, (mu, cos(alpha), 1)),
                "μ = cosθ",
                change={mu: cos(theta)},
            ),
            follows(arriving, pi * SR * light * (1 - cos(alpha) ** 2), "∫ μ dμ"),
            follows(arriving, pi * SR * light * R**2 / (R**2 + d**2), "the edge put in", "edge"),
        ),
        source=at(HOWELL, "B-12"),
        tags=("irradiance",),
    )


def _sphere() -> Derivation:
    n = Notation()
    light, arriving = n.quantity("L", "radiance", "of the sphere"), n.quantity("E", "irradiance")
    psi, phi = n.angle("ψ", "from the way to the centre"), n.angle("φ", "azimuth about that way")
    mu = n.symbol("μ", "1", "cosψ")
    R, d = n.symbol("R", "m", "radius", within=(0.1, 0.5)), n.symbol("d", "m", "to the centre", within=(1, 2))
    beta, alpha = (
        n.angle("β", "tilt of the receiver from the centre"),
        n.angle("α", "half-angle of the sphere"),
    )
    cosine = cos(beta) * cos(psi) + sin(beta) * sin(psi) * cos(phi)
    flat = 2 * pi * cos(beta) * SR * light
    return Derivation(
        name="irradiance-from-sphere",
        title="The irradiance from a sphere",
        statement="E = π L (R/d)² cosβ (π in sr), as from a point in its centre, near or far.",
        assumptions=(_UNIFORM, "the whole sphere is above the receiver's horizon: β + α ≤ π/2"),
        notation=n,
        steps=(
            premise(
                arriving,
                Integral(light * cosine * SR * sin(psi), (phi, 0, 2 * pi), (psi, 0, alpha)),
                "E = ∫ L cosθ dω over the cone of the sphere; cosθ by the cosine rule",
            ),
            premise(sin(alpha), R / d, "a tangent from the receiver touches the sphere", "tangent"),
            follows(arriving, flat * Integral(cos(psi) * sin(psi), (psi, 0, alpha)), "cosφ has the mean 0"),
            follows(arriving, flat * Integral(mu, (mu, cos(alpha), 1)), "μ = cosψ", change={mu: cos(psi)}),
            follows(arriving, pi * SR * light * cos(beta) * sin(alpha) ** 2, "∫ μ dμ"),
            follows(arriving, pi * SR * light * cos(beta) * (R / d) ** 2, "the tangent put in", "tangent"),
        ),
        source=at(HOWELL, "B-43"),
        tags=("irradiance",),
    )


def _hemisphere() -> Derivation:
    n = Notation()
    light, arriving = n.quantity("L", "radiance", "of the sky"), n.quantity("E", "irradiance")
    theta, phi, mu = n.angle("θ", "from the normal"), n.angle("φ", "azimuth"), n.symbol("μ", "1", "cosθ")
    return Derivation(
        name="irradiance-from-hemisphere",
        title="The irradiance from a uniform hemisphere",
        statement="E = π L (π in sr): as many steradians as the projected hemisphere has.",
        assumptions=(_UNIFORM,),
        notation=n,
        steps=(
            premise(
                arriving,
                Integral(light * cos(theta) * SR * sin(theta), (theta, 0, pi / 2), (phi, 0, 2 * pi)),
                "E = ∫ L cosθ dω over the hemisphere",
            ),
            follows(
                arriving,
                2 * pi * SR * light * Integral(cos(theta) * sin(theta), (theta, 0, pi / 2)),
                "nothing depends on the azimuth",
            ),
            follows(
                arriving, 2 * pi * SR * light * Integral(mu, (mu, 0, 1)), "μ = cosθ", change={mu: cos(theta)}
            ),
            follows(arriving, pi * SR * light, "∫ μ dμ = 1/2"),
        ),
        source=LAMBERT,
        tags=("irradiance",),
    )


def _tilted_sky() -> Derivation:
    n = Notation()
    light, arriving = n.quantity("L", "radiance", "of the sky"), n.quantity("E", "irradiance")
    beta = n.angle("β", "tilt of the receiver", within=(0.1, 3.0))
    psi = n.angle("ψ", "from the line in which receiver and ground meet", within=(0.1, 3.0))
    alpha = n.angle("α", "about that line, from the receiver's normal", real=True)
    return Derivation(
        name="irradiance-from-tilted-sky",
        title="The irradiance from a uniform sky on a tilted receiver",
        statement="E = π L (1 + cosβ)/2 (π in sr).",
        assumptions=(_UNIFORM, "the ground is black"),
        notation=n,
        steps=(
            premise(
                arriving,
                Integral(
                    light * sin(psi) * cos(alpha) * SR * sin(psi),
                    (alpha, -pi / 2, pi / 2 - beta),
                    (psi, 0, pi),
                ),
                "E = ∫ L cosθ dω over the lune above both horizons, cosθ = sinψ cosα",
            ),
            follows(
                arriving,
                SR * light * (1 + cos(beta)) * Integral(sin(psi) ** 2, (psi, 0, pi)),
                "∫ cosα dα, and sin(π/2 − β) = cosβ",
            ),
            follows(arriving, pi * SR * light * (1 + cos(beta)) / 2, "∫ sin²ψ dψ = π/2"),
        ),
        source=WALSH,
        tags=("irradiance",),
    )


def _rectangle() -> Derivation:
    n = Notation()
    light, arriving = n.quantity("L", "radiance", "of the rectangle"), n.quantity("E", "irradiance")
    a, b, d = n.symbol("a", "m", "side"), n.symbol("b", "m", "side"), n.symbol("d", "m", "distance")
    x, y = n.symbol("x", "m", "in the rectangle"), n.symbol("y", "m", "in the rectangle")
    p, q = sqrt(a**2 + d**2), sqrt(b**2 + d**2)
    s = d**2 + y**2
    slope = a / (2 * s * (s + a**2)) + atan(a / sqrt(s)) / (2 * s ** S("3/2"))
    whole = (y / sqrt(s) * atan(a / sqrt(s)) + a / p * atan(y / p)) / 2
    return Derivation(
        name="irradiance-from-rectangle",
        title="The irradiance from a rectangle",
        statement="Below a corner, E = (L/2) [a/√(a²+d²) atan(b/√(a²+d²)) + b/√(b²+d²) atan(a/√(b²+d²))].",
        assumptions=(_UNIFORM, "the receiver is parallel to the rectangle, below a corner"),
        notation=n,
        steps=(
            premise(
                arriving,
                Integral(light * SR * d**2 / (x**2 + s) ** 2, (x, 0, a), (y, 0, b)),
                "E = ∫ L cosθ dω, dω = Ω₀ cosθ dA/r², cosθ = d/r",
            ),
            follows(
                arriving,
                Integral(light * SR * d**2 * slope, (y, 0, b)),
                "along x",
                antiderivative=(
                    x,
                    light * SR * d**2 * (x / (2 * s * (s + x**2)) + atan(x / sqrt(s)) / (2 * s ** S("3/2"))),
                ),
            ),
            follows(
                arriving,
                light * SR / 2 * (a / p * atan(b / p) + b / q * atan(a / q)),
                "along y",
                antiderivative=(y, light * SR * whole),
            ),
        ),
        source=at(HOWELL, "B-3"),
        tags=("irradiance",),
    )


def _polygon() -> Derivation:
    n = Notation()
    count = n.symbol("m", "1", "number of edges", integer=True, positive=True)
    j = n.symbol("j", "1", "number of an edge", integer=True, positive=True)
    edge = n.angle("Θ", "that an edge subtends", of=(j,))
    gamma = n.symbol(
        "c", "1", "normal of the receiver times the outward normal of an edge's sector", of=(j,), real=True
    )
    r, t = n.symbol("r", "1", "radius in a sector"), n.angle("τ", "in a sector")
    sector = n.symbol("A", "1", "area of an edge's sector", of=(j,))
    cap = n.symbol("P", "1", "projected area of the spherical polygon", real=True)
    light, arriving = n.quantity("L", "radiance", "of the polygon"), n.quantity("E", "irradiance")
    return Derivation(
        name="irradiance-from-polygon",
        title="Lambert's formula for polygons",
        statement="E = −(L/2) Σ Θ_j Γ_j·n over the edges, Γ_j outward normals of their sectors.",
        assumptions=(_UNIFORM, "the polygon is wholly above the receiver's horizon"),
        notation=n,
        steps=(
            premise(
                arriving, light * SR * cap, "E = ∫ L n·ω dω: the projection of the polygon on the unit sphere"
            ),
            premise(
                cap + Sum(gamma(j) * sector(j), (j, 1, count)),
                0,
                "Gauss: the outward areas of a closed surface, seen along n, add up to 0",
                "closed",
            ),
            premise(
                sector(j), Integral(r, (r, 0, 1), (t, 0, edge(j))), "a sector of the unit disk", "sector"
            ),
            follows(sector(j), edge(j) / 2, "its area", label="area"),
            follows(
                arriving,
                -light * SR * Sum(gamma(j) * sector(j), (j, 1, count)),
                "the sectors close the polygon",
                ("closed", cap),
            ),
            follows(
                arriving,
                -light * SR * Sum(gamma(j) * edge(j), (j, 1, count)) / 2,
                "their areas put in",
                "area",
            ),
        ),
        source=at(ARVO, "equation 2, Lambert's formula"),
        tags=("irradiance",),
    )


def _plane() -> Derivation:
    n = Notation()
    light, arriving = n.quantity("L", "radiance", "of the plane"), n.quantity("E", "irradiance")
    R, d = n.symbol("R", "m", "radius of a disk of it"), n.symbol("d", "m", "distance")
    return Derivation(
        name="irradiance-under-plane",
        title="The irradiance under an infinite plane",
        statement="E = π L (π in sr) at any distance.",
        assumptions=(_UNIFORM, "the receiver is parallel to the plane"),
        notation=n,
        steps=(
            premise(
                arriving,
                Limit(pi * SR * light * R**2 / (R**2 + d**2), R, oo),
                "a disk that grows (irradiance-under-disk)",
            ),
            follows(arriving, pi * SR * light, "the distance no longer counts"),
        ),
        source=WALSH,
        tags=("irradiance",),
    )


DERIVATIONS = (_disk(), _sphere(), _hemisphere(), _tilted_sky(), _rectangle(), _polygon(), _plane())
