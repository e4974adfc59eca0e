"""Round: spheres and disks over diffuse and glossy surfaces: near, far, tilted, and cut by the horizon."""

from __future__ import annotations

import math

from radiokit.bsdfs.lambert import Lambert
from radiokit.bsdfs.mirror import Mirror
from radiokit.bsdfs.phong import Phong
from radiokit.contracts.bsdf import BSDF
from radiokit.contracts.emitter import Emitter
from radiokit.emitters.disk import Disk
from radiokit.emitters.sphere import Sphere
from radiokit.facts.source import Source
from radiokit.physics.cap import CAP_SOURCE
from radiokit.physics.disk import DISK_SOURCE
from radiokit.physics.view_factor import HOWELL
from radiokit.worlds.cases.catalogue import Case, Scene, shading_case

__all__ = ["CASES"]

Triple = tuple[float, float, float]

_LEFT_OUT: dict[str, tuple[str, tuple[str, ...]]] = {
    "": ("", ()),
    "cut": (" For quadrature, the kink that the horizon makes leaves 5e-7.", ("quadrature",)),
    "small": (" Samples of the material do not find so small a light.", ("mc-bsdf",)),
}
_HALF = Lambert(reflectance=0.5)
_UP: Triple = (0.0, 0.0, 1.0)
_SIDE: Triple = (1.0, 0.0, 0.0)


def _case(
    name: str,
    title: str,
    setup: str,
    exact: float,
    derivation: str,
    light: Emitter,
    *,
    f: BSDF = _HALF,
    source: Source,
    wo: Triple | None = None,
    normal: Triple = _UP,
    left_out: str = "",
) -> Case:
    words, methods = _LEFT_OUT[left_out]
    return shading_case(
        name=name,
        title=title,
        setup=setup + words,
        exact=exact,
        derivation=derivation,
        source=source,
        scene=Scene(f=f, emitters=(light,), wo=normal if wo is None else wo, normal=normal),
        tags=("area light", light.name, f.name),
        left_out=methods,
    )


# --- disks ---

_DIFFUSE = "A diffuse surface of reflectance 0.5, seen along its normal, "


def _facing(radius: float, depth: float, offset: float) -> float:
    """Return E/πL of a parallel receiver: half of 1 − (a² + b² − R²)/Q, by its conjugate."""
    power = depth**2 + (offset - radius) * (offset + radius)
    product = math.hypot(power, 2 * depth * radius)
    return 2 * (depth * radius) ** 2 / (product * (product + power))


_FACING = (
    r"Lambert's contour integral for a disk at height $a$ and offset $b$ is $E = \frac{\pi L}{2}\left(1 - "
    r"\frac{a^2+b^2-R^2}{Q}\right) = \frac{2\pi L a^2R^2}{Q(Q + a^2 + b^2 - R^2)}$, "
    r"$Q^2 = (a^2+b^2+R^2)^2 - 4b^2R^2$, and $L_o = \rho E/\pi$."
)


def _parallel(
    suffix: str, words: str, radius: float, depth: float, offset: float, left_out: str = ""
) -> Case:
    return _case(
        f"lambert-under-disk{suffix}",
        f"Lambert under a {words}disk" if words else "Lambert under a disk",
        f"{_DIFFUSE}under a disk of radius {radius:g} m and radiance 1 W/m²/sr that faces it from {depth:g} "
        f"m above, its axis {offset:g} m away.",
        0.5 * _facing(radius, depth, offset),
        _FACING,
        Disk(center=(offset, 0.0, depth), normal=(0.0, 0.0, -1.0), radius=radius, radiance=1.0),
        source=HOWELL,
        left_out=left_out,
    )


