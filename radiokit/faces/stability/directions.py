"""Directions: angles, cones, lengths and frames, where directions nearly meet or nearly vanish."""

from __future__ import annotations

from typing import Any

import numpy as np

from radiokit.faces.stability.row import Row, decades
from radiokit.facts import directions
from radiokit.facts.source import Source
from radiokit.measure.twin import Twin

__all__ = ["ROWS"]

_KAHAN = Source(
    authors="Kahan",
    year=2006,
    title="How Futile are Mindless Assessments of Roundoff in Floating-Point Computation?",
    equation="section 12",
)
_HIGHAM = Source(
    authors="Higham",
    year=2002,
    title="Accuracy and Stability of Numerical Algorithms, 2nd edition",
    doi="10.1137/1.9780898718027",
    equation="chapter 1 for cancellation, chapter 27 for underflow",
)


def _stack(*components: Any) -> Any:
    return np.stack(np.broadcast_arrays(*components), axis=-1)


def _pair(opposite: bool) -> Any:
    """Return the inputs of two directions whose tangent is the axis's value: one pair on z, one oblique."""

    def inputs(delta: Any) -> tuple[Any, ...]:
        sign = -1.0 if opposite else 1.0
        x, z = np.array([0.0, 0.6]), np.array([1.0, 0.8])
        return x, 0.0, z, sign * x, delta, sign * z

    return inputs


def _angle(ax: Any, ay: Any, az: Any, bx: Any, by: Any, bz: Any) -> Any:
    return directions.angle_between(_stack(ax, ay, az), _stack(bx, by, bz))


def _arccosine(m: Any, ax: Any, ay: Any, az: Any, bx: Any, by: Any, bz: Any) -> Any:
    lengths = m.sqrt(ax * ax + ay * ay + az * az) * m.sqrt(bx * bx + by * by + bz * bz)
    return m.acos((ax * bx + ay * by + az * bz) / lengths)


def _angle_twin() -> Twin:
    import sympy

    symbols = sympy.symbols("a_x a_y a_z b_x b_y b_z", real=True)
    a, b = sympy.Matrix(symbols[:3]), sympy.Matrix(symbols[3:])
    across = a.cross(b)
    return Twin(sympy.atan2(sympy.sqrt(across.dot(across)), a.dot(b)), {}, symbols)


def _polar_twin() -> Twin:
    import sympy

    x, y, z = symbols = sympy.symbols("x y z", real=True)
    return Twin(sympy.atan2(sympy.sqrt(x**2 + y**2), z), {}, symbols)


def _cap_twin() -> Twin:
    import sympy

    theta = sympy.Symbol("theta", positive=True)
    return Twin(4 * sympy.pi * sympy.sin(theta / 2) ** 2, {}, (theta,))


def _cap_inverse_twin() -> Twin:
    import sympy

    omega = sympy.Symbol("Omega", positive=True)
    return Twin(2 * sympy.asin(sympy.sqrt(omega / (4 * sympy.pi))), {}, (omega,))


def _unit_twin() -> Twin:
    import sympy

    x, y, z = symbols = sympy.symbols("x y z", positive=True)
    return Twin(1 / sympy.sqrt((x / y) ** 2 + 1 + (z / y) ** 2), {}, symbols)


def _half_twin() -> Twin:
    import sympy

    symbols = sympy.symbols("x_i y_i z_i x_o y_o z_o", real=True)
    total = sympy.Matrix(symbols[:3]) + sympy.Matrix(symbols[3:])
    return Twin(total[1] / sympy.sqrt(total.dot(total)), {}, symbols)


def _round_trip(vx: Any, vy: Any, vz: Any, wx: Any, wy: Any, wz: Any) -> Any:
    turned = directions.frame(directions.unit(_stack(vx, vy, vz)))
    return directions.to_world(turned, directions.to_local(turned, _stack(wx, wy, wz)))[..., 0]


