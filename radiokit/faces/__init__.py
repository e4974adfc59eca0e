"""Faces: what a person or a program sees: the command line, plots, grading, and the validation run."""

import lazy_loader as _lazy

__getattr__, __dir__, _ = _lazy.attach(__name__, ["grading"])
