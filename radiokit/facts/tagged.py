"""Tagged: a value that knows which kind of quantity it is, so that irradiance and exitance never mix."""

from __future__ import annotations

import operator
from collections.abc import Callable
from numbers import Number
from typing import TYPE_CHECKING, Any

import numpy as np

from radiokit.facts.errors import QuantityKindError

if TYPE_CHECKING:
    from radiokit.facts.quantities import Quantity

__all__ = ["Tagged"]


class Tagged:
    """A value of one kind of quantity, such as 5 W/m² of irradiance; ``quantity("irradiance")`` makes them.

    Values of one kind add, subtract and compare, whatever their units; values of different kinds raise.
    A plain number or array scales a value and keeps its kind. A product or a quotient of two values is
    another quantity: it is returned as a pint quantity without a kind.

    Parameters
    ----------
    kind : Quantity
    quantity : pint.Quantity
        The value and its unit, which must suit the kind.
    """

    __slots__ = ("kind", "quantity")
    __array_ufunc__ = None  # or else an array would multiply element by element, past __rmul__
    __hash__ = None  # type: ignore[assignment]

    kind: Quantity
    quantity: Any

    def __init__(self, kind: Quantity, quantity: Any) -> None:
        self.kind, self.quantity = kind, quantity

    @property
    def magnitude(self) -> Any:
        """The number or array, in ``units``."""
        return self.quantity.magnitude

    @property
    def units(self) -> Any:
        """The pint unit."""
        return self.quantity.units

    def to(self, unit: str) -> Tagged:
        """Return the same value in another unit.

        Raises
        ------
        ParameterError
            When ``unit`` is no unit of this kind of quantity.
        """
        return self._same(self.quantity.to(self.kind.unit_checked(unit)))

    def magnitude_in(self, unit: str) -> Any:
        """Return the number or array that the value has in ``unit``."""
        return self.to(unit).magnitude

    def to_json(self) -> dict[str, Any]:
        """Return the value as JSON-ready data."""
        magnitude = np.asarray(self.magnitude).tolist()
        return {"quantity": self.kind.name, "value": magnitude, "unit": f"{self.units:~P}"}

    def __str__(self) -> str:
        return f"{self.quantity} ({self.kind.english})"

    def __repr__(self) -> str:
        return f"<{self}>"

    def __format__(self, spec: str) -> str:
        if not set(spec) & set("~CDHLP"):  # a plain number's format; pint would spell the unit out
            return f"{self.magnitude:{spec}} {self.units:~P} ({self.kind.english})"
        return f"{self.quantity:{spec}} ({self.kind.english})"

    def __reduce__(self) -> tuple[Any, ...]:
        return Tagged, (self.kind, self.quantity)

    def _same(self, quantity: Any) -> Tagged:
        return Tagged(self.kind, quantity)

    def _matched(self, other: Any, deed: str) -> Any:
        """Return the pint quantity of ``other``, which must be of this very kind."""
        if isinstance(other, Tagged):
            if other.kind.name == self.kind.name:
                return other.quantity
            left, right = self.kind, other.kind
            message = (
                f"cannot {deed.format(left.english, right.english)}: {left.english} is {left.meaning} "
                f"[{left.unit}], {right.english} is {right.meaning} [{right.unit}]"
            )
            if left.dimensionality == right.dimensionality:
                message += "; the unit is the same, the quantity is not"
            raise QuantityKindError(message, left=left.name, right=right.name)
        raise QuantityKindError(
            f"cannot {deed.format(self.kind.english, other)}: nothing says which quantity {other} is; "
            f'if it is {self.kind.english}, write quantity("{self.kind.name}")("{other}")',
            left=self.kind.name,
            right=None,
        )

    def __add__(self, other: Any) -> Tagged:
        if isinstance(other, (int, float)) and other == 0:  # sum() starts with 0
            return self
        return self._same(self.quantity + self._matched(other, "add {} and {}"))

    __radd__ = __add__

    def __sub__(self, other: Any) -> Tagged:
        return self._same(self.quantity - self._matched(other, "subtract {1} from {0}"))

    def __rsub__(self, other: Any) -> Tagged:
        return self._same(self._matched(other, "subtract {0} from {1}") - self.quantity)

    def __mul__(self, other: Any) -> Any:
        if isinstance(other, (Number, np.ndarray)):
            return self._same(self.quantity * other)
        return self.quantity * _bare(other)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Any:
        if isinstance(other, (Number, np.ndarray)):
            return self._same(self.quantity / other)
        return self.quantity / _bare(other)

    def __rtruediv__(self, other: Any) -> Any:
        return other / self.quantity

    def __pow__(self, exponent: float) -> Any:
        return self.quantity**exponent

    def __neg__(self) -> Tagged:
        return self._same(-self.quantity)

    def __abs__(self) -> Tagged:
        return self._same(abs(self.quantity))

    def __bool__(self) -> bool:
        return bool(self.quantity)

    def __getitem__(self, index: Any) -> Tagged:
        return self._same(self.quantity[index])

    def __len__(self) -> int:
        return len(self.quantity)

    def _compare(self, other: Any, compare: Callable[[Any, Any], Any]) -> Any:
        return compare(self.quantity, self._matched(other, "compare {} with {}"))

    def __lt__(self, other: Any) -> Any:
        return self._compare(other, operator.lt)

    def __le__(self, other: Any) -> Any:
        return self._compare(other, operator.le)

    def __gt__(self, other: Any) -> Any:
        return self._compare(other, operator.gt)

    def __ge__(self, other: Any) -> Any:
        return self._compare(other, operator.ge)

    def __eq__(self, other: object) -> Any:
        return self._compare(other, operator.eq) if _is_value(other) else NotImplemented

    def __ne__(self, other: object) -> Any:
        return self._compare(other, operator.ne) if _is_value(other) else NotImplemented


def _bare(value: Any) -> Any:
    return value.quantity if isinstance(value, Tagged) else value


def _is_value(other: object) -> bool:
    return isinstance(other, (Tagged, Number, np.ndarray)) or hasattr(other, "dimensionality")
