"""Lights of several wavelengths: each is the light of one number, in every method."""

from __future__ import annotations

import numpy as np
import pytest

from radiokit.contracts.emitter import emitter, list_emitters
from radiokit.contracts.parameters import at_wavelength, spectrum_length
from radiokit.contracts.spectral import check_wavelengths, stacked, times
from radiokit.facts.directions import unit
from radiokit.facts.errors import ParameterError
from radiokit.worlds.scene import irradiance, solid_angle

IES = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 9\n0 90\n0\n1366 100"
SPECTRUM = (0.0, 0.5, 2.0, 7e-3)
SQUARE = [(-1, -1, 1), (-1, 1, 1), (1, 1, 1), (1, -1, 1)]
MAP = np.multiply.outer([[1.0, 0.0, 2.0], [0.5, 3.0, 1.0]], SPECTRUM) + np.eye(3)[:2, :, None]
LIGHTS = {
    "point": {"position": (0, 1, 2), "intensity": SPECTRUM},
    "spot": {"position": (0, 0, 2), "direction": (0, 0.1, -1), "intensity": SPECTRUM, "outer": 0.3},
    "goniometric": {"position": (0, 0.3, 2), "ies": IES, "scale": SPECTRUM},
    "directional": {"direction": (0, 1, 2), "irradiance": SPECTRUM},
    "sphere": {"center": (2, 0, 0.5), "radius": 1, "radiance": SPECTRUM},
    "disk": {
        "center": (2, 0, 0.5),
        "normal": (-1, 0, -0.2),
        "radius": 1,
        "radiance": SPECTRUM,
        "exponent": 0.0,
    },
    "polygon": {"vertices": SQUARE, "radiance": SPECTRUM},
    "triangle": {"vertices": SQUARE[:3], "radiance": SPECTRUM},
    "rectangle": {"center": (0, 0, 2), "normal": (0, 0.2, -1), "width": 1, "height": 2, "radiance": SPECTRUM},
    "constant": {"radiance": SPECTRUM, "normal": (0, 0.6, 0.8)},
    "sky_overcast": {"radiance": SPECTRUM, "normal": (0, 0.6, 0.8)},
    "sky_gradient": {"radiance": SPECTRUM, "horizon": (1.0, 0.0, 3.0, 0.2), "curvature": 0.5},
    "environment": {"radiance": MAP, "forward": (0, 1, 0)},
}
ORIGIN, UP, TILTED = np.zeros(3), np.array([0.0, 0.0, 1.0]), np.array([0.6, 0.0, 0.8])


def one(light, k):
    if light.name == "environment":
        return emitter(
            "environment", radiance=light.radiance[..., k], normal=light.normal, forward=light.forward
        )
    return at_wavelength(light, k)


def test_all_lights_are_here():
    assert sorted(LIGHTS) == list_emitters()


@pytest.mark.parametrize("name", LIGHTS)
def test_each_wavelength_is_the_light_of_one_number(name, rng):
    light = emitter(name, **LIGHTS[name])
    assert light.wavelengths == len(SPECTRUM)
    assert hash(light) == hash(emitter(name, **LIGHTS[name]))
    for k in range(len(SPECTRUM)):
        single = one(light, k)
        assert single.wavelengths is None
        for normal in (UP, TILTED, -UP):
            found, exact = irradiance(light, normal=normal), irradiance(single, normal=normal)
            assert np.shape(found.value) == np.shape(found.error) == (len(SPECTRUM),)
            assert found.value[k] == pytest.approx(float(exact.value), rel=1e-14)
            assert found.error[k] == pytest.approx(float(exact.error), rel=1e-12, abs=1e-300)
        if light.flux() is not None:
            assert light.flux().value[k] == pytest.approx(float(single.flux().value), rel=1e-15)
        assert np.ndim(solid_angle(light).value) == 0
        if light.delta:
            directions, arriving = light.incident(ORIGIN)
            assert arriving.shape == (len(directions), len(SPECTRUM))
            assert arriving[:, k] == pytest.approx(single.incident(ORIGIN)[1], rel=1e-15)
        else:
            w = unit(rng.normal(size=(200, 3)))
            assert light.radiance_from(w, ORIGIN).shape == (200, len(SPECTRUM))
            assert np.array_equal(light.radiance_from(w, ORIGIN)[:, k], single.radiance_from(w, ORIGIN))


@pytest.mark.parametrize("name", [n for n in LIGHTS if not emitter(n, **LIGHTS[n]).delta])
def test_samples_serve_all_wavelengths(name, rng):
    """One density for all: it integrates to 1, and weighs every wavelength's radiance to its irradiance."""
    light = emitter(name, **LIGHTS[name])
    u = rng.random((40_000, 2))
    wi, density = light.sample(u, ORIGIN)
    assert density.shape == (len(u),)
    assert light.pdf(wi, ORIGIN) == pytest.approx(density, rel=1e-9)
    terms = times(light.radiance_from(wi, ORIGIN), np.maximum(wi @ UP, 0) / density)
    exact = irradiance(light, normal=UP).value
    spread = 5 * terms.std(axis=0) / np.sqrt(len(u))
    assert (np.abs(terms.mean(axis=0) - exact) <= spread + 1e-12 * exact).all()


@pytest.mark.parametrize(("name", "field"), [
    ("point", "intensity"), ("directional", "irradiance"), ("sphere", "radiance"), ("polygon", "radiance"),
    ("sky_gradient", "horizon"), ("goniometric", "scale"),
])  # fmt: skip
def test_bad_spectra_are_named(name, field):
    for bad in ((), (1.0, -1.0), (1.0, float("nan")), [[1.0, 2.0]], (1.0, float("inf")), (1.0, 1e200)):
        with pytest.raises(ParameterError, match=f"{field} = .*in \\[0, 1e100\\]"):
            emitter(name, **{**LIGHTS[name], field: bad})


def test_unequal_spectra_are_refused():
    with pytest.raises(ParameterError, match="as many numbers as"):
        emitter("sky_gradient", radiance=(1.0, 2.0), horizon=(1.0, 2.0, 3.0))
    with pytest.raises(ParameterError, match=r"wavelengths of the light = 2 .* the material's, 3"):
        times(np.ones((4, 3)), np.ones((4, 2)))
    assert check_wavelengths(None, 2) == check_wavelengths(2, None) == check_wavelengths(2, 2) == 2
    assert check_wavelengths(None, None) is None


def test_a_planted_mix_up_of_wavelengths_is_found():
    light = emitter("sphere", **LIGHTS["sphere"])
    reversed_spectrum = emitter("sphere", **{**LIGHTS["sphere"], "radiance": SPECTRUM[::-1]})
    assert irradiance(light).value != pytest.approx(irradiance(reversed_spectrum).value, rel=1e-3)
    assert spectrum_length(light) == 4
    assert stacked([irradiance(one(light, k)) for k in range(4)]).value == pytest.approx(
        irradiance(light).value
    )
