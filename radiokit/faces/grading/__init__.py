"""Grading: assignments as data, sandboxes for code that is not trusted, and what a submission earns."""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
