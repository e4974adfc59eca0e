"""Enclosures: light that is reflected again and again, between diffuse walls and in an integrating sphere."""

from __future__ import annotations

from sympy import Sum, cos, pi

from radiokit.physics.relations.derivation import Derivation
from radiokit.physics.relations.notation import SR, Notation
from radiokit.physics.relations.sources import GOEBEL, WALSH, at
from radiokit.physics.relations.steps import follows, premise

__all__ = ["DERIVATIONS"]


def _enclosure() -> Derivation:
    n = Notation()
    own, light = (
        n.quantity("L_e", "radiance", "that the walls emit"),
        n.quantity("L", "radiance", "in the enclosure"),
    )
    rho = n.quantity("ρ", "reflectance", "of the walls", within=(0.1, 0.9))
    k = n.symbol("k", "1", "number of reflections", integer=True, nonnegative=True)
    m = n.symbol("m", "1", "reflections counted", integer=True, positive=True)
    some = n.quantity("L_m", "radiance", "after some reflections", of=(m,))
    return Derivation(
        name="closed-enclosure",
        title="A closed diffuse enclosure",
        statement="L = L_e/(1 − ρ): every reflection adds ρ times what was there.",
        assumptions=("walls of the same reflectance and emission everywhere, ρ < 1",),
        notation=n,
        steps=(
            premise(
                some(m),
                own * Sum(rho**k, (k, 0, m)),
                "emitted light, and up to m reflections of it",
                "series",
            ),
            premise(
                light,
                own + rho * light,
                "what leaves a wall is emitted or reflected (white-furnace)",
                "steady",
            ),
            follows(light, own / (1 - rho), "solved", ("steady", light), label="sum"),
            follows(
                some(m),
                light * (1 - rho ** (m + 1)),
                "the geometric series: what lacks is ρ^(m+1)",
                ("steady", own),
            ),
        ),
        source=WALSH,
        tags=("enclosure",),
    )


def _sphere_view_factor() -> Derivation:
    n = Notation()
    R, r = n.symbol("R", "m", "radius of the sphere"), n.symbol("r", "m", "chord between the elements")
    theta = n.angle("θ", "of the chord with either normal")
    dA, share = n.differential("dA", "m^2", "that is lit"), n.differential("dF", "1", "share that reaches it")
    area = n.symbol("A", "m^2", "of the sphere")
    return Derivation(
        name="sphere-view-factor",
        title="Inside a sphere, every place sees every other alike",
        statement="dF = dA/(4πR²), wherever the two places are.",
        assumptions=("the walls reflect diffusely",),
        notation=n,
        steps=(
            premise(
                share, cos(theta) * cos(theta) * dA / (pi * r**2), "share of a Lambertian element's flux"
            ),
            premise(r, 2 * R * cos(theta), "a chord makes the same angle with both normals"),
            premise(area, 4 * pi * R**2, "area of the sphere"),
            follows(share, dA / (4 * pi * R**2), "the cosines cancel", "r"),
            follows(share, dA / area, "the share of the area", ("A", R)),
        ),
        source=WALSH,
        tags=("enclosure", "view factor"),
    )


def _integrating_sphere() -> Derivation:
    n = Notation()
    rho = n.quantity("ρ", "reflectance", "of the wall", within=(0.1, 0.9))
    ports = n.symbol("p", "1", "share of the sphere's area that is ports", within=(0.01, 0.2))
    flux, area = n.quantity("Φ", "radiant_flux", "that enters"), n.symbol("A", "m^2", "of the whole sphere")
    arriving = n.quantity("E", "irradiance", "by reflected light, on wall and ports alike")
    light = n.quantity("L", "radiance", "that leaves a port")
    return Derivation(
        name="integrating-sphere",
        title="The integrating sphere with ports",
        statement="L = Φ/(π A) · ρ/(1 − ρ(1 − p)) (π in sr).",
        assumptions=(
            "the wall is Lambertian",
            "the flux falls on the wall first, and no port sees that spot",
        ),
        notation=n,
        steps=(
            premise(
                arriving,
                rho * flux / area + rho * (1 - ports) * arriving,
                "first reflection, spread evenly (sphere-view-factor), and that of the wall without ports",
                "balance",
            ),
            premise(light, arriving / (pi * SR), "what arrives at a port leaves through it, evenly"),
            follows(arriving, rho * flux / (area * (1 - rho * (1 - ports))), "solved", ("balance", arriving)),
            follows(light, rho * flux / (pi * SR * area * (1 - rho * (1 - ports))), "put in", "E"),
        ),
        source=at(GOEBEL, "the sphere multiplier"),
        tags=("enclosure",),
    )


DERIVATIONS = (_enclosure(), _sphere_view_factor(), _integrating_sphere())
