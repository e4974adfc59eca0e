"""Terms: the table behind ``quantity``, an entry for each term of CIE/ISO 80000-7 that radiokit uses."""

from __future__ import annotations

from dataclasses import replace

from radiokit.facts.quantities import Quantity
from radiokit.facts.source import Source

__all__ = ["TERMS"]

_LIGHT = Source(authors="ISO", year=2019, title="ISO 80000-7 Quantities and units: Light and radiation")
_SPACE = Source(authors="ISO", year=2019, title="ISO 80000-3 Quantities and units: Space and time")
_NICODEMUS = Source(
    authors="Nicodemus, Richmond, Hsia, Ginsberg, Limperis",
    year=1977,
    title="Geometrical Considerations and Nomenclature for Reflectance",
    doi="10.6028/NBS.MONO.160",
)


def _item(number: str, source: Source = _LIGHT) -> Source:
    return replace(source, equation=f"item {number}")


_RADIOMETRIC = (
    Quantity(
        name="radiant_energy",
        symbol="Q_e",
        unit="J",
        kind="radiometric",
        english="radiant energy",
        russian="энергия излучения",
        definition="Q_e = ∫ Φ_e dt",
        meaning="the energy that light carries",
        twin="luminous_energy",
        source=_item("7-2.1"),
        aliases=("energy", "лучистая энергия"),
    ),
    Quantity(
        name="radiant_flux",
        symbol="Φ_e",
        unit="W",
        kind="radiometric",
        english="radiant flux",
        russian="поток излучения",
        definition="Φ_e = dQ_e/dt",
        meaning="the energy per time",
        twin="luminous_flux",
        source=_item("7-4.1"),
        aliases=("flux", "power", "radiant power", "поток", "мощность излучения", "лучистый поток"),
    ),
    Quantity(
        name="radiant_intensity",
        symbol="I_e",
        unit="W/sr",
        kind="radiometric",
        english="radiant intensity",
        russian="сила излучения",
        definition="I_e = dΦ_e/dΩ",
        meaning="the flux of a source per solid angle",
        twin="luminous_intensity",
        source=_item("7-5.1"),
        aliases=("intensity", "энергетическая сила света"),
    ),
    Quantity(
        name="irradiance",
        symbol="E_e",
        unit="W/m^2",
        kind="radiometric",
        english="irradiance",
        russian="облучённость",
        definition="E_e = dΦ_e/dA",
        meaning="the flux that arrives per area",
        twin="illuminance",
        source=_item("7-7.1"),
        aliases=("энергетическая освещённость",),
    ),
    Quantity(
        name="radiant_exitance",
        symbol="M_e",
        unit="W/m^2",
        kind="radiometric",
        english="radiant exitance",
        russian="энергетическая светимость",
        definition="M_e = dΦ_e/dA",
        meaning="the flux that leaves per area",
        twin="luminous_exitance",
        source=_item("7-8.1"),
        aliases=("exitance", "radiant emittance", "radiosity", "излучательность"),
    ),
    Quantity(
        name="radiance",
        symbol="L_e",
        unit="W/(m^2 sr)",
        kind="radiometric",
        english="radiance",
        russian="энергетическая яркость",
        definition="L_e = d²Φ_e/(dΩ dA cosθ)",
        meaning="the flux per solid angle and projected area",
        twin="luminance",
        source=_item("7-6.1"),
        aliases=("лучистость",),
    ),
)

