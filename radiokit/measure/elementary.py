"""Elementary functions as kernels: random numbers, and the functions whose library forms are no vectors."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from radiokit.measure.kernels import kernel, select

__all__ = ["atan2", "exp", "expm1", "key_of", "log", "log1p", "sincos", "stream", "uniform"]

# Random numbers: a hash of seed, dimension and index, so that any of them is had without those before it.

_GOLDEN = np.uint64(0x9E3779B97F4A7C15)  # 2⁶⁴ over the golden ratio, odd
_FIRST, _SECOND = np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB)
_S11, _S27, _S30, _S31 = np.uint64(11), np.uint64(27), np.uint64(30), np.uint64(31)
_ONE = np.uint64(1)
_ULP = 2.0**-53


@lru_cache(maxsize=64)
def key_of(seed: int) -> np.uint64:
    """Return the 64-bit key of a seed of any length.

    >>> key_of(1) == key_of(1) != key_of(2)
    np.True_
    """
    return np.random.SeedSequence(seed).generate_state(1, np.uint64)[0]


@kernel
def _mix(bits: Any) -> Any:
    """Return a bijection of 64 bits in which each input bit flips each output bit half the time.

    Source: Steele, Lea, Flood (2014), Fast Splittable Pseudorandom Number Generators, OOPSLA,
    doi:10.1145/2660193.2660195; the finaliser is variant 13 of Stafford's.
    """
    bits = (bits ^ (bits >> _S30)) * _FIRST
    bits = (bits ^ (bits >> _S27)) * _SECOND
    return bits ^ (bits >> _S31)


@kernel
def stream(key: Any, dimension: Any) -> Any:
    """Return the start of the stream of one dimension (uint64)."""
    return _mix(key + (dimension + _ONE) * _GOLDEN)


@kernel
def uniform(start: Any, index: Any) -> Any:
    """Return number ``index`` (uint64) of the stream, uniform on the multiples of 2⁻⁵³ in [0, 1).

    >>> with np.errstate(over="ignore"):
    ...     u = uniform(stream(key_of(7), np.uint64(0)), np.arange(4, dtype=np.uint64))
    >>> bool(np.all((u >= 0) & (u < 1)))
    True
    """
    return (_mix(start + index * _GOLDEN) >> _S11) * _ULP


# Minimax fits in t = r² for |r| ≤ 1/8, of relative error 3e-18 and 4e-19.
_S0, _S1, _S2, _S3 = 6.283185307179586, -41.341702240399634, 81.60524927594804, -76.70585970427454
_S4, _S5, _S6 = 42.058685020160894, -15.093804209987114, 3.7808689593022957
_C0, _C1, _C2, _C3 = -19.739208802178716, 64.93939402266824, -85.4568172066438, 60.24464135270201
_C4, _C5, _C6 = -26.426253275854723, 7.903206911569678, -1.6990343940660637


@kernel
def sincos(turn: Any) -> Any:
    """Return sine and cosine of 2π ``turn``, for turns in [0, 1], to 2 units in the last place.

    >>> sine, cosine = sincos(0.25)
    >>> float(sine), float(cosine) == 0.0
    (1.0, True)
    """
    quarter = np.rint(4.0 * turn)
    r = turn - 0.25 * quarter  # exact
    t = r * r
    s = r * (_S0 + t * (_S1 + t * (_S2 + t * (_S3 + t * (_S4 + t * (_S5 + t * _S6))))))
    c = 1.0 + t * (_C0 + t * (_C1 + t * (_C2 + t * (_C3 + t * (_C4 + t * (_C5 + t * _C6))))))
    odd = (quarter == 1.0) | (quarter == 3.0)
    sign = select((quarter == 2.0) | (quarter == 3.0), -1.0, 1.0)
    return sign * select(odd, c, s), sign * select(odd, -s, c)


# Minimax fits: log in t = s² for |s| ≤ 3 − √8, of relative error 9e-20; expm1 for |r| ≤ log(2)/2, of 3e-19.
_LN2, _PER_LN2 = 0.6931471805599453, 1.4426950408889634
_LN2_HIGH, _LN2_LOW = 0.6931471804855391, 7.440617110012397e-11  # the first has 33 bits: exact products
_ROOT_HALF, _EXPONENT = np.int64(0x3FE6A09E667F3BCD), np.int64(52)
_BIAS = np.int64(1023)
_L0, _L1, _L2 = 0.3333333333333333, 0.2000000000000044, 0.14285714285401807
_L3, _L4, _L5 = 0.11111111195856958, 0.09090897820066453, 0.07693119851407329
_L6, _L7 = 0.06634386569328443, 0.06543313073920051
_E0, _E1, _E2 = 0.5, 0.1666666666666667, 0.04166666666666667
_E3, _E4, _E5 = 0.008333333333326136, 0.0013888888888883748, 0.00019841269874820627
_E6, _E7, _E8 = 2.4801587325547743e-05, 2.7557255400206422e-06, 2.75572736431103e-07
_E9, _E10 = 2.5105217004720745e-08, 2.0914686968086876e-09


@kernel
def _log_of(exponent: Any, m: Any) -> Any:
    """Return the logarithm of (1 + m) 2^exponent."""
    s = m / (2.0 + m)
    t = s * s
    tail = t * (_L0 + t * (_L1 + t * (_L2 + t * (_L3 + t * (_L4 + t * (_L5 + t * (_L6 + t * _L7)))))))
    return exponent * _LN2 + 2.0 * (s + s * tail)


@kernel
def _parts(x: Any) -> Any:
    """Return the exponent of the power of two that leaves a number near 1, and that number less 1."""
    bits = np.float64(x).view(np.int64)
    exponent = (bits - _ROOT_HALF) >> _EXPONENT
    return exponent, np.int64(bits - (exponent << _EXPONENT)).view(np.float64) - 1.0


@kernel
def log(x: Any) -> Any:
    """Return log ``x`` for a normal number above 0, to 3 units in the last place.

    >>> float(log(0.5)) == float(np.log(0.5))
    True
    """
    exponent, m = _parts(x)
    return _log_of(exponent, m)


@kernel
def log1p(x: Any) -> Any:
    """Return log(1 + ``x``) for ``x`` above -1, to 3 units in the last place.

    >>> float(log1p(1e-20)), float(log1p(-0.5)) == float(np.log(0.5))
    (1e-20, True)
    """
    exponent, m = _parts(1.0 + x)
    near = (x > -0.29) & (x < 0.41)
    return _log_of(select(near, 0.0, exponent * 1.0), select(near, x, m))


@kernel
def _powers(x: Any) -> Any:
    """Return 2ⁿ, and e^r − 1 for the rest r of ``x`` = n log 2 + r."""
    n = np.rint(x * _PER_LN2)
    r = (x - n * _LN2_HIGH) - n * _LN2_LOW
    power = np.int64((np.int64(n) + _BIAS) << _EXPONENT).view(np.float64)
    tail = _E5 + r * (_E6 + r * (_E7 + r * (_E8 + r * (_E9 + r * _E10))))
    return power, r + r * r * (_E0 + r * (_E1 + r * (_E2 + r * (_E3 + r * (_E4 + r * tail)))))


@kernel
def exp(x: Any) -> Any:
    """Return e to the ``x``, to 2 + |x| units in the last place: 0 below -708, and e⁷⁰⁹ above 709.

    >>> round(float(exp(1.0)), 14), float(exp(-1e9))
    (2.71828182845905, 0.0)
    """
    within = select(x > -708.0, select(x < 709.0, x, 709.0), -708.0)
    power, p = _powers(within)
    return select(x < -708.0, 0.0, power + power * p)


@kernel
def expm1(x: Any) -> Any:
    """Return exp ``x`` − 1 for ``x`` in [-700, 700], to 3 + |x| units in the last place.

    >>> float(expm1(1e-20)), float(expm1(-700.0))
    (1e-20, -1.0)
    """
    power, p = _powers(x)
    return power * p + (power - 1.0)


# Minimax fit of (atan(t)/t − 1)/t² in t² for |t| ≤ tan(π/8), of error 2e-18.
_QUARTER, _HALF, _TAN_EIGHTH = 0.25 * np.pi, 0.5 * np.pi, 0.41421356237309503
_A0, _A1, _A2, _A3 = -0.3333333333333333, 0.19999999999999804, -0.14285714285659779, 0.11111111105150588
_A4, _A5, _A6, _A7 = -0.09090908753259112, 0.07692296368042296, -0.0666642476020052, 0.05878927554473807
_A8, _A9, _A10, _A11 = -0.05230443640686948, 0.045515447340221615, -0.03456931506332609, 0.016284375050043393


@kernel
def atan2(y: Any, x: Any) -> Any:
    """Return the angle of the point (x, y) from the x axis, in [-π, π], to 3 units in the last place.

    It is 0 for the origin.

    >>> float(atan2(1.0, -1.0)) == 0.75 * np.pi, float(atan2(1e-300, 1.0))
    (True, 1e-300)
    """
    across, along = abs(y), abs(x)
    steep = across > along
    low, high = select(steep, along, across), select(steep, across, along)
    far = low > _TAN_EIGHTH * high
    below = select(far, low + high, high)
    t = select(far, low - high, low) / select(below > 0.0, below, 1.0)
    z = t * t
    tail = _A6 + z * (_A7 + z * (_A8 + z * (_A9 + z * (_A10 + z * _A11))))
    tail = _A0 + z * (_A1 + z * (_A2 + z * (_A3 + z * (_A4 + z * (_A5 + z * tail)))))
    angle = select(far, _QUARTER, 0.0) + (t + t * z * tail)
    angle = select(steep, _HALF - angle, angle)
    angle = select(x < 0.0, np.pi - angle, angle)
    return select(y < 0.0, -angle, angle)
