"""Families: lobes narrow, long, kinked and summed are integrated to eight digits, known or as black boxes."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import erfcx

from radiokit.facts.directions import spherical_to_cartesian
from radiokit.measure.quadrature import hemisphere
from radiokit.measure.slope import slope_rule
from radiokit.measure.split import kinked, split_rule


def _half(wi, wo):
    """Return the slope vector of the half vector (N, 2), wo·h (N,) and cosθh (N,)."""
    total = wi + wo
    length = np.sqrt(np.sum(total * total, axis=1))
    return total[:, :2] / total[:, 2:], length / 2, total[:, 2] / length


def _beckmann_lambda(w, alpha):
    """Smith's Λ, exactly: (exp(−a²)/(a√π) − erfc a)/2 with a = cotθ/α."""
    tan = np.hypot(w[..., 0], w[..., 1]) / w[..., 2]
    a = 1 / np.maximum(alpha * tan, 1e-12)
    small = np.minimum(a, 25.0)  # beyond it Λ < 1e-270
    return np.exp(-small * small) * (1 / (small * np.sqrt(np.pi)) - erfcx(small)) / 2


def beckmann(wi, wo, alpha):
    slope, _, cos_h = _half(wi, wo)
    d = np.exp(-np.sum(slope * slope, axis=1) / alpha**2) / (np.pi * alpha**2 * cos_h**4)
    g = 1 / (1 + _beckmann_lambda(wi, alpha) + _beckmann_lambda(wo, alpha))
    return d * g / (4 * wo[2])


def ggx(wi, wo, alpha_x, alpha_y):
    slope, _, cos_h = _half(wi, wo)
    stretched = 1 + (slope[:, 0] / alpha_x) ** 2 + (slope[:, 1] / alpha_y) ** 2
    d = 1 / (np.pi * alpha_x * alpha_y * cos_h**4 * stretched**2)

    def root(w):
        return np.sqrt(w[..., 2] ** 2 + (alpha_x * w[..., 0]) ** 2 + (alpha_y * w[..., 1]) ** 2)

    return d * 0.5 * wi[:, 2] / (wi[:, 2] * root(wo) + wo[2] * root(wi))


def phong(wi, wo, exponent):
    cosine = np.maximum(wi @ (wo * [-1, -1, 1]), 0)
    return (exponent + 2) / (2 * np.pi) * cosine**exponent * wi[:, 2]


def ashikhmin_shirley(wi, wo, nu, nv):
    slope, wo_h, _ = _half(wi, wo)
    square = np.sum(slope * slope, axis=1)
    share = np.where(square > 0, slope[:, 0] ** 2 / np.where(square > 0, square, 1), 0.5)
    power = nu * share + nv * (1 - share)
    d = np.sqrt((nu + 1) * (nv + 1)) / (8 * np.pi) * np.exp(-0.5 * power * np.log1p(square))
    fresnel = 0.5 + 0.5 * (1 - wo_h) ** 5
    return d * fresnel * wi[:, 2] / (wo_h * np.maximum(wi[:, 2], wo[2]))


def diffuse(wi, wo):
    return wi[:, 2] / np.pi


def _arcs(focus):
    """Yield (from, to, scale): half arcs of the circle, each of which starts where nodes should crowd."""
    points = sorted(focus)
    for k, here in enumerate(points):
        ahead = points[(k + 1) % len(points)]
        gap = (ahead - here) % (2 * np.pi) or 2 * np.pi
        yield here, here + gap / 2, focus[here]
        yield ahead, ahead - gap / 2, focus[ahead]


def dense(f, wo, width, n, ridge=None):
    """∫ f(wi) dω by Gauss-Legendre panels over the slopes of half vectors, cut where cosθi = cosθo.

    Independent of the rule under test in its azimuths, its radii and its number of nodes. ``ridge`` is the
    azimuth, absolute, and the relative width of a long lobe.
    """
    x, w = np.polynomial.legendre.leggauss(n)
    x, w = (x + 1) / 2, w / 2
    sin_o, cos_o = np.hypot(wo[0], wo[1]), wo[2]
    tan_o = sin_o / cos_o
    turn = np.arctan2(wo[1], wo[0]) if sin_o > 0 else 0.0
    focus = dict.fromkeys((np.pi / 2, 3 * np.pi / 2), 1 / max(1.0, tan_o))  # where the limits bend
    if ridge is not None:
        focus |= dict.fromkeys([(ridge[0] - turn + k * np.pi) % (2 * np.pi) for k in (0, 1)], ridge[1])
    total = 0.0
    for here, there, scale in _arcs(focus):
        length = np.arcsinh(abs(there - here) / scale)
        phi = here + np.copysign(scale, there - here) * np.sinh(length * x)
        d_phi = scale * np.cosh(length * x) * length * w
        y = np.arcsinh(tan_o * np.cos(phi))
        circle = np.maximum(np.sinh(y), 0.0)
        for low, high in ((np.zeros_like(y), circle), (circle, np.exp(y))):
            a, b = np.arcsinh(low / width), np.arcsinh(high / width)
            t = a + (b - a) * (x**2 * (3 - 2 * x))[:, None]
            rho = width * np.sinh(t)
            d_rho = width * np.cosh(t) * (b - a) * (6 * x * (1 - x) * w)[:, None]
            plane = rho * np.cos(phi + turn), rho * np.sin(phi + turn), 1.0
            square = 1 + rho * rho
            cosine = cos_o * (1 + rho * np.sinh(y))
            wi = 2 * (cosine / square)[..., None] * np.stack(np.broadcast_arrays(*plane), axis=-1) - wo
            wi[..., 2] = np.maximum(wi[..., 2], 1e-300)
            weight = 4 * cosine / square**2 * rho * d_rho * d_phi
            total += weight.ravel() @ f(wi.reshape(-1, 3))
    return float(total)


