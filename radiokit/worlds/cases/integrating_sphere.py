"""Integrating sphere: spheres with ports, lamps, samples and detectors, in Goebel's closed form."""

from __future__ import annotations

import math

from radiokit.emitters.point import Point
from radiokit.emitters.spot import Spot
from radiokit.physics.integrating_sphere import IntegratingSphere
from radiokit.worlds.cases.asking import Ask, by_both, from_above, grey, room_case
from radiokit.worlds.cases.catalogue import Case
from radiokit.worlds.enclosure import Cap, Sphere, Wall

__all__ = ["CASES"]


def _share(share: float, direction: tuple[float, float, float], wall: Wall | None = None) -> Cap:
    """Return a cap that takes a share of the sphere."""
    return Cap(direction=direction, half_angle=2 * math.asin(math.sqrt(share)), wall=wall or Wall())


_LAMP = Point(position=(0, 0, 0), intensity=1 / (4 * math.pi))
_BEAM = Spot(
    position=(0, 0, 0.9),
    direction=(0, 0, -1),
    outer=0.6,
    inner=0.6,
    intensity=1 / (4 * math.pi * math.sin(0.3) ** 2),
)
_PER_PORT = 1 / (0.08 * math.pi**2)  # π times the area of a port of 2 %
_TOP, _SIDE, _FRONT = (0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
_THREE = Sphere(
    wall=grey(0.9),
    caps=[_share(0.02, _TOP, grey(0.2, 1.0)), _share(0.03, _SIDE, grey(0.4)), _share(0.01, _FRONT)],
)
_BALANCE = (
    r"A patch of a sphere sends each part the share of its flux that the part takes of the area, so every "
    r"point receives $E = \Phi/(A\bar\alpha)$ of the flux $\Phi$ that leaves walls for the first time, with "
    r"the mean absorptance $\bar\alpha = \sum_j f_j (1-\rho_j)$. "
)

CASES: tuple[Case, ...] = (
    room_case(
        "integrating-sphere-one-port",
        "The light out of an integrating sphere's port",
        "A sphere of radius 1, reflectance 0.95, has a port of 2 % of its area; at its centre is a lamp of "
        "1 W, the same in all directions. Wanted: the mean radiance of what leaves through the port, its "
        "flux over π times the cap's area.",
        250 / (69 * math.pi**2),
        _BALANCE + r"The lamp lights every part as evenly: $E = \frac{\Phi}{A} + \frac{\rho(1-f)\Phi}"
        r"{A\bar\alpha} = \frac{\Phi}{A\bar\alpha}$, so $f\Phi/(1-\rho(1-f))$ leaves.",
        by_both(
            Ask(
                Sphere(wall=grey(0.95), caps=[_share(0.02, _TOP)], lights=_LAMP),
                "flux",
                {"part": 1},
                factor=_PER_PORT,
            )
        ),
        tags=("integrating sphere", "port"),
    ),
    room_case(
        "integrating-sphere-two-ports",
        "The throughput of an integrating sphere with two ports",
        "A sphere of radius 1, reflectance 0.5, has two ports, each of 2 % of its area, in the directions "
        "+z and +x. A cone of light of half-angle 0.6 and of 1 W, with the same intensity throughout, "
        "comes from (0, 0, 0.9) along −z. Wanted: the mean radiance of what leaves by the port at +x.",
        25 / (104 * math.pi**2),
        _BALANCE + r"The cone's whole flux falls on the wall, which sends on $\rho\Phi$: the port receives "
        r"$f\rho\Phi/(1 - \rho(1-2f)) = \Phi/52$, and $\Phi/(52 \cdot 0.08\pi^2)$ of radiance.",
        by_both(
            Ask(
                Sphere(wall=grey(0.5), caps=[_share(0.02, _TOP), _share(0.02, _SIDE)], lights=_BEAM),
                "flux",
                {"part": 2},
                factor=_PER_PORT,
                paths=1 << 13,
            ),
            known=_PER_PORT
            * float(IntegratingSphere(reflectance=0.5, port_share=[0.02, 0.02]).throughput(port=1)),
        ),
        tags=("integrating sphere", "port", "spot"),
    ),
    room_case(
        "integrating-sphere-three-ports",
        "What a detector sees on a sphere with a lamp and a sample",
        "A sphere of reflectance 0.9 has three caps: a diffuse lamp of 2 % of its area, radiance 1 and "
        "reflectance 0.2; a sample of 3 % and reflectance 0.4; a black detector of 1 %. Wanted: the "
        "mean radiance that the detector sees, its irradiance over π.",
        10 / 69,
        _BALANCE + r"The lamp sends out $\pi L_e f_1 A$, so $E/\pi = L_e f_1/\bar\alpha$ with $\bar\alpha = "
        r"0.94 \cdot 0.1 + 0.02 \cdot 0.8 + 0.03 \cdot 0.6 + 0.01 = 0.138$.",
        by_both(Ask(_THREE, "irradiance", {"position": (0, 1, 0)}, factor=1 / math.pi)),
        tags=("integrating sphere", "port"),
    ),
    room_case(
        "integrating-sphere-sample",
        "The radiance of a sample on an integrating sphere",
        "The sphere of integrating-sphere-three-ports. Wanted: the radiance that leaves the sample.",
        4 / 69,
        _BALANCE + r"The sample, of another reflectance than the wall, leaves $\rho_2 E/\pi$.",
        by_both(Ask(_THREE, "radiance", {"position": (1, 0, 0), "direction": (-0.8, 0.0, 0.6)})),
        tags=("integrating sphere", "port"),
    ),
    room_case(
        "integrating-sphere-0.99",
        "The radiance of a white integrating sphere",
        "A sphere of radius 1, reflectance 0.99, has a port of 3 % of its area in the direction +z; at its "
        "centre is a lamp of 1 W. Wanted: the radiance that leaves the point (0, 0, −1).",
        2475 / (397 * math.pi**2),
        _BALANCE + r"Every point receives $\Phi/(A\bar\alpha)$ in all, and leaves "
        r"$\rho\Phi/(\pi A (1-\rho(1-f)))$: some 25 times what the lamp alone gives.",
        by_both(
            Ask(
                Sphere(wall=grey(0.99), caps=[_share(0.03, _TOP)], lights=_LAMP),
                "radiance",
                from_above(),
                paths=1 << 13,
            )
        ),
        tags=("integrating sphere", "port"),
    ),
    room_case(
        "blackbody-cavity",
        "How black the opening of a hot sphere is",
        "The wall of a sphere has emissivity 0.7: it emits radiance 0.7, where a black body would emit 1, "
        "and reflects 0.3 diffusely. Its opening is a tenth of its area. Wanted: the mean radiance "
        "of the opening.",
        63 / 73,
        _BALANCE
        + r"$\Phi = \pi\varepsilon(1-f)A$, so $E/\pi = \varepsilon(1-f)/(\varepsilon(1-f)+f)$, which "
        r"tends to 1 as the opening shrinks, whatever the wall.",
        by_both(
            Ask(
                Sphere(wall=grey(0.3, 0.7), caps=[_share(0.1, _TOP)]),
                "flux",
                {"part": 1},
                factor=1 / (0.4 * math.pi**2),
            )
        ),
        tags=("port", "kirchhoff"),
    ),
)
