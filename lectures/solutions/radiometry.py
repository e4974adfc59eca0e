"""Assignment 1, radiometry: a solution."""

import math

import numpy as np


def cone_solid_angle(half_angle):
    return 4 * np.pi * np.sin(half_angle / 2) ** 2


def triangle_solid_angle(a, b, c):
    la, lb, lc = (np.linalg.norm(corner, axis=-1) for corner in (a, b, c))
    volume = np.sum(a * np.cross(b - a, c - a), axis=-1)
    ab, bc, ca = (np.sum(p * q, axis=-1) for p, q in ((a, b), (b, c), (c, a)))
    return 2 * np.arctan2(np.abs(volume), la * lb * lc + ab * lc + bc * la + ca * lb)


def spot_flux(intensity, exponent, half_angle):
    m = exponent + 1
    log_cosine = 0.5 * np.log1p(-(np.sin(half_angle) ** 2))
    return -2 * np.pi * intensity * np.expm1(m * log_cosine) / m


def isotropic_irradiance(flux, distance):
    return flux / (4 * np.pi) / distance / distance


def lamp_irradiance(intensity, distance, theta_deg):
    cosine = np.sin(np.radians(90 - theta_deg))
    return intensity * np.maximum(0, cosine) / distance**2


def length_and_direction(v):
    largest = np.max(np.abs(v), axis=-1, keepdims=True)
    scaled = v / largest
    length = np.linalg.norm(scaled, axis=-1, keepdims=True)
    return (largest * length)[..., 0], scaled / length


def light_irradiance(position, normal, light, intensity):
    distance, to_light = length_and_direction(light - position)
    _, up = length_and_direction(normal)
    cosine = np.sum(to_light * up, axis=-1)
    return intensity / distance / distance * np.maximum(0, cosine)


def cone_irradiance(radiance, half_angle):
    return np.pi * radiance * np.sin(half_angle) ** 2


def patch_irradiance(radiance, area, distance, theta, theta_light):
    solid_angle = area * np.maximum(0, np.cos(theta_light)) / distance**2
    return radiance * np.maximum(0, np.cos(theta)) * solid_angle


def luminance(wavelength, exitance, efficiency):
    y = exitance * efficiency
    steps = np.abs(np.diff(wavelength, axis=-1))
    integral = np.sum((y[..., 1:] + y[..., :-1]) / 2 * steps, axis=-1)
    return 683 * integral / np.pi


def reflected_radiance(albedo, radiance, cosine, solid_angle):
    terms = radiance * np.maximum(0, cosine) * solid_angle
    return albedo / math.pi * np.sum(terms, axis=-1)
