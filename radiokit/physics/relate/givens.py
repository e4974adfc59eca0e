"""Givens: what may be known, by the names that ``relate`` takes, with symbols, units and ranges."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.facts.errors import ParameterError, QuantityKindError, UnknownNameError
from radiokit.facts.quantities import Quantity, list_quantities, quantity
from radiokit.facts.tagged import Tagged

__all__ = ["GIVENS", "Given", "Shown", "read_givens", "role_of"]


@dataclass(frozen=True, kw_only=True)
class Given:
    """Something that may be known.

    Parameters
    ----------
    symbol : str
        In LaTeX, as it stands in the formulas.
    unit : str
    kind : str
        The radiometric quantity; its photometric twin may take its place. Empty for what is plain geometry
        or a number.
    low, high : float
        The range allowed, in ``unit``; the ends count, but for a ``low`` where ``above`` is set.
    above : bool
    """

    symbol: str
    unit: str
    kind: str = ""
    low: float = 0.0
    high: float = np.inf
    above: bool = False

    @property
    def plain(self) -> bool:
        """True for what is a number, or an angle in degrees: it needs no unit."""
        return self.unit in ("1", "deg")


def _light(symbol: str, kind: str) -> Given:
    return Given(symbol=symbol, unit=quantity(kind).unit, kind=kind)


GIVENS: Mapping[str, Given] = {
    "energy": _light("Q", "radiant_energy"),
    "flux": _light(r"\Phi", "radiant_flux"),
    "intensity": _light("I", "radiant_intensity"),
    "irradiance": _light("E", "irradiance"),
    "exitance": _light("M", "radiant_exitance"),
    "radiance": _light("L", "radiance"),
    "bsdf": _light("f", "bsdf"),
    "reflectance": Given(symbol=r"\rho", unit="1", kind="reflectance", high=1.0),
    "solid_angle": Given(symbol=r"\Omega", unit="sr", kind="solid_angle", high=4 * np.pi, above=True),
    "time": Given(symbol="t", unit="s", above=True),
    "area": Given(symbol="A", unit="m^2", above=True),
    "distance": Given(symbol="r", unit="m", above=True),
    "new_distance": Given(symbol="s", unit="m", above=True),
    "radius": Given(symbol="R", unit="m", above=True),
    "diameter": Given(symbol="D", unit="m"),
    "angle_deg": Given(symbol=r"\theta", unit="deg", high=90.0),
    "half_angle_deg": Given(symbol=r"\alpha", unit="deg", high=180.0),
    "f_number": Given(symbol="N", unit="1", above=True),
    "transmittance": Given(symbol=r"\tau", unit="1", high=1.0),
    "port_share": Given(symbol="p", unit="1", high=1.0),
    "luminous_efficacy": Given(symbol="K", unit="lm/W", high=683.002, above=True),
}
"""Every name that ``relate`` takes, beside the photometric twins' own names."""

_ROLES = {given.kind: name for name, given in GIVENS.items() if given.kind}


def role_of(kind: Quantity) -> str | None:
    """Return the name in ``GIVENS`` of a quantity or of its photometric twin's radiometric one.

    >>> role_of(quantity("illuminance"))
    'irradiance'
    """
    return _ROLES.get(kind.name) or _ROLES.get(kind.twin)


def read_givens(values: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Quantity]]:
    """Return the values as pint quantities by their names in ``GIVENS``, and which kinds they turn out to be.

    Raises
    ------
    UnknownNameError, ParameterError, QuantityKindError
        When a name is not known, or a value has no unit, a wrong one, or is out of range.
    """
    read: dict[str, Any] = {}
    kinds: dict[str, Quantity] = {}
    for name, value in values.items():
        role, wanted = _named(name)
        if role in read:
            raise ParameterError(name, value, f"given once: it is another name of {role}")
        found = _quantity(name, value, GIVENS[role], wanted)
        if GIVENS[role].kind:
            kinds[role] = _kind(name, value, found, GIVENS[role], wanted)
        _check_range(name, found, GIVENS[role], kinds.get(role))
        read[role] = found
    return read, kinds


def _named(name: str) -> tuple[str, Quantity | None]:
    """Return the role of a keyword, and the one quantity that the keyword means, where it says so."""
    if name in GIVENS:
        return name, None
    try:
        wanted = quantity(name)
    except UnknownNameError:
        raise UnknownNameError("given", name, GIVENS, aliases=list_quantities()) from None
    role = role_of(wanted)
    if role is None:
        raise UnknownNameError("given", name, GIVENS)
    return role, wanted


def _quantity(name: str, value: Any, given: Given, wanted: Quantity | None) -> Any:
    from radiokit.facts.units import parse

    if isinstance(value, Tagged):
        return value.quantity
    if given.plain and not isinstance(value, str) and not hasattr(value, "units"):
        return parse(name, value, "" if given.unit == "1" else given.unit)
    found = parse(name, value)
    if found.unitless and not given.plain:
        unit = given.unit if wanted is None else wanted.unit
        raise ParameterError(name, value, f"a quantity with its unit, such as rk.Q('{value} {unit}')")
    return found


def _kind(name: str, value: Any, found: Any, given: Given, wanted: Quantity | None) -> Quantity:
    """Return the radiometric quantity, or its twin, whichever the unit is that of."""
    usual = quantity(given.kind)
    allowed = [wanted] if wanted is not None else [usual, *([quantity(usual.twin)] if usual.twin else [])]
    if isinstance(value, Tagged):
        if value.kind.name not in [kind.name for kind in allowed]:
            names = " or ".join(kind.english for kind in allowed)
            raise QuantityKindError(
                f"{name} is {names}, and {value.kind.english} is given: {value.kind.meaning}",
                left=allowed[0].name,
                right=value.kind.name,
            )
        return value.kind
    for kind in allowed:
        if found.dimensionality == kind.dimensionality:
            return kind
    units = " or ".join(kind.unit for kind in allowed)
    owners = [
        quantity(each).english
        for each in list_quantities()
        if quantity(each).dimensionality == found.dimensionality
    ]
    hint = (
        f" ({found.units:~P} is the unit of {' and '.join(owners)})" if owners and not found.unitless else ""
    )
    raise ParameterError(name, Shown(found), f"in {units}{hint}")


def _check_range(name: str, found: Any, given: Given, kind: Quantity | None) -> None:
    from radiokit.facts.units import parse

    unit = given.unit if kind is None else kind.unit
    bare = "" if unit == "1" else unit
    if found.dimensionality != parse("unit", 1, bare).dimensionality:
        raise ParameterError(name, Shown(found), f"in {given.unit}" if bare else "a number without unit")
    number = np.asarray(found.to(bare).magnitude, dtype=float)
    low = number <= given.low if given.above else number < given.low
    if not np.all(np.isfinite(number)) or np.any(low | (number > given.high)):
        start = f"above {given.low:g}" if given.above else f"at least {given.low:g}"
        end = "" if np.isinf(given.high) else f" and at most {given.high:g}"
        raise ParameterError(name, Shown(found), f"{start}{end}{f' {bare}' if bare else ''}")


class Shown:
    """A value that an error message shows as itself, not as its repr."""

    def __init__(self, value: Any) -> None:
        self.value = value

    def __repr__(self) -> str:
        return str(self.value)