_PHOTOMETRIC = (
    Quantity(
        name="luminous_energy",
        symbol="Q_v",
        unit="lm s",
        kind="photometric",
        english="luminous energy",
        russian="световая энергия",
        definition="Q_v = ∫ Φ_v dt",
        meaning="the energy that light carries as the eye weighs it",
        twin="radiant_energy",
        source=_item("7-12"),
        aliases=("quantity of light",),
    ),
    Quantity(
        name="luminous_flux",
        symbol="Φ_v",
        unit="lm",
        kind="photometric",
        english="luminous flux",
        russian="световой поток",
        definition="Φ_v = dQ_v/dt",
        meaning="the energy per time as the eye weighs it",
        twin="radiant_flux",
        source=_item("7-13"),
        aliases=("luminous power",),
    ),
    Quantity(
        name="luminous_intensity",
        symbol="I_v",
        unit="cd",
        kind="photometric",
        english="luminous intensity",
        russian="сила света",
        definition="I_v = dΦ_v/dΩ",
        meaning="the flux of a source per solid angle as the eye weighs it",
        twin="radiant_intensity",
        source=_item("7-14"),
    ),
    Quantity(
        name="illuminance",
        symbol="E_v",
        unit="lx",
        kind="photometric",
        english="illuminance",
        russian="освещённость",
        definition="E_v = dΦ_v/dA",
        meaning="the flux that arrives per area as the eye weighs it",
        twin="irradiance",
        source=_item("7-16"),
    ),
    Quantity(
        name="luminous_exitance",
        symbol="M_v",
        unit="lm/m^2",
        kind="photometric",
        english="luminous exitance",
        russian="светимость",
        definition="M_v = dΦ_v/dA",
        meaning="the flux that leaves per area as the eye weighs it",
        twin="radiant_exitance",
        source=_item("7-17"),
        aliases=("luminous emittance",),
    ),
    Quantity(
        name="luminance",
        symbol="L_v",
        unit="cd/m^2",
        kind="photometric",
        english="luminance",
        russian="яркость",
        definition="L_v = d²Φ_v/(dΩ dA cosθ)",
        meaning="the flux per solid angle and projected area as the eye weighs it",
        twin="radiance",
        source=_item("7-15"),
    ),
)

_OTHER = (
    Quantity(
        name="solid_angle",
        symbol="Ω",
        unit="sr",
        kind="geometric",
        english="solid angle",
        russian="телесный угол",
        definition="Ω = A/r²",
        meaning="the area cut from a sphere over its radius squared",
        source=_item("3-8", _SPACE),
    ),
    Quantity(
        name="bsdf",
        symbol="f",
        unit="1/sr",
        kind="scattering",
        english="bidirectional scattering distribution function",
        russian="двунаправленная функция рассеяния",
        definition="f = dL_o/(L_i cosθ_i dΩ_i)",
        meaning="the radiance scattered per irradiance received from one direction",
        source=_NICODEMUS,
        aliases=(
            "brdf",
            "btdf",
            "bidirectional reflectance distribution function",
            "bidirectional transmittance distribution function",
            "двунаправленная функция отражения",
            "двулучевая функция отражательной способности",
            "ДФОС",
        ),
    ),
    Quantity(
        name="reflectance",
        symbol="ρ",
        unit="1",
        kind="scattering",
        english="reflectance",
        russian="коэффициент отражения",
        definition="ρ = Φ_r/Φ_i",
        meaning="the reflected share of the flux that arrives",
        source=_item("7-31.3"),
        aliases=("albedo", "альбедо"),
    ),
)

_SPECTRAL = (
    ("spectral radiant energy", "энергии излучения", "J/nm", "7-2.2"),
    ("spectral radiant flux", "потока излучения", "W/nm", "7-4.2"),
    ("spectral radiant intensity", "силы излучения", "W/(sr nm)", "7-5.2"),
    ("spectral irradiance", "облучённости", "W/(m^2 nm)", "7-7.2"),
    ("spectral radiant exitance", "энергетической светимости", "W/(m^2 nm)", "7-8.2"),
    ("spectral radiance", "энергетической яркости", "W/(m^2 sr nm)", "7-6.2"),
)


def _spectral(whole: Quantity, english: str, genitive: str, unit: str, number: str) -> Quantity:
    """Return the spectral concentration of ``whole``: the same term per wavelength."""
    short = [f"spectral {alias}" for alias in whole.aliases if alias.isascii()]
    return Quantity(
        name=english.replace(" ", "_"),
        symbol=f"{whole.symbol},λ",
        unit=unit,
        kind="spectral",
        english=english,
        russian=f"спектральная плотность {genitive}",
        definition=f"{whole.symbol},λ = d{whole.symbol}/dλ",
        meaning=f"{whole.meaning} and wavelength"
        if " per " in whole.meaning
        else f"{whole.meaning} per wavelength",
        spectral=whole.name,
        source=_item(number),
        aliases=tuple(short),
    )


_CONCENTRATIONS = tuple(_spectral(whole, *row) for whole, row in zip(_RADIOMETRIC, _SPECTRAL, strict=True))
_WHOLES = tuple(
    replace(whole, spectral=part.name) for whole, part in zip(_RADIOMETRIC, _CONCENTRATIONS, strict=True)
)

TERMS: dict[str, Quantity] = {
    item.name: item for item in (*_WHOLES, *_CONCENTRATIONS, *_PHOTOMETRIC, *_OTHER)
}
"""Every term, by name: radiometric, spectral, photometric, then the rest."""
