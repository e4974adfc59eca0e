"""Facts: what is true before anything is measured. This floor imports nothing above it."""

import lazy_loader as _lazy

__getattr__, __dir__, _ = _lazy.attach(__name__, ["directions", "errors"])
