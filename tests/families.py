"""Lobes for the quadrature's truth set, written for clarity: each is f(wi) cosθi, for a fixed wo (3,)."""

from __future__ import annotations

import numpy as np
from scipy.special import erfc, erfcx


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
    slope, wo_h, cos_h = _half(wi, wo)
    square = np.sum(slope * slope, axis=1)
    share = np.where(square > 0, slope[:, 0] ** 2 / np.where(square > 0, square, 1), 0.5)
    power = nu * share + nv * (1 - share)
    d = np.sqrt((nu + 1) * (nv + 1)) / (8 * np.pi) * np.exp(-0.5 * power * np.log1p(square))
    fresnel = 0.5 + 0.5 * (1 - wo_h) ** 5
    return d * fresnel * wi[:, 2] / (wo_h * np.maximum(wi[:, 2], wo[2]))


def diffuse(wi, wo):
    return wi[:, 2] / np.pi


def dense(f, wo, width, n=240, kink=True, offset=0.0):
    """∫ f(wi) dω by Gauss-Legendre panels over the half vector's slope plane, cut at the circle cosθi = cosθo.

    Independent of the rule under test: plain azimuths, panels about the lobe's azimuth ``offset``, and
    radial panels at fixed slopes.
    """
    x, w = np.polynomial.legendre.leggauss(n)
    x, w = (x + 1) / 2, w / 2
    sin_o, cos_o = np.hypot(wo[0], wo[1]), wo[2]
    tan_o = sin_o / cos_o
    turn = np.arctan2(wo[1], wo[0])
    quarter = np.arcsinh(np.pi / 2 * max(1.0, tan_o))
    v, dv = quarter * x, quarter * w
    bow, slope = np.sinh(v) / max(1.0, tan_o), np.cosh(v) / max(1.0, tan_o)
    total = 0.0
    for centre, sign in ((0.5, 1), (0.5, -1), (-0.5, 1), (-0.5, -1)):
        phi = np.pi * centre + sign * bow  # crowded at ±π/2, where the limits bend
        y = np.arcsinh(tan_o * np.cos(phi))
        edge = np.exp(y)
        circle = np.clip(np.sinh(y), 0.0, edge) if kink else np.zeros_like(y)
        for low, high in ((np.zeros_like(y), circle), (circle, edge)):
            a, b = np.arcsinh(low / width), np.arcsinh(high / width)
            t = a + (b - a) * (x**2 * (3 - 2 * x))[:, None]
            rho = width * np.sinh(t)
            d_rho = width * np.cosh(t) * (b - a) * (6 * x * (1 - x) * w)[:, None]
            h = np.stack(
                np.broadcast_arrays(rho * np.cos(phi + turn), rho * np.sin(phi + turn), 1.0), axis=-1
            )
            square = 1 + rho * rho
            cosine = cos_o * (1 + rho * np.sinh(y))
            wi = 2 * (cosine / square)[..., None] * h - wo
            wi[..., 2] = np.maximum(wi[..., 2], 1e-300)
            weight = 4 * cosine / square**2 * rho * d_rho * (slope * dv)
            total += weight.ravel() @ f(wi.reshape(-1, 3))
    return float(total)


def families():
    """Yield (name, f(wi, wo), azimuth of wo [rad], width in slope or None)."""
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
