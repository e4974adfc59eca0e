"""Units: a pint registry in which the steradian is a unit of its own. Imports pint: loaded on first use.

Pint's own definitions make sr a mere 1, so that W and W/sr add without complaint. Here sr has a dimension,
the radian has none, and lm = cd·sr. The registry is separate from pint's application registry, also when
its quantities cross a process boundary.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from typing import Any, TypeAlias

import numpy as np
import pint
from pint.registry import Quantity as _PintQuantity
from pint.registry import Unit as _PintUnit

from radiokit.facts.errors import ParameterError, suggestion
from radiokit.facts.tagged import Tagged

__all__ = ["Registry", "parse", "registry"]

_DEFINITIONS = """
tera- = 1e12 = T-
giga- = 1e9 = G-
mega- = 1e6 = M- = М-
kilo- = 1e3 = k- = к-
centi- = 1e-2 = c- = с-
milli- = 1e-3 = m- = м-
micro- = 1e-6 = µ- = μ- = u- = мк-
nano- = 1e-9 = n- = н-
pico- = 1e-12 = p- = п-
femto- = 1e-15 = f-

meter = [length] = m = metre = м
second = [time] = s = с
gram = [mass] = g = г
kelvin = [temperature] = K = К
candela = [luminosity] = cd = кд
steradian = [solid_angle] = sr = ср
radian = [] = rad = рад
count = []

degree = 0.017453292519943295 * radian = ° = deg = град
square_degree = 3.046174197867086e-4 * steradian = sq_deg
percent = 0.01 = %
minute = 60 * second = min = мин
hour = 3600 * second = h = ч
hertz = 1 / second = Hz = Гц
inch = 0.0254 * meter = in
foot = 0.3048 * meter = ft
angstrom = 1e-10 * meter = Å = ångström
micron = 1e-6 * meter

joule = kilogram * meter ** 2 / second ** 2 = J = Дж
watt = joule / second = W = Вт
erg = 1e-7 * joule
electron_volt = 1.602176634e-19 * joule = eV = эВ

lumen = candela * steradian = lm = лм
lux = lumen / meter ** 2 = lx = лк
nit = candela / meter ** 2 = _ = нт = нит
stilb = 1e4 * candela / meter ** 2 = sb
phot = 1e4 * lumen / meter ** 2 = ph
apostilb = 0.3183098861837907 * candela / meter ** 2 = asb
lambert = 3183.098861837907 * candela / meter ** 2 = _ = Lb
foot_candle = lumen / foot ** 2 = fc = footcandle
foot_lambert = 0.3183098861837907 * candela / foot ** 2 = fL = footlambert

@system SI
    meter
    kilogram
    second
@end
@defaults
    group = root
    system = SI
@end
"""

_POWER = re.compile(r"(?<![\w.])([^\W\d_]+)(-?\d+)")


def _powers(text: str) -> str:
    """Read "W m-2 sr-1" as "W m^-2 sr^-1", the way instruments and climate files spell units."""
    return _POWER.sub(r"\1^(\2)", text.replace("⋅", "*"))


class UnitQuantity(_PintQuantity[Any]):
    """A pint quantity that unpickles into this registry, and leaves tagged values to themselves."""

    def __reduce__(self) -> Any:
        return _rebuild, ("Quantity", self.magnitude, dict(self.unit_items()))


class UnitOfRegistry(_PintUnit):
    """A pint unit that unpickles into this registry."""

    def __reduce__(self) -> Any:
        return _rebuild, ("Unit", None, dict(self._units))


class Registry(pint.UnitRegistry[Any]):
    """The registry's class; ``registry()`` is the one instance."""

    Quantity: TypeAlias = UnitQuantity
    Unit: TypeAlias = UnitOfRegistry


def _deferring(name: str) -> Callable[[Any, Any], Any]:
    operate = getattr(_PintQuantity, name)

    def method(self: Any, other: Any) -> Any:
        return NotImplemented if isinstance(other, Tagged) else operate(self, other)

    return method


for _name in ("add", "sub", "mul", "truediv", "lt", "le", "gt", "ge", "eq", "ne"):
    setattr(UnitQuantity, f"__{_name}__", _deferring(f"__{_name}__"))


def _rebuild(kind: str, magnitude: Any, units: dict[str, Any]) -> Any:
    container = registry().UnitsContainer(units)
    unit = registry().Unit(container)
    return unit if kind == "Unit" else registry().Quantity(magnitude, unit)


@cache
def registry() -> Registry:
    """Return the registry; made on the first call."""
    made = Registry(_DEFINITIONS.strip().splitlines(), preprocessors=[_powers])
    made.formatter.default_format = "~P"
    return made


def parse(name: str, value: Any, unit: Any = None) -> UnitQuantity:
    """Return ``value`` (a number, an array, text, or another quantity) as a quantity of this registry.

    Raises
    ------
    ParameterError
        Naming the argument ``name`` when the text or the unit cannot be read.
    """
    if isinstance(value, Tagged):
        value = value.quantity
    if isinstance(value, str) and unit is not None:
        raise ParameterError(name, value, "a number or an array, since its unit is given besides")
    try:
        if isinstance(value, pint.Quantity) and not isinstance(value, UnitQuantity):
            value = registry().Quantity(value.magnitude, str(value.units))
        quantity = registry().Quantity(value, str(unit) if isinstance(unit, pint.Unit) else unit)
        if np.asarray(quantity.magnitude).dtype.kind not in "fiuc":
            raise ValueError(f"{value!r} is no number")
    except Exception as error:
        raise ParameterError(name, value if unit is None else (value, unit), _allowed(error)) from None
    return quantity


def _allowed(error: Exception) -> str:
    text = "a number and units, such as '5 W/(m^2 sr)'"
    if isinstance(error, pint.UndefinedUnitError):
        names = error.unit_names
        unknown = names if isinstance(names, str) else names[0]
        text += f" (there is no unit {unknown!r}{suggestion(unknown, sorted(registry()))})"
    return text
