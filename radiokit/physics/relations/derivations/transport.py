"""Transport: what stays the same along a ray and through an interface, and what a camera makes of it."""

from __future__ import annotations

from sympy import Derivative, asin, cos, pi, sin, sqrt

from radiokit.physics.relations.derivation import Derivation
from radiokit.physics.relations.notation import HALF, SR, Notation
from radiokit.physics.relations.sources import BORN_WOLF, NICODEMUS_1963, at
from radiokit.physics.relations.steps import follows, premise

__all__ = ["DERIVATIONS"]


def _along_a_ray() -> Derivation:
    n = Notation()
    L1, L2 = n.quantity("L_1", "radiance", "that leaves"), n.quantity("L_2", "radiance", "that arrives")
    t1, t2 = n.angle("θ_1", "at the first element"), n.angle("θ_2", "at the second element")
    A1, A2 = n.differential("dA_1", "m^2"), n.differential("dA_2", "m^2")
    w1 = n.differential("dω_1", "sr", "of the second element from the first")
    w2 = n.differential("dω_2", "sr", "of the first element from the second")
    r = n.symbol("r", "m", "distance")
    flux = n.quantity("d2Φ", "radiant_flux", "from the first to the second", order=2)
    return Derivation(
        name="radiance-along-a-ray",
        title="Radiance does not change along a ray",
        statement="L₂ = L₁: the radiance that arrives is the one that left, however far.",
        assumptions=("vacuum: nothing absorbs, scatters or emits on the way",),
        notation=n,
        steps=(
            premise(w1, SR * A2 * cos(t2) / r**2, "solid angle of the second element"),
            premise(w2, SR * A1 * cos(t1) / r**2, "solid angle of the first element"),
            premise(flux, L1 * cos(t1) * A1 * w1, "definition of radiance, at the first", "leaves"),
            premise(L2, flux / (cos(t2) * A2 * w2), "definition of radiance, at the second; no flux is lost"),
            follows(
                w1 * A1 * cos(t1),
                w2 * A2 * cos(t2),
                "the étendue is the same from both ends",
                "dω_1",
                "dω_2",
                label="étendue",
            ),
            follows(L2, L1, "flux and solid angles put in", "leaves", "dω_1", "dω_2"),
        ),
        source=NICODEMUS_1963,
        tags=("radiance", "lecture"),
    )


def _across_an_interface() -> Derivation:
    n = Notation()
    n1, n2 = (
        n.symbol(f"n_{i}", "1", "index of refraction", within=w)
        for i, w in ((1, (1.0, 1.2)), (2, (1.3, 2.0)))
    )
    t1 = n.angle("θ_1", "of incidence")
    t2 = n.angle("θ_2", "of refraction", of=(t1,))
    L1, L2 = n.quantity("L_1", "radiance", "before"), n.quantity("L_2", "radiance", "behind")
    d1, d2 = n.differential("dθ_1", "rad", order=HALF), n.differential("dθ_2", "rad", order=HALF)
    dphi, dA = n.differential("dφ", "rad", "the same on both sides", order=HALF), n.differential("dA", "m^2")
    w1, w2 = n.differential("dω_1", "sr"), n.differential("dω_2", "sr")
    flux = n.quantity("d2Φ", "radiant_flux", order=2)
    bent = asin(n1 * sin(t1) / n2)
    return Derivation(
        name="radiance-across-an-interface",
        title="Basic radiance: L/n² across a refracting interface",
        statement="L₂/n₂² = L₁/n₁², where nothing is reflected or absorbed.",
        assumptions=("the interface is smooth", "losses are counted apart, as a factor of transmittance"),
        notation=n,
        steps=(
            premise(t2(t1), bent, "Snell's law, n₂ sinθ₂ = n₁ sinθ₁", "Snell"),
            premise(d2, Derivative(t2(t1), t1) * d1, "how the refracted beam spreads"),
            premise(w1, SR * sin(t1) * d1 * dphi, "solid angle of the beam before"),
            premise(w2, SR * sin(t2(t1)) * d2 * dphi, "solid angle of the beam behind"),
            premise(flux, L1 * cos(t1) * w1 * dA, "flux of the beam"),
            premise(L2, flux / (cos(t2(t1)) * w2 * dA), "definition of radiance; no flux is lost"),
            follows(
                Derivative(t2(t1), t1),
                n1 * cos(t1) / (n2 * sqrt(1 - (n1 * sin(t1) / n2) ** 2)),
                "Snell's law differentiated",
                "Snell",
                label="spread",
            ),
            follows(
                n2**2 * cos(t2(t1)) * w2,
                n1**2 * cos(t1) * w1,
                "n² cosθ dω is the same on both sides",
                "dω_1",
                "dω_2",
                "dθ_2",
                "Snell",
                label="étendue",
            ),
            follows(L2 / n2**2, L1 / n1**2, "the étendue put in", "L_2", "d2Φ", ("étendue", w2)),
        ),
        source=at(NICODEMUS_1963, "basic radiance"),
        tags=("radiance", "refraction"),
    )


def _camera() -> Derivation:
    n = Notation()
    light, arriving = (
        n.quantity("L", "radiance", "of the scene"),
        n.quantity("E", "irradiance", "on the sensor"),
    )
    theta = n.angle("θ", "from the axis")
    d, D = n.symbol("d", "m", "from the pupil to the sensor"), n.symbol("D", "m", "diameter of the pupil")
    N = n.symbol("N", "1", "f-number")
    area, r = n.symbol("A", "m^2", "of the pupil"), n.symbol("r", "m", "from the pupil to the pixel")
    omega = n.symbol("Ω", "sr", "of the pupil from the pixel")
    return Derivation(
        name="camera-equation",
        title="The cos⁴ law and the camera equation",
        statement="E = π L cos⁴θ / (4 N²) (π in sr): a camera measures radiance.",
        assumptions=(
            "the pupil is small against its distance",
            "the lens loses nothing and focuses at infinity",
        ),
        notation=n,
        steps=(
            premise(arriving, light * cos(theta) * omega, "E = L cosθ Ω; radiance is the same along the ray"),
            premise(omega, SR * area * cos(theta) / r**2, "solid angle of the pupil, seen obliquely"),
            premise(r, d / cos(theta), "the pixel is farther off the axis"),
            premise(area, pi * D**2 / 4, "a round pupil"),
            premise(N, d / D, "definition of the f-number"),
            follows(arriving, SR * light * area * cos(theta) ** 2 / r**2, "the solid angle put in", "Ω"),
            follows(arriving, SR * light * area * cos(theta) ** 4 / d**2, "the cos⁴ law", "r"),
            follows(
                arriving, pi * SR * light * cos(theta) ** 4 / (4 * N**2), "the f-number put in", "A", ("N", d)
            ),
        ),
        source=at(BORN_WOLF, "section 4.8"),
        tags=("radiance", "camera", "lecture"),
    )


DERIVATIONS = (_along_a_ray(), _across_an_interface(), _camera())
