"""Relation: one way from what is known to what is wanted, as data."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

__all__ = ["Relation"]


@dataclass(frozen=True, kw_only=True)
class Relation:
    """A formula for a quantity.

    Parameters
    ----------
    name : str
        As ``relate(..., by=name)`` takes it.
    target : str
        The radiometric quantity's name among the givens, such as ``"irradiance"``.
    needs : tuple of str
        Names of what must be given.
    formula : str
        LaTeX, right of the sign of equality included.
    compute : callable
        Takes the givens by name, pint quantities, and returns one.
    condition : str
        When it holds.
    derivation : str
        Its name for ``radiokit.derive``.
    may : mapping of str to float
        What may be given besides, with the number that stands for it otherwise, in degrees for angles.
    notes : tuple of str
        Names of what may be given for ``judge`` alone.
    judge : callable, optional
        Takes the givens by name, and says in words why the condition fails; empty where it holds, None where
        the givens do not tell.
    crosses : str
        ``"photometric"`` or ``"radiometric"`` for a relation that leads from one to the other.
    pi : str
        ``"sr"`` where π in the formula is a number of steradians.
    """

    name: str
    target: str
    needs: tuple[str, ...]
    formula: str
    compute: Callable[..., Any]
    condition: str
    derivation: str = ""
    may: Mapping[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    judge: Callable[..., str | None] | None = None
    crosses: str = ""
    pi: str = "sr"
