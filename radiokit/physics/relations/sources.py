"""Sources: the standards, books and papers that the derivations cite."""

from __future__ import annotations

from dataclasses import replace

from radiokit.facts.source import Source

__all__ = [
    "ARVO",
    "BORN_WOLF",
    "GOEBEL",
    "ISO_LIGHT",
    "ISO_SPACE",
    "LAMBERT",
    "NICODEMUS_1963",
    "NICODEMUS_1977",
    "OOSTEROM",
    "VEACH",
    "WALSH",
    "at",
]

ISO_LIGHT = Source(authors="ISO", year=2019, title="ISO 80000-7 Quantities and units: Light and radiation")
ISO_SPACE = Source(authors="ISO", year=2019, title="ISO 80000-3 Quantities and units: Space and time")
LAMBERT = Source(authors="Lambert", year=1760, title="Photometria")
NICODEMUS_1963 = Source(authors="Nicodemus", year=1963, title="Radiance", doi="10.1119/1.1969512")
NICODEMUS_1977 = Source(
    authors="Nicodemus, Richmond, Hsia, Ginsberg, Limperis",
    year=1977,
    title="Geometrical Considerations and Nomenclature for Reflectance",
    doi="10.6028/NBS.MONO.160",
)
BORN_WOLF = Source(
    authors="Born, Wolf",
    year=1999,
    title="Principles of Optics, 7th edition",
    doi="10.1017/CBO9781139644181",
)
ARVO = Source(
    authors="Arvo",
    year=1994,
    title="The Irradiance Jacobian for Partially Occluded Polyhedral Sources",
    doi="10.1145/192161.192250",
)
OOSTEROM = Source(
    authors="van Oosterom, Strackee",
    year=1983,
    title="The Solid Angle of a Plane Triangle",
    doi="10.1109/TBME.1983.325207",
)
GOEBEL = Source(
    authors="Goebel", year=1967, title="Generalized Integrating-Sphere Theory", doi="10.1364/AO.6.000125"
)
VEACH = Source(authors="Veach", year=1997, title="Robust Monte Carlo Methods for Light Transport Simulation")


def at(source: Source, equation: str) -> Source:
    """Return the source with the place in it."""
    return replace(source, equation=equation)


WALSH = Source(authors="Walsh", year=1958, title="Photometry, 3rd edition")
