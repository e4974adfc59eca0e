"""Dimension: products of powers of base dimensions, the steradian among them, and how they are spelled."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache

__all__ = ["NUMBER", "Dimension"]

_BASE = {
    "[mass]": "kg",
    "[length]": "m",
    "[time]": "s",
    "[temperature]": "K",
    "[luminosity]": "cd",
    "[solid_angle]": "sr",
}
_POWERS = str.maketrans("0123456789-/", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻ᐟ")


@dataclass(frozen=True)
class Dimension:
    """A dimension, such as that of W/(m² sr); the steradian counts, the radian does not.

    Parameters
    ----------
    powers : tuple of (str, Fraction)
        pint's base dimensions and their exponents, sorted, none of them 0.

    >>> print(Dimension.of("W/(m^2 sr)") * Dimension.of("sr"))
    W/m²
    >>> print(Dimension.of("lm/m^2"), Dimension.of("J") / Dimension.of("W"), Dimension.of("1"))
    lm/m² s 1
    """

    powers: tuple[tuple[str, Fraction], ...] = ()

    @classmethod
    def of(cls, unit: str) -> Dimension:
        """Return the dimension of a unit, as ``radiokit.Q`` reads it."""
        return _of(unit)

    @classmethod
    def _from(cls, powers: Mapping[str, Fraction]) -> Dimension:
        return cls(tuple(sorted((name, power) for name, power in powers.items() if power)))

    def __mul__(self, other: Dimension) -> Dimension:
        powers = dict(self.powers)
        for name, power in other.powers:
            powers[name] = powers.get(name, Fraction(0)) + power
        return Dimension._from(powers)

    def __truediv__(self, other: Dimension) -> Dimension:
        return self * other**-1

    def __pow__(self, exponent: Fraction | int) -> Dimension:
        return Dimension._from({name: power * exponent for name, power in self.powers})

    def __bool__(self) -> bool:
        return bool(self.powers)

    def __str__(self) -> str:
        factors = _factors(dict(self.powers))
        above = [_power(name, p) for name, p in factors if p > 0]
        below = [_power(name, -p) for name, p in factors if p < 0]
        text = " ".join(above) or "1"
        if below:
            text += "/" + (below[0] if len(below) == 1 else f"({' '.join(below)})")
        return text


NUMBER = Dimension()
"""The dimension of numbers and of plane angles."""


@cache
def _of(unit: str) -> Dimension:
    from radiokit.facts.units import parse

    found = parse("unit", 1, unit or "1").dimensionality
    return Dimension._from(
        {str(name): Fraction(str(power)).limit_denominator(60) for name, power in found.items()}
    )


def _power(name: str, power: Fraction) -> str:
    return name if power == 1 else name + str(power).translate(_POWERS)


def _factors(powers: dict[str, Fraction]) -> list[tuple[str, Fraction]]:
    """Return the units that spell the dimension: watt, joule and lumen where they fit."""
    mass = powers.pop("[mass]", Fraction(0))
    found: list[tuple[str, Fraction]] = []
    if mass:  # kg = W s³/m²
        powers["[length]"] = powers.get("[length]", Fraction(0)) - 2 * mass
        powers["[time]"] = powers.get("[time]", Fraction(0)) + 3 * mass
        name = "W"
        if mass == powers["[time]"]:
            name, powers["[time]"] = "J", Fraction(0)
        found.append((name, mass))
    light, angle = (powers.get(name, Fraction(0)) for name in ("[luminosity]", "[solid_angle]"))
    if light and light == angle:
        found.append(("lm", light))
        powers["[luminosity]"] = powers["[solid_angle]"] = Fraction(0)
    order = sorted(powers, key=lambda name: list(_BASE).index(name) if name in _BASE else -1)
    return found + [(_BASE.get(name, name), powers[name]) for name in order if powers[name]]
