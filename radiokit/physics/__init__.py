"""Physics: what holds for any material."""

import lazy_loader as _lazy

__getattr__, __dir__, _ = _lazy.attach(
    __name__, ["fresnel", "integrating_sphere", "photometry", "planck", "relations", "view_factor"]
)
