"""Errors: every exception that radiokit raises, with the fields that a program can read."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from typing import Any

__all__ = [
    "AssignmentError",
    "CallableError",
    "MissingExtraError",
    "NonFiniteError",
    "ParameterError",
    "QuantityKindError",
    "RadiokitError",
    "TargetError",
    "UnknownNameError",
    "suggestion",
]


def suggestion(name: str, known: Iterable[str]) -> str:
    """Return ``"; did you mean 'x'?"`` for the closest known name, or an empty string.

    >>> suggestion("gxg", ["ggx", "phong"])
    "; did you mean 'ggx'?"
    """
    close = difflib.get_close_matches(name, list(known), n=1, cutoff=0.5)
    return f"; did you mean {close[0]!r}?" if close else ""


class RadiokitError(Exception):
    """Base of all radiokit errors. ``fields`` holds what the message says, for programs."""

    def __init__(self, message: str, **fields: Any) -> None:
        super().__init__(message)
        self.message = message
        self.fields = fields

    def __str__(self) -> str:
        return self.message

    def __reduce__(self) -> tuple[Any, ...]:
        return (_rebuild, (type(self), self.message, self.fields))

    def to_json(self) -> dict[str, Any]:
        """Return the error as JSON-ready data.

        >>> ParameterError("alpha", -1, "in (0, 1]").to_json()["error"]
        'ParameterError'
        """
        fields = {key: repr(value) for key, value in self.fields.items()}
        return {"error": type(self).__name__, "message": self.message, "fields": fields}


def _rebuild(cls: type[RadiokitError], message: str, fields: dict[str, Any]) -> RadiokitError:
    """Rebuild an error that crossed a process boundary."""
    error = cls.__new__(cls)
    RadiokitError.__init__(error, message, **fields)
    return error


class ParameterError(RadiokitError, ValueError):
    """An argument has a value that is not allowed; the message names it, its value and the range.

    >>> print(ParameterError("alpha", -1, "in (0, 1]"))
    alpha = -1 is not allowed: it must be in (0, 1]
    """

    def __init__(self, name: str, value: Any, allowed: str) -> None:
        super().__init__(
            f"{name} = {value!r} is not allowed: it must be {allowed}",
            name=name,
            value=value,
            allowed=allowed,
        )


class UnknownNameError(RadiokitError, LookupError):
    """A name that nothing answers to; the message lists what there is.

    ``aliases`` are spellings that are understood, and so may be suggested, but are not listed.

    >>> print(UnknownNameError("BSDF", "gxg", ["ggx", "phong"]))
    unknown BSDF 'gxg'; did you mean 'ggx'? Known: ggx, phong
    """

    def __init__(self, kind: str, name: Any, known: Iterable[str], aliases: Iterable[str] = ()) -> None:
        known = sorted(known)
        guess = (suggestion(name, [*known, *aliases]) if isinstance(name, str) else "") or "."
        super().__init__(
            f"unknown {kind} {name!r}{guess} Known: {', '.join(known) or 'none'}",
            kind=kind,
            name=name,
            known=known,
        )


class QuantityKindError(RadiokitError, TypeError):
    """Values of different kinds of quantity were added, compared or converted; units may agree or not.

    ``fields`` has ``left`` and ``right``, the names of the two kinds; ``right`` is None where it is unknown.
    """


class CallableError(RadiokitError):
    """A user's function raised, or returned something that is no BSDF value.

    ``fields`` has ``function``, ``problem`` and, where they are known, the offending ``wi`` and ``wo``.
    """

    def __init__(self, function: str, problem: str, wi: Any = None, wo: Any = None) -> None:
        where = "" if wi is None else f" at wi = {_triple(wi)}, wo = {_triple(wo)}"
        super().__init__(f"{function} {problem}{where}", function=function, problem=problem, wi=wi, wo=wo)


def _triple(direction: Any) -> str:
    return "(" + ", ".join(repr(float(x)) for x in direction) + ")"


class TargetError(RadiokitError):
    """A command-line target that cannot be loaded."""


class AssignmentError(RadiokitError):
    """An assignment is at fault, such as its inputs or its reference, and no submission is."""


class MissingExtraError(RadiokitError, ImportError):
    """An optional dependency is absent; the message is the install command that helps.

    >>> print(MissingExtraError("drawing a lobe", "pyvista", "viz"))
    drawing a lobe needs pyvista: pip install 'radiokit[viz]'
    """

    def __init__(self, task: str, module: str, extra: str) -> None:
        super().__init__(
            f"{task} needs {module}: pip install 'radiokit[{extra}]'",
            task=task,
            module=module,
            extra=extra,
        )


class NonFiniteError(RadiokitError, ArithmeticError):
    """An integrand or a sample is NaN or infinite; ``fields`` has its ``value``, and where it is, ``at``."""
