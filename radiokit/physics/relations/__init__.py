"""Relations: the formulas of radiometry as symbols with units and kinds, derived in verified steps."""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach(
    __name__,
    submod_attrs={
        "catalogue": ["derive", "list_derivations"],
        "checker": ["Clash", "Dimensions", "check_dimensions"],
        "derivation": ["Derivation", "Finding"],
        "dimension": ["Dimension"],
        "notation": ["Meaning", "Notation", "SR"],
        "steps": ["Step", "eq", "follows", "premise"],
    },
)
