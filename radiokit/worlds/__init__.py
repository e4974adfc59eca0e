"""Worlds: scenes with an answer: shading a point, enclosures, closed-form cases."""

import lazy_loader as _lazy

__getattr__, __dir__, _ = _lazy.attach(__name__, ["enclosure"])
