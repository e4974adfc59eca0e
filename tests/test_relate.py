"""Relate: every relation against its own formula, its units, radiokit's functions; and what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest
import sympy

import radiokit as rk
from radiokit.facts.errors import ParameterError, QuantityKindError, RadiokitError, UnknownNameError
from radiokit.physics.relate.givens import GIVENS
from radiokit.physics.relate.table import RELATIONS
from radiokit.physics.relations import derive
from radiokit.physics.relations.notation import SR
from radiokit.worlds.lecture.printed import clashes, read

NAMES = [relation.name for relation in RELATIONS]
TARGETS = {role: given.kind for role, given in GIVENS.items() if given.kind}


def symbols(relation):
    """What the letters of a relation's formula mean."""
    found = {"π": relation.pi, "Ω_0": "sr"}
    for given in GIVENS.values():
        letter = {r"\Phi": "Φ", r"\rho": "ρ", r"\Omega": "Ω", r"\theta": "θ", r"\alpha": "α", r"\tau": "τ"}
        found[letter.get(given.symbol, given.symbol)] = given.kind or (
            "rad" if given.unit == "deg" else given.unit
        )
    for letter in ("Q", "Φ", "I", "E", "M", "L"):
        found[f"{letter}_v"] = rk.quantity(found[letter]).twin
    return found


def values(relation, rng):
    """Random givens, in the units of the table."""
    found = {}
    for name in (*relation.needs, *relation.may):
        given = GIVENS[name]
        number = float(rng.uniform(0.2, 0.9)) if name != "distance" else float(rng.uniform(1.5, 3.0))
        if given.unit == "deg":
            number = float(rng.uniform(10, 60))
        kind = given.kind
        if relation.crosses == "radiometric" and kind:
            kind = rk.quantity(kind).twin
        unit = rk.quantity(kind).unit if kind else given.unit
        found[name] = number if given.plain else rk.Q(number, unit)
    return found


@pytest.mark.parametrize("name", NAMES)
def test_the_formula_fits_its_units_and_gives_the_value(name, rng):
    """The formula is read as LaTeX; its units are checked, and its value is the relation's."""
    relation = RELATIONS[NAMES.index(name)]
    reading = read(relation.formula, symbols(relation))
    assert not clashes(reading)
    given = values(relation, rng)
    target = rk.quantity(TARGETS[relation.target])
    target = rk.quantity(target.twin) if relation.crosses == "photometric" else target
    found = rk.relate(target.name, by=name, **given)
    assert found.value.kind.name == target.name
    numbers = {SR: 1}
    letters = {value.symbol.lstrip("\\"): key for key, value in GIVENS.items()}
    greek = {"Φ": "Phi", "ρ": "rho", "Ω": "Omega", "θ": "theta", "α": "alpha", "τ": "tau"}
    for symbol in reading.sides[1].free_symbols - {SR}:
        letter = symbol.name.split("_")[0]
        key = letters[greek.get(letter, letter)]
        value = given[key]
        number = float(getattr(value, "magnitude", value))
        numbers[symbol] = math.radians(number) if GIVENS[key].unit == "deg" else number
    exact = float(reading.sides[1].subs(numbers).evalf(30))
    assert float(found.value.magnitude_in(target.unit)) == pytest.approx(exact, rel=1e-14)


def test_a_wrong_formula_is_caught():
    """The two ways of the test above: units, and the reading of the formula."""
    relation = RELATIONS[NAMES.index("irradiance-from-intensity")]
    assert clashes(read(r"E = \frac{I \cos\theta}{r} \Omega_0", symbols(relation)))
    assert clashes(read(r"E = \frac{I \cos\theta}{r^2}", symbols(relation)))
    twice = read(r"E = 2 \frac{I}{r^2} \Omega_0", symbols(relation)).sides[1]
    assert twice.subs(dict.fromkeys(twice.free_symbols, 1)) == sympy.Integer(2)


@pytest.mark.parametrize("name", sorted({relation.derivation for relation in RELATIONS}))
def test_the_derivation_exists(name):
    assert name in rk.list_derivations()


def test_the_table_is_large_and_has_no_name_twice():
    assert len(NAMES) == len(set(NAMES)) >= 25
    assert rk.list_relations() == NAMES
    assert all(relation.condition and relation.derivation for relation in RELATIONS)


def test_conditions_that_the_derivations_prove(tmp_path, monkeypatch):
    """The derivation behind the README's example holds."""
    monkeypatch.setenv("RADIOKIT_CACHE_DIR", str(tmp_path))
    assert derive("irradiance-from-intensity").ok


