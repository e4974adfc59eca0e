"""Metals: the index η + ik of a few, as measured, across the visible spectrum; ``metals.json`` has it."""

from __future__ import annotations

import json
from functools import cache
from importlib import resources
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.errors import ParameterError
from radiokit.facts.source import Source

__all__ = ["METALS", "VISIBLE_NM", "metal", "metal_source"]

METALS = ("Ag", "Al", "Au", "Cu")
"""Chemical symbols of the metals there are."""

VISIBLE_NM = (380.0, 780.0)
"""The wavelengths for which there are indices [nm]."""


@cache
def _tables() -> dict[str, Any]:
    text = resources.files("radiokit.physics").joinpath("metals.json").read_text(encoding="utf-8")
    tables: dict[str, Any] = json.loads(text)
    return tables


def _table(symbol: str) -> dict[str, Any]:
    if symbol not in METALS:
        raise ParameterError("symbol", symbol, f"one of {', '.join(METALS)}")
    table: dict[str, Any] = _tables()[symbol]
    return table


def metal(symbol: str, wavelength_nm: npt.ArrayLike) -> tuple[Any, Any]:
    """Return the index η + ik of a metal in air, interpolated linearly in wavelength between measurements.

    Parameters
    ----------
    symbol : str
        Chemical symbol: ``"Ag"``, ``"Al"``, ``"Au"`` or ``"Cu"``.
    wavelength_nm : array_like, shape (...)
        Wavelengths in vacuum [nm], in [380, 780].

    Returns
    -------
    eta, k : float or ndarray, shape (...)
        Real part and extinction [1].

    Raises
    ------
    ParameterError
        Naming the argument, its value, and what is allowed.

    Source: ``metal_source(symbol)``. The noble metals' η has two decimals there, so that silver's, about
    0.05, is known to a tenth only.

    >>> eta, k = metal("Au", [521.0, 654.0])
    >>> eta.round(3).tolist(), k.round(3).tolist()
    ([0.619, 0.149], [2.082, 3.642])
    """
    table = _table(symbol)
    allowed = f"finite and in [{VISIBLE_NM[0]:g}, {VISIBLE_NM[1]:g}] nm"
    try:
        at = np.asarray(wavelength_nm, dtype=np.float64)
    except (TypeError, ValueError):
        raise ParameterError("wavelength_nm", wavelength_nm, allowed) from None
    bad = ~((at >= VISIBLE_NM[0]) & (at <= VISIBLE_NM[1]))
    if bad.any():
        raise ParameterError("wavelength_nm", float(at[bad].flat[0]), allowed)
    eta, k = (np.interp(at, table["wavelength_nm"], table[name])[()] for name in ("eta", "k"))
    return eta, k


def metal_source(symbol: str) -> Source:
    """Return where the index of a metal was published.

    Raises
    ------
    ParameterError
        When there is no such metal.

    >>> metal_source("Al").year
    1995
    """
    return Source(**_table(symbol)["source"])
