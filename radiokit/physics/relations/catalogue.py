"""Catalogue: finds derivations in their folder by name, verifies them, or remembers that they were."""

from __future__ import annotations

import importlib
import pkgutil
from dataclasses import replace
from functools import cache

from radiokit.facts.errors import RadiokitError, UnknownNameError
from radiokit.physics.relations.cache import load, store
from radiokit.physics.relations.derivation import Derivation

__all__ = ["derive", "list_derivations", "unverified"]

_PACKAGE = "radiokit.physics.relations.derivations"


@cache
def _catalogue() -> dict[str, Derivation]:
    found: dict[str, Derivation] = {}
    package = importlib.import_module(_PACKAGE)
    for info in pkgutil.iter_modules(package.__path__):
        for derivation in importlib.import_module(f"{_PACKAGE}.{info.name}").DERIVATIONS:
            if derivation.name in found:
                raise RadiokitError(f"two derivations are called {derivation.name!r}", name=derivation.name)
            found[derivation.name] = derivation
    return found


def list_derivations(*, tag: str = "") -> list[str]:
    """Return the names of all derivations, or of those with a tag, such as ``"lecture"``.

    >>> "lambertian-exitance" in list_derivations()
    True
    """
    return [name for name, each in _catalogue().items() if not tag or tag in each.tags]


def unverified(name: str) -> Derivation:
    """Return the derivation called ``name`` as it is written.

    Raises
    ------
    UnknownNameError
        When there is no such derivation.
    """
    known = _catalogue()
    if name not in known:
        raise UnknownNameError("derivation", name, known)
    return known[name]


def derive(name: str, *, fresh: bool = False) -> Derivation:
    """Return the derivation called ``name``, every step of it verified.

    Parameters
    ----------
    name : str
        One of ``list_derivations()``.
    fresh : bool
        Verify anew, even when a proof of just these steps is kept in the user's cache folder.

    Raises
    ------
    UnknownNameError
        When there is no such derivation.

    >>> found = derive("lambertian-exitance")
    >>> print(found.result, found.verdict.evidence)
    Eq(M, pi*L*Ω_0) proved
    """
    derivation = unverified(name)
    kept = None if fresh else load(derivation)
    if kept is not None:
        return replace(derivation, findings=kept)
    found = derivation.verified()
    store(found)
    return found
