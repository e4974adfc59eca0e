"""Solution of assignment 2: BRDFs and their laws."""

import numpy as np


def above_horizon(wi, wo, value):
    """Return the value where both directions are above the horizon, 0 elsewhere."""
    return np.where((wi[..., 2] > 0) & (wo[..., 2] > 0), value, 0.0)


def lambert(wi, wo, reflectance):
    """The integral of cos θ over the hemisphere is π."""
    return above_horizon(wi, wo, reflectance / np.pi)


def mirror_cosine(wi, wo):
    """The mirror direction of (x, y, z) about the normal is (−x, −y, z)."""
    mirror = wo * np.array([-1.0, -1.0, 1.0])
    return np.maximum(np.sum(wi * mirror, axis=-1), 0.0)


def phong_original(wi, wo, exponent, coefficient):
    """Exchanging wi and wo exchanges the cosine below, and at grazing angles it is as small as you like."""
    cos_i = np.where(wi[..., 2] > 0, wi[..., 2], 1.0)
    return above_horizon(wi, wo, coefficient * mirror_cosine(wi, wo) ** exponent / cos_i)


def phong(wi, wo, exponent):
    """At normal incidence 2π ∫ cosⁿ⁺¹θ sin θ dθ = 2π/(n + 2)."""
    return above_horizon(wi, wo, (exponent + 2) / (2 * np.pi) * mirror_cosine(wi, wo) ** exponent)


def half_cosine(wi, wo):
    """Opposite directions have no half vector: one of them is not above the horizon then."""
    h = wi + wo
    length = np.linalg.norm(h, axis=-1)
    return above_horizon(wi, wo, h[..., 2] / np.where(length > 0, length, 1.0))


def blinn_phong(wi, wo, exponent):
    """8π ∫ cⁿ⁺¹ (2c² − 1) dc from 1/√2 to 1 is 8π (2^(−n/2) + n) / ((n + 2)(n + 4))."""
    n = exponent
    scale = (n + 2) * (n + 4) / (8 * np.pi * (2.0 ** (-n / 2) + n))
    return scale * half_cosine(wi, wo) ** n


def asymmetry(a, b):
    """The larger of two values, neither of which is negative, is 0 only where both are."""
    larger = np.maximum(a, b)
    return np.abs(a - b) / np.where(larger > 0, larger, 1.0)


def mixed(wi, wo, diffuse, specular, exponent):
    """What is reflected at normal incidence is k_d + k_s, and that is the most."""
    whole = np.maximum(1.0, diffuse + specular)
    lobe = phong(wi, wo, exponent)
    return (diffuse * above_horizon(wi, wo, 1 / np.pi) + specular * lobe) / whole
