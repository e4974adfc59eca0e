"""LM-63: the IES file of a luminaire's intensities, read strictly, and what its interpolant is worth."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, NoReturn

import numpy as np
import numpy.typing as npt

from radiokit.facts.errors import ParameterError
from radiokit.facts.source import Source
from radiokit.measure.cancelling import x_minus_sine

__all__ = ["SOURCE", "Photometry", "read_lm63"]

FloatArray = npt.NDArray[np.float64]

SOURCE = Source(
    authors="Illuminating Engineering Society of North America",
    year=2002,
    title="ANSI/IESNA LM-63-02: Standard File Format for the Electronic Transfer of Photometric Data",
    equation="Type C photometry",
)

_STANDARDS = ("IESNA:LM-63-1995", "IESNA:LM-63-2002")
_EPS = float(np.finfo(float).eps)
_ON_EDGE = 1e-13  # [°]: so near the end of the table, rounding decides whether it is dark


@dataclass(frozen=True, eq=False)
class Photometry:
    """Intensities [cd] by polar angle from the nadir and azimuth, bilinear between the tabulated angles.

    Parameters
    ----------
    vertical : ndarray, shape (V,)
        Polar angles [°], rising, within [0, 180]; it is dark beyond them.
    horizontal : ndarray, shape (H,)
        Azimuths [°], rising by 360 from the first to the last: the symmetries are written out.
    candela : ndarray, shape (H, V)
        The multiplier and the ballast factor are applied. The last row is the first one again.
    keywords : dict
        What the file says in brackets.
    watts : float
        Input power [W].
    """

    vertical: FloatArray
    horizontal: FloatArray
    candela: FloatArray
    keywords: dict[str, str] = field(default_factory=dict)
    watts: float = 0.0

    def intensity(self, polar_deg: float, azimuth_deg: float) -> tuple[float, float]:
        """Return the intensity [cd], and how far off it may be for a direction known to a few eps."""
        v, h = self.vertical, self.horizontal
        inside = v[0] <= polar_deg <= v[-1]
        polar = min(max(polar_deg, float(v[0])), float(v[-1]))
        azimuth = float(h[0] + (azimuth_deg - h[0]) % 360.0)
        i = min(int(np.searchsorted(h, azimuth, side="right")) - 1, len(h) - 2)
        j = min(int(np.searchsorted(v, polar, side="right")) - 1, len(v) - 2)
        s = (azimuth - float(h[i])) / float(h[i + 1] - h[i])
        t = (polar - float(v[j])) / float(v[j + 1] - v[j])
        low, high = (1 - s) * self.candela[i, j : j + 2] + s * self.candela[i + 1, j : j + 2]
        value = float((1 - t) * low + t * high)
        ends = [float(end) for end in (v[0], v[-1]) if 0 < end < 180]
        if any(abs(polar_deg - end) <= _ON_EDGE for end in ends):
            return value * inside, value
        if not inside:
            return 0.0, 0.0
        # Next to a tabulated angle the neighbouring cell may be the steeper one.
        near = self.candela[np.arange(i - 1, i + 3) % (len(h) - 1)]
        turn = float(np.ptp((1 - t) * near[:, j] + t * near[:, j + 1])) / float(np.min(np.diff(h)))
        fall = float(np.ptp(near[:, max(0, j - 1) : j + 3])) / float(np.min(np.diff(v)))
        slope = math.degrees(fall + turn / max(math.sin(math.radians(polar)), _EPS))
        return value, _EPS * (16 * value + 32 * slope)

    def flux(self) -> float:
        """Return the luminous flux [lm] of the interpolant, ∫ I sinθ dθ dφ in closed form.

        Over a cell of height 2h about the angle m, the weight of I at its upper edge is
        ∫ (θ₁ − θ)/2h sinθ dθ = 2 sin(m − h/2) sin(h/2) + cos m (h − sin h)/h; at the lower one the signs of
        h and of the last term are reversed.
        """
        edges = np.radians(self.vertical)
        half = np.diff(edges) / 2
        middle = edges[:-1] + half
        bend = np.cos(middle) * x_minus_sine(half) / half
        upper = 2 * np.sin(middle - half / 2) * np.sin(half / 2) + bend
        lower = 2 * np.sin(middle + half / 2) * np.sin(half / 2) - bend
        profiles = self.candela[:, :-1] @ upper + self.candela[:, 1:] @ lower
        steps = np.radians(np.diff(self.horizontal))
        return math.fsum(steps * (profiles[:-1] + profiles[1:]) / 2)


class _Reader:
    """Numbers one after the other, each with its line, whatever the line breaks."""

    def __init__(self, lines: list[str], first: int) -> None:
        self.tokens = [
            (number, token)
            for number, line in enumerate(lines[first:], start=first + 1)
            for token in line.replace(",", " ").split()
        ]
        self.at, self.end = 0, len(lines)

    def number(self, expected: str, allowed: str = "a finite number") -> float:
        """Return the next number."""
        if self.at == len(self.tokens):
            _refuse(self.end, "the end of the file", f"followed by {expected}")
        line, token = self.tokens[self.at]
        try:
            value = float(token)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            _refuse(line, token, f"{expected}: {allowed}")
        self.at += 1
        return value

    def checked(self, expected: str, allowed: str, good: Any) -> float:
        """Return the next number if it is as ``allowed`` says."""
        value = self.number(expected, allowed)
        if not good(value):
            line, token = self.tokens[self.at - 1]
            _refuse(line, token, f"{expected}: {allowed}")
        return value

    def count(self, expected: str, least: int) -> int:
        """Return the next number, an integer."""
        allowed = f"an integer, at least {least}"
        return int(self.checked(expected, allowed, lambda x: x == int(x) and x >= least))

    def angles(self, count: int, expected: str) -> FloatArray:
        """Return ``count`` rising angles."""
        found: list[float] = []
        for k in range(count):
            previous = found[-1] if found else -math.inf
            allowed = "above the one before, " + repr(previous) if found else "an angle in degrees"
            found.append(self.checked(f"{expected} {k + 1} of {count}", allowed, lambda x, p=previous: x > p))
        return np.array(found)


def _refuse(line: int, value: str, allowed: str) -> NoReturn:
    raise ParameterError(f"line {line} of the IES file", value, allowed)


def read_lm63(text: str) -> Photometry:
    r"""Read the text of an IES file of LM-63-1995 or -2002: Type C photometry, without tilt.

    Horizontal angles that end at 0°, 90° or 180°, or span 90° to 270°, stand for the symmetric whole.

    Raises
    ------
    ParameterError
        Naming the line, what is there, and what is expected.

    Source: ANSI/IESNA LM-63-02, whose format of Type C data LM-63-1995 shares.

    >>> lamp = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 9\n0 180\n0\n5 5"
    >>> round(read_lm63(lamp).flux() / np.pi, 12)  # 4πI
    20.0
    """
    lines = text.splitlines()
    first = lines[0].strip() if lines else ""
    if first not in _STANDARDS:
        _refuse(1, first, " or ".join(map(repr, _STANDARDS)))
    keywords: dict[str, str] = {}
    last, tilt = "", 0
    for tilt in range(1, len(lines) + 1):
        if tilt == len(lines):
            _refuse(tilt, lines[-1], "followed by 'TILT=NONE'")
        line = lines[tilt].strip()
        if line.startswith("TILT="):
            break
        if not (line.startswith("[") and "]" in line):
            _refuse(tilt + 1, line, "'[KEYWORD] text', or 'TILT=NONE'")
        word, rest = line[1:].split("]", 1)
        if word == "MORE" and last:
            keywords[last] += "\n" + rest.strip()
        else:
            keywords[word], last = rest.strip(), word
    if lines[tilt].strip() != "TILT=NONE":
        _refuse(tilt + 1, lines[tilt].strip(), "'TILT=NONE': what depends on the tilt is not read")
    return _read_numbers(_Reader(lines, tilt + 1), keywords)


def _read_numbers(reader: _Reader, keywords: dict[str, str]) -> Photometry:
    reader.count("the number of lamps", 1)
    reader.number("the lumens of each lamp, or -1 for absolute photometry")
    factor = reader.checked("the candela multiplier", "above 0", lambda x: x > 0)
    verticals = reader.count("the number of vertical angles", 2)
    horizontals = reader.count("the number of horizontal angles", 1)
    reader.checked("the photometric type", "1, Type C, is the one that is read", lambda x: x == 1)
    reader.checked("the unit of lengths", "1 for feet, 2 for metres", lambda x: x in (1, 2))
    for name in ("width", "length", "height"):
        reader.number(f"the {name} of the luminous opening")
    factor *= reader.checked("the ballast factor", "above 0", lambda x: x > 0)
    reader.number("the number for future use")
    watts = reader.checked("the input power", "at least 0", lambda x: x >= 0)
    vertical = _vertical(reader, verticals)
    horizontal = reader.angles(horizontals, "horizontal angle")
    span = (float(horizontal[0]), float(horizontal[-1]))
    if span not in ((0, 0), (0, 90), (0, 180), (0, 360), (90, 270)):
        line = reader.tokens[reader.at - 1][0]
        _refuse(line, f"{span[0]:g}° to {span[1]:g}°", "0°, or 0° to 90°, 180° or 360°, or 90° to 270°")
    table = np.array(
        [
            reader.checked(
                f"the candela at vertical angle {v:g}°, horizontal {h:g}°", "at least 0", lambda x: x >= 0
            )
            for h in horizontal
            for v in vertical
        ]
    ).reshape(horizontals, verticals)
    if reader.at < len(reader.tokens):
        line, token = reader.tokens[reader.at]
        _refuse(line, token, f"the end of the file, after {table.size} candela values")
    if span == (0, 360) and not np.array_equal(table[0], table[-1]):
        line = reader.tokens[-1][0]
        _refuse(line, "the candela at 360°", "what they are at 0°")
    if not math.isfinite(factor * float(table.max())):
        _refuse(reader.end, "a candela value times the multiplier", "finite")
    horizontal, table = _written_out(horizontal, factor * table)
    return Photometry(vertical, horizontal, table, keywords, watts)


def _vertical(reader: _Reader, count: int) -> FloatArray:
    vertical = reader.angles(count, "vertical angle")
    span = (float(vertical[0]), float(vertical[-1]))
    if span not in ((0, 90), (90, 180), (0, 180)):
        line = reader.tokens[reader.at - 1][0]
        _refuse(line, f"{span[0]:g}° to {span[1]:g}°", "0° to 90°, 90° to 180° or 0° to 180°")
    return vertical


def _written_out(horizontal: FloatArray, table: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return azimuths that go all round, and their rows."""
    if len(horizontal) == 1:
        return np.array([0.0, 360.0]), np.repeat(table, 2, axis=0)
    while horizontal[-1] - horizontal[0] < 360:  # the mirror image about the last plane
        horizontal = np.concatenate((horizontal, 2 * horizontal[-1] - horizontal[-2::-1]))
        table = np.concatenate((table, table[-2::-1]))
    return horizontal, table
