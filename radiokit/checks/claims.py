"""Claims: what the judges observe of a model equals what the model claims."""

from __future__ import annotations

import numpy as np

from radiokit.checks.probes import pairs
from radiokit.contracts.bsdf import BSDF
from radiokit.facts.report import Report
from radiokit.facts.verdict import Evidence, Outcome, Verdict, Witness

__all__ = ["claims"]

CLAIM = "what is observed of the model equals what it claims"


def claims(f: BSDF, report: Report) -> Verdict:
    """Compare a model's claims with the verdicts of its report, in both directions.

    A model that claims to break a law must be seen to break it. What is found of reciprocity is "no" where
    the law that was judged is broken; else "eta-scaled" where that was the scaled law, of a model that
    transmits into another index, whether or not the plain one holds as well; else "yes".
    """
    said = f.claims
    if said is None:
        return Verdict(
            check="claims",
            claim=CLAIM,
            outcome=Outcome.INCONCLUSIVE,
            evidence=Evidence.MEASURED,
            message="the model claims nothing",
        )
    energy = report["energy"]
    wi, wo = pairs(256, f)
    only_delta = bool(f.delta_lobes(wo)) and not np.any(f.evaluate(wi, wo))
    lossless = bool(energy.details.get("lossless")) and energy.outcome is Outcome.HOLDS
    turns = report["reciprocity"]
    law = turns.details.get("law", "yes")
    if said.reciprocity in (law, "no"):
        rows = {"reciprocity": (said.reciprocity != "no", turns.outcome)}
    else:  # the other law is claimed than the one that governs the model
        rows = {"reciprocity": (True, Outcome.VIOLATED)}
    rows |= {
        "conserves": (said.conserves, energy.outcome),
        "lossless": (said.lossless, Outcome.HOLDS if lossless else Outcome.VIOLATED),
        "delta": (said.delta, Outcome.HOLDS if only_delta else Outcome.VIOLATED),
    }
    wrong = [name for name, (claimed, seen) in rows.items() if seen is not _expected(claimed)]
    unsure = [name for name in wrong if rows[name][1] is Outcome.INCONCLUSIVE]
    outcome = Outcome.HOLDS
    if wrong:
        outcome = Outcome.INCONCLUSIVE if len(unsure) == len(wrong) else Outcome.VIOLATED
    words = {name: "yes" if claimed else "no" for name, (claimed, _) in rows.items()}
    words["reciprocity"] = said.reciprocity
    message = "; ".join(f"{name}: claimed {words[name]}, observed {rows[name][1]}" for name in wrong)
    if said.reciprocity not in (law, "no"):
        message += f" (the law that governs it is {law}, and {turns.outcome})"
    if not wrong:
        message = "as observed: " + ", ".join(f"{name} {word}" for name, word in words.items())
    refuted = outcome is Outcome.VIOLATED
    return Verdict(
        check="claims",
        claim=CLAIM,
        outcome=outcome,
        evidence=Evidence.REFUTED if refuted else Evidence.MEASURED,
        message=message,
        witness=Witness(values={name: str(rows[name][1]) for name in wrong}) if refuted else None,
        details={name: {"claimed": claimed, "observed": str(seen)} for name, (claimed, seen) in rows.items()},
    )


def _expected(claimed: bool) -> Outcome:
    return Outcome.HOLDS if claimed else Outcome.VIOLATED
