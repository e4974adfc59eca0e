"""Emitters: one file for each light source; no emitter imports another.

Each file's class is an attribute of this package, found when it is first asked for.
"""

from typing import Any

from radiokit.contracts.emitter import REGISTRY as _REGISTRY


def __getattr__(name: str) -> Any:
    if name.startswith("_"):
        raise AttributeError(name)
    return _REGISTRY.by_class_name(name)


def __dir__() -> list[str]:
    return sorted(cls.__name__ for cls in _REGISTRY.classes.values())
