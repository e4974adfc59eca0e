"""Parameters: how a model declares them (range, unit, meaning), and how they are checked."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Any

from radiokit.facts.errors import ParameterError, RadiokitError, suggestion

__all__ = ["Parameter", "build", "check_parameters", "parameter", "parameters_of"]


@dataclass(frozen=True)
class Parameter:
    """What a model says of one parameter: its interval, unit and meaning."""

    interval: str
    unit: str
    meaning: str

    def contains(self, value: float) -> bool:
        """Return whether ``value`` lies in the interval.

        >>> Parameter("(0, 1]", "1", "width").contains(0.0)
        False
        """
        low, high = (float(end) for end in self.interval[1:-1].split(","))
        above = value > low if self.interval[0] == "(" else value >= low
        below = value < high if self.interval[-1] == ")" else value <= high
        return above and below


def parameter(interval: str, unit: str, meaning: str, **field: Any) -> Any:
    """Declare a dataclass field with its interval, such as ``"(0, 1]"`` or ``"[0, inf)"``.

    ``default=None`` makes it optional: then ``None`` is allowed too.
    """
    return dataclasses.field(metadata={"parameter": Parameter(interval, unit, meaning)}, **field)


def parameters_of(cls: type) -> dict[str, Parameter]:
    """Return the declared parameters of a model's class, by name."""
    return {
        field.name: field.metadata["parameter"]
        for field in dataclasses.fields(cls)
        if "parameter" in field.metadata
    }


def check_parameters(model: Any) -> None:
    """Turn every declared parameter of a frozen dataclass into a float and check its range.

    Raises
    ------
    ParameterError
        Naming the parameter, its value and what is allowed.
    """
    for name, declared in parameters_of(type(model)).items():
        value = getattr(model, name)
        allowed = f"a number in {declared.interval}"
        if value is None:
            fields = {field.name: field for field in dataclasses.fields(model)}
            if fields[name].default is None:
                continue
            raise ParameterError(name, value, allowed)
        try:
            number = float(value)
        except (TypeError, ValueError):
            raise ParameterError(name, value, allowed) from None
        if math.isnan(number) or not declared.contains(number):
            raise ParameterError(name, value, allowed)
        object.__setattr__(model, name, number)


def build(kind: str, name: str, cls: type, values: dict[str, Any]) -> Any:
    """Make a model from keyword parameters, with a helpful error for an unknown or missing one."""
    fields = {field.name: field for field in dataclasses.fields(cls) if field.init}
    for given in values:
        if given not in fields:
            known = ", ".join(fields) or "none"
            raise RadiokitError(
                f"{kind} {name!r} has no parameter {given!r}{suggestion(given, fields) or '.'} "
                f"It has: {known}",
                kind=kind,
                name=name,
                parameter=given,
            )
    missing = [
        field.name
        for field in fields.values()
        if field.default is dataclasses.MISSING
        and field.default_factory is dataclasses.MISSING
        and field.name not in values
    ]
    if missing:
        raise RadiokitError(
            f"{kind} {name!r} needs {', '.join(missing)}", kind=kind, name=name, missing=missing
        )
    return cls(**values)
