"""Sampling: sample, pdf and evaluate agree with each other, point by point and in distribution."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from radiokit.checks.cells import cells_of
from radiokit.checks.delta import in_lobe, lobe_means
from radiokit.checks.parts import flipped, mean_weight, parts
from radiokit.checks.probes import channels, pairs, polar
from radiokit.contracts.bsdf import BSDF, FloatArray
from radiokit.facts.errors import NonFiniteError
from radiokit.facts.verdict import Evidence, Outcome, Verdict, Witness

__all__ = ["ANGLES_DEG", "LEVEL", "sampling"]

CLAIM = "sample follows pdf, and its weight is f |cos θi| / pdf"
ANGLES_DEG = (0.0, 30.0, 60.0, 80.0, 85.0, 89.5)
LEVEL = 1e-6
"""Chance of rejecting a right sampler, over all tests of one verdict (and of a suite, see ``tests``)."""

P_VALUES = ("p_chi_square", "p_albedo", "p_delta")
"""The tests at each direction; all three share the level, though few models have delta lobes."""

MOST = 400_000  # evaluations that one integral may cost
REFINED = 4_000_000  # the same for cells that a narrow ridge may cross
DOUBTFUL = 0.01  # p-value below which cells are refined: the fault may be that of the integrals
WEIGHT = 1e-6  # relative disagreement of a weight that is let pass


def sampling(f: BSDF, *, samples: int = 1 << 17, seed: int = 0, tests: int = 1) -> Verdict:
    """Judge whether the sampler of ``f`` agrees with its pdf and its values.

    At six outgoing directions up to 89.5°, on both sides of a surface that transmits: every weight equals
    f cosθi / pdf; the pdf integrates to at most 1 and falls short by exactly the share of samples that are
    absorbed, leave below the horizon of a surface that does not transmit, or go into a delta lobe; the
    samples follow it (chi-square over cells that are fine where the lobe is); each delta lobe is brought, on
    average, the weight that is its due; the weights' mean is the albedo (Bernstein's inequality, since rare
    weights may matter).

    Parameters
    ----------
    samples : int
        For each direction.
    seed : int
    tests : int
        How many verdicts of this kind the level is shared among (Šidák).
    """
    from radiokit.measure.statistics import sidak

    start = time.perf_counter()
    p_least, evaluations = 1.0, 0
    places = [
        (theta, below) for below in ((False, True) if f.transmissive else (False,)) for theta in ANGLES_DEG
    ]
    level = sidak(LEVEL, tests * len(P_VALUES) * len(places))
    details: dict[str, Any] = {"samples": samples, "angles_deg": list(ANGLES_DEG)}
    details |= {"level": level, "level_of_all": LEVEL, "verdicts": tests}
    problem: tuple[str, Witness] | None = None
    doubt = ""
    rows = []
    for k, (theta, below) in enumerate(places):
        wo = flipped(polar(np.cos(np.deg2rad([theta])), [0.7 * k])[0], below)
        rng = np.random.default_rng([seed, k])
        u = rng.random((samples, f.dimensions))
        wi, weight = f.sample(u, np.broadcast_to(wo, (samples, 3)))
        evaluations += samples
        problem = _pointwise(f, u, wi, weight, wo)
        if problem is None:
            row, problem = _distribution(f, wi, weight, wo, level)
            evaluations += int(row.pop("evaluations", 0))
            side = {"side": "below" if below else "above"} if f.transmissive else {}
            rows.append({"theta_deg": theta, **side, **row})
            p_least = min(p_least, *(row.get(name, 1.0) for name in P_VALUES))
            if "unsure" in row:
                doubt = doubt or f"{row['unsure']}, at θo = {theta:g}°{' below' if below else ''}"
        if problem is not None:
            problem = (f"{problem[0]}, at θo = {theta:g}°{' below' if below else ''}", problem[1])
            break
    details["rows"] = rows
    message = f"{samples} samples at each of {len(places)} directions; smallest p = {p_least:.2g}"
    outcome = Outcome.INCONCLUSIVE if doubt else Outcome.HOLDS
    return Verdict(
        check="sampling",
        claim=CLAIM,
        outcome=outcome if problem is None else Outcome.VIOLATED,
        evidence=Evidence.MEASURED if problem is None else Evidence.REFUTED,
        message=doubt or message if problem is None else problem[0],
        witness=None if problem is None else problem[1],
        p_value=p_least,
        evaluations=evaluations,
        seconds=time.perf_counter() - start,
        details=details,
    )


def _pointwise(
    f: BSDF, u: FloatArray, wi: FloatArray, weight: FloatArray, wo: FloatArray
) -> tuple[str, Witness] | None:
    """Look at each sample: a unit vector, a finite weight, and the weight that f and pdf say."""
    weight = channels(weight)
    held = np.broadcast_to(wo, wi.shape)

    def witness(row: int, **values: Any) -> Witness:
        at = {"u": u[row].tolist(), "wi": wi[row].tolist(), "wo": wo.tolist()}
        return Witness(at, {name: np.squeeze(value) for name, value in values.items()})

    live = weight.any(axis=1) | ~np.isfinite(weight).all(axis=1)
    length = np.abs(np.linalg.norm(wi, axis=1) - 1)
    bad = live & ~((length < 1e-6) & np.isfinite(weight).all(axis=1) & (weight >= 0).all(axis=1))
    if np.any(bad):
        row = int(np.argmax(bad))
        return "a sample is no unit vector, or its weight is negative or not finite", witness(
            row, weight=weight[row]
        )
    live &= ~in_lobe(f, wi, wo)  # what went into a delta lobe has no density to compare with
    rows = np.flatnonzero(live)
    density = np.asarray(f.pdf(wi[rows], held[rows]), dtype=float)
    value = channels(f.evaluate(wi[rows], held[rows]))
    wrong = ~((density > 0) & np.isfinite(density))
    if np.any(wrong):
        row = int(np.argmax(wrong))
        return "a direction was sampled whose pdf is not positive", witness(int(rows[row]), pdf=density[row])
    said = value * np.abs(wi[rows, 2])[:, None] / density[:, None]
    scale = np.maximum(said, weight[rows]) + 1e-300
    off = (np.abs(said - weight[rows]) / scale).max(axis=1, initial=0.0)
    # Rounding: a grazing direction or a narrow lobe magnifies it, so a quantile decides, not the worst.
    allowed = WEIGHT + 64 * f.precision
    if len(off) and np.quantile(off, 0.99) > allowed:
        row = int(np.argsort(off)[len(off) // 2])
        return f"the weight is not f cosθi / pdf: off by {off[row]:.3g}", witness(
            int(rows[row]), weight=weight[rows[row]], **{"f cosθi / pdf": said[row]}
        )
    return None


def _distribution(
    f: BSDF, wi: FloatArray, weight: FloatArray, wo: FloatArray, level: float
) -> tuple[dict[str, Any], tuple[str, Witness] | None]:
    """Compare the samples with the pdf, cell by cell, and their mean weight with the albedo."""
    from radiokit.measure.statistics import bernstein_test, chi_square

    samples = len(wi)
    at = {"wo": wo.tolist()}
    special = in_lobe(f, wi, wo) | _absorbed(f, wi, weight, wo)
    row, problem = _delta(f, wi, weight, wo, level)
    if problem is not None or (row and not np.any(channels(weight)[~special]) and _only_delta(f, wo)):
        return row, problem
    below = bool(wo[2] < 0)
    up, pieces = flipped(wo, below), parts(f, "wo", below)
    places = [flipped(wi, below)] + ([flipped(wi, not below)] if len(pieces) > 1 else [])
    row["evaluations"] = 0
    most = MOST if len(pieces) == 1 else MOST // 4  # light that passes has kinks, and the samples err more
    total, error = 0.0, 0.0
    regions = [cells_of(f, piece, up) for piece in pieces]
    sampled, observed = [], []
    for region, place in zip(regions, places, strict=True):
        try:
            found = region.integral(most)
        except NonFiniteError as problem_found:
            return {}, ("the pdf is not finite", Witness(at, {"pdf": str(problem_found)}))
        total, error = total + float(found.value), error + float(found.error)
        row["evaluations"] += found.evaluations
        sampled.append(place[(place[:, 2] > 0) & ~special])
        observed.append(region.counts(sampled[-1]))
    row["pdf_integral"] = total
    if total - error > 1 + 1e-6:
        domain = "sphere" if f.transmissive else "hemisphere"
        return row, (
            f"the pdf integrates to {total:.6g} over the {domain}, more than 1",
            Witness(at, {"∫ pdf dω": total, "±": error}),
        )

    def fitted(expected: list[FloatArray]) -> tuple[Any, FloatArray, Any]:
        shares, counts = _with_rest(np.concatenate(expected), np.concatenate(observed), samples)
        return chi_square(counts, shares / shares.sum() * samples), shares, counts

    rough = [region.shares() for region in regions]
    row["evaluations"] += sum(spent for _, spent in rough)
    fit, shares, counts = fitted([share for share, _ in rough])
    resolved = True
    if fit.p_value < DOUBTFUL:
        fine = [region.refined(here, samples, REFINED) for region, here in zip(regions, sampled, strict=True)]
        row["evaluations"] += sum(each.evaluations for each in fine)
        resolved = all(each.resolved for each in fine)
        fit, shares, counts = fitted([each.shares for each in fine])
    if fit.p_value < level and not resolved:
        return row | {"unsure": "the lobe is too narrow for the cells of the chi-square test"}, None
    row["p_chi_square"] = float(fit.p_value)
    row["chi_square"], row["dof"] = float(fit.statistic), int(fit.dof)
    if fit.p_value < level:
        cell = int(np.argmax(np.abs(counts - shares * samples) / np.sqrt(shares * samples + 1)))
        values = {"p-value": float(fit.p_value), "observed": int(counts[cell])}
        values["expected"] = float(shares[cell] * samples)
        return row, (
            f"the samples do not follow the pdf: chi-square p = {fit.p_value:.1e}",
            Witness(at, values),
        )
    truth = mean_weight(f, wo, rtol=1e-6, max_evaluations=len(pieces) * most)
    row["evaluations"] += truth.evaluations
    columns, exact = channels(weight), np.atleast_1d(truth.value)
    slack = np.broadcast_to(truth.error, exact.shape) + 1e-12
    chances = [bernstein_test(columns[:, k], exact[k], slack[k]) for k in range(len(exact))]
    k = int(np.argmin(chances))
    p = min(1.0, chances[k] * len(chances))
    if p < level and not truth.converged:
        return row | {"unsure": f"the albedo is not known well enough: {truth.note}"}, None
    row["p_albedo"] = p
    if p < level:
        values = {"mean weight": columns[:, k].mean(), "∫ f |cosθi| dωi": exact[k], "p-value": p}
        return row, ("the weights' mean is not the albedo", Witness(at, values))
    return row, None


def _delta(
    f: BSDF, wi: FloatArray, weight: FloatArray, wo: FloatArray, level: float
) -> tuple[dict[str, Any], tuple[str, Witness] | None]:
    """Judge what the samples brought to each delta lobe."""
    lobes = lobe_means(f, wi, weight, wo)
    if not lobes:
        return {}, None
    worst = min(lobes, key=lambda lobe: float(lobe["p"]))
    p = min(1.0, worst["p"] * len(lobes))
    row = {"delta_lobes": lobes, "p_delta": p}
    if p >= level:
        return row, None
    values = {name: worst[name] for name in ("due", "mean", "frequency")} | {"p-value": p}
    return row, (
        "the weights' mean is not that of the delta lobes",
        Witness({"wo": wo.tolist(), "wi": worst["wi"]}, values),
    )


def _absorbed(f: BSDF, wi: FloatArray, weight: FloatArray, wo: FloatArray) -> Any:
    """Return which samples were absorbed by a surface that transmits, and so went nowhere.

    They have weight 0. Their direction may be any: they are told from a sample that went where f is 0 by an f
    that is not, or by a pdf of 0.
    """
    found = np.zeros(len(wi), dtype=bool)
    rows = np.flatnonzero(~channels(weight).any(axis=1)) if f.transmissive else ()
    if len(rows):
        held = np.broadcast_to(wo, (len(rows), 3))
        unit = np.abs(np.linalg.norm(wi[rows], axis=1) - 1) < 1e-6
        safe = np.where(unit[:, None], wi[rows], wo)
        dark = ~channels(f.evaluate(safe, held)).any(axis=1)
        found[rows] = ~unit | ~dark | (np.asarray(f.pdf(safe, held)) == 0)
    return found


def _only_delta(f: BSDF, wo: FloatArray) -> bool:
    """Whether nothing is sampled beside the delta lobes, as far as can be seen."""
    wi, _ = pairs(256, f)
    return not np.any(f.pdf(wi, np.broadcast_to(wo, wi.shape)))


def _with_rest(expected: FloatArray, observed: Any, samples: int) -> tuple[FloatArray, Any]:
    """Append a cell for what is absorbed, lost below the horizon or gone into a delta lobe, if any is."""
    lost, rest = max(0.0, 1 - float(expected.sum())), samples - int(observed.sum())
    if lost < 1e-6 and rest == 0:
        return np.maximum(expected / expected.sum(), 0.0), observed
    return np.maximum(np.append(expected, lost), 0.0), np.append(observed, rest)
