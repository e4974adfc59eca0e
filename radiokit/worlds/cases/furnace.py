"""Furnace: a material under an environment of radiance 1 everywhere, so that Lo is its directional albedo."""

from __future__ import annotations

import math

from radiokit.bsdfs.ggx import GGX
from radiokit.bsdfs.lambert import Lambert
from radiokit.bsdfs.mirror import Mirror
from radiokit.bsdfs.phong import Phong
from radiokit.contracts.bsdf import BSDF
from radiokit.emitters.constant import Constant
from radiokit.worlds.cases.catalogue import Case, Scene, shading_case

__all__ = ["CASES", "phong_albedo"]


def _furnace(f: BSDF, theta_deg: float) -> Scene:
    theta = math.radians(theta_deg)
    return Scene(f=f, emitters=(Constant(radiance=1.0),), wo=(math.sin(theta), 0.0, math.cos(theta)))


def _setup(material: str, theta_deg: float) -> str:
    return f"{material}, seen {theta_deg:g}° off its normal, under radiance 1 from every direction."


def phong_albedo(exponent: int, theta_deg: float) -> float:
    """Return the directional albedo of modified Phong with reflectance 1 and an even exponent.

    In longitude ψ and latitude λ about the axis n × r, with β between the normal n and the mirror
    direction r: w·n = cosλ cosψ, w·r = cosλ cos(ψ − β), dω = cosλ dλ dψ. The integral then factorises and
    is elementary.

    >>> round(phong_albedo(10, 0.0), 15), round(phong_albedo(10, 80.0), 3)
    (1.0, 0.228)
    """
    n, half, beta = exponent, exponent // 2, math.radians(theta_deg)
    # ∫ cosⁿ⁺²λ dλ over [−π/2, π/2] is π times the central binomial coefficient over 2ⁿ⁺²; π cancels.
    latitude = (n + 2) / 2 * math.comb(n + 2, half + 1) / 4 ** (half + 1)
    # ∫ cosᵐχ dχ over [−π/2, π/2 − β] from m = 1 up to n + 1, by parts: every term is positive.
    odd = 1.0 + math.cos(beta)
    for m in range(3, n + 2, 2):
        odd = (math.sin(beta) ** (m - 1) * math.cos(beta) + (m - 1) * odd) / m
    return latitude * (math.cos(beta) * odd + math.sin(beta) ** (n + 2) / (n + 1))


_PHONG_DERIVATION = (
    r"In longitude $\psi$ and latitude $\lambda$ about the axis $n \times r$, with $\beta$ between the "
    r"normal and the mirror direction, $w\cdot n = \cos\lambda\cos\psi$ and $w\cdot r = "
    r"\cos\lambda\cos(\psi-\beta)$, so $L_o = \frac{n+2}{2\pi} \int_{-\pi/2}^{\pi/2} "
    r"\cos^{n+2}\lambda\,d\lambda \int_{\beta-\pi/2}^{\pi/2} \cos\psi \cos^n(\psi-\beta)\,d\psi$, and "
    r"the second integral is $\cos\beta \int_{-1}^{\cos\beta} (1-s^2)^{n/2} ds + \sin^{n+2}\beta/(n+1)$."
)

_GGX_ONE = (
    r"For $\alpha = 1$, $D = 1/\pi$ and $G_2 = 2\mu_i\mu_o/(\mu_i+\mu_o)$, so $f = 1/(2\pi(\mu_i+\mu_o))$ "
    r"(Lommel and Seeliger's law) and "
    r"$L_o = \int_0^1 \frac{\mu_i}{\mu_i+\mu_o} d\mu_i = 1 - \mu_o \ln\frac{1+\mu_o}{\mu_o}$."
)

