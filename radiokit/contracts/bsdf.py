"""The BSDF contract: what a scattering model must provide, and what it claims of itself."""

from __future__ import annotations

import dataclasses
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Literal, get_args

import numpy as np
import numpy.typing as npt

from radiokit.contracts.parameters import at_wavelength, check_parameters
from radiokit.contracts.registry import Registry
from radiokit.facts.directions import check_directions
from radiokit.facts.source import Source

if TYPE_CHECKING:
    from radiokit.contracts.microfacet import Microfacets
    from radiokit.measure.kernels import Kernel
    from radiokit.measure.twin import Twin

__all__ = ["BSDF", "KINDS", "REGISTRY", "Claims", "DeltaLobe", "FloatArray", "Kind", "bsdf", "list_bsdfs"]

FloatArray = npt.NDArray[np.float64]

Kind = Literal["", "diffuse", "glossy", "microfacet", "delta", "transmission", "principled"]
"""What a model is in one word: a broad lobe, an empirical narrow one, one of facets, a mirror's, one that
light passes, or many in one for artists. Empty where a model does not say."""

KINDS: tuple[Kind, ...] = get_args(Kind)[1:]


@dataclass(frozen=True, kw_only=True)
class Claims:
    """What a model says of itself. The judges' findings must equal it.

    Parameters
    ----------
    reciprocity : {"yes", "no", "eta-scaled"}
    conserves : bool
        The directional albedo never exceeds 1.
    lossless : bool
        The directional albedo is 1 for every direction.
    delta : bool
        The model scatters (only) into delta lobes.
    """

    reciprocity: Literal["yes", "no", "eta-scaled"]
    conserves: bool
    lossless: bool = False
    delta: bool = False


@dataclass(frozen=True)
class DeltaLobe:
    """Scattering into a single direction: ``wi`` (N, 3) and ``weight`` (N,), the share of the flux.

    Of the flux that arrives from ``wi`` this share leaves towards ``wo``, and the same share the other way
    round. Radiance is multiplied by ``weight n(wo)² / n(wi)²``, with n(w) the index on w's side: that is
    f |cos θi| / pdf of a sample that always goes there.

    >>> (lobe,) = bsdf("mirror", reflectance=0.9).delta_lobes(np.array([[0.6, 0.0, 0.8]]))
    >>> lobe.wi.tolist(), lobe.weight.tolist()
    ([[-0.6, -0.0, 0.8]], [0.9])
    """

    wi: FloatArray
    weight: FloatArray