def _disks() -> tuple[Case, ...]:
    disk = Disk(center=(0.0, 0.0, 2.0), normal=(0.0, 0.0, -1.0), radius=1.0, radiance=1.0)
    beside = Disk(center=(3.0, 0.0, 2.0), normal=(0.0, 0.0, -1.0), radius=1.0, radiance=1.0)
    above = Disk(center=(0.0, 0.0, 1.0), normal=(0.0, 0.0, -1.0), radius=1.0, radiance=1.0)
    spot = Disk(center=(0.0, 0.0, 1.0), normal=(0.0, 0.0, -1.0), radius=1.0, radiance=1.0, exponent=2.0)
    root = math.sqrt(0.5)
    return (
        _parallel("", "", 1.0, 1.0, 0.0),
        _parallel("-tiny", "tiny ", 1e-6, 1.0, 0.0, "small"),
        _parallel("-huge", "huge ", 1e4, 1.0, 0.0),
        _parallel("-off-axis", "", 1.0, 2.0, 3.0),
        _parallel("-below-its-edge", "", 1.0, 0.5, 1.0),
        _case(
            "lambert-under-disk-tilted",
            "Lambert tilted by 45° under a disk",
            f"{_DIFFUSE}tilted by 45°, 2 m below the centre of a disk of radius 1 m and radiance 1 W/m²/sr "
            "that faces down.",
            0.1 * root,
            r"The whole disk is above the horizon, and by symmetry its irradiance vector is along the axis: "
            r"$E = \pi L \frac{R^2}{R^2+h^2} \cos 45°$ and $L_o = \rho E/\pi$.",
            disk,
            source=HOWELL,
            normal=(root, 0.0, root),
        ),
        _case(
            "lambert-wall-beside-disk",
            "Lambert wall beside a disk",
            f"{_DIFFUSE}upright, 2 m below the plane of a disk of radius 1 m and radiance 1 W/m²/sr that "
            "faces down, and facing the disk's axis, 3 m away.",
            0.5 * 12.0 / (math.sqrt(160.0) * (math.sqrt(160.0) + 14.0)),
            r"The contour integral along the offset is $E = \frac{\pi L a}{2b}\,\frac{S - Q}{Q} = "
            r"\frac{2\pi L\, abR^2}{Q(Q+S)}$ with $S = a^2+b^2+R^2 = 14$, $Q^2 = S^2 - 4b^2R^2 = 160$; "
            r"$L_o = \rho E/\pi$.",
            beside,
            source=DISK_SOURCE,
            normal=_SIDE,
        ),
        _case(
            "lambert-wall-under-disk",
            "Lambert wall under the centre of a disk",
            f"{_DIFFUSE}upright, 1 m below the centre of a disk of radius 1 m and radiance 1 W/m²/sr that "
            "faces down, so that it sees half of it.",
            0.125 - 0.25 / math.pi,
            r"The half circle gives $-aR/(a^2+R^2)$ and the diameter its half angle $\arctan(R/a)$: "
            r"$E/L = \arctan 1 - 1/2$ and $L_o = \rho E/\pi$.",
            above,
            source=DISK_SOURCE,
            normal=_SIDE,
            left_out="cut",
        ),
        _case(
            "lambert-under-cos2-disk",
            "Lambert under a disk that shines as cos²",
            f"{_DIFFUSE}1 m below the centre of a disk of radius 1 m that faces it, of radiance cos²θ "
            "W/m²/sr at the angle θ from its normal.",
            0.1875,
            r"$E = 2\pi L a^{n+2} \int_a^{\sqrt{a^2+R^2}} r^{-n-3} dr = \frac{2\pi L}{n+2} \left(1 - "
            r"\left(\frac{a^2}{a^2+R^2}\right)^{(n+2)/2}\right) = \frac{3\pi}{8}$, and $L_o = \rho E/\pi$.",
            spot,
            source=DISK_SOURCE,
        ),
        _case(
            "phong-10-under-disk",
            "Phong under a disk",
            "Modified Phong with exponent 10 and reflectance 1, seen along its normal, 2 m below the centre "
            "of a disk of radius 1 m and radiance 1 W/m²/sr that faces it.",
            1 - 0.8**6,
            r"$L_o = (n+2) \int_0^\sigma \cos^{n+1}\theta \sin\theta\, d\theta = 1 - \cos^{n+2}\sigma$, with "
            r"$\cos^2\sigma = h^2/(h^2+R^2) = 0.8$.",
            disk,
            f=Phong(reflectance=1.0, exponent=10.0),
            source=Phong.SOURCE,
        ),
    )


# --- spheres ---


def _seen(radius: float, distance: float, elevation_deg: float) -> tuple[Sphere, str]:
    """Return a sphere of radiance 1 at an elevation above the horizon, and where it is in words."""
    e = math.radians(elevation_deg)
    upright = math.sin(math.radians(90.0 - elevation_deg)) if elevation_deg else 1.0
    center = (distance * upright, 0.0, distance * math.sin(e))
    where = f"a sphere of radius {radius:g} m and radiance 1 W/m²/sr, {distance:g} m away, "
    return Sphere(center=center, radius=radius, radiance=1.0), where


_WHOLE = r"By symmetry $E = \pi L \sin^2\sigma\cos\theta$ with $\sin\sigma = R/d$, and $L_o = \rho E/\pi$."
_PART = (
    r"The contour is the cone's arc of half angle $T$ and the horizon between its ends: $E/L = \beta + "
    r"\sin^2\sigma\cos\theta\, T - \sin\sigma\cos\sigma\sin\theta\sin T$, $\cos T = -\cot\sigma\cot\theta$, "
    r"$\cos\beta = \cos\sigma/\sin\theta$; $L_o = \rho E/\pi$."
)


def _overhead(text: str, distance: float) -> Case:
    return _case(
        f"lambert-under-sphere-at-{text.replace(' ', '')}",
        f"Lambert under a sphere of 1 m at {text}",
        f"{_DIFFUSE}under a sphere of radius 1 m and radiance 1 W/m²/sr whose centre is {text} above it.",
        0.5 / distance / distance,
        _WHOLE,
        Sphere(center=(0.0, 0.0, distance), radius=1.0, radiance=1.0),
        source=CAP_SOURCE,
        left_out="small" if distance > 10 else "",
    )


