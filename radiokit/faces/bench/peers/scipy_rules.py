"""SciPy's adaptive rules in θ and φ, which know nothing of where the lobe is."""

from __future__ import annotations

import math
import warnings
from typing import Any

import numpy as np

from radiokit.bsdfs.ggx import GGX
from radiokit.contracts.albedo import integrand
from radiokit.faces.bench.peers.peer import Peer
from radiokit.faces.bench.tasks import towards
from radiokit.facts.estimate import Estimate

__all__ = ["Cubature", "Dblquad"]


class Dblquad(Peer):
    """``scipy.integrate.dblquad`` on an integrand of Python floats; where it fails it warns, no more."""

    name = "SciPy dblquad"
    rival = "quadrature"

    def answer(self, alpha: float, theta_deg: float, size: float, seed: int) -> Estimate:
        """Return the albedo to the relative tolerance ``size``."""
        from scipy.integrate import IntegrationWarning, dblquad

        sin_o, _, cos_o = towards(theta_deg)
        a2, calls = alpha * alpha, 0
        root_o = math.sqrt(a2 * sin_o * sin_o + cos_o * cos_o)

        def value(theta: float, phi: float) -> float:
            nonlocal calls
            calls += 1
            sine, z = math.sin(theta), math.cos(theta)
            x, y = sine * math.cos(phi), sine * math.sin(phi)
            hx, hz = x + sin_o, z + cos_o
            across, up = hx * hx + y * y, hz * hz
            ratio = (across + up) / (across / alpha + alpha * up)
            root = math.sqrt(a2 * sine * sine + z * z)
            return 2 * ratio * ratio / math.pi * z * sine / (2 * (z * root_o + cos_o * root))

        with warnings.catch_warnings():
            warnings.simplefilter("ignore", IntegrationWarning)
            # Half of the azimuth, by symmetry: the lobe lies at φ = π.
            found, error = dblquad(value, 0.0, math.pi, 0.0, math.pi / 2, epsabs=0.0, epsrel=size)
        return Estimate(found, error, "truncation", calls, method=self.name)


class Cubature(Peer):
    """``scipy.integrate.cubature`` (Gauss–Kronrod 21) on arrays of radiokit's own values."""

    name = "SciPy cubature"
    rival = "quadrature"

    def absent(self) -> str | None:
        """Return why not, with an older SciPy."""
        from scipy import __version__, integrate

        return None if hasattr(integrate, "cubature") else f"SciPy {__version__} has no cubature; 1.15 has"

    def answer(self, alpha: float, theta_deg: float, size: float, seed: int) -> Estimate:
        """Return the albedo to the relative tolerance ``size``."""
        from scipy.integrate import cubature

        value = integrand(GGX(alpha=alpha), np.array(towards(theta_deg)), "wo")
        calls = 0

        def over_angles(x: Any) -> Any:
            nonlocal calls
            calls += len(x)
            sine = np.sin(x[:, 0])
            wi = np.stack([sine * np.cos(x[:, 1]), sine * np.sin(x[:, 1]), np.cos(x[:, 0])], axis=1)
            return 2 * value(wi) * sine

        found = cubature(over_angles, [0.0, 0.0], [math.pi / 2, math.pi], rule="gk21", rtol=size, atol=0.0)
        done = found.status == "converged"
        value_, error = float(found.estimate), float(found.error)
        return Estimate(value_, error, "truncation", calls, method=self.name, converged=done)
