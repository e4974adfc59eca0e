"""Function: a student's f(wi, wo) beside the model it should be, at hard pairs of directions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from radiokit.checks.probes import pairs
from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.bsdf import BSDF
from radiokit.faces.diagnosis.diagnose import diagnose
from radiokit.faces.diagnosis.result import Diagnosis
from radiokit.facts.errors import ParameterError

__all__ = ["diagnose_function"]


def diagnose_function(
    f: Callable[..., Any] | BSDF,
    reference: Callable[..., Any] | BSDF,
    *,
    count: int = 256,
    language: str = "en",
    rtol: float | None = None,
) -> Diagnosis:
    """Say which misconception makes a function f(wi, wo) differ from the BSDF that it should be.

    Both are evaluated at pairs that judges use: some uniform, some grazing, some near the mirror direction.

    Parameters
    ----------
    f : callable or BSDF
        What the student wrote, f(wi, wo) [sr⁻¹], of arrays or of one pair.
    reference : callable or BSDF
        What it should be, of one wavelength. Its parameter ``exponent``, if any, is an input.
    count : int
        How many pairs, at least 8.
    language, rtol
        As in `diagnose`.

    Raises
    ------
    ParameterError
        When an argument is out of its range, or a value is not one number a pair.
    CallableError
        When a function raises.

    Examples
    --------
    >>> import radiokit as rk
    >>> lambert = rk.bsdf("lambert", reflectance=0.5)
    >>> diagnose_function(lambda wi, wo: 0.5 + 0 * wi[:, 2], lambert).first.name
    'pi-too-many'
    """
    if count < 8:
        raise ParameterError("count", count, "at least 8")
    student, model = as_bsdf(f), as_bsdf(reference)
    wi, wo = pairs(count, model)

    def truth(wi: Any, wo: Any, **_: Any) -> Any:
        return model.evaluate(wi, wo)

    answer, right = np.asarray(student.evaluate(wi, wo)), np.asarray(truth(wi, wo))
    for name, given, values in (("f", f, answer), ("reference", reference, right)):
        if values.shape != (count,):
            raise ParameterError(name, given, "a function of one number a pair, at one wavelength")
    inputs = {"wi": wi, "wo": wo}
    exponent = getattr(reference, "exponent", None)
    if isinstance(exponent, float):
        inputs["exponent"] = np.full(count, exponent)
    return diagnose(answer, right, inputs=inputs, variants=truth, language=language, rtol=rtol)
