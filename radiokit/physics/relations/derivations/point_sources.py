"""Point sources: intensity and flux, the inverse square, and how far away a disk is a point."""

from __future__ import annotations

from sympy import Integral, Le, Rational, cos, pi, sin

from radiokit.physics.relations.derivation import Derivation
from radiokit.physics.relations.notation import SR, Notation
from radiokit.physics.relations.sources import ISO_LIGHT, LAMBERT, WALSH, at
from radiokit.physics.relations.steps import follows, holds, premise

__all__ = ["DERIVATIONS"]


def _isotropic() -> Derivation:
    n = Notation()
    intensity = n.quantity("I", "radiant_intensity", "the same in all directions")
    flux = n.quantity("Φ", "radiant_flux", "in all directions")
    theta, phi = n.angle("θ", "from the pole"), n.angle("φ", "azimuth")
    return Derivation(
        name="isotropic-flux",
        title="The flux of an isotropic source",
        statement="Φ = 4π I (4π in sr), where the intensity is the same in all directions, and only there.",
        assumptions=("I does not depend on direction",),
        notation=n,
        steps=(
            premise(
                flux,
                Integral(intensity * SR * sin(theta), (theta, 0, pi), (phi, 0, 2 * pi)),
                "Φ = ∫ I dω over all directions, dω = Ω₀ sinθ dθ dφ",
            ),
            follows(flux, 2 * pi * SR * intensity * Integral(sin(theta), (theta, 0, pi)), "no azimuth in it"),
            follows(flux, 4 * pi * SR * intensity, "∫ sinθ dθ = 2"),
        ),
        source=at(ISO_LIGHT, "item 7-5.1"),
        tags=("flux", "lecture"),
    )


def _irradiance() -> Derivation:
    n = Notation()
    intensity = n.quantity("I", "radiant_intensity", "towards the receiver")
    arriving = n.quantity("E", "irradiance")
    theta, r = n.angle("θ", "of incidence"), n.symbol("r", "m", "distance")
    dA, dw = n.differential("dA", "m^2", "of the receiver"), n.differential("dω", "sr")
    flux = n.quantity("dΦ", "radiant_flux", order=1)
    return Derivation(
        name="irradiance-from-intensity",
        title="The irradiance from a point source",
        statement="E = I cosθ / r² (times 1 sr): the cosine law and the inverse square together.",
        assumptions=("the source is a point", "nothing absorbs on the way"),
        notation=n,
        steps=(
            premise(arriving, flux / dA, "definition of irradiance"),
            premise(flux, intensity * dw, "definition of intensity"),
            premise(
                dw, SR * dA * cos(theta) / r**2, "the receiver's solid angle: its projected area over r²"
            ),
            follows(arriving, intensity * dw / dA, "the flux put in", "dΦ"),
            follows(arriving, SR * intensity * cos(theta) / r**2, "the solid angle put in", "dω"),
        ),
        source=LAMBERT,
        tags=("irradiance", "lecture"),
    )


def _inverse_square() -> Derivation:
    n = Notation()
    r1, r2 = n.symbol("r_1", "m", "radius of a sphere"), n.symbol("r_2", "m", "radius of another")
    E1, E2 = n.quantity("E_1", "irradiance", "on the first"), n.quantity("E_2", "irradiance", "on the second")
    flux = n.quantity("Φ", "radiant_flux", "of the source")
    return Derivation(
        name="inverse-square-law",
        title="The inverse square law, from conservation of flux",
        statement="E₂/E₁ = (r₁/r₂)²: the same flux crosses every sphere about the source.",
        assumptions=("the source is an isotropic point", "nothing absorbs on the way"),
        notation=n,
        steps=(
            premise(flux, E1 * 4 * pi * r1**2, "all flux crosses the first sphere", "first"),
            premise(flux, E2 * 4 * pi * r2**2, "all flux crosses the second sphere", "second"),
            follows(E1, flux / (4 * pi * r1**2), "the flux over the area", ("first", E1)),
            follows(E2, flux / (4 * pi * r2**2), "the flux over the area", ("second", E2)),
            follows(E2 / E1, r1**2 / r2**2, "the flux cancels", "E_1", "E_2"),
        ),
        source=LAMBERT,
        tags=("irradiance", "lecture"),
    )


def _five_times() -> Derivation:
    n = Notation()
    light = n.quantity("L", "radiance", "of the disk")
    D, d = n.symbol("D", "m", "diameter of the disk"), n.symbol("d", "m", "distance on the axis")
    more = n.symbol("m", "1", "diameters beyond five", nonnegative=True)
    exact, point = n.quantity("E", "irradiance"), n.quantity("E_p", "irradiance", "as from a point")
    intensity = n.quantity("I", "radiant_intensity", "of the disk along its axis")
    error = n.symbol("ε", "1", "relative error of taking the disk for a point")
    return Derivation(
        name="five-times-rule",
        title="The five-times rule",
        statement="From five diameters on, a disk taken for a point gives an error of 1 % at most: (D/2d)².",
        assumptions=("the disk is Lambertian and faces the receiver, which faces it",),
        notation=n,
        steps=(
            premise(
                exact,
                pi * SR * light * (D / 2) ** 2 / ((D / 2) ** 2 + d**2),
                "under a disk (irradiance-under-disk)",
            ),
            premise(intensity, light * pi * (D / 2) ** 2, "I = L A along the axis"),
            premise(point, SR * intensity / d**2, "the inverse square (irradiance-from-intensity)"),
            premise(error, point / exact - 1, "definition of the relative error"),
            follows(error, ((D / 2) ** 2 + d**2) / d**2 - 1, "both put in", "E", "E_p", "I"),
            follows(error, (D / (2 * d)) ** 2, "what is left"),
            premise(d, (5 + more) * D, "five diameters or more"),
            follows(error, 1 / (4 * (5 + more) ** 2), "the distance put in", "d"),
            holds(Le(error, Rational(1, 100), evaluate=False), "largest at m = 0, where it is 1/100"),
        ),
        source=WALSH,
        tags=("irradiance",),
    )


DERIVATIONS = (_isotropic(), _irradiance(), _inverse_square(), _five_times())
