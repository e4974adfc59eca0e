"""Measure: integration, sampling and statistics. It knows no optics."""

import lazy_loader as _lazy

__getattr__, __dir__, _ = _lazy.attach(__name__, ["montecarlo", "quadrature", "statistics", "warps"])
