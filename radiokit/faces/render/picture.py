"""Picture: radiances and their errors, pixel by pixel; as numbers, as a PNG or as an OpenEXR file."""

from __future__ import annotations

from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from radiokit.facts.errors import MissingExtraError, ParameterError, RadiokitError
from radiokit.facts.jsonable import jsonable

__all__ = ["Image", "check_file", "srgb"]

FloatArray = npt.NDArray[np.float64]
File = TypeVar("File", Path, BytesIO)


@dataclass(frozen=True, kw_only=True, eq=False)
class Image:
    """A rendered picture.

    Parameters
    ----------
    values : ndarray, shape (H, W) or (H, W, K)
        Radiances [W m⁻² sr⁻¹], of K wavelengths.
    error : ndarray
        Of the same shape: a bound where ``statistical`` is False, a standard error where it is True.
    statistical, converged, surface : ndarray of bool, shape (H, W)
        What the error is, whether the tolerance was reached, and whether the pixel shows a surface.
    evaluations : int
    seconds : float
        Wall time [s].
    about : dict
        What the picture shows, and how it was made.
    """

    values: FloatArray
    error: FloatArray
    statistical: npt.NDArray[np.bool_]
    converged: npt.NDArray[np.bool_]
    surface: npt.NDArray[np.bool_]
    evaluations: int = 0
    seconds: float = 0.0
    about: dict[str, Any] = field(default_factory=dict)

    @property
    def worst_error(self) -> float:
        """The largest error of any pixel."""
        return float(np.max(self.error, initial=0.0))

    def to_json(self) -> dict[str, Any]:
        """Return what there is to say of the picture, without its pixels, as JSON-ready data."""
        height, width = self.values.shape[:2]
        data = {
            **self.about,
            "height": height,
            "width": width,
            "wavelengths": self.values.shape[2] if self.values.ndim > 2 else None,
            "minimum": float(np.min(self.values)),
            "maximum": float(np.max(self.values)),
            "mean": float(np.mean(self.values)),
            "worst_error": self.worst_error,
            "statistical_pixels": int(np.count_nonzero(self.statistical)),
            "surface_pixels": int(np.count_nonzero(self.surface)),
            "unconverged_pixels": int(np.count_nonzero(~self.converged)),
            "evaluations": self.evaluations,
            "seconds": self.seconds,
        }
        return {key: jsonable(value) for key, value in data.items()}

    def save(self, path: str | Path, *, white: float = 1.0) -> Path:
        """Write the radiances as a PNG (8-bit sRGB) or as OpenEXR (32-bit, with the errors); return the path.

        Parameters
        ----------
        path : str or Path
            Ends in ``.png`` or ``.exr``. One wavelength is grey, three are red, green and blue.
        white : float
            Radiance shown as white in a PNG, above 0; what is brighter is white too.

        Raises
        ------
        ParameterError
            When the name ends otherwise, ``white`` is not allowed, or there are two wavelengths or more
            than three.
        MissingExtraError
            When OpenEXR is needed and not installed.
        RadiokitError
            When the file cannot be written.
        """
        file = Path(path)
        if file.suffix == ".png":
            return _write_png(file, self._grey_or_rgb(self.values), white)
        if file.suffix == ".exr":
            return _write_exr(file, {"": self.values, "error": self.error})
        raise ParameterError("path", str(path), "a name that ends in .png or .exr")

    def save_error(self, path: str | Path) -> Path:
        """Write the errors as a PNG whose white is the worst of them, or as OpenEXR; return the path.

        Raises
        ------
        ParameterError, MissingExtraError, RadiokitError
            As ``save`` does.
        """
        file = Path(path)
        if file.suffix == ".png":
            return _write_png(file, self._grey_or_rgb(self.error), self.worst_error or 1.0)
        if file.suffix == ".exr":
            return _write_exr(file, {"": self.error})
        raise ParameterError("path", str(path), "a name that ends in .png or .exr")

    def _repr_png_(self) -> bytes | None:
        """Return the picture for a notebook, if it can be seen."""
        if self.values.ndim > 2 and self.values.shape[2] != 3:
            return None
        stream = BytesIO()
        _write_png(stream, self._grey_or_rgb(self.values), 1.0)
        return stream.getvalue()

    def _grey_or_rgb(self, values: FloatArray) -> FloatArray:
        if values.ndim > 2 and values.shape[2] != 3:
            raise ParameterError("wavelengths", values.shape[2], "1 or 3 for a picture that can be seen")
        return values if values.ndim > 2 else np.repeat(values[:, :, None], 3, axis=2)


def check_file(path: str | Path, suffix: str) -> None:
    """Raise before the work begins if a picture cannot be written there.

    Raises
    ------
    ParameterError
        When the name does not end in ``suffix``, or there is no such folder.
    MissingExtraError
        When OpenEXR is needed and not installed.
    """
    file = Path(path)
    if file.suffix != suffix:
        raise ParameterError("path", str(path), f"a name that ends in {suffix}")
    if not file.absolute().parent.is_dir():
        raise ParameterError("path", str(path), "in a folder that exists")
    if suffix == ".exr":
        _openexr()


def _openexr() -> Any:
    try:
        import OpenEXR
    except ImportError:
        raise MissingExtraError("writing an OpenEXR file", "OpenEXR", "images") from None
    return OpenEXR


def srgb(linear: npt.ArrayLike) -> Any:
    """Return sRGB's encoding of linear light in [0, 1]; what is outside is moved to its ends.

    Source: IEC 61966-2-1 (1999), section 5.2.

    >>> round(float(srgb(0.5)), 6)
    0.735357
    """
    x = np.clip(np.asarray(linear, dtype=float), 0.0, 1.0)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 0.0031308) ** (1 / 2.4) - 0.055)[()]


def _write_png(file: File, rgb: FloatArray, white: float) -> File:
    from matplotlib.image import imsave

    if not (np.isfinite(white) and white > 0):
        raise ParameterError("white", white, "a finite radiance above 0")
    levels = np.round(255 * srgb(rgb / white)).astype(np.uint8)
    try:
        imsave(file, levels, format="png")
    except OSError as error:
        raise RadiokitError(f"cannot write {file}: {error}", path=str(file)) from error
    return file


def _write_exr(file: Path, layers: dict[str, FloatArray]) -> Path:
    OpenEXR = _openexr()
    channels: dict[str, npt.NDArray[np.float32]] = {}
    for layer, values in layers.items():
        planes = values[:, :, None] if values.ndim == 2 else values
        count = planes.shape[2]
        names = {1: ("Y",), 3: ("R", "G", "B")}.get(count) or tuple(f"S{k}" for k in range(count))
        for name, plane in zip(names, np.moveaxis(planes, 2, 0), strict=True):
            label = layer if layer and count == 1 else ".".join(filter(None, (layer, name)))
            channels[label] = np.ascontiguousarray(plane, dtype=np.float32)
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    try:
        with OpenEXR.File(header, channels) as image:
            image.write(str(file))
    except (OSError, RuntimeError) as error:
        raise RadiokitError(f"cannot write {file}: {error}", path=str(file)) from error
    return file
