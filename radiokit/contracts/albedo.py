"""Directional albedo: the share of the flux that a BSDF scatters, for one direction or many."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.bsdf import BSDF, FloatArray
from radiokit.facts.checking import check_above_zero
from radiokit.facts.directions import check_directions
from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate
from radiokit.measure import lowdiscrepancy
from radiokit.measure.montecarlo import seed_from
from radiokit.measure.quadrature import hemisphere
from radiokit.measure.transmission import reflection_edges, sphere, transmission

__all__ = ["Part", "Side", "albedo", "delta_albedo", "directional_albedo", "integrand", "radiance_to_flux"]

Side = Literal["wo", "wi"]
"""Which direction is held fixed."""

Part = Literal["both", "reflected", "transmitted"]
"""What is counted: the flux that stays on the fixed direction's side of the surface, or passes, or both."""

SAMPLES, MOST_SAMPLES = 1 << 20, 1 << 24
"""Samples for each direction by default, and at most when a relative error is asked for."""


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
    side: Part = "both",
) -> Estimate:
    """Return the directional albedo ρ(wo) = ∫ f(wi, wo) cosθi dωi, delta lobes included.

    Where light passes, it is the share of the flux that is reflected and transmitted. Light sent from wo
    would be scattered into wi with the density f(wo, wi) |cosθi| = f(wi, wo) n(wi)²/n(wo)² |cosθi|, with n(w)
    the refractive index on w's side, and that is what is integrated for a fixed ``wo``; for a fixed ``wi``
    it is f(wi, wo) |cosθo|.

    Parameters
    ----------
    f : BSDF or callable
    wo : array_like, shape (3,) or (N, 3)
        Unit vectors above the horizon; on either side for a model that transmits.
    method : {"quadrature", "mc", "qmc"}
        Quadrature gives a bound; Monte Carlo samples the BSDF and gives a standard error, with random points
        or (``qmc``) with sixteen randomly shifted lattices. For ``mc``, a model with a weight kernel is run
        as machine code on all processors, with the same answer on any number.
    rtol : float, optional
        Relative error that is asked for: of the quadrature, 1e-8 unless it is given; of Monte Carlo, whose
        standard error it is, to stop early, at a number of samples that does not depend on the processors.
    seconds : float, optional
        For Monte Carlo: stop after so much time [s]. Directions take turns, with equally many samples each.
    samples, rng
        For Monte Carlo: the number of samples for each direction (``qmc`` rounds it down to 16 times a power
        of 2), and the seed. With ``rtol`` or ``seconds`` it is the most that are drawn. By default 2²⁰, with
        ``rtol`` at most 2²⁴, and with ``seconds`` as many as there is time for.
    fixed : {"wo", "wi"}
        Hold ``wi`` fixed instead and integrate over wo: what a ray of light from there loses.
    side : {"both", "reflected", "transmitted"}
        Count only what stays on the fixed direction's side of the surface, or only what passes.

    Returns
    -------
    Estimate
        Of shape () or (N,), with (..., K) for K wavelengths. Dimensionless; in [0, 1] for a BSDF that
        conserves energy. ``converged`` is False where ``rtol`` was not reached, or the ``samples`` asked for
        were not drawn in time; ``note`` then says what was.

    Raises
    ------
    ParameterError
        When ``wo`` is not a unit vector above the horizon (off the surface, for a model that transmits),
        ``method`` or ``side`` is unknown, ``rtol`` or ``seconds`` is not above 0, ``rng`` is no seed, or
        ``seconds`` is given for the quadrature.
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
    if not np.all(wo[..., 2] != 0 if model.transmissive else wo[..., 2] > 0):
        allowed = "off the surface (z ≠ 0)" if model.transmissive else "above the horizon (z > 0)"
        raise ParameterError("wo", wo.tolist(), allowed)
    if side not in ("both", "reflected", "transmitted"):
        raise ParameterError("side", side, "'both', 'reflected' or 'transmitted'")
    if fixed not in ("wo", "wi"):
        raise ParameterError("fixed", fixed, "'wo' or 'wi'")
    check_above_zero(rtol=rtol, seconds=seconds)
    if method == "quadrature":
        if seconds is not None:
            raise ParameterError("seconds", seconds, "None, or method 'mc' or 'qmc'")
        aim = 1e-8 if rtol is None else rtol
        one = partial(directional_albedo, model, fixed=fixed, side=side, rtol=aim)
    elif method in ("mc", "qmc"):
        if fixed == "wi":
            raise ParameterError("method", method, "'quadrature' when wi is held fixed")
        if samples is None and seconds is None:
            samples = SAMPLES if rtol is None else MOST_SAMPLES
        generator = rng if isinstance(rng, np.random.Generator) else np.random.default_rng(seed_from(rng))
        seed = int(generator.integers(1 << 63))
        sampled = _monte_carlo if method == "mc" else _low_discrepancy
        one = partial(sampled, model, seed=seed, side=side, samples=samples, rtol=rtol, seconds=seconds)
    else:
        raise ParameterError("method", method, "'quadrature', 'mc' or 'qmc'")
    if wo.ndim == 1 or (seconds is not None and len(wo)):
        return one(wo)
    start = time.perf_counter()
    found = [one(w) for w in wo]
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
    side: Part = "both",
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
    options: dict[str, Any] = {
        "wo": fixed_direction,
        "width": model.lobe_width() if width is None else width,
        "rtol": rtol,
        "atol": atol,
        "symmetric": model.isotropic,
        "smooth": model.smooth,
        "max_evaluations": max_evaluations,
    }
    value = integrand(model, fixed_direction, fixed)
    eta = float(model.relative_index() ** np.sign(fixed_direction[2]))
    if not model.transmissive:
        found = hemisphere(value, **options)
        found = found if side != "transmitted" else found.scaled(0.0)
    elif side == "reflected":
        below = fixed_direction[2] < 0
        options["wo"] = _mirror(fixed_direction) if below else fixed_direction
        own = (lambda w: value(_mirror(w))) if below else value
        found = hemisphere(own, edges=reflection_edges(eta), **options)
    else:
        found = (sphere if side == "both" else transmission)(value, eta=eta, **options)
    delta = delta_albedo(model, fixed_direction, side)
    if not np.any(delta):
        return replace(found, error=found.error + 4 * model.precision * np.abs(found.value))
    total = found.value + delta
    return replace(found, value=total, error=found.error + 4 * model.precision * np.abs(total))


def integrand(model: BSDF, fixed_direction: FloatArray, fixed: Side) -> Callable[[FloatArray], Any]:
    """Return w ↦ f |cosθ(w)|, as a share of flux, with the other direction held fixed."""

    def value(w: FloatArray) -> Any:
        other = np.broadcast_to(fixed_direction, w.shape)
        if not model.transmissive:
            f = model.evaluate(w, other) if fixed == "wo" else model.evaluate(other, w)
            return (f.T * w[:, 2]).T
        if fixed == "wi":
            return (model.evaluate(other, w).T * np.abs(w[:, 2])).T
        return (model.evaluate(w, other).T * (np.abs(w[:, 2]) * radiance_to_flux(model, w, other))).T

    return value


def radiance_to_flux(model: BSDF, wi: FloatArray, wo: FloatArray) -> Any:
    """Return n(wi)²/n(wo)² (N,), which makes f |cosθi| a share of flux for a fixed ``wo``."""
    eta = model.relative_index()
    passes = (wi[:, 2] < 0) != (wo[:, 2] < 0)
    return np.where(passes, np.where(wi[:, 2] < 0, eta * eta, 1 / (eta * eta)), 1.0)


def delta_albedo(model: BSDF, wo: FloatArray, side: Part = "both") -> Any:
    """Return the share of the flux that leaves in delta lobes; 0.0 when there are none."""
    lobes = [
        lobe
        for lobe in model.delta_lobes(wo[None, :])
        if side == "both" or (side == "reflected") == (lobe.wi[0, 2] * wo[2] > 0)
    ]
    return sum((lobe.weight[0] for lobe in lobes), start=np.float64(0.0))


def _mirror(w: FloatArray) -> FloatArray:
    return w * np.array([1.0, 1.0, -1.0])


def _sampled_share(model: BSDF, u: FloatArray, wo: FloatArray, side: Part) -> Any:
    """Return the samples' weights as shares of flux, 0 where they leave on the side that is not counted."""
    held = np.broadcast_to(wo, (len(u), 3))
    wi, weight = model.sample(u, held)
    if model.transmissive:
        weight = (weight.T * radiance_to_flux(model, wi, held)).T
    if side == "both":
        return weight
    return (weight.T * ((wi[:, 2] * wo[2] > 0) == (side == "reflected"))).T


