"""Ladders: sizes of rules in slope space, tried in turn until they agree, and factors on their widths."""

from __future__ import annotations

__all__ = ["SLOPE_SIZES", "SMOOTH_SIZES", "SMOOTH_WIDTHS", "SPLIT_SIZES", "WIDTHS"]

SLOPE_SIZES: tuple[tuple[int, int], ...] = (
    (20, 14),
    (28, 20),
    (40, 28),
    (52, 40),
    (72, 52),
    (104, 76),
    (144, 104),
    (208, 152),
    (288, 216),
    (400, 304),
)
"""Radii and azimuths in slope space; a lobe at grazing incidence needs more of the former."""

SMOOTH_SIZES: tuple[tuple[int, int], ...] = (
    (14, 10),
    (26, 18),
    (40, 28),
    (59, 40),
    (84, 60),
    (120, 88),
    (168, 128),
    (240, 184),
    (340, 264),
    (480, 376),
)
"""The same for an integrand known to be smooth: 4088 nodes in four rules give twelve digits of GGX."""

SPLIT_SIZES: tuple[tuple[int, int], ...] = (
    (14, 10),
    (18, 14),
    (24, 20),
    (32, 28),
    (44, 40),
    (60, 56),
    (84, 80),
    (120, 112),
    (160, 160),
    (200, 240),
)
"""Radii and azimuths of each part of a rule that is cut at the circle cosθi = cosθo."""

WIDTHS = (1.35, 0.8, 1.2, 1.0, 0.9, 1.1, 0.85, 1.0, 0.9, 1.1)
"""Factors on the lobe's width, so that consecutive rules do not fail in the same way."""

SMOOTH_WIDTHS = (1.1, 0.9, 1.0, 1.05, 0.95, 1.1, 0.9, 1.0, 0.95, 1.05)
"""The same where rules are known to converge: less off, since they are best near the width itself."""
