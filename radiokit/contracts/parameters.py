"""Parameters: how a model declares them (range, unit, meaning), and how they are checked."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.facts.errors import ParameterError, RadiokitError, suggestion

__all__ = [
    "Choice",
    "Parameter",
    "Spectrum",
    "at_wavelength",
    "build",
    "check_parameters",
    "choice",
    "parameter",
    "parameters_of",
    "spectrum_length",
]

Spectrum = float | tuple[float, ...]
"""A number, or one for each wavelength."""


@dataclass(frozen=True)
class Parameter:
    """What a model says of one parameter: its interval, unit, meaning, and whether it may be a spectrum."""

    interval: str
    unit: str
    meaning: str
    spectral: bool = False

    def contains(self, value: float) -> bool:
        """Return whether ``value`` lies in the interval.

        >>> Parameter("(0, 1]", "1", "width").contains(0.0)
        False
        """
        low, high = (float(end) for end in self.interval[1:-1].split(","))
        above = value > low if self.interval[0] == "(" else value >= low
        below = value < high if self.interval[-1] == ")" else value <= high
        return above and below


def parameter(interval: str, unit: str, meaning: str, *, spectral: bool = False, **field: Any) -> Any:
    """Declare a field of a model's dataclass: the range that is checked, the unit, and what it means.

    Parameters
    ----------
    interval : str
        Such as ``"(0, 1]"`` or ``"[0, inf)"``.
    unit : str
        Such as ``"rad"``; ``"1"`` for a pure number.
    meaning : str
        In a few words.
    spectral : bool
        Whether it may also be a sequence of K numbers, one a wavelength, which becomes a tuple.
    **field
        As for ``dataclasses.field``. ``default=None`` makes it optional: then ``None`` is allowed too.

    >>> from dataclasses import dataclass
    >>> @dataclass(frozen=True, kw_only=True)
    ... class Lamp:
    ...     radius: float = parameter("(0, inf)", "m", "of the globe")
    ...     __post_init__ = check_parameters
    >>> Lamp(radius=-1)
    Traceback (most recent call last):
    ...
    radiokit.facts.errors.ParameterError: radius = -1 is not allowed: it must be a number in (0, inf)
    """
    declared = Parameter(interval, unit, meaning, spectral)
    return dataclasses.field(metadata={"parameter": declared}, **field)


@dataclass(frozen=True)
class Choice:
    """What a model says of a parameter that is one of a few words."""

    options: tuple[str, ...]
    meaning: str


def choice(*options: str, meaning: str) -> Any:
    """Declare a dataclass field that is one of ``options``; the first is the default."""
    return dataclasses.field(default=options[0], metadata={"choice": Choice(options, meaning)})


def parameters_of(cls: type) -> dict[str, Parameter]:
    """Return the declared parameters of a model's class, by name."""
    return {
        field.name: field.metadata["parameter"]
        for field in dataclasses.fields(cls)
        if "parameter" in field.metadata
    }


def check_parameters(model: Any) -> None:
    """Turn every declared number of a frozen dataclass into a float, or a tuple of them; check all ranges.

    Raises
    ------
    ParameterError
        Naming the parameter, its value and what is allowed.
    """
    fields = {field.name: field for field in dataclasses.fields(model)}
    for field in fields.values():
        options = field.metadata["choice"].options if "choice" in field.metadata else None
        if options and getattr(model, field.name) not in options:
            *most, final = map(repr, options)
            allowed = f"{', '.join(most)} or {final}"
            raise ParameterError(field.name, getattr(model, field.name), allowed)
    lengths: dict[str, int] = {}
    for name, declared in parameters_of(type(model)).items():
        value = getattr(model, name)
        if value is None and fields[name].default is None:
            continue
        checked = _checked(name, value, declared)
        if isinstance(checked, tuple):
            lengths[name] = len(checked)
        object.__setattr__(model, name, checked)
    if len(set(lengths.values())) > 1:
        first, other = sorted(lengths, key=lengths.__getitem__)[:: len(lengths) - 1]
        raise ParameterError(
            other,
            getattr(model, other),
            f"as many numbers as {first} has, {lengths[first]}: one a wavelength",
        )


def spectrum_length(model: Any) -> int | None:
    """Return the number of wavelengths of a model's parameters, or None when all are single numbers."""
    names = parameters_of(type(model)) if dataclasses.is_dataclass(model) else ()
    found = (getattr(model, name) for name in names)
    return next((len(value) for value in found if isinstance(value, tuple)), None)


def at_wavelength(model: Any, index: int) -> Any:
    """Return the model with number ``index`` of every parameter that is a spectrum."""
    values = {name: getattr(model, name) for name in parameters_of(type(model))}
    chosen = {name: value[index] for name, value in values.items() if isinstance(value, tuple)}
    return dataclasses.replace(model, **chosen) if chosen else model


def _checked(name: str, value: Any, declared: Parameter) -> float | tuple[float, ...]:
    allowed = f"a number in {declared.interval}"
    if declared.spectral:
        allowed += ", or a sequence of them, one a wavelength"
    try:
        numbers = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise ParameterError(name, value, allowed) from None
    if value is None or numbers.ndim > declared.spectral or not numbers.size:
        raise ParameterError(name, value, allowed)
    for number in np.atleast_1d(numbers).tolist():
        if math.isnan(number) or not declared.contains(number):
            raise ParameterError(name, value if numbers.ndim == 0 else number, allowed)
    return float(numbers) if numbers.ndim == 0 else tuple(numbers.tolist())


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
