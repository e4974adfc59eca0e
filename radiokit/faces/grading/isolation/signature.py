"""Signature: which parameters a function has, and which of them are those that a question gives names to.

The child reads it as well, so it imports the standard library alone.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from typing import Any

__all__ = ["by_position", "listed", "renamed"]

PAIR = 2
"""How many parameters are directions, which are passed by position."""


def listed(function: Callable[..., Any]) -> list[tuple[str, bool]]:
    """Return a function's parameters by name, and whether each must be given; none where it takes any name.

    The name of one that is taken by position alone is empty.

    >>> listed(lambda wi, wo, n, eps=1e-9: 0)
    [('wi', True), ('wo', True), ('n', True), ('eps', False)]
    """
    try:
        found = list(inspect.signature(function).parameters.values())
    except Exception:  # a submission's object may raise anything when it is looked at
        return []
    if any(each.kind is each.VAR_KEYWORD for each in found):
        return []
    return [
        ("" if each.kind is each.POSITIONAL_ONLY else each.name, each.default is each.empty)
        for each in found
        if each.kind is not each.VAR_POSITIONAL
    ]


def renamed(parameters: Sequence[tuple[str, bool]], given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the keyword arguments of f(wi, wo, ...) under the names that the function has for them.

    What it does not know by name goes to its other parameters in their order, if they are as many; those that
    need not be given may be left out.

    >>> renamed([("wi", True), ("wo", True), ("n", True), ("eps", False)], {"exponent": 10.0})
    {'n': 10.0}
    """
    known = [name for name, _ in parameters[PAIR:]]
    strangers = [name for name in given if name not in known]
    free = [(name, needed) for name, needed in parameters[PAIR:] if name not in given]
    for names in ([name for name, needed in free if needed], [name for name, _ in free]):
        if len(names) == len(strangers) and all(names):
            own = dict(zip(strangers, names, strict=True))
            return {own.get(name, name): value for name, value in given.items()}
    return dict(given)


def by_position(function: Callable[..., Any], given: Mapping[str, Any]) -> bool:
    """Return whether a function takes what has names by position alone, as a decorator's ``*args`` does.

    >>> by_position(lambda wi, wo, *rest: 0, {"n": 10.0}), by_position(lambda wi, wo, n: 0, {"n": 10.0})
    (True, False)
    """
    try:
        found = inspect.signature(function, follow_wrapped=False).parameters
    except Exception:  # a submission's object may raise anything when it is looked at
        return False
    kinds = {each.kind for each in found.values()}
    stars = inspect.Parameter.VAR_POSITIONAL in kinds and inspect.Parameter.VAR_KEYWORD not in kinds
    return stars and not any(name in found for name in given)
