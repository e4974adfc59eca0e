"""Disney: the principled BRDF of 2012, from paint to metal by numbers in [0, 1] that artists turn.

For pictures, and for a lesson in what is given up for them. It is reciprocal; it conserves energy for some
parameters only, which is measured for each set: lobes are added, and nothing is taken from the one below. The
largest albedo of a white surface is 1.050 at 73.6° for roughness 0, 1.090 at 82.3° for 0.5 and 1.601 at
grazing for 1, where the retro-reflection alone makes 1.557; with subsurface scattering 1.375 at 80.3° (0.5).
The default roughness conserves up to a base colour of 0.9121. Sheen, which is not divided by π, adds up to
0.088; a coat on a white mirror makes 1.0094 at normal incidence. A metal of one width conserves, but G knows
no direction: with widths of 3.16 and 0.32 a white one reaches 1.633 at grazing along x.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, ClassVar

import numpy as np

from radiokit.contracts.bsdf import BSDF, Claims
from radiokit.contracts.lobes import linear_lobes, lobes_conserve
from radiokit.contracts.parameters import Spectrum, parameter
from radiokit.contracts.scalar import Kernels, ScalarBSDF
from radiokit.facts.source import Source
from radiokit.measure.kernels import kernel, select
from radiokit.measure.twin import Twin
from radiokit.measure.vectors import from_disk
from radiokit.physics.facet import reflect
from radiokit.physics.gtr import gtr1_constants, gtr1_d_symbolic, gtr1_density, gtr1_normal
from radiokit.physics.interface import schlick_complement_kernel, schlick_kernel
from radiokit.physics.masking import HORIZON, separable_over_cosines
from radiokit.physics.ndf import ggx_area, ggx_area_isotropic, ggx_density
from radiokit.physics.visible import ggx_visible, reflected_density

__all__ = ["Disney"]

SOURCE = Source(
    authors="Burley",
    year=2012,
    title="Physically-Based Shading at Disney. SIGGRAPH course notes, revised 31 August 2012",
    equation="sections 5.3 (diffuse), 5.4 (D), 5.5 (F), 5.6 (G) and appendix B (GTR, its factor corrected by "
    "the revision); subsurface, sheen and the tints are only in its code, disney.brdf of the BRDF Explorer, "
    "which later replaced G by Smith's of the unremapped widths",
)

_COAT_WIDTH, _COAT_F0 = 0.25, 0.04


@kernel
def _masked(iz: Any, oz: Any, alpha: Any) -> Any:
    """Return G/(4 cosθi cosθo) of Smith's separable G for GGX of one width."""
    return separable_over_cosines(iz, oz, ggx_area_isotropic(iz, alpha), ggx_area_isotropic(oz, alpha))


@kernel
def _value(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, *constants: Any) -> Any:
    paint, volume, fuzz, f0, f90, coat, rough, alpha_x, alpha_y, alpha_g, alpha_c, scale, _, _, _ = constants
    above = (iz > HORIZON) & (oz > HORIZON)
    iz, oz = select(above, iz, 1.0), select(above, oz, 1.0)
    hx, hy, hz = ix + ox, iy + oy, iz + oz
    gx, gy, gz = ix - ox, iy - oy, iz - oz
    cos2 = 0.25 * (hx * hx + hy * hy + hz * hz)  # of θd, between a direction and h
    cosine = np.sqrt(cos2)
    fall = 0.25 * (gx * gx + gy * gy + gz * gz) / (1.0 + cosine)  # 1 − cosθd
    schlick, rest = fall * fall * (fall * fall) * fall, schlick_complement_kernel(cosine, 0.0)
    fifth_i, fifth_o, retro = schlick_kernel(iz, 0.0), schlick_kernel(oz, 0.0), rough * cos2
    diffuse = (1.0 + (2.0 * retro - 0.5) * fifth_i) * (1.0 + (2.0 * retro - 0.5) * fifth_o)
    flat = schlick_complement_kernel(iz, 0.0) + retro * fifth_i
    flat = flat * (schlick_complement_kernel(oz, 0.0) + retro * fifth_o)
    inside = flat * (1.0 / hz - 0.5) + 0.5
    base = ggx_density(hx, hy, hz, alpha_x, alpha_y) * _masked(iz, oz, alpha_g)
    glaze = gtr1_density(hx, hy, hz, alpha_c, scale) * _masked(iz, oz, _COAT_WIDTH)
    body = paint * diffuse + volume * inside + fuzz * schlick
    total = body + base * (f0 * rest + f90 * schlick) + coat * glaze * (_COAT_F0 * rest + schlick)
    return select(above, total, 0.0)


