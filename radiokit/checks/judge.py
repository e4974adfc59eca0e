"""The judge: puts a BSDF before every law and reports the verdicts."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable
from numbers import Real
from typing import Any

from radiokit.checks.energy import energy
from radiokit.checks.microfacet import microfacet
from radiokit.checks.probes import seconds_per_evaluation
from radiokit.checks.reciprocity import reciprocity
from radiokit.checks.sampling import ANGLES_DEG, sampling
from radiokit.checks.values import values
from radiokit.contracts.blackbox import BlackBox, as_bsdf
from radiokit.contracts.bsdf import BSDF
from radiokit.facts.errors import ParameterError, UnknownNameError
from radiokit.facts.report import Report
from radiokit.facts.verdict import TOLERANCE, Evidence, Outcome, Verdict

__all__ = ["LAWS", "check"]

LAWS = ("values", "reciprocity", "energy", "sampling", "microfacet")

_PLENTY = {"values": 1 << 16, "reciprocity": 1 << 17, "energy": 16_000_000, "sampling": 6 << 17}
"""Evaluations that each law may spend on a fast function."""

_SHARE = {"values": 0.05, "reciprocity": 0.25, "energy": 0.65, "sampling": 0.05}
"""Each law's share of the time for a slow one, or of the evaluations that are asked for."""

_USUAL = 8_000_000
"""Evaluations that a check usually stays below; a function is slow when they would take too long."""

_FEWEST = 1000
"""The smallest budget that may be asked for."""


def check(
    f: BSDF | Callable[..., Any],
    *,
    laws: str | Iterable[str] = LAWS,
    tolerance: float = TOLERANCE,
    seconds: float = 60.0,
    evaluations: int | None = None,
    tests: int = 1,
    progress: Callable[[int, int], None] | None = None,
) -> Report:
    """Check a BSDF for finite values, reciprocity, energy conservation, its sampler, and its facets.

    Searches are deterministic, and the samples' seed derives from the model's name and parameters: the same
    function gets the same report, however fast it is, unless it is so slow that ``seconds`` makes the
    searches coarser. With ``evaluations`` they depend on nothing that is measured. A function without a
    sampler is not judged for one, nor a model without ``microfacets`` for them.

    Parameters
    ----------
    f : BSDF or callable
        A callable f(wi, wo) [sr⁻¹] is wrapped by ``as_bsdf``; one through which light passes says so by its
        attributes ``transmissive`` and ``eta``.
    laws : str or iterable of str
        Which of ``values``, ``reciprocity``, ``energy``, ``sampling``, ``microfacet``.
    tolerance : float
        How far beyond a limit a value may lie.
    seconds : float
        Aimed-at time for a slow function: searches become coarser, and say so.
    evaluations : int, optional
        About how often the function may be evaluated in all, at least 1000, in place of ``seconds``: the
        report is then the same on any machine. From 100 000 a gain of some percent is seen, with 1 000 000 a
        lossless model is told from one that gains 1e-9, and above 25 000 000 the searches get no finer.
        Energy needs some 30 000 in any case; the verdicts say what was taken.
    tests : int
        How many models share the level of the statistical tests.
    progress : callable, optional
        Called with the number of finished laws and the number of all, before each law.

    Returns
    -------
    Report

    Raises
    ------
    CallableError
        When the function raises, or returns what is no value; it names the directions.
    ParameterError, UnknownNameError
        When an argument is out of range.

    >>> import numpy as np
    >>> report = check(lambda wi, wo: np.full(len(wi), 1 / np.pi))
    >>> report.ok, report["energy"].message[:8]
    (True, 'sup 1 ± ')
    """
    chosen = [laws] if isinstance(laws, str) else list(laws)
    for law in chosen:
        if law not in LAWS:
            raise UnknownNameError("law", law, LAWS)
    if not isinstance(seconds, Real) or not seconds > 0:
        raise ParameterError("seconds", seconds, "greater than 0")
    if evaluations is not None and not (isinstance(evaluations, int) and evaluations >= _FEWEST):
        raise ParameterError("evaluations", evaluations, f"an integer of at least {_FEWEST}, or None")
    if not isinstance(tolerance, Real) or not 0 <= tolerance < 1:
        raise ParameterError("tolerance", tolerance, "in [0, 1)")
    model = as_bsdf(f)
    if not getattr(model, "has_sampler", True):
        chosen = [law for law in chosen if law != "sampling"]
    facets = model.microfacets()
    if facets is None:
        chosen = [law for law in chosen if law != "microfacet"]
    budget, notes = _budget(model, seconds, evaluations)
    verdicts: list[Verdict] = []

    def step() -> None:
        if progress is not None:
            progress(len(verdicts), len(set(chosen)))

    if "values" in chosen:
        step()
        verdicts.append(values(model, count=budget["values"] // 2))
    proved = False
    if "reciprocity" in chosen:
        step()
        verdicts.append(reciprocity(model, count=budget["reciprocity"] // 2, tolerance=tolerance))
        proved = verdicts[-1].evidence is Evidence.PROVED
    if "energy" in chosen:
        step()
        verdicts.append(energy(model, tolerance=tolerance, budget=budget["energy"], reciprocal=proved))
    if "sampling" in chosen:
        step()
        samples = max(budget["sampling"] // len(ANGLES_DEG), 1 << 10)
        verdicts.append(sampling(model, samples=samples, seed=_seed(model), tests=tests))
    if "microfacet" in chosen and facets is not None:
        step()
        verdicts.append(microfacet(facets))
    if isinstance(model, BlackBox) and (remark := model.below_horizon()):
        notes.append(remark)
    if any(v.check == "values" and "asked again" in v.message for v in verdicts):
        verdicts = [_doubted(verdict) for verdict in verdicts]
    return Report(
        subject=getattr(model, "label", model.name),
        verdicts=tuple(verdicts),
        notes=(*notes, *getattr(model, "notes", ())),
        parameters={} if hasattr(model, "label") else model.parameters(),
    )


def _budget(model: BSDF, seconds: float, evaluations: int | None) -> tuple[dict[str, int], list[str]]:
    """Return how many evaluations each law may spend, and a note if it is because the function is slow."""
    if evaluations is not None:
        return {law: min(most, max(64, int(_SHARE[law] * evaluations))) for law, most in _PLENTY.items()}, []
    cost = seconds_per_evaluation(model)
    if cost * _USUAL <= seconds:
        return dict(_PLENTY), []
    note = f"one evaluation takes {cost * 1e3:.2g} ms: the searches are coarser than for a fast function"
    return {law: int(max(64, _SHARE[law] * seconds / cost)) for law in _PLENTY}, [note]


def _seed(model: BSDF) -> int:
    return int.from_bytes(hashlib.sha256(repr(model).encode()).digest()[:8], "big")


def _doubted(verdict: Verdict) -> Verdict:
    """A function that answers differently each time cannot be cleared, nor convicted, of anything else."""
    if verdict.check == "values":
        return verdict
    from dataclasses import replace

    return replace(
        verdict,
        outcome=Outcome.INCONCLUSIVE,
        evidence=Evidence.MEASURED,
        message=f"not repeatable, so not judged; this time: {verdict.outcome}, {verdict.message}",
        witness=None,
    )