ANGLES_DEG = (0.0, 60.0, 85.0, 89.0, 89.9)


def families():
    """Yield (name, f(wi, wo), azimuth of wo [rad], width in slope)."""
    for alpha in (0.001, 0.01, 0.1, 0.3, 1.0):
        yield f"beckmann {alpha:g}", lambda wi, wo, a=alpha: beckmann(wi, wo, a), 0.4, alpha
    for phi in (0.0, 0.5, 1.0, np.pi / 2):
        yield f"ggx 0.1 x 0.5 at {phi:.2g}", lambda wi, wo: ggx(wi, wo, 0.1, 0.5), phi, 0.2
    yield "phong 1000", lambda wi, wo: phong(wi, wo, 1000), 0.4, 0.03
    for nu, nv in ((10, 10), (100, 1000), (1e4, 10)):
        width = (nu * nv) ** -0.25
        yield (
            f"ashikhmin-shirley {nu:g}, {nv:g}",
            lambda wi, wo, a=nu, b=nv: ashikhmin_shirley(wi, wo, a, b),
            0.4,
            width,
        )
    yield (
        "ggx 0.01 + diffuse",
        lambda wi, wo: 0.5 * ggx(wi, wo, 0.01, 0.01) + 0.5 * diffuse(wi, wo),
        0.4,
        0.01,
    )
    yield (
        "ggx 0.001 + 0.3",
        lambda wi, wo: 0.5 * ggx(wi, wo, 0.001, 0.001) + 0.5 * ggx(wi, wo, 0.3, 0.3),
        0.4,
        0.001,
    )


FAMILIES = {name: (f, phi, width) for name, f, phi, width in families()}


def exactly(name, wo):
    """Return the dense integral of a family, and by how much two of them differ."""
    f, _, width = FAMILIES[name]
    long = name == "ashikhmin-shirley 10000, 10"
    ridge = (np.pi / 2, 0.03) if long else None
    sizes = (170, 210) if long else (110, 140)
    one, two = (
        dense(lambda w: f(w, wo), wo, width * k, n, ridge) for n, k in zip(sizes, (1, 1.4), strict=True)
    )
    return two, abs(one - two)


@pytest.mark.parametrize("theta", ANGLES_DEG)
@pytest.mark.parametrize("name", FAMILIES)
def test_bound_holds_and_reaches_eight_digits(name, theta, record_property):
    f, phi, width = FAMILIES[name]
    wo = spherical_to_cartesian(np.deg2rad(theta), phi)
    exact, doubt = exactly(name, wo)
    assert doubt < 2e-9 * exact
    for known in (width, None):
        found = hemisphere(lambda w: f(w, wo), wo=wo, width=known)
        record_property(
            "black box" if known is None else "known", (int(found.evaluations), float(found.error / exact))
        )
        assert found.converged
        assert abs(found.value - exact) <= found.error + doubt
        assert found.error <= 1e-8 * exact
        assert found.evaluations <= 800_000


@pytest.mark.parametrize("theta", [60.0, 89.9])
def test_the_kink_is_found_where_there_is_one(theta):
    wo = spherical_to_cartesian(np.deg2rad(theta), 0.4)
    for name, (f, _, width) in FAMILIES.items():
        seen, evaluations = kinked(lambda w, f=f: f(w, wo), wo, width)
        assert [curve.name for curve in seen] == ["cosθi = cosθo"] * ("ashikhmin" in name)
        assert evaluations < 500


def test_a_rule_that_ignores_the_kink_is_off():
    """The planted failure: plain rules with as many nodes keep an error that the cut one has not."""
    f, phi, width = FAMILIES["ashikhmin-shirley 10, 10"]
    wo = spherical_to_cartesian(np.deg2rad(60.0), phi)
    exact, _ = exactly("ashikhmin-shirley 10, 10", wo)
    plain, plain_weight = slope_rule(wo, width, (48, 42))
    cut, cut_weight = split_rule(wo, width, (24, 28))
    assert len(cut) == len(plain)
    assert abs(plain_weight @ f(plain, wo) - exact) > 1e-7 * exact
    assert abs(cut_weight @ f(cut, wo) - exact) < 1e-11 * exact
