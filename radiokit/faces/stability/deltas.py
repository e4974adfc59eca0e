"""Deltas: the share of the flux that a twin's Dirac deltas carry, found from its expression."""

from __future__ import annotations

import itertools
from typing import Any

from radiokit.contracts.bsdf import FloatArray
from radiokit.measure.twin import Twin, compiled

__all__ = ["delta_share"]


def delta_share(twin: Twin, wo: FloatArray, transmissive: bool, eta: float) -> Any:
    """Return ∫ of the deltas times |cosθi| dωi = dx dy, as a share of flux; ``wo`` (3,) is above.

    Two deltas whose arguments are linear in x_i and y_i leave the value at their common zero over the
    determinant, on each side of the surface where there is one. ``eta`` is the index below over that above.

    >>> import numpy as np
    >>> from radiokit.contracts.bsdf import bsdf
    >>> float(delta_share(bsdf("mirror", reflectance=0.25).symbolic(), np.array([0.6, 0.0, 0.8]), False, 1.0))
    0.25
    """
    import sympy
    from mpmath import mp

    x_i, y_i, z_i = twin.arguments[:3]
    numbers = [mp.mpf(v) for v in wo.tolist()]
    length = mp.sqrt(sum(v * v for v in numbers))
    numbers = [v / length for v in numbers]
    constants = [mp.mpf(v) for v in twin.parameters.values()]
    given = (*twin.arguments[3:], *twin.parameters)
    deltas = sorted(twin.expression.atoms(sympy.DiracDelta), key=str)
    total = mp.mpf(0)
    for pair in itertools.combinations(deltas, 2):
        a, b = (delta.args[0] for delta in pair)
        matrix = sympy.Matrix([a, b]).jacobian([x_i, y_i])
        if matrix.free_symbols & {x_i, y_i, z_i} or matrix.det() == 0:
            continue
        rest = sympy.Matrix([a, b]).subs({x_i: 0, y_i: 0})
        place = -matrix.inv() * rest
        marks = {delta: sympy.S.One if delta in pair else sympy.S.Zero for delta in deltas}
        # Deltas that never stand in one product give 0 together: their value alone is one that each lacks.
        product = twin.expression.xreplace(marks)
        for lone in pair:
            product -= twin.expression.xreplace({delta: sympy.Integer(delta == lone) for delta in deltas})
        product += twin.expression.xreplace(dict.fromkeys(deltas, sympy.S.Zero))
        x, y, det = (compiled(e, given)(*numbers, *constants) for e in (*place, matrix.det()))
        upright = 1 - x * x - y * y
        if upright <= 0:
            continue
        for side in (1, -1) if transmissive else (1,):
            z = side * mp.sqrt(upright)
            value = compiled(product, (*twin.arguments, *twin.parameters))(x, y, z, *numbers, *constants)
            total += mp.re(value) / abs(det) * (mp.mpf(eta) ** 2 if side < 0 else 1)
    return total