def test_against_the_emitters():
    """What relate says, and what the emitters of the same light give."""
    light = rk.emitter("point", position=(3.0, 0, 4.0), intensity=7.0)
    angle = math.degrees(math.atan2(3, 4))
    found = rk.relate("irradiance", intensity="7 W/sr", distance="5 m", angle_deg=angle)
    assert found.value.magnitude == pytest.approx(rk.irradiance(light).value, rel=1e-14)
    ball = rk.emitter("sphere", center=(0, 0, 4.0), radius=1.5, radiance=2.0)
    given = {"radiance": "2 W/(m^2 sr)", "radius": "150 cm", "distance": "4 m"}
    found = rk.relate("irradiance", by="irradiance-from-sphere", **given)
    assert found.value.magnitude == pytest.approx(rk.irradiance(ball).value, rel=1e-14)
    disk = rk.emitter("disk", center=(0, 0, 4.0), radius=1.5, normal=(0, 0, -1), radiance=2.0)
    found = rk.relate("irradiance", by="irradiance-under-disk", **given)
    assert found.value.magnitude == pytest.approx(rk.irradiance(disk).value, rel=1e-14)
    found = rk.relate("solid angle", radius="1.5 m", distance="4 m")
    assert found.value.magnitude == pytest.approx(rk.solid_angle(ball).value, rel=1e-14)
    sky = rk.emitter("constant", radiance=2.0)
    found = rk.relate("irradiance", radiance="2 W/(m^2 sr)")
    assert found.value.magnitude == pytest.approx(rk.irradiance(sky).value, rel=1e-14)


def test_against_the_materials_and_the_integrating_sphere():
    wo = (0.6, 0.0, 0.8)
    found = rk.relate("bsdf", reflectance=0.4)
    assert found.value.magnitude == pytest.approx(rk.bsdf("lambert", reflectance=0.4)(wo, wo), rel=1e-14)
    found = rk.relate("reflectance", bsdf=found.value)
    assert float(found.value.magnitude) == pytest.approx(0.4, rel=1e-14)
    sphere = rk.integrating_sphere.IntegratingSphere(radius=0.5, reflectance=0.97, port_share=0.02)
    found = rk.relate("radiance", flux="3 W", area=rk.Q(math.pi, "m^2"), reflectance=0.97, port_share=0.02)
    assert found.value.magnitude == pytest.approx(float(sphere.wall_radiance(flux=3.0)), rel=1e-14)


def test_photometric_values_take_the_same_relations():
    found = rk.relate("illuminance", intensity="5 cd", distance="2 m")
    assert str(found.value) == "1.25 lx (illuminance)"
    found = rk.relate("luminous flux", flux="2 W", luminous_efficacy="683 lm/W")
    assert found.value.magnitude == pytest.approx(1366)
    found = rk.relate("irradiance", illuminance="683 lx", luminous_efficacy="683 lm/W")
    assert found.value.magnitude == pytest.approx(1)


def test_arrays_and_the_ends_of_ranges():
    found = rk.relate(
        "irradiance", intensity=rk.Q(np.array([1.0, 2.0]), "W/sr"), distance="1 m", angle_deg=90
    )
    assert found.value.magnitude.tolist() == [0.0, 0.0]
    assert rk.relate("solid_angle", half_angle_deg=1e-9).value.magnitude == pytest.approx(
        math.pi * math.radians(1e-9) ** 2, rel=1e-14
    )


@pytest.mark.parametrize(
    ("target", "given", "holds"),
    [
        ("irradiance", {"intensity": "1 W/sr", "distance": "1 m"}, None),
        ("irradiance", {"intensity": "1 W/sr", "distance": "1 m", "diameter": "20 cm"}, True),
        ("irradiance", {"intensity": "1 W/sr", "distance": "1 m", "diameter": "21 cm"}, False),
        ("irradiance", {"radiance": "1 W/(m^2 sr)", "solid_angle": "1 sr"}, False),
        ("irradiance", {"radiance": "1 W/(m^2 sr)", "solid_angle": "0.01 sr"}, True),
        ("solid_angle", {"area": "1 m^2", "distance": "2 m"}, False),
        ("reflectance", {"exitance": "2 W/m^2", "irradiance": "1 W/m^2"}, False),
        ("reflectance", {"bsdf": "0.3 1/sr"}, True),
    ],
)
def test_conditions_are_judged_where_the_givens_tell(target, given, holds):
    if target == "reflectance" and holds is False:
        assert rk.relate(target, **given).fails == "more leaves than arrives"
    assert rk.relate(target, **given).condition_holds is holds