@kernel
def _density(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, *constants: Any) -> Any:
    """Return the sum of the lobes' densities, each times the chance that it is chosen."""
    _, _, _, _, _, _, _, alpha_x, alpha_y, _, alpha_c, scale, _, p_body, p_coat = constants
    above = (iz > HORIZON) & (oz > HORIZON)
    hx, hy, hz = ix + ox, iy + oy, select(above, iz + oz, 1.0)
    area = ggx_area(ox, oy, oz, alpha_x, alpha_y)
    body, base = iz / np.pi, reflected_density(ggx_density(hx, hy, hz, alpha_x, alpha_y), area)
    glaze = 0.5 * gtr1_density(hx, hy, hz, alpha_c, scale) * hz / (hx * hx + hy * hy + hz * hz)
    total = p_body * body + (1.0 - p_body - p_coat) * base + p_coat * glaze
    return select(above, total, 0.0)


@kernel
def _sample(u0: Any, u1: Any, u2: Any, ox: Any, oy: Any, oz: Any, *constants: Any) -> Any:
    """Return wi of the lobe that u2 chooses: a cosine's, a visible normal's, or one about a coat's normal."""
    _, _, _, _, _, _, _, alpha_x, alpha_y, _, alpha_c, _, log_square, p_body, p_coat = constants
    bx, by, bz = from_disk(u0, u1)
    hx, hy, hz = ggx_visible(u0, u1, ox, oy, oz, alpha_x, alpha_y)
    cx, cy, cz = gtr1_normal(u0, u1, alpha_c, log_square)
    glazed = u2 >= 1.0 - p_coat
    wx, wy, wz = reflect(ox, oy, oz, select(glazed, cx, hx), select(glazed, cy, hy), select(glazed, cz, hz))
    painted = u2 < p_body
    wx, wy, wz = select(painted, bx, wx), select(painted, by, wy), select(painted, bz, wz)
    density = _density(wx, wy, wz, ox, oy, oz, *constants)
    value = _value(wx, wy, wz, ox, oy, oz, *constants)
    return wx, wy, wz, select(density > 0.0, value * wz / select(density > 0.0, density, 1.0), 0.0)


