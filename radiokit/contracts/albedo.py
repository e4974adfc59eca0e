"""Directional albedo: the share of the flux that a BSDF scatters, for one direction or many."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.bsdf import BSDF, FloatArray
from radiokit.facts.directions import check_directions
from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate
from radiokit.measure import lowdiscrepancy
from radiokit.measure.quadrature import hemisphere

__all__ = ["Side", "albedo", "delta_albedo", "directional_albedo", "integrand"]

Side = Literal["wo", "wi"]
"""Which direction is held fixed."""

SAMPLES, MOST_SAMPLES = 1 << 20, 1 << 24
"""Samples for each direction by default, and at most when a relative error is asked for."""

_SHORTEST = 1e-6  # seconds for a direction when the others have used up the time: one block


def albedo(
    f: BSDF | Callable[..., Any],
    wo: npt.ArrayLike,
    *,
    method: Literal["quadrature", "mc", "qmc"] = "quadrature",
    rtol: float | None = None,
    seconds: float | None = None,
    samples: int | None = None,
    rng: int | np.random.Generator | None = None,
    fixed: Side = "wo",
) -> Estimate:
    """Return the directional albedo ρ(wo) = ∫ f(wi, wo) cosθi dωi, delta lobes included.

    Parameters
    ----------
    f : BSDF or callable
    wo : array_like, shape (3,) or (N, 3)
        Unit vectors above the horizon.
    method : {"quadrature", "mc", "qmc"}
        Quadrature gives a bound; Monte Carlo samples the BSDF and gives a standard error, with random points
        or (``qmc``) with sixteen randomly shifted lattices. For ``mc``, a model with a weight kernel is run
        as machine code on all processors, with the same answer on any number.
    rtol : float, optional
        Relative error that is asked for: of the quadrature, 1e-8 unless it is given; of Monte Carlo, whose
        standard error it is, to stop early, at a number of samples that does not depend on the processors.
    seconds : float, optional
        For Monte Carlo: stop after so much time [s], of which each direction gets an equal share.
    samples, rng
        For Monte Carlo: the number of samples for each direction (``qmc`` rounds it down to 16 times a power
        of 2), and the seed. With ``rtol`` or ``seconds`` it is the most that are drawn. By default 2²⁰, with
        ``rtol`` at most 2²⁴, and with ``seconds`` as many as there is time for.
    fixed : {"wo", "wi"}
        Hold ``wi`` fixed instead and integrate over wo: what a ray of light from there loses.

    Returns
    -------
    Estimate
        Of shape () or (N,), with (..., K) for K wavelengths. Dimensionless; in [0, 1] for a BSDF that
        conserves energy. ``converged`` is False where ``rtol`` was not reached, or the ``samples`` asked for
        were not drawn in time; ``note`` then says what was.

    Raises
    ------
    ParameterError
        When ``wo`` is not a unit vector above the horizon, ``method`` is unknown, or ``seconds`` is given for
        the quadrature.
    CallableError, NonFiniteError
        When the function fails at some direction.

    Notes
    -----
    Nicodemus et al. (1977), NBS Monograph 160, eq. (16): the directional-hemispherical reflectance.

    >>> from radiokit.contracts.bsdf import bsdf
    >>> print(albedo(bsdf("lambert", reflectance=0.5), (0.0, 0.0, 1.0)).value.round(12))
    0.5
    >>> quick = albedo(bsdf("ggx", alpha=0.5), (0.0, 0.6, 0.8), method="mc", rtol=1e-3, rng=1)
    >>> quick.converged, bool(quick.error <= 1e-3 * quick.value), quick.evaluations < 1 << 20
    (True, True, True)
    """
    model = as_bsdf(f)
    wo = check_directions("wo", wo)
    if wo.ndim > 2:
        raise ParameterError("wo", wo.shape, "of shape (3,) or (N, 3)")
    if not np.all(wo[..., 2] > 0):
        raise ParameterError("wo", wo.tolist(), "above the horizon (z > 0)")
    if fixed not in ("wo", "wi"):
        raise ParameterError("fixed", fixed, "'wo' or 'wi'")
    if seconds is not None and not seconds > 0:
        raise ParameterError("seconds", seconds, "above 0, or None")
    if method == "quadrature":
        if seconds is not None:
            raise ParameterError("seconds", seconds, "None, or method 'mc' or 'qmc'")
        aim = 1e-8 if rtol is None else rtol
        one = lambda w, share: directional_albedo(model, w, fixed=fixed, rtol=aim)  # noqa: E731
    elif method in ("mc", "qmc"):
        if fixed == "wi":
            raise ParameterError("method", method, "'quadrature' when wi is held fixed")
        seed = int(np.random.default_rng(rng).integers(1 << 63))
        sampled = _monte_carlo if method == "mc" else _low_discrepancy
        if samples is None and seconds is None:
            samples = SAMPLES if rtol is None else MOST_SAMPLES
        one = lambda w, share: sampled(  # noqa: E731
            model, w, seed, samples=samples, rtol=rtol, seconds=None if seconds is None else share
        )
    else:
        raise ParameterError("method", method, "'quadrature', 'mc' or 'qmc'")
    if wo.ndim == 1:
        return one(wo, seconds or 0.0)
    start = time.perf_counter()
    found = []
    for index, w in enumerate(wo):
        left = (seconds or 0.0) - (time.perf_counter() - start)
        found.append(one(w, max(left / (len(wo) - index), _SHORTEST)))
    notes = list(dict.fromkeys(estimate.note for estimate in found if estimate.note))
    return Estimate(
        np.array([estimate.value for estimate in found]),
        np.array([estimate.error for estimate in found]),
        found[0].kind if found else "rounding",
        sum(estimate.evaluations for estimate in found),
        time.perf_counter() - start,
        found[0].method if found else method,
        all(estimate.converged for estimate in found),
        "; ".join(notes),
        found[0].dof if found else None,
    )


def directional_albedo(
    model: BSDF,
    fixed_direction: FloatArray,
    *,
    fixed: Side = "wo",
    width: float | None = None,
    rtol: float = 1e-8,
    atol: float = 0.0,
    max_evaluations: int = 4_000_000,
) -> Estimate:
    """Return the directional albedo by quadrature, with a truncation bound.

    ``width`` is the lobe's width if the caller knows it better than the model does.

    >>> from radiokit.contracts.bsdf import bsdf
    >>> estimate = directional_albedo(bsdf("lambert", reflectance=0.5), np.array([0.0, 0.6, 0.8]))
    >>> bool(abs(estimate.value - 0.5) <= estimate.error < 5e-9)
    True
    """
    found = hemisphere(
        integrand(model, fixed_direction, fixed),
        wo=fixed_direction,
        width=model.lobe_width() if width is None else width,
        rtol=rtol,
        atol=atol,
        symmetric=model.isotropic,
        smooth=model.smooth,
        max_evaluations=max_evaluations,
    )
    delta = delta_albedo(model, fixed_direction)
    if not np.any(delta):
        return replace(found, error=found.error + 4 * model.precision * np.abs(found.value))
    total = found.value + delta
    return replace(found, value=total, error=found.error + 4 * model.precision * np.abs(total))


def integrand(model: BSDF, fixed_direction: FloatArray, fixed: Side) -> Callable[[FloatArray], Any]:
    """Return w ↦ f cosθ(w) with the other direction held fixed."""

    def value(w: FloatArray) -> Any:
        other = np.broadcast_to(fixed_direction, w.shape)
        f = model.evaluate(w, other) if fixed == "wo" else model.evaluate(other, w)
        return (f.T * w[:, 2]).T

    return value


def delta_albedo(model: BSDF, wo: FloatArray) -> Any:
    """Return the share of the flux that leaves in delta lobes; 0.0 when there are none."""
    return sum((lobe.weight[0] for lobe in model.delta_lobes(wo[None, :])), start=np.float64(0.0))


def _monte_carlo(model: BSDF, wo: FloatArray, seed: int, **stop: Any) -> Estimate:
    from radiokit.measure.fused import fused_mean

    def weight(*u: FloatArray) -> Any:
        points = np.stack(u, axis=-1)
        return model.sample(points, np.broadcast_to(wo, (len(points), 3)))[1]

    function, constants = model.weight_kernel(wo) or (weight, ())
    method = "Monte Carlo, BSDF-sampled"
    return fused_mean(function, constants, dimensions=model.dimensions, rng=seed, method=method, **stop)


def _low_discrepancy(model: BSDF, wo: FloatArray, seed: int, **stop: Any) -> Estimate:
    def draw(u: FloatArray) -> Any:
        return model.sample(u, np.broadcast_to(wo, (len(u), 3)))[1]

    method = "shifted lattices, BSDF-sampled"
    return lowdiscrepancy.mean(draw, dimensions=model.dimensions, rng=seed, method=method, **stop)
