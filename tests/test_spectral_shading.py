"""Spectral materials under spectral lights: wavelength by wavelength, by every method."""

from __future__ import annotations

import numpy as np
import pytest

from radiokit.contracts.bsdf import bsdf
from radiokit.contracts.emitter import emitter
from radiokit.contracts.parameters import at_wavelength
from radiokit.facts.errors import ParameterError
from radiokit.worlds.scene import irradiance
from radiokit.worlds.shading import shade

SPECTRUM = (0.5, 2.0, 0.0)
LIGHTS = {
    "point": emitter("point", position=(0, 0.5, 2), intensity=SPECTRUM),
    "directional": emitter("directional", direction=(0, 1, 2), irradiance=SPECTRUM),
    "sphere": emitter("sphere", center=(2, 0, 0.3), radius=1, radiance=SPECTRUM),
    "disk": emitter(
        "disk", center=(1, 0.2, 1), normal=(-1, 0, -1), radius=1, radiance=SPECTRUM, exponent=2.0
    ),
    "rectangle": emitter(
        "rectangle", center=(0, 0, 2), normal=(0, 0, -1), width=1, height=2, radiance=SPECTRUM
    ),
    "constant": emitter("constant", radiance=SPECTRUM),
    "sky_gradient": emitter("sky_gradient", radiance=SPECTRUM, horizon=(0.0, 1.0, 2.0), normal=(0, 0.6, 0.8)),
}
MATERIALS = {
    "grey lambert": bsdf("lambert", reflectance=0.5),
    "lambert": bsdf("lambert", reflectance=(0.2, 0.5, 0.8)),
    "gloss": bsdf("phong", reflectance=(0.2, 0.5, 0.8), exponent=20.0),
    "grey gloss": bsdf("ggx", alpha=0.3),
    "mirror": bsdf("mirror", reflectance=(0.2, 0.5, 0.8)),
}
WO = (0.0, 0.6, 0.8)


def at(f, k):
    return at_wavelength(f, k)


@pytest.mark.parametrize("material", MATERIALS)
@pytest.mark.parametrize("name", LIGHTS)
def test_each_wavelength_is_shaded_by_itself(name, material):
    light, f = LIGHTS[name], MATERIALS[material]
    found = shade(f, light, WO, rtol=1e-5)
    assert np.shape(found.value) == (3,)
    for k in range(3):
        exact = shade(at(f, k), at(light, k), WO, rtol=1e-5)
        assert abs(found.value[k] - exact.value) <= found.error[k] + exact.error + 1e-14 * exact.value
    if material == "gloss" and not light.delta:
        for method in ("mc-bsdf", "mc-light", "mis", "qmc"):
            drawn = shade(f, light, WO, method=method, samples=4096, rng=1)
            one = shade(at(f, 1), at(light, 1), WO, method=method, samples=4096, rng=1)
            if not light.name.startswith("sky"):  # skies are sampled by the mean of their spectrum
                assert drawn.value[1] == pytest.approx(one.value, rel=1e-12)


@pytest.mark.parametrize("material", ["lambert", "gloss", "mirror"])
@pytest.mark.parametrize("name", LIGHTS)
def test_other_numbers_of_wavelengths_are_refused(name, material):

    f = bsdf(MATERIALS[material].name, **{**MATERIALS[material].parameters(), "reflectance": (0.5, 0.5)})
    with pytest.raises(ParameterError, match=r"wavelengths of the light = 3 .* the material's, 2"):
        shade(f, LIGHTS[name], WO)


def test_irradiance_by_quadrature_has_all_wavelengths():
    found = irradiance(LIGHTS["disk"])
    assert "over the light" in found.method
    for k in range(3):
        assert found.value[k] == pytest.approx(irradiance(at(LIGHTS["disk"], k)).value, rel=1e-9)