@dataclass(frozen=True, kw_only=True)
class Disney(ScalarBSDF):
    """The principled BRDF: a diffuse base or one of subsurface scattering, sheen, a metal or gloss, a coat.

    Parameters
    ----------
    base_color : float or sequence of float
        Reflectance of the body or, of a metal, at normal incidence [1], in [0, 1]; linear in radiance (the
        source's code takes it to the power of 2.2 first).
    subsurface : float
        Share of the diffuse base that scatters as in a thin volume (Hanrahan & Krueger) [1], in [0, 1].
    metallic : float
        Share of metal [1], in [0, 1]: no diffuse base, and a reflectance that is the base colour.
    specular : float
        Gloss [1], in [0, 1]: 0.08 of it is the reflectance at normal incidence of what is no metal.
    specular_tint, sheen_tint : float
        How much of the base colour's hue gloss and sheen take on [1], in [0, 1].
    roughness : float
        Square root of the width of the slope distribution [1], in [0, 1].
    anisotropic : float
        In [0, 1]: the widths along x and y are as 1 to 1 − 0.9 ``anisotropic``.
    sheen : float
        Extra reflectance at grazing angles, as of cloth [1], in [0, 1].
    clearcoat, clearcoat_gloss : float
        Weight of a second gloss, over four [1], and how narrow that is, both in [0, 1].
    tint : float or sequence of float, optional
        The base colour over its luminance [1], in [0, 1e6], which is what the tints mix in. By default that
        of ``base_color``: luminance is (0.3, 0.6, 0.1) of three wavelengths, red, green and blue, as in the
        source, and the mean of any other number. A single number has no hue, and black has none: 1.

    Raises
    ------
    ParameterError
        When a parameter is out of its range, or ``tint`` and ``base_color`` differ in length.

    >>> import numpy as np
    >>> metal = Disney(base_color=1.0, metallic=1.0, roughness=1.0)
    >>> bool(abs(metal([0, 0, 1], [0, 0, 1]) - 1 / (4 * np.pi)) < 1e-15)
    True
    >>> Disney(base_color=(0.9, 0.3, 0.3), sheen=1.0).wavelength(0).tint.__round__(12)
    1.875
    """

    name = "disney"
    SOURCE = SOURCE
    EXAMPLES = (
        {},
        {"base_color": 0.8, "subsurface": 1.0, "sheen": 1.0, "roughness": 0.8},
        {"base_color": 0.9, "metallic": 1.0, "roughness": 0.4, "anisotropic": 0.8},
        {"base_color": (0.7, 0.2, 0.1), "specular_tint": 1.0, "roughness": 0.1, "clearcoat": 1.0},
        {"base_color": 1.0, "metallic": 1.0, "roughness": 0.0},
        {"base_color": 1.0, "roughness": 1.0, "sheen": 1.0, "clearcoat": 1.0, "clearcoat_gloss": 0.0},
    )
    dimensions: ClassVar[int] = 3
    kind = "principled"

    base_color: Spectrum = parameter("[0, 1]", "1", "reflectance of the body", spectral=True, default=0.5)
    subsurface: float = parameter("[0, 1]", "1", "share of subsurface scattering", default=0.0)
    metallic: float = parameter("[0, 1]", "1", "share of metal", default=0.0)
    specular: float = parameter("[0, 1]", "1", "gloss", default=0.5)
    specular_tint: float = parameter("[0, 1]", "1", "hue of the gloss", default=0.0)
    roughness: float = parameter("[0, 1]", "1", "root of the slopes' width", default=0.5)
    anisotropic: float = parameter("[0, 1]", "1", "how unlike the widths are", default=0.0)
    sheen: float = parameter("[0, 1]", "1", "reflectance at grazing angles", default=0.0)
    sheen_tint: float = parameter("[0, 1]", "1", "hue of the sheen", default=0.5)
    clearcoat: float = parameter("[0, 1]", "1", "weight of the coat", default=0.0)
    clearcoat_gloss: float = parameter("[0, 1]", "1", "gloss of the coat", default=1.0)
    tint: Spectrum | None = parameter("[0, 1e6]", "1", "colour over luminance", spectral=True, default=None)

    def symbolic(self) -> Twin:
        """Return the symbolic twin, in the angles of the source."""
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS
        from radiokit.physics import microfacet as paper

        given = self.parameters().items()
        values: dict[Any, Any] = {sympy.Symbol(name, nonnegative=True): value for name, value in given}
        color, subsurface, metallic, specular, specular_tint, rough, anisotropic, *others = values
        sheen, sheen_tint, clearcoat, gloss, tint = others
        values[tint] = self._tint()
        wi, wo, n = DIRECTION_SYMBOLS[:3], DIRECTION_SYMBOLS[3:], (0, 0, 1)
        half = [i + o for i, o in zip(wi, wo, strict=True)]
        cos_i, cos_o, cos_d = (paper.cosine_symbolic(*pair) for pair in ((wi, n), (wo, n), (wi, half)))
        quarter, tenth, thousandth = (sympy.Rational(1, k) for k in (4, 10, 1000))

        def mix(a: Any, b: Any, share: Any) -> Any:
            return a * (1 - share) + b * share

        def smith(w: Any, alpha: Any) -> Any:
            smith_g = paper.masking_symbolic(paper.ggx_lambda_symbolic(w, alpha, alpha))
            return smith_g / (2 * paper.cosine_symbolic(w, n))

        fifth_i, fifth_o, fifth_d = ((1 - c) ** 5 for c in (cos_i, cos_o, cos_d))
        retro = 2 * rough * cos_d**2
        diffuse = mix(1, retro + sympy.S.Half, fifth_i) * mix(1, retro + sympy.S.Half, fifth_o)
        flat = mix(1, retro / 2, fifth_i) * mix(1, retro / 2, fifth_o)
        inside = sympy.Rational(5, 4) * (flat * (1 / (cos_i + cos_o) - sympy.S.Half) + sympy.S.Half)
        body = color / sympy.pi * mix(diffuse, inside, subsurface)
        body += sheen * mix(1, tint, sheen_tint) * fifth_d
        f0 = mix(specular * sympy.Rational(2, 25) * mix(1, tint, specular_tint), color, metallic)
        aspect = sympy.sqrt(1 - 9 * tenth * anisotropic)
        density = paper.ggx_d_symbolic(
            half, sympy.Max(thousandth, rough**2 / aspect), sympy.Max(thousandth, rough**2 * aspect)
        )
        alpha = ((1 + rough) / 2) ** 2
        base = density * smith(wi, alpha) * smith(wo, alpha) * mix(f0, 1, fifth_d)
        coat = gtr1_d_symbolic(half, mix(tenth, thousandth, gloss)) * mix(sympy.Rational(1, 25), 1, fifth_d)
        coat *= clearcoat / 4 * smith(wi, quarter) * smith(wo, quarter)
        return Twin(body * (1 - metallic) + base + coat, values)

    def kernels(self) -> Kernels:
        """Return the kernels. The lobes are chosen without regard to colour, which may be a spectrum."""
        alpha_x, alpha_y = self._widths()
        alpha_c = self._coat_width()
        body, base, coat = 1.0 - self.metallic, 0.25 + 0.75 * self.metallic, 0.1 * self.clearcoat
        total = body + base + coat
        shape = (self.roughness, alpha_x, alpha_y, (0.5 + 0.5 * self.roughness) ** 2, alpha_c)
        chances = (*gtr1_constants(alpha_c), body / total, coat / total)
        return Kernels(_value, _density, _sample, (*self._coefficients(), *shape, *chances))

    def wavelength(self, index: int) -> BSDF:
        """Return the model at one of the K wavelengths, with the tint that it has among the others."""
        if not isinstance(self.base_color, tuple):
            return super().wavelength(index)
        return super(Disney, replace(self, tint=self._tint())).wavelength(index)

    def _tint(self) -> Any:
        """Return the base colour over its luminance, of shape () or (K,), as a float or a tuple."""
        if self.tint is not None:
            return self.tint
        if not isinstance(self.base_color, tuple):
            return 1.0
        color = np.asarray(self.base_color)
        weights = (0.3, 0.6, 0.1) if len(color) == 3 else np.full(len(color), 1.0 / len(color))
        luminance = float(np.dot(weights, color))
        return tuple((color / luminance if luminance > 0.0 else np.ones_like(color)).tolist())

    def _widths(self) -> tuple[float, float]:
        square = self.roughness * self.roughness
        aspect = math.sqrt((10.0 - 9.0 * self.anisotropic) / 10.0)
        return max(0.001, square / aspect), max(0.001, square * aspect)

    def _coat_width(self) -> float:
        return 0.1 * (1.0 - self.clearcoat_gloss) + 0.001 * self.clearcoat_gloss

    def _coefficients(self) -> tuple[Any, ...]:
        """Return what multiplies diffuse, subsurface, sheen, the metal's F at 0° and at 90°, and the coat."""
        color, tint = np.asarray(self.base_color), np.asarray(self._tint())
        dielectric, metallic = 1.0 - self.metallic, self.metallic
        gloss = 0.08 * self.specular * ((1.0 - self.specular_tint) + self.specular_tint * tint)
        fuzz = self.sheen * dielectric * ((1.0 - self.sheen_tint) + self.sheen_tint * tint)
        paint = color * dielectric * (1.0 - self.subsurface) / np.pi
        volume = color * dielectric * (1.25 * self.subsurface) / np.pi
        return paint, volume, fuzz, gloss * dielectric + color * metallic, 1.0, 0.25 * self.clearcoat

    @property
    def isotropic(self) -> bool:
        """Whether both widths are the same."""
        return len(set(self._widths())) == 1

    @property
    def smooth(self) -> bool:
        """True."""
        return True

    def lobe_width(self) -> float:
        """Return the width of the narrowest lobe."""
        return min(1.0, *self._widths(), *((self._coat_width(),) if self.clearcoat else ()))

    @property
    def claims(self) -> Claims:
        """Reciprocal; whether it conserves is measured by a scan of the albedo, once for each set."""
        return Claims(reciprocity="yes", conserves=_conserves(self))


@lru_cache(maxsize=1024)
def _conserves(model: Disney) -> bool:
    """Return whether the largest albedo is at most 1.

    Without a coat a metal of one width always conserves: it is a facet model with F ≤ 1, whose G is that of
    facets no narrower than its own, hence no larger than theirs.
    """
    if model.metallic == 1.0 and model.clearcoat == 0.0 and model.isotropic:
        return True
    narrow, wide = sorted(model._widths())
    parts = ((0, 3, 1.0, 1.0), (3, 5, min(narrow, 1.0), wide / narrow), (5, 6, model._coat_width(), 1.0))
    shape = model.kernels().constants[6:]
    return lobes_conserve(linear_lobes(_value, model._coefficients(), shape, parts))