class BSDF(ABC):
    """A scattering model in the local frame whose z axis is the surface normal.

    Subclasses are frozen, keyword-only dataclasses, one a file. Directions are float64 unit vectors
    that point away from the surface. ``evaluate``, ``pdf`` and ``sample`` take ``(N, 3)`` arrays and trust
    them; calling the model checks them first. A value is in [sr⁻¹] and excludes the cosine; it has the shape
    ``(N,)``, or ``(N, K)`` for K wavelengths.
    """

    name: ClassVar[str] = ""
    SOURCE: ClassVar[Source]
    EXAMPLES: ClassVar[tuple[Mapping[str, Any], ...]] = ({},)
    """Parameters, easy and hard, with which ``radiokit validate`` puts the model before the judges."""

    kind: ClassVar[Kind] = ""
    """What the model is in one word, for the table of models."""

    transmissive: ClassVar[bool] = False
    """Whether light passes: then either direction may be below the horizon, and the cosine is |cosθ|."""

    dimensions: ClassVar[int] = 2
    """How many uniform numbers ``sample`` takes: more than 2 where one of them picks a lobe."""

    precision: float = float(np.finfo(float).eps)
    """Rounding unit of the values; larger than float64's for a function that computes in float32."""

    def __post_init__(self) -> None:
        check_parameters(self)

    @property
    @abstractmethod
    def claims(self) -> Claims | None:
        """What the model claims, for these parameters; None where nothing is claimed."""

    @abstractmethod
    def evaluate(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return f(wi, wo) [sr⁻¹], without delta lobes; 0 below the horizon unless light passes through."""

    @abstractmethod
    def pdf(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return the density [sr⁻¹] with which ``sample`` picks ``wi``, without delta lobes."""

    @abstractmethod
    def sample(self, u: FloatArray, wo: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Turn uniform points ``u`` (N, dimensions) into ``wi`` and ``weight = f |cos θi| / pdf``.

        A sample that is absorbed, or leaves below the horizon, has weight 0.
        """

    def weight_kernel(self, wo: FloatArray) -> tuple[Kernel, tuple[float, ...]] | None:
        """Return ``sample``'s weight for ``wo`` (3,) above the horizon as a kernel, or None if there is none.

        ``kernel(u0, u1, *constants)``, with ``u2`` too for three dimensions, is the weight that ``sample``
        gives for that point. Monte Carlo compiles it into its loop.
        """
        return None

    def delta_lobes(self, wo: FloatArray) -> tuple[DeltaLobe, ...]:
        """Return the delta lobes for ``wo`` (N, 3); none by default."""
        return ()

    @property
    def isotropic(self) -> bool:
        """Whether f is unchanged by a turn about the normal, and by mirroring at the plane of incidence."""
        return True

    @property
    def smooth(self) -> bool:
        """Whether f has no kink or jump up to the horizon, so that quadrature may believe rules that agree.

        False unless a model says otherwise: then agreement must be closer, and is doubted longer.
        """
        return False

    def lobe_width(self) -> float | None:
        """Return the lobe's width in the slope space of half vectors, or None if it is unknown.

        α for a microfacet model, 1 for a diffuse one, the narrowest of a sum of lobes. Quadrature places its
        nodes by it; being wrong by a factor of 4 costs evaluations, not accuracy.
        """
        return None

    def relative_index(self) -> float:
        """Return η, the refractive index below the surface over that above it; 1 unless a model refracts.

        f is the ratio of radiance to irradiance, and radiance grows as the square of the index: with n(w) the
        index on w's side, reciprocity is f(wi, wo) / n(wo)² = f(wo, wi) / n(wi)², and it is for fixed ``wi``
        that ∫ f |cosθo| dωo, the light reflected and transmitted, is at most 1.
        """
        return 1.0

    def microfacets(self) -> Microfacets | None:
        """Return the distribution of the surface's facets with its masking, or None if it has no facets."""
        return None

    def diffuse_reflectance(self) -> Any:
        """Return ρ of a model that is ρ/π for every pair of directions above the surface, None for another.

        Its reflected radiance is ρE/π, whatever the irradiance E comes from.
        """
        return None

    def diffuse_sides(self) -> tuple[Any, Any] | None:
        """Return ρ and τ of a sheet that is ρ/π for directions on one side and τ/π across it, or None.

        >>> bsdf("lambert_transmitter", reflectance=0.2, transmittance=0.7).diffuse_sides()
        (0.2, 0.7)
        """
        return None

    @abstractmethod
    def symbolic(self) -> Twin:
        """Return the symbolic twin: f(wi, wo) as a SymPy expression written from the source."""

    def wavelength(self, index: int) -> BSDF:
        """Return the model at one of the K wavelengths of its parameters; itself where it has none.

        >>> bsdf("lambert", reflectance=[0.2, 0.5]).wavelength(1)
        Lambert(reflectance=0.5)
        """
        found: BSDF = at_wavelength(self, index)
        return found

    def parameters(self) -> dict[str, Any]:
        """Return the parameters by name."""
        if not dataclasses.is_dataclass(self):
            return {}
        return {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}

    __array_ufunc__: ClassVar[None] = None
    """NumPy's numbers and arrays leave ``number * f`` to f."""

    def __mul__(self, factor: Any) -> BSDF:
        """Return factor · f, see ``scaled``.

        >>> 0.5 * bsdf("lambert") + 0.5 * bsdf("mirror")
        0.5*Lambert(reflectance=1.0) + 0.5*Mirror(reflectance=1.0)
        """
        from radiokit.contracts.mixture import multiplied

        return NotImplemented if isinstance(factor, BSDF) else multiplied(self, factor)

    __rmul__ = __mul__

    def __add__(self, other: Any) -> BSDF:
        """Return the sum of two BSDFs, see ``mixture``."""
        from radiokit.contracts.mixture import added

        return added(self, other) if isinstance(other, BSDF) else NotImplemented

    def __radd__(self, other: Any) -> BSDF:
        """Return f for 0 + f, with which ``sum`` begins."""
        return self if isinstance(other, int) and other == 0 else NotImplemented

    def __call__(self, wi: npt.ArrayLike, wo: npt.ArrayLike) -> Any:
        """Return f(wi, wo) [sr⁻¹] for checked directions of any broadcastable shape ``(..., 3)``.

        Raises
        ------
        ParameterError
            When a direction is not a finite unit vector of shape ``(..., 3)``.
        """
        wi, wo = check_directions("wi", wi), check_directions("wo", wo)
        wi, wo = np.broadcast_arrays(wi, wo)
        flat = self.evaluate(wi.reshape(-1, 3), wo.reshape(-1, 3))
        value = np.reshape(flat, wi.shape[:-1] + np.shape(flat)[1:])
        return value[()]


REGISTRY: Registry[BSDF] = Registry("BSDF", "radiokit.bsdfs", BSDF, "radiokit.bsdfs")


def list_bsdfs() -> list[str]:
    """Return the names of all BSDF models, third-party ones included.

    >>> "lambert" in list_bsdfs()
    True
    """
    return REGISTRY.names()


def bsdf(name: str, **parameters: Any) -> BSDF:
    """Return the BSDF model called ``name``.

    Parameters
    ----------
    name : str
        One of ``list_bsdfs()``.
    **parameters
        Those of its class, such as ``alpha=0.3``; the help of its class gives their ranges and units.

    Raises
    ------
    UnknownNameError
        When there is no such model.
    ParameterError
        When a parameter is out of its range.
    RadiokitError
        When a parameter is unknown or missing.

    >>> bsdf("lambert", reflectance=0.5)
    Lambert(reflectance=0.5)
    """
    return REGISTRY.make(name, parameters)
