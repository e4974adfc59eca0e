"""Quantities: the radiometric and photometric terms, with symbols, units, Russian names, and tagged values.

Units keep the steradian: W/sr and W do not add, and a BSDF is in 1/sr. One consequence to remember: in
E = I cosθ / r² the r² is the area that a steradian cuts from the sphere of radius r, in m²/sr.
"""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass
from functools import cache
from html import escape
from typing import TYPE_CHECKING, Any, Literal

from radiokit.facts.errors import ParameterError, QuantityKindError, UnknownNameError
from radiokit.facts.source import Source
from radiokit.facts.tagged import Tagged

if TYPE_CHECKING:
    from radiokit.facts.units import UnitQuantity

__all__ = ["Q", "Quantity", "list_quantities", "quantity"]

Kind = Literal["radiometric", "spectral", "photometric", "geometric", "scattering"]


@dataclass(frozen=True, kw_only=True)
class Quantity:
    """One term of radiometry. Calling it makes a value that knows its kind.

    Parameters
    ----------
    name : str
        As ``quantity`` takes it, such as ``"radiant_flux"``.
    symbol : str
    unit : str
        As ``Q`` takes it.
    kind : {"radiometric", "spectral", "photometric", "geometric", "scattering"}
    english, russian : str
        The standard's term (Russian after GOST 8.654-2016).
    definition : str
        A short formula.
    meaning : str
        The formula in words.
    twin : str
        The photometric quantity of a radiometric one, and the reverse; empty where there is none.
    spectral : str
        The spectral concentration of a radiometric quantity, and the reverse; empty where there is none.
    source : Source
    aliases : tuple of str
        Other spellings that ``quantity`` understands.

    >>> print(quantity("irradiance")("5 W/m^2"))
    5.0 W/m² (irradiance)
    """

    name: str
    symbol: str
    unit: str
    kind: Kind
    english: str
    russian: str
    definition: str
    meaning: str
    source: Source
    twin: str = ""
    spectral: str = ""
    aliases: tuple[str, ...] = ()

    @property
    def dimensionality(self) -> Any:
        """The dimension, as pint writes it; the steradian counts."""
        return Q(self.unit).dimensionality

    def unit_checked(self, unit: str) -> Any:
        """Return ``unit`` as a pint unit, or say which unit this quantity has.

        Raises
        ------
        ParameterError
            When ``unit`` has another dimension, or is none.
        """
        given = _parse("unit", unit)
        if given.dimensionality != self.dimensionality:
            raise ParameterError("unit", unit, self._allowed(given))
        return given.units

    def __call__(self, value: Any, unit: str | None = None) -> Tagged:
        """Return a value of this kind from text, or from a number or array and its unit.

        Raises
        ------
        ParameterError
            When the unit is not one of this quantity, or cannot be read.
        QuantityKindError
            When ``value`` already is of another kind. ``quantity(name)(value.quantity)`` overrides its kind.
        """
        if isinstance(value, Tagged) and value.kind.name != self.name:
            raise QuantityKindError(
                f"cannot take {value.kind.english} for {self.english}: {value.kind.english} is "
                f"{value.kind.meaning}, {self.english} is {self.meaning}",
                left=self.name,
                right=value.kind.name,
            )
        given = _parse(self.name, value, unit)
        if given.dimensionality != self.dimensionality:
            raise ParameterError(self.name, _Shown(given), self._allowed(given))
        return Tagged(self, given)

    def _allowed(self, given: Any) -> str:
        owners = [
            other.english for other in _catalogue().values() if other.dimensionality == given.dimensionality
        ]
        hint = (
            f" ({given.units:~P} is the unit of {' and '.join(owners)})"
            if owners and not given.dimensionless
            else ""
        )
        return f"in {self.unit}{hint}"

    def _facts(self) -> list[tuple[str, str]]:
        rows = [
            ("symbol", self.symbol),
            ("unit", self.unit),
            ("kind", self.kind),
            ("Russian", self.russian),
            ("definition", self.definition),
            ("meaning", self.meaning),
            ("twin", self.twin),
            ("spectral", self.spectral),
            ("source", self.source.cite()),
        ]
        return [(name, text) for name, text in rows if text]

    def __str__(self) -> str:
        return "\n".join([self.english, *(f"  {name:<11}{text}" for name, text in self._facts())])

    def _repr_html_(self) -> str:
        rows = "".join(
            f'<tr><th>{name}</th><td style="text-align:left">{escape(text)}</td></tr>'
            for name, text in self._facts()
        )
        return f"<table><caption>{escape(self.english)}</caption><tbody>{rows}</tbody></table>"

    def to_json(self) -> dict[str, Any]:
        """Return the term as JSON-ready data."""
        fields = {name: getattr(self, name) for name in self.__dataclass_fields__}
        return {**fields, "source": self.source.to_json(), "aliases": list(self.aliases)}


class _Shown:
    """A value that an error message shows as itself, not as its repr."""

    def __init__(self, value: Any) -> None:
        self.value = value

    def __repr__(self) -> str:
        return str(self.value)


def _parse(name: str, value: Any, unit: str | None = None) -> Any:
    from radiokit.facts.units import parse

    return parse(name, value, unit)


def Q(value: Any, unit: str | None = None) -> UnitQuantity:
    """Return a pint quantity of a registry in which the steradian is a unit of its own.

    Parameters
    ----------
    value : str, number, array, or quantity
    unit : str, optional
        Such as ``"W/(m^2 sr)"``, ``"W m-2 sr-1"``, ``"кд/м²"``.

    Raises
    ------
    ParameterError
        When the number or the unit cannot be read.

    >>> print(Q("5 W/sr") * Q("2 sr"))
    10.0 W
    >>> Q("1 W/sr").is_compatible_with("W")
    False
    """
    result: UnitQuantity = _parse("value", value, unit)
    return result


def list_quantities() -> list[str]:
    """Return the names of all quantities: radiometric, spectral, photometric, geometric, scattering.

    >>> list_quantities()[:3]
    ['radiant_energy', 'radiant_flux', 'radiant_intensity']
    """
    return list(_catalogue())


def quantity(name: str) -> Quantity:
    """Return the quantity called ``name``: its name, its English or Russian term, or an alias.

    Raises
    ------
    UnknownNameError
        When there is no such quantity.

    >>> quantity("radiance").unit, quantity("яркость").english
    ('W/(m^2 sr)', 'luminance')
    """
    spellings = _spellings()
    key = _normal(name)
    if key not in spellings:
        raise UnknownNameError("quantity", name, _catalogue(), aliases=spellings)
    return _catalogue()[spellings[key]]


def _normal(name: str) -> str:
    text = unicodedata.normalize("NFKC", str(name)).casefold().replace("ё", "е")
    return " ".join(re.split(r"[\s_-]+", text.strip()))


def _catalogue() -> dict[str, Quantity]:
    from radiokit.facts.terms import TERMS

    return TERMS


@cache
def _spellings() -> dict[str, str]:
    found: dict[str, str] = {}
    for item in _catalogue().values():
        for spelling in (item.name, item.english, item.russian, *item.aliases):
            found[_normal(spelling)] = item.name
    return found
