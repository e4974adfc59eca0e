"""Results: what became of a request to a sandbox, as far as the child's answer can be believed.

Their words go into feedback: what differs from run to run, as addresses and the sandbox's folder, is taken
out.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from radiokit.faces.grading.isolation.limits import PROTECTIONS
from radiokit.faces.grading.isolation.protocol import Array, MalformedError, plain_text

__all__ = ["Result", "judged", "steady"]

NAMES = 60
PROBLEMS = 20
LARGEST = 1e300
_PLACE = re.compile(r"(cell \d{1,6})?(, )?(line \d{1,7})?")


@dataclass(frozen=True, kw_only=True)
class Result:
    """What became of one call.

    ``values`` are the arrays that came back, of real or complex numbers, and empty where ``error`` says in
    one line what the function did instead, as in "took longer than 1 s". ``raised`` is the exception's type
    where it raised one, ``where`` the last place in the submission that it came through, as in "line 12" or
    "cell 3, line 2", and ``row`` the row that was at hand, where the function was called row by row.
    ``ended`` says that the process ended, or was ended, before it answered. ``output`` is the beginning of
    what it printed. ``protections`` were active during the call, ``missing`` were not, see ``PROTECTIONS``.
    ``seconds`` is how long the answer was waited for, without what the whole machine stood still meanwhile.
    ``facts`` are what ``Sandbox.load`` and ``Sandbox.facts`` asked for.
    """

    values: tuple[Array, ...] = ()
    error: str = ""
    raised: str = ""
    where: str = ""
    row: int | None = None
    ended: bool = False
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


def steady(text: str, folder: str = "") -> str:
    """Return a text without what differs from run to run: addresses, process and user ids, temporary names.

    >>> steady("<f at 0x7f3a5c2b1d90> of pid 4711 in /tmp/radiokit-a1b2/home/x.py", "/tmp/radiokit-a1b2")
    '<f at 0x…> of pid … in /home/x.py'
    """
    if folder:
        text = text.replace(folder, "")
    text = re.sub(r"\b0x[0-9a-fA-F]{6,}\b", "0x…", text)
    text = re.sub(r"\b([pug]id(?: not found)?\W{1,3})\d+", r"\1…", text, flags=re.IGNORECASE)
    return re.sub(r"/tmp[a-z0-9_]{8}\b", "/tmp…", text)


def judged(
    header: dict[str, Any], values: list[Array], token: str, *, outputs: int = 1, folder: str = ""
) -> dict[str, Any]:
    """Return a result's fields from an answer of unknown honesty."""

    def words(text: object, limit: int = 300) -> str:
        return plain_text(steady(plain_text(text, 1200), folder), limit)

    if header.get("id") != token:
        raise MalformedError("it answers what was not asked")
    if "error" in header:
        raised, text, row = (
            words(header.get("type", "Exception"), 60),
            words(header["error"]),
            header.get("row"),
        )
        return {
            "error": f"raised {raised}: {text}" if text else f"raised {raised}",
            "raised": raised,
            "where": _place(header.get("where")),
            "row": row if type(row) is int and 0 <= row < 1 << 40 else None,
        }
    if "refused" in header:
        return {"error": words(header["refused"]) or "refused"}
    if "problems" in header:
        names, problems = header.get("names"), header["problems"]
        if not isinstance(names, list) or not isinstance(problems, list):
            raise MalformedError("its problems are none")
        kept = [each for each in problems[:PROBLEMS] if isinstance(each, dict)]
        return {
            "facts": {
                "names": [words(name, 60) for name in names[:NAMES]],
                "problems": [
                    {
                        "where": _place(each.get("where")),
                        "raised": words(each.get("raised", ""), 60),
                        "message": words(each.get("message", "")),
                    }
                    for each in kept
                ],
            }
        }
    if "facts" in header:
        return {"facts": _facts(header["facts"])}
    if not values or outputs not in (1, len(values)):
        raise MalformedError("it has neither values nor an error" if not values else "values are missing")
    return {"values": tuple(values)}


def _place(where: object) -> str:
    text = plain_text(where, 60)
    return text if _PLACE.fullmatch(text) else ""


def _facts(found: Any) -> dict[str, Any]:
    if not isinstance(found, dict):
        raise MalformedError("its facts are none")
    eta = found.get("eta")
    if not (eta is None or (isinstance(eta, int | float) and -LARGEST <= eta <= LARGEST)):
        raise MalformedError("its refractive index is no number")
    return {
        **{name: found.get(name) is True for name in ("callable", "pdf", "sample", "transmissive")},
        "eta": None if eta is None else float(eta),
        "parameters": _parameters(found.get("parameters")),
    }


def _parameters(found: Any) -> tuple[tuple[str, bool], ...]:
    """Return the parameters that a function says it has, as ``signature.listed`` does."""
    listed = found[:NAMES] if isinstance(found, list) else []
    return tuple(
        (plain_text(each[0], 60), each[1] is True)
        for each in listed
        if isinstance(each, list) and len(each) == 2
    )