def _monte_carlo(model: BSDF, wo: FloatArray, *, seed: int, side: Part, **stop: Any) -> Estimate:
    """Return the albedo for one direction (3,), or for several together (N, 3)."""
    from radiokit.measure.fused import fused_mean, fused_means

    plain = side == "both" and model.relative_index() == 1.0  # a weight is a share of flux as it is

    def term(w: FloatArray) -> Any:
        def weight(*u: FloatArray) -> Any:
            return _sampled_share(model, np.stack(u, axis=-1), w, side)

        return (model.weight_kernel(w) if plain else None) or (weight, ())

    options = {"dimensions": model.dimensions, "rng": seed, "method": "Monte Carlo, BSDF-sampled", **stop}
    if wo.ndim == 1:
        return fused_mean(*term(wo), **options)
    return fused_means([term(w) for w in wo], **options)


def _low_discrepancy(model: BSDF, wo: FloatArray, *, seed: int, side: Part, **stop: Any) -> Estimate:
    """Return the albedo for one direction (3,), or for several together (N, 3)."""
    method = "shifted lattices, BSDF-sampled"
    options = {"dimensions": model.dimensions, "rng": seed, "method": method, **stop}
    if wo.ndim == 1:
        return lowdiscrepancy.mean(lambda u: _sampled_share(model, u, wo, side), **options)
    middle = np.full((1, model.dimensions), 0.5)
    shape = (len(wo), *np.shape(_sampled_share(model, middle, wo[0], side))[1:])

    def draw(u: FloatArray) -> Any:
        return np.stack([_sampled_share(model, u, w, side) for w in wo], axis=1).reshape(len(u), -1)

    found = lowdiscrepancy.mean(draw, **options)
    value, error = np.reshape(found.value, shape), np.reshape(found.error, shape)
    return replace(found, value=value, error=error, evaluations=len(wo) * found.evaluations)
