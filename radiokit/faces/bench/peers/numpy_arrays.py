"""NumPy on whole arrays: the Monte Carlo estimate as it is first written, one array for each quantity."""

from __future__ import annotations

import numpy as np

from radiokit.faces.bench.peers.peer import Peer, mean_of
from radiokit.faces.bench.tasks import towards
from radiokit.facts.estimate import Estimate

__all__ = ["NumpyArrays"]


class NumpyArrays(Peer):
    """Visible normals, and the weight as f cosθ / pdf with every factor evaluated as the papers print it."""

    name = "NumPy, whole arrays"
    rival = "mc"
    most = 1 << 22  # which take a gigabyte

    def answer(self, alpha: float, theta_deg: float, size: float, seed: int) -> Estimate:
        """Return the albedo from ``size`` samples."""
        samples = int(size)
        rng = np.random.default_rng(seed)
        wo = np.array(towards(theta_deg))
        stretched = wo * [alpha, alpha, 1.0]
        stretched /= np.linalg.norm(stretched)
        phi = 2 * np.pi * rng.random(samples)
        z = (1 - rng.random(samples)) * (1 + stretched[2]) - stretched[2]
        sine = np.sqrt(np.clip(1 - z * z, 0, 1))
        h = np.stack([sine * np.cos(phi), sine * np.sin(phi), z], axis=1) + stretched
        h = h * [alpha, alpha, 1.0]
        h /= np.linalg.norm(h, axis=1)[:, None]
        cos_oh = h @ wo
        wi = 2 * cos_oh[:, None] * h - wo
        cos_i, cos_o, cos_h = wi[:, 2], wo[2], h[:, 2]
        with np.errstate(divide="ignore", invalid="ignore"):
            d = alpha**2 / (np.pi * cos_h**4 * (alpha**2 + (1 - cos_h**2) / cos_h**2) ** 2)
            lambda_o = (np.sqrt(1 + alpha**2 * (1 - cos_o**2) / cos_o**2) - 1) / 2
            lambda_i = (np.sqrt(1 + alpha**2 * (1 - cos_i**2) / cos_i**2) - 1) / 2
            f = d / (1 + lambda_i + lambda_o) / (4 * cos_i * cos_o)
            pdf = d / (1 + lambda_o) / (4 * cos_o)
            weight = np.where(cos_i > 0, f * cos_i / pdf, 0.0)
        return mean_of(float(weight.sum()), float(weight @ weight), samples, self.name)
