"""Microfacets as the papers write them: SymPy definitions, from which the models' twins are composed.

Written from the sources in angles, tangents and error functions, never from the kernels of ``ndf``,
``masking``, ``visible`` and ``facet``. Directions are sequences of three expressions, of any length.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import sympy

__all__ = [
    "beckmann_d_symbolic",
    "beckmann_lambda_symbolic",
    "correlated_symbolic",
    "cosine_symbolic",
    "dot_symbolic",
    "ggx_d_symbolic",
    "ggx_lambda_symbolic",
    "groove_symbolic",
    "masking_symbolic",
    "refract_symbolic",
    "refraction_half_symbolic",
    "refraction_jacobian_symbolic",
    "separable_symbolic",
]

Vector = Sequence[Any]


def dot_symbolic(a: Vector, b: Vector) -> Any:
    """Return a·b."""
    return sum(p * q for p, q in zip(a, b, strict=True))


def cosine_symbolic(a: Vector, b: Vector) -> Any:
    """Return the cosine of the angle between two vectors: a·b over their lengths."""
    import sympy

    return dot_symbolic(a, b) / sympy.sqrt(dot_symbolic(a, a) * dot_symbolic(b, b))


def ggx_d_symbolic(h: Vector, alpha_x: Any, alpha_y: Any) -> Any:
    """Return D [sr⁻¹] of GGX: Walter et al. (2007), equation 33; Heitz (2014), equation 85."""
    import sympy

    tangent2 = ((h[0] / alpha_x) ** 2 + (h[1] / alpha_y) ** 2) / h[2] ** 2
    cos4 = cosine_symbolic(h, (0, 0, 1)) ** 4
    return 1 / (sympy.pi * alpha_x * alpha_y * cos4 * (1 + tangent2) ** 2)


def beckmann_d_symbolic(h: Vector, alpha_x: Any, alpha_y: Any) -> Any:
    """Return D [sr⁻¹] of Beckmann: Walter et al. (2007), equation 25; Heitz (2014), equation 80."""
    import sympy

    tangent2 = ((h[0] / alpha_x) ** 2 + (h[1] / alpha_y) ** 2) / h[2] ** 2
    return sympy.exp(-tangent2) / (sympy.pi * alpha_x * alpha_y * cosine_symbolic(h, (0, 0, 1)) ** 4)


def _slope(w: Vector, alpha_x: Any, alpha_y: Any) -> Any:
    """Return α tanθ of a direction, α that along its azimuth: Heitz (2014), equation 86."""
    import sympy

    return sympy.sqrt(((alpha_x * w[0]) ** 2 + (alpha_y * w[1]) ** 2) / w[2] ** 2)


def ggx_lambda_symbolic(w: Vector, alpha_x: Any, alpha_y: Any) -> Any:
    """Return Smith's Λ [1] of GGX: Heitz (2014), section 5.4."""
    import sympy

    return (sympy.sqrt(1 + _slope(w, alpha_x, alpha_y) ** 2) - 1) / 2


def beckmann_lambda_symbolic(w: Vector, alpha_x: Any, alpha_y: Any) -> Any:
    """Return Smith's Λ [1] of Beckmann: Heitz (2014), section 5.3."""
    import sympy

    a = 1 / _slope(w, alpha_x, alpha_y)
    return (sympy.erf(a) - 1) / 2 + sympy.exp(-(a**2)) / (2 * a * sympy.sqrt(sympy.pi))


def masking_symbolic(smith: Any) -> Any:
    """Return G₁ [1] for one Λ: Heitz (2014), equation 43."""
    return 1 / (1 + smith)


def correlated_symbolic(smith_i: Any, smith_o: Any) -> Any:
    """Return G₂ [1] correlated by height, for two Λ: Heitz (2014), equation 99."""
    return 1 / (1 + smith_i + smith_o)


def separable_symbolic(smith_i: Any, smith_o: Any) -> Any:
    """Return G₂ [1] of independent shadowing and masking, for two Λ: Heitz (2014), equation 98."""
    return masking_symbolic(smith_i) * masking_symbolic(smith_o)


def groove_symbolic(h: Vector, *directions: Vector) -> Any:
    """Return the V-groove's G [1] for one direction or two: Cook & Torrance (1982), the factor G."""
    import sympy

    n = (0, 0, 1)
    return sympy.Min(
        1, *(2 * cosine_symbolic(h, n) * cosine_symbolic(w, n) / cosine_symbolic(w, h) for w in directions)
    )


def refraction_half_symbolic(wi: Vector, wo: Vector, eta: Any) -> list[Any]:
    """Return −(o + η i), the normal up to its length: Walter et al. (2007), equation 16."""
    return [-(o + eta * i) for i, o in zip(wi, wo, strict=True)]


def refraction_jacobian_symbolic(wi: Vector, wo: Vector, eta: Any) -> Any:
    """Return dωh/dωi [1]: Walter et al. (2007), equation 17 with the index of o's side divided out."""
    import sympy

    h = refraction_half_symbolic(wi, wo, eta)
    i_h, o_h = (dot_symbolic(w, h) / sympy.sqrt(dot_symbolic(h, h)) for w in (wi, wo))
    return eta**2 * sympy.Abs(i_h) / (o_h + eta * i_h) ** 2


def refract_symbolic(wo: Vector, h: Vector, eta: Any) -> list[sympy.Expr]:
    """Return the direction refracted to o, for o·h above 0: Walter et al. (2007), equation 40."""
    import sympy

    c = dot_symbolic(wo, h) / sympy.sqrt(dot_symbolic(h, h))
    scale = (c / eta - sympy.sqrt(1 + (c**2 - 1) / eta**2)) / sympy.sqrt(dot_symbolic(h, h))
    return [scale * n - o / eta for n, o in zip(h, wo, strict=True)]