def test_the_five_times_rule_is_that_of_a_disk():
    """The error that is told is at least that of a disk taken for a point."""
    found = rk.relate("irradiance", intensity="1 W/sr", distance="2 m", diameter="1 m")
    disk = rk.emitter("disk", center=(0, 0, 2.0), radius=0.5, normal=(0, 0, -1), radiance=4 / math.pi)
    error = found.value.magnitude / rk.irradiance(disk).value - 1
    assert error == pytest.approx((1 / 4) ** 2)
    assert "6.2 %" in found.fails


@pytest.mark.parametrize(
    ("target", "given", "words"),
    [
        (
            "irradiance",
            {"intensity": "5 W/sr"},
            "for an irradiance from an intensity the distance is missing",
        ),
        (
            "irradiance",
            {"intensity": "5 W/sr", "distance": "2 m", "area": "1 m^2"},
            "for an irradiance from an intensity and a distance the area is too much",
        ),
        ("irradiance", {}, "nothing is given; what does: intensity and distance; flux and area"),
        (
            "irradiance",
            {"time": "3 s"},
            "time does not lead to an irradiance; what does: intensity and distance",
        ),
        ("flux", {"intensity": "5 W/sr"}, "choose one. by='isotropic-flux': "),
        ("irradiance", {"intensity": "5 cd", "distance": "2 m"}, "ask for 'illuminance'"),
        (
            "illuminance",
            {"illuminance": "5 lx", "luminous_efficacy": "90 lm/W"},
            "no luminous efficacy is needed",
        ),
        ("reflectance", {"exitance": "5 lm/m^2", "irradiance": "5 W/m^2"}, "do not go together"),
        ("bsdf", {"radiance": "5 W/(m^2 sr)", "irradiance": "0 W/m^2"}, "has no finite value"),
        ("intensity", {"irradiance": "1 W/m^2", "distance": "1 m", "angle_deg": 90}, "has no finite value"),
    ],
)
def test_what_is_missing_ambiguous_or_too_much_is_said(target, given, words):
    with pytest.raises(RadiokitError) as caught:
        rk.relate(target, **given)
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("given", "error", "words"),
    [
        ({"intensity": 5}, ParameterError, "a quantity with its unit, such as rk.Q('5 W/sr')"),
        ({"intensity": "5 W"}, ParameterError, "in W/sr or cd (W is the unit of radiant flux)"),
        ({"distance": "5 sr"}, ParameterError, "in m"),
        ({"distance": "-2 m"}, ParameterError, "above 0 m"),
        ({"reflectance": 1.5}, ParameterError, "at least 0 and at most 1"),
        ({"illuminance": "5 W/m^2"}, ParameterError, "in lx"),
        ({"irradiance": "1 lx", "illuminance": "1 lx"}, ParameterError, "given once"),
        ({"colour": 5}, UnknownNameError, "unknown given 'colour'"),
        ({"distanse": 5}, UnknownNameError, "did you mean 'distance'?"),
        ({"intensity": float("nan")}, ParameterError, "unit"),
        ({"irradiance": rk.quantity("radiant_exitance")("1 W/m^2")}, QuantityKindError, "flux that leaves"),
    ],
)
def test_wrong_givens_are_refused(given, error, words):
    with pytest.raises(error) as caught:
        rk.relate("irradiance", **given)
    assert words in str(caught.value)


def test_a_receiver_inside_the_sphere_is_refused():
    given = {"radiance": "1 W/(m^2 sr)", "radius": "2 m", "distance": "1 m"}
    with pytest.raises(ParameterError, match="smaller than the distance"):
        rk.relate("irradiance", by="irradiance-from-sphere", **given)


def test_unknown_targets_and_relations_are_refused():
    with pytest.raises(UnknownNameError, match="unknown target"):
        rk.relate("spectral radiance", flux="1 W")
    with pytest.raises(UnknownNameError, match="did you mean 'isotropic-flux'"):
        rk.relate("flux", by="isotropic-flx", intensity="1 W/sr")


def test_the_answer_shows_and_exports_itself():
    found = rk.relate("irradiance", intensity="5 W/sr", distance="2 m", angle_deg=30)
    assert str(found).endswith("derivation: irradiance-from-intensity")
    assert "<pre>" in found._repr_html_()
    data = found.to_json()
    assert data["derivation"] == "irradiance-from-intensity"
    assert data["condition_holds"] is None
