"""Occluders: one file for each opaque body; no occluder imports another.

Each file's class is an attribute of this package, found when it is first asked for.
"""

from radiokit.contracts.occluder import REGISTRY as _REGISTRY

__getattr__, __dir__ = _REGISTRY.lazy_names()