def _at_horizon(elevation_deg: float, exact: float) -> Case:
    """Return a case with sinσ = 1/2; the formula's terms cancel, so that its value comes from 30 digits."""
    light, where = _seen(1.0, 2.0, elevation_deg)
    side = "above" if elevation_deg > 0 else "below"
    place = f"{abs(elevation_deg):g}° {side} the horizon" if elevation_deg else "in the horizon"
    name = place.replace("° ", "deg-").replace(" ", "-").replace("the-", "")
    return _case(
        f"lambert-under-sphere-{name}",
        f"Lambert under a sphere {place}",
        f"{_DIFFUSE}under {where}its centre {place}.",
        exact,
        _PART,
        light,
        source=CAP_SOURCE,
        left_out="cut",
    )


def _spheres() -> tuple[Case, ...]:
    lamp, where = _seen(0.3, 1.0, 30.0)
    touched = 1.0 + 2.0**-20
    beside = Sphere(center=(touched, 0.0, 0.0), radius=1.0, radiance=1.0)
    gap = math.sqrt((touched - 1.0) * (touched + 1.0))
    return (
        *(_overhead(f"{d:g} m", d) for d in (1.001, 2.0, 100.0)),
        _overhead("1000 km", 1e6),
        _case(
            "lambert-under-sphere-30deg-above-horizon",
            "Lambert under a sphere 30° above the horizon",
            f"{_DIFFUSE}under {where}its centre 30° above the horizon: all of it is seen.",
            0.5 * 0.09 * math.sin(math.radians(30.0)),
            _WHOLE,
            lamp,
            source=CAP_SOURCE,
        ),
        _at_horizon(10.0, 0.027347908222768627),
        _at_horizon(0.0, 0.014417221405609327),
        _at_horizon(-10.0, 0.005641886014402333),
        _case(
            "lambert-wall-beside-sphere",
            "Lambert all but touching a sphere, its horizon through the centre",
            f"{_DIFFUSE}2⁻²⁰ m beside a sphere of radius 1 m and radiance 1 W/m²/sr, with the sphere's "
            "centre in its horizon: nearly a quarter of all directions.",
            0.5 / math.pi * (math.atan2(1.0, gap) - gap / touched / touched),
            r"With the axis in the horizon $T = \pi/2$ and $\beta = \sigma$: $E/L = \sigma - "
            r"\sin\sigma\cos\sigma$, where $\tan\sigma = R/\sqrt{d^2 - R^2}$; $L_o = \rho E/\pi$.",
            beside,
            source=CAP_SOURCE,
            left_out="cut",
        ),
        _case(
            "phong-10-under-sphere",
            "Phong under a sphere",
            "Modified Phong with exponent 10 and reflectance 1, seen along its normal, under a sphere of "
            "radius 3 m and radiance 1 W/m²/sr whose centre is 5 m above it.",
            1 - 0.64**6,
            r"$L_o = (n+2) \int_0^\sigma \cos^{n+1}\theta \sin\theta\, d\theta = 1 - \cos^{n+2}\sigma$, with "
            r"$\sin\sigma = R/d = 3/5$.",
            Sphere(center=(0.0, 0.0, 5.0), radius=3.0, radiance=1.0),
            f=Phong(reflectance=1.0, exponent=10.0),
            source=Phong.SOURCE,
        ),
        _case(
            "phong-10-under-sphere-at-mirror",
            "Phong with a sphere in the mirror direction",
            f"Modified Phong with exponent 10 and reflectance 1, seen 60° off its normal, under {where}its "
            "centre in the mirror direction: all of it is above the horizon.",
            0.5 * (1 - 0.91**6),
            r"On a ring about the mirror direction $\cos\theta$ averages $\cos 60° \cos\alpha$, so that "
            r"$L_o = \cos 60° (n+2) \int_0^\sigma \cos^{n+1}\alpha \sin\alpha\, d\alpha = \cos 60° "
            r"(1 - \cos^{n+2}\sigma)$, with $\cos^2\sigma = 1 - 0.3^2$.",
            lamp,
            f=Phong(reflectance=1.0, exponent=10.0),
            source=Phong.SOURCE,
            wo=(-math.sqrt(0.75), 0.0, 0.5),
        ),
        _case(
            "mirror-under-sphere",
            "A mirror that shows a sphere",
            f"A mirror of reflectance 0.9, seen 60° off its normal, under {where}its centre in the mirror "
            "direction.",
            0.9,
            r"A mirror shows the radiance: $L_o = \rho L$, however far the sphere is.",
            lamp,
            f=Mirror(reflectance=0.9),
            source=Mirror.SOURCE,
            wo=(-math.sqrt(0.75), 0.0, 0.5),
        ),
    )


CASES: tuple[Case, ...] = (*_disks(), *_spheres())