_GGX_NUMBER = (
    r"$L_o = \int D(h)\, G_2\, (w_o\cdot h)/\cos\theta_o\, d\omega_h$ over the half vectors whose $w_i$ is "
    r"above the horizon. In the slope $(\rho, \varphi)$ of $h$ the integrand is analytic up to the "
    r"horizon, $\rho = e^y$ with $\cos\varphi = \sinh(y)/\tan\theta_o$. Gauss–Legendre in "
    r"$\mathrm{asinh}(\rho/\alpha)$ times the midpoint rule in $\arccos(y/\mathrm{asinh}\tan\theta_o)$ "
    r"in 34-digit arithmetic: 120² and 160² nodes agree to 30 digits, and panels of Gauss–Legendre in "
    r"$\theta_i$ and $\varphi$ to 22: "
)


def _ggx_one(theta_deg: float) -> float:
    mu = math.cos(math.radians(theta_deg))
    return 1 - mu * math.log1p(1 / mu)


CASES: tuple[Case, ...] = (
    shading_case(
        name="lambert-in-furnace",
        title="Lambert in a white furnace",
        setup=_setup("A diffuse surface of reflectance 0.5", 60),
        exact=0.5,
        derivation=r"$L_o = \int \frac{\rho}{\pi} \cos\theta\, d\omega = \rho$.",
        source=Lambert.SOURCE,
        scene=_furnace(Lambert(reflectance=0.5), 60),
        tags=("furnace", "lambert"),
    ),
    shading_case(
        name="mirror-in-furnace",
        title="A mirror in a white furnace",
        setup=_setup("A mirror of reflectance 0.9", 45),
        exact=0.9,
        derivation=r"$f = \rho\,\delta(w_i - r)/\cos\theta_i$, so $L_o = \rho L_i(r) = \rho$.",
        source=Mirror.SOURCE,
        scene=_furnace(Mirror(reflectance=0.9), 45),
        tags=("furnace", "mirror", "delta"),
    ),
    *(
        shading_case(
            name=f"phong-10-in-furnace-at-{theta}deg",
            title=f"Modified Phong, n = 10, in a white furnace at {theta}°",
            setup=_setup("Modified Phong, f = (n + 2)/2π · cosⁿα with n = 10,", theta),
            exact=phong_albedo(10, theta) if theta else 1.0,
            derivation=_PHONG_DERIVATION,
            source=Phong.SOURCE,
            scene=_furnace(Phong(exponent=10, reflectance=1.0), theta),
            tags=("furnace", "phong"),
        )
        for theta in (0, 30, 60, 80)
    ),
    *(
        shading_case(
            name=f"ggx-1-in-furnace-at-{theta}deg",
            title=f"GGX, α = 1, in a white furnace at {theta}°",
            setup=_setup("GGX with α = 1, height-correlated Smith masking and Fresnel factor 1", theta),
            exact=_ggx_one(theta),
            derivation=_GGX_ONE,
            source=GGX.SOURCE,
            scene=_furnace(GGX(alpha=1.0), theta),
            tags=("furnace", "ggx"),
        )
        for theta in (0, 30, 60, 80, 89)
    ),
    *(
        shading_case(
            name=f"ggx-{alpha:g}-in-furnace-at-{theta}deg",
            title=f"GGX, α = {alpha:g}, in a white furnace at {theta}°",
            setup=_setup(
                f"GGX with α = {alpha:g}, height-correlated Smith masking and Fresnel factor 1", theta
            ),
            exact=exact,
            derivation=_GGX_NUMBER + digits,
            source=GGX.SOURCE,
            scene=_furnace(GGX(alpha=alpha), theta),
            tags=("furnace", "ggx"),
            left_out=left_out,
        )
        for alpha, theta, exact, digits, left_out in (
            (0.3, 60, 0.8217110031507660, "0.821711003150766039063260417888.", ()),
            # The lobe fills some 1e-4 of the sphere: the light's samples all but miss it.
            (0.05, 89, 0.9358703275489729, "0.935870327548972855240983306498.", ("mc-light",)),
        )
    ),
)
