"""The solutions of homework.py, as an instructor may keep them."""

from __future__ import annotations

import math

import numpy as np

TWO = 2  # halves


def squared(x):
    """Return x²."""
    return x**TWO


def irradiance(
    intensity,
    distance,
    theta,
):
    # the cosine law, too
    projected = intensity * np.cos(theta)
    return projected / squared(distance)


# small cones lose no digits
def cone(half_angle):
    """Mine."""
    message = """
not indented"""
    assert message
    return 4 * math.pi * squared(np.sin(half_angle / 2))


if __name__ == "__main__":
    raise SystemExit(cone(1.0))