def _one_pole(m: Any, vx: Any, vy: Any, vz: Any, wx: Any, wy: Any, wz: Any) -> Any:
    length = m.sqrt(vx * vx + vy * vy + vz * vz)
    x, y, z = vx / length, vy / length, vz / length
    a = 1 / (1 + z)
    b = -x * y * a
    t, s, n = (1 - x * x * a, b, -x), (b, 1 - y * y * a, -y), (x, y, z)
    return sum(axis[0] * (axis[0] * wx + axis[1] * wy + axis[2] * wz) for axis in (t, s, n))


def _identity_twin() -> Twin:
    import sympy

    symbols = sympy.symbols("v_x v_y v_z w_x w_y w_z", real=True)
    return Twin(symbols[3], {}, symbols)


ROWS = (
    Row(
        name="angle-near-parallel",
        title="Angle between nearly parallel directions",
        axis="angle [rad]",
        values=decades(-1, -15),
        inputs=_pair(opposite=False),
        kernel=_angle,
        textbook=_arccosine,
        twin=_angle_twin,
        kernel_name="radiokit.facts.directions.angle_between",
        kernel_form="atan2(|(a − b) × (a + b)| / 2, a·b)",
        textbook_form="acos(a·b / (|a| |b|))",
        lesson="The cosine of a small angle θ is 1 − θ²/2, and a float next to 1 is known to ε: everything "
        "below θ = √ε is rounded away before acos sees it, and a quotient that rounds to more than 1 "
        "becomes NaN. The cross product is proportional to the angle itself, and the difference a − "
        "b of near neighbours is exact.",
        source=_KAHAN,
    ),
    Row(
        name="angle-near-opposite",
        title="Angle between nearly opposite directions",
        axis="distance from π [rad]",
        values=decades(-1, -15),
        inputs=_pair(opposite=True),
        kernel=_angle,
        textbook=_arccosine,
        twin=_angle_twin,
        kernel_name="radiokit.facts.directions.angle_between",
        kernel_form="atan2(|(a − b) × (a + b)| / 2, a·b)",
        textbook_form="acos(a·b / (|a| |b|))",
        lesson="Here the answer is about π, and still half of the digits go: acos has an infinite slope at "
        "−1, so an error of ε in the cosine is one of √ε in the angle. A function is to be entered "
        "where its slope is tame: atan2 of sine and cosine always is.",
        source=_KAHAN,
    ),
    Row(
        name="polar-angle-near-pole",
        title="Polar angle of a direction near the pole",
        axis="angle [rad]",
        values=decades(-1, -15),
        inputs=lambda delta: (
            np.array([1.0, 0.6]) * np.sin(delta),
            np.array([0.0, 0.8]) * np.sin(delta),
            np.cos(delta),
        ),
        kernel=lambda x, y, z: directions.cartesian_to_spherical(_stack(x, y, z))[0],
        textbook=lambda m, x, y, z: m.acos(z / m.sqrt(x * x + y * y + z * z)),
        twin=_polar_twin,
        kernel_name="radiokit.facts.directions.cartesian_to_spherical",
        kernel_form="atan2(hypot(x, y), z)",
        textbook_form="acos(z / |w|)",
        lesson="z is 1 for every direction within √ε of the pole, so z alone cannot tell them apart. Their "
        "x and y can, to the last digit: never ask a large component what a small one knows.",
        source=_HIGHAM,
    ),
    Row(
        name="cap-solid-angle",
        title="Solid angle of a narrow cone",
        axis="half-angle [rad]",
        values=decades(0, -15),
        inputs=lambda theta: (theta,),
        kernel=directions.cap_solid_angle,
        textbook=lambda m, theta: 2 * m.pi * (1 - m.cos(theta)),
        twin=_cap_twin,
        kernel_name="radiokit.facts.directions.cap_solid_angle",
        kernel_form="4π sin²(θ/2)",
        textbook_form="2π (1 − cos θ)",
        lesson="1 − cos θ subtracts two numbers that agree in their leading digits; the difference is made "
        "of the rounding of cos θ, and is 0 for θ below 10⁻⁸. The sun's solid angle loses five "
        "digits so. The identity 1 − cos θ = 2 sin²(θ/2) has nothing to subtract.",
        source=_HIGHAM,
    ),
    Row(
        name="cap-half-angle",
        title="Half-angle of a cone of small solid angle",
        axis="solid angle [sr]",
        values=decades(0, -30, 2),
        inputs=lambda omega: (omega,),
        kernel=directions.cap_half_angle,
        textbook=lambda m, omega: m.acos(1 - omega / (2 * m.pi)),
        twin=_cap_inverse_twin,
        kernel_name="radiokit.facts.directions.cap_half_angle",
        kernel_form="2 atan2(√Ω, √(4π − Ω))",
        textbook_form="acos(1 − Ω/2π)",
        lesson="Adding a small Ω/2π to 1 keeps only those of its digits that reach above ε; acos cannot "
        "bring the others back. The square roots take Ω as it is.",
        source=_HIGHAM,
    ),
    Row(
        name="unit-of-short-vector",
        title="Unit vector of a very short vector",
        axis="length [1]",
        values=decades(0, -300, 20),
        values_float32=decades(0, -40, 4),
        inputs=lambda length: (3.0 * length, 4.0 * length, 12.0 * length),
        kernel=lambda x, y, z: directions.unit(_stack(x, y, z))[..., 1],
        textbook=lambda m, x, y, z: y / m.sqrt(x * x + y * y + z * z),
        twin=_unit_twin,
        kernel_name="radiokit.facts.directions.unit",
        kernel_form="v 2⁻ᵉ / |v 2⁻ᵉ| with e the exponent of the largest component",
        textbook_form="v / √(v·v)",
        lesson="Squaring halves the range of exponents: components below 10⁻¹⁶² in float64, and already "
        "below 10⁻²³ in float32, have squares that underflow to 0, and 0/0 is NaN; long before, the "
        "squares are denormal and their digits go one by one. Scaling by a power of two is exact and "
        "costs nothing.",
        source=_HIGHAM,
    ),
    Row(
        name="half-vector-opposite",
        title="Half vector of nearly opposite grazing directions",
        axis="elevation [rad]",
        values=decades(-1, -301, 20),
        values_float32=decades(-1, -37, 4),
        inputs=lambda e: (1.0, 0.0, e, -1.0, 0.5 * e, e),
        kernel=lambda *c: directions.half_vector(_stack(*c[:3]), _stack(*c[3:]))[..., 1],
        textbook=lambda m, xi, yi, zi, xo, yo, zo: (
            (yi + yo) / m.sqrt((xi + xo) * (xi + xo) + (yi + yo) * (yi + yo) + (zi + zo) * (zi + zo))
        ),
        twin=_half_twin,
        kernel_name="radiokit.facts.directions.half_vector",
        kernel_form="(wi + wo), scaled by a power of two, over its length",
        textbook_form="(wi + wo) / |wi + wo|",
        lesson="The sum is safe, though it cancels: subtracting near neighbours is exact (Sterbenz). Its "
        "length is not, for the square of what is left underflows, and the half vector is 0/0. "
        "Cancellation only uncovers errors made before; where there are none, it does no harm.",
        source=_HIGHAM,
    ),
    Row(
        name="frame-near-minus-z",
        title="Into the frame of a normal near −z, and back",
        axis="angle from −z [rad]",
        values=decades(-1, -12),
        inputs=lambda e: (np.array([0.6, 0.8]) * e, np.array([0.8, 0.6]) * e, -np.cos(e), 0.8, 0.48, 0.36),
        kernel=_round_trip,
        textbook=_one_pole,
        twin=_identity_twin,
        kernel_name="radiokit.facts.directions.frame",
        kernel_form="a = −1/(sign z + z): the pole of the formula is always in the other hemisphere",
        textbook_form="a = 1/(1 + z), t = (1 − a x², −a x y, −x)",
        lesson="1 + z cancels near z = −1 and is then divided by: the axes are neither of unit length nor "
        "at right angles, and at −z itself they are NaN. No continuous frame covers the sphere; so "
        "two formulas, each used in the hemisphere where it adds numbers of the same sign.",
        source=directions.FRAME_SOURCE,
    ),
)
