"""Factor truth: view factors as Howell's catalogue prints them, for many digits."""

from __future__ import annotations

from typing import Any

__all__ = ["b3", "b4", "b13", "b13_aside", "ball_disk", "c11", "c14", "c41", "disk_ball", "tilted_ball"]


def c41(radius1: Any, radius2: Any, distance: Any) -> Any:
    """Return the factor of coaxial disks."""
    import mpmath

    x = 1 + (distance**2 + radius2**2) / radius1**2
    return (x - mpmath.sqrt(x * x - 4 * (radius2 / radius1) ** 2)) / 2


def c11(width: Any, length: Any, distance: Any) -> Any:
    """Return the factor of equal rectangles that face each other."""
    import mpmath

    x, y = width / distance, length / distance
    p, q = mpmath.sqrt(1 + x * x), mpmath.sqrt(1 + y * y)
    total = mpmath.log(p * q / mpmath.sqrt(1 + x * x + y * y))
    total += x * q * mpmath.atan(x / q) + y * p * mpmath.atan(y / p)
    total -= x * mpmath.atan(x) + y * mpmath.atan(y)
    return 2 * total / (mpmath.pi * x * y)


def c14(edge: Any, width: Any, height: Any) -> Any:
    """Return the factor of rectangles at a right angle with a common edge."""
    import mpmath

    w, h = width / edge, height / edge
    a, b = w * w, h * h
    logs = mpmath.log((1 + a) * (1 + b) / (1 + a + b))
    logs += a * mpmath.log(a * (1 + a + b) / ((1 + a) * (a + b)))
    logs += b * mpmath.log(b * (1 + a + b) / ((1 + b) * (a + b)))
    far = mpmath.sqrt(a + b)
    angles = w * mpmath.atan(1 / w) + h * mpmath.atan(1 / h) - far * mpmath.atan(1 / far)
    return (angles + logs / 4) / (mpmath.pi * w)


def ball_disk(radius: Any, distance: Any) -> Any:
    """Return the factor from a sphere to a coaxial disk."""
    import mpmath

    return (1 - distance / mpmath.hypot(radius, distance)) / 2


def disk_ball(disk_radius: Any, sphere_radius: Any, distance: Any) -> Any:
    """Return the factor from a disk to a coaxial sphere."""
    return 4 * (sphere_radius / disk_radius) ** 2 * ball_disk(disk_radius, distance)


def b13(radius: Any, distance: Any, offset: Any) -> Any:
    """Return the factor from an element to a disk that is parallel to it."""
    import mpmath

    z = distance**2 + offset**2 + radius**2
    return (1 - (z - 2 * radius**2) / mpmath.sqrt(z * z - 4 * (radius * offset) ** 2)) / 2


def b13_aside(radius: Any, distance: Any, offset: Any) -> Any:
    """Return the factor from an element to a disk that is perpendicular to it."""
    import mpmath

    z = distance**2 + offset**2 + radius**2
    return distance / offset / 2 * (z / mpmath.sqrt(z * z - 4 * (radius * offset) ** 2) - 1)


def b3(width: Any, length: Any, distance: Any) -> Any:
    """Return the factor from an element to a rectangle parallel to it, a corner opposite."""
    import mpmath

    p, q = mpmath.hypot(width, distance), mpmath.hypot(length, distance)
    total = width / p * mpmath.atan(length / p) + length / q * mpmath.atan(width / q)
    return total / (2 * mpmath.pi)


def b4(width: Any, length: Any, distance: Any) -> Any:
    """Return the factor from an element to a rectangle perpendicular to it."""
    import mpmath

    far = mpmath.hypot(width, distance)
    total = mpmath.atan(length / distance) - distance / far * mpmath.atan(length / far)
    return total / (2 * mpmath.pi)


def tilted_ball(radius: Any, distance: Any, tilt: Any) -> Any:
    """Return the factor from an element to a sphere that its horizon may cut."""
    import mpmath

    from radiokit.faces.stability.lighttruth import sphere_irradiance

    normal = (mpmath.sin(tilt), mpmath.mpf(0), mpmath.cos(tilt))
    return sphere_irradiance((0, 0, distance), radius, (0, 0, 0), normal) / mpmath.pi
