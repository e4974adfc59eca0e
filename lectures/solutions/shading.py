"""A solution of Assignment 3, as a student writes it."""

import numpy as np


def direct_light(f, positions, intensities):
    """Return the reflected radiance under point lights."""
    d2 = np.sum(positions**2, axis=-1)
    cosine = np.maximum(positions[..., 2] / np.sqrt(d2), 0)
    return np.sum(f * intensities * cosine / d2, axis=-1)


def sphere_irradiance(theta, half_angle):
    """Return the irradiance from a sphere, by midpoints in cones about its centre."""
    rings, sectors = 300, 400
    theta, half_angle = np.atleast_1d(theta), np.atleast_1d(half_angle)
    phi = (np.arange(sectors) + 0.5) * 2 * np.pi / sectors
    result = []
    for t, a in zip(theta, half_angle, strict=True):
        alpha = (np.arange(rings)[:, None] + 0.5) * a / rings
        cosine = np.cos(t) * np.cos(alpha) + np.sin(t) * np.sin(alpha) * np.cos(phi)
        weights = np.sin(alpha) * (a / rings) * (2 * np.pi / sectors)
        result.append(np.sum(np.maximum(cosine, 0) * weights))
    return np.array(result)


def _mean(weights):
    """Return the mean and its standard error."""
    return weights.mean(), weights.std(ddof=1) / np.sqrt(len(weights))


def furnace(albedo, samples, seed):
    """Return the reflected radiance in a furnace."""
    cosine = np.random.default_rng(seed).random(samples)  # Archimedes: uniform on the hemisphere
    pdf = 1 / (2 * np.pi)
    return _mean(albedo / np.pi * cosine / pdf)


def _around(cosine, turn):
    """Return directions at an angle from z."""
    sine = np.sqrt(np.maximum(1 - cosine**2, 0))
    phi = 2 * np.pi * turn
    return np.stack([sine * np.cos(phi), sine * np.sin(phi), cosine], axis=-1)


def cosine_sample(u):
    """Return cosine-weighted directions."""
    return _around(np.sqrt(1 - u[:, 0]), u[:, 1])


def cosine_pdf(directions):
    """Return their density."""
    return np.maximum(directions[:, 2], 0) / np.pi


def lobe_sample(u, exponent):
    """Return directions of Phong's lobe."""
    return _around((1 - u[:, 0]) ** (1 / (exponent + 1)), u[:, 1])


def lobe_pdf(directions, exponent):
    """Return their density."""
    return (exponent + 1) / (2 * np.pi) * np.maximum(directions[:, 2], 0) ** exponent


def glossy(exponent, zenith, side, samples, seed):
    """Return the radiance that a glossy surface reflects."""
    u = np.random.default_rng(seed).random((samples, 2))
    w = lobe_sample(u, exponent)
    f = (exponent + 2) / (2 * np.pi) * w[:, 2] ** exponent
    radiance = zenith * w[:, 2] + side * (1 + w[:, 0])
    return _mean(f * radiance * w[:, 2] / lobe_pdf(w, exponent))


def window(distance, width, height, samples, seed):
    """Return the irradiance of the floor before a window."""
    u = np.random.default_rng(seed).random((samples, 2))
    y, z = (u[:, 0] - 0.5) * width, u[:, 1] * height
    d2 = distance**2 + y**2 + z**2
    cosine, cosine_light = z / np.sqrt(d2), distance / np.sqrt(d2)
    pdf = d2 / cosine_light / (width * height)
    return _mean(cosine / pdf)


def mis_weight(distance, cosine_light, area, pdf):
    """Return the balance heuristic's weight; multiplied out, so that nothing is divided by 0."""
    return distance**2 / (distance**2 + area * cosine_light * pdf)
