"""Compare: two runs of the bench: what has become slower, beyond the noise, or less accurate."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median
from typing import Any, Literal

from radiokit.faces.bench.rows import size_text
from radiokit.facts.errors import RadiokitError

__all__ = ["Change", "compare", "load"]

ROW_FACTOR = 1.3
"""A row may take so much longer, times the noise of its own repetitions."""
METHOD_FACTOR = 1.15
"""All rows of a method together may take so much longer, times the noise among them."""
NOISE = 5.0
"""Standard errors that count as noise."""
ACCURACY_FACTOR = 3.0
"""A deterministic error may grow so much before it counts; it is rounding below 1e-13."""
CLAIM_FACTOR = 1.5
"""A standard error at equal samples may grow so much."""
_ROUNDING = 1e-13
_FEWEST = 5  # rows of a method that are judged together


@dataclass(frozen=True)
class Change:
    """One thing that was better before."""

    kind: Literal["slower", "less accurate", "gone"]
    what: str
    message: str

    def to_json(self) -> dict[str, str]:
        """Return the change as JSON-ready data."""
        return asdict(self)


def load(path: Path) -> dict[str, Any]:
    """Return the run that ``radiokit bench --json`` wrote.

    Raises
    ------
    RadiokitError
        When there is no such file, or it is something else.
    """
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise RadiokitError(f"cannot read {path}: {error.strerror}", path=str(path)) from None
    except ValueError as error:
        raise RadiokitError(f"{path} is no JSON: {error}", path=str(path)) from None
    if not isinstance(data, dict) or data.get("format") != 1 or not isinstance(data.get("rows"), list):
        raise RadiokitError(
            f"{path} is no run of the bench: write one with radiokit bench --json > {path.name}",
            path=str(path),
        )
    return data


def compare(old: dict[str, Any], new: dict[str, Any]) -> list[Change]:
    """Return what is slower or less accurate in ``new`` than in ``old``, both from ``Bench.to_json``.

    Times count in units of the standard work that was timed in between, so that a busy or another machine
    is not taken for a slow program. Rows that only one of a full and a quick run has are left out.
    """
    before, after = _by_key(old), _by_key(new)
    changes: list[Change] = []
    logs: dict[str, list[float]] = {}
    for key, earlier in before.items():
        later = after.get(key)
        what = f"{key[0]} by {key[1]} ({size_text(key[2])})"
        if later is None:
            if old.get("settings", {}).get("quick") == new.get("settings", {}).get("quick"):
                changes.append(Change("gone", what, "it is no longer measured"))
            continue
        changes += [Change("less accurate", what, message) for message in _accuracy(earlier, later)]
        if later["evaluations"] > ROW_FACTOR * earlier["evaluations"]:
            message = f"{later['evaluations']} evaluations in place of {earlier['evaluations']}"
            changes.append(Change("slower", what, message))
        # By the medians and by the shortest times: a burst of other work lengthens the one or the other.
        log = min(math.log(later[name] / earlier[name]) for name in ("relative_seconds", "relative_best"))
        logs.setdefault(key[1], []).append(log)
        noise = math.hypot(earlier["noise"], later["noise"])
        if log > math.log(ROW_FACTOR) + NOISE * noise:
            message = f"{math.exp(log):.2f} times as long, where noise is {100 * noise:.0f} %"
            changes.append(Change("slower", what, message))
    for method, values in logs.items():
        changes += _together(method, values)
    return changes


def _by_key(run: dict[str, Any]) -> dict[tuple[str, str, float], dict[str, Any]]:
    return {(row["task"], row["method"], row["size"]): row for row in run["rows"]}


def _accuracy(old: dict[str, Any], new: dict[str, Any]) -> Iterator[str]:
    if old["honest"] and not new["honest"]:
        yield f"an error of {new['true_error']:.1e} where {new['claimed_error']:.1e} is claimed"
    if old["converged"] and not new["converged"]:
        yield "it no longer converges"
    if new["kind"] == "statistical":
        if new["claimed_error"] > CLAIM_FACTOR * old["claimed_error"] + _ROUNDING * abs(new["exact"]):
            yield f"a standard error of {new['claimed_error']:.1e} in place of {old['claimed_error']:.1e}"
    elif new["true_error"] > ACCURACY_FACTOR * old["true_error"] + _ROUNDING * abs(new["exact"]):
        yield f"an error of {new['true_error']:.1e} in place of {old['true_error']:.1e}"


def _together(method: str, logs: list[float]) -> Iterator[Change]:
    """A method's rows together show what each of them alone would leave to noise."""
    if len(logs) < _FEWEST:
        return
    centre = median(logs)
    spread = 1.2533 * 1.4826 * median(abs(log - centre) for log in logs) / math.sqrt(len(logs))
    if centre > math.log(METHOD_FACTOR) + NOISE * spread:
        message = f"{math.exp(centre):.2f} times as long over {len(logs)} rows, ± {100 * spread:.0f} %"
        yield Change("slower", f"{method}, all rows", message)
