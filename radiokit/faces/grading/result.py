"""Results: what became of a call in a sandbox, as far as the child's answer can be believed."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from radiokit.faces.grading.limits import PROTECTIONS
from radiokit.faces.grading.protocol import Array, MalformedError, plain_text

__all__ = ["Result", "judged"]


@dataclass(frozen=True, kw_only=True)
class Result:
    """What became of one call.

    ``values`` are the arrays that came back, of real or complex numbers, and empty where ``error`` says in
    one line what the function did instead, as in "took longer than 1 s". ``raised`` is the exception's type
    where it raised one. ``output`` is the beginning of what it printed. ``protections`` were active during
    the call, ``missing`` were not, see ``PROTECTIONS``. ``seconds`` is wall time, a child's start included.
    ``facts`` are what ``Sandbox.facts`` asked for.
    """

    values: tuple[Array, ...] = ()
    error: str = ""
    raised: str = ""
    seconds: float = 0.0
    output: str = ""
    protections: tuple[str, ...] = ()
    facts: Mapping[str, Any] = dataclasses.field(default_factory=dict)

    @property
    def ok(self) -> bool:
        """Whether values came back."""
        return not self.error

    @property
    def missing(self) -> tuple[str, ...]:
        """Which protections this system did not grant."""
        return tuple(name for name in PROTECTIONS if name not in self.protections)


def judged(header: dict[str, Any], values: list[Array], token: str) -> dict[str, Any]:
    """Return a result's fields from an answer of unknown honesty."""
    if header.get("id") != token:
        raise MalformedError("it answers what was not asked")
    if "error" in header:
        raised = plain_text(header.get("type", "Exception"), 60)
        text = plain_text(header["error"])
        return {"error": f"raised {raised}: {text}" if text else f"raised {raised}", "raised": raised}
    if "refused" in header:
        return {"error": plain_text(header["refused"]) or "refused"}
    if "facts" in header:
        return {"facts": _facts(header)}
    if not values:
        raise MalformedError("it has neither values nor an error")
    return {"values": tuple(values)}


def _facts(header: dict[str, Any]) -> dict[str, Any]:
    found, names = header["facts"], header.get("names")
    if not isinstance(found, dict) or not isinstance(names, list):
        raise MalformedError("its facts are none")
    eta = found.get("eta")
    return {
        **{name: found.get(name) is True for name in ("callable", "pdf", "sample", "transmissive")},
        "eta": float(eta) if isinstance(eta, int | float) else None,
        "names": [plain_text(name, 60) for name in names[:50]],
    }
