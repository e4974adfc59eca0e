"""radiokit: radiometry for teaching, and an analytic validator of BSDFs and renderers.

Names load when they are first used; ``__init__.pyi`` beside this file lists them.
"""

import lazy_loader as _lazy

__version__ = "0.1.0"

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
