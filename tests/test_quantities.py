"""Quantities: the steradian counts, kinds do not mix, terms are found by all names, and messages teach."""

from __future__ import annotations

import pickle
import subprocess
import sys

import numpy as np
import pint
import pytest

from radiokit.facts.errors import ParameterError, QuantityKindError, UnknownNameError
from radiokit.facts.quantities import Q, list_quantities, quantity
from radiokit.facts.source import Source
from radiokit.facts.tagged import Tagged

TERMS = [quantity(name) for name in list_quantities()]
E, M, FLUX = quantity("irradiance"), quantity("exitance"), quantity("flux")


def message(error, deed):
    with pytest.raises(error) as caught:
        deed()
    return str(caught.value)


# ---------------------------------------------------------------- the registry


def test_importing_quantities_loads_no_pint():
    code = (
        "import sys; from radiokit.facts.quantities import Q, list_quantities, quantity; "
        "quantity('radiance'); list_quantities(); assert 'pint' not in sys.modules; "
        "Q('1 W'); assert 'pint' in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


@pytest.mark.parametrize(
    ("one", "other"),
    [("W/sr", "W"), ("cd", "lm"), ("sr", "1"), ("sr", "rad^2"), ("lx", "cd/m^2"), ("W/m^2", "W/(m^2 sr)")],
)
def test_the_steradian_counts(one, other):
    with pytest.raises(pint.DimensionalityError):
        Q(1.0, one) + Q(1.0, other)
    # pint's own registry sees no difference, which is why there is another one
    assert pint.UnitRegistry().Quantity(1.0, one).is_compatible_with(other)


@pytest.mark.parametrize(
    ("one", "other", "factor"),
    [
        ("lm", "cd sr", 1),
        ("lx", "lm/m^2", 1),
        ("nit", "cd/m^2", 1),
        ("phot", "lx", 1e4),
        ("foot_candle", "lx", 1 / 0.3048**2),
        ("foot_lambert", "cd/m^2", 1 / np.pi / 0.3048**2),
        ("lambert", "cd/m^2", 1e4 / np.pi),
        ("rad", "1", 1),
        ("degree", "rad", np.pi / 180),
        ("square_degree", "sr", (np.pi / 180) ** 2),
        ("W/(m^2 nm)", "W/m^3", 1e9),
        ("eV", "J", 1.602176634e-19),
        ("erg/s", "W", 1e-7),
        ("mW/cm^2", "W/m^2", 10),
    ],
)
def test_units_convert(one, other, factor):
    np.testing.assert_allclose(Q(1.0, one).to(other).magnitude, factor, rtol=1e-14)


@pytest.mark.parametrize(
    "text", ["W/(m^2 sr)", "W/m²/sr", "W·m⁻²·sr⁻¹", "W m-2 sr-1", "W / (m**2 * sr)", "Вт/(м² ср)", "Вт/м2/ср"]
)
def test_units_may_be_spelled_in_many_ways(text):
    assert Q("5 " + text) == Q(5.0, text) == 5.0 * Q("W/sr/m^2")
    assert str(Q("5 " + text)) == "5.0 W/m²/sr"


def test_quantities_take_arrays_numbers_and_quantities():
    np.testing.assert_array_equal(Q([1.0, 2.0], "W").magnitude, [1.0, 2.0])
    assert Q(Q("5 W"), "mW").magnitude == 5000.0
    assert Q(E("5 W/m^2")) == Q("5 W/m^2")
    foreign = pint.UnitRegistry().Quantity(5.0, "W/sr")
    assert Q(foreign) == Q("5 W/sr")
    assert not Q(foreign).is_compatible_with("W")


def test_pints_application_registry_is_left_alone():
    before = pint.get_application_registry().get()
    assert Q("1 W/sr").to_base_units().magnitude == 1.0
    assert pint.get_application_registry().get() is before
    assert pint.Quantity(1.0, "sr").dimensionless


@pytest.mark.parametrize("value", [Q("5 W/sr"), Q([1.0, 2.0], "lx"), Q("1 sr").units])
def test_pickling_comes_back_to_this_registry(value):
    again = pickle.loads(pickle.dumps(value))
    assert np.all(again == value)
    assert not (again * Q("1 sr")).is_compatible_with(again * Q("1"))


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (
            ("5 wat",),
            "value = '5 wat' is not allowed: it must be a number and units, such as '5 W/(m^2 sr)' "
            "(there is no unit 'wat'; did you mean 'watt'?)",
        ),
        (
            ("5 W/(sr",),
            "value = '5 W/(sr' is not allowed: it must be a number and units, such as '5 W/(m^2 sr)'",
        ),
        (("",), "value = '' is not allowed: it must be a number and units, such as '5 W/(m^2 sr)'"),
        ((None,), "value = None is not allowed: it must be a number and units, such as '5 W/(m^2 sr)'"),
        (
            ("5", "W"),
            "value = '5' is not allowed: it must be a number or an array, since its unit is given besides",
        ),
    ],
)
def test_what_cannot_be_read_is_named(arguments, expected):
    assert message(ParameterError, lambda: Q(*arguments)) == expected


# ---------------------------------------------------------------- the terms


def test_the_catalogue_is_complete():
    kinds = [term.kind for term in TERMS]
    assert {kind: kinds.count(kind) for kind in dict.fromkeys(kinds)} == {
        "radiometric": 6,
        "spectral": 6,
        "photometric": 6,
        "geometric": 1,
        "scattering": 2,
    }


@pytest.mark.parametrize("term", TERMS, ids=list_quantities())
def test_each_term_is_found_by_all_its_names(term):
    names = (term.name, term.english, term.russian, *term.aliases)
    spellings = {s for n in names for s in (n, n.upper(), n.replace(" ", "-"), n.replace(" ", "_"), f" {n} ")}
    spellings |= {n.replace("ё", "е") for n in names}
    assert {quantity(spelling).name for spelling in spellings} == {term.name}


@pytest.mark.parametrize("term", TERMS, ids=list_quantities())
def test_each_term_is_whole(term):
    assert all((term.symbol, term.unit, term.english, term.russian, term.definition, term.meaning))
    assert isinstance(term.source, Source)
    assert term.definition.startswith(f"{term.symbol} = ")
    assert isinstance(term(2.0, term.unit), Tagged)
    assert term.to_json()["source"]["year"] in (1977, 2019)
    if term.kind in ("radiometric", "photometric"):
        twin = quantity(term.twin)
        assert quantity(twin.twin).name == term.name
        # the same per area, angle and time: only the watt is a lumen
        lumen = {"radiometric": "lm", "photometric": "W"}[term.kind]
        watt = {"radiometric": "W", "photometric": "lm"}[term.kind]
        assert (Q(term.unit) / Q(watt) * Q(lumen)).is_compatible_with(twin.unit)
    if term.kind in ("radiometric", "spectral"):
        other = quantity(term.spectral)
        assert quantity(other.spectral).name == term.name
        whole, part = (term, other) if term.kind == "radiometric" else (other, term)
        assert (Q(whole.unit) / Q("nm")).units == Q(part.unit).units


@pytest.mark.parametrize(
    ("russian", "name"),
    [
        ("энергия излучения", "radiant_energy"),
        ("поток излучения", "radiant_flux"),
        ("сила излучения", "radiant_intensity"),
        ("облучённость", "irradiance"),
        ("энергетическая светимость", "radiant_exitance"),
        ("энергетическая яркость", "radiance"),
        ("световая энергия", "luminous_energy"),
        ("световой поток", "luminous_flux"),
        ("сила света", "luminous_intensity"),
        ("освещённость", "illuminance"),
        ("светимость", "luminous_exitance"),
        ("яркость", "luminance"),
        ("спектральная плотность энергетической яркости", "spectral_radiance"),
        # the lecture's words, where they are no photometric term
        ("Энергетическая сила света", "radiant_intensity"),
        ("Энергетическая освещенность", "irradiance"),
        ("Поток", "radiant_flux"),
        ("Телесный угол", "solid_angle"),
    ],
)
def test_russian_terms(russian, name):
    assert quantity(russian).name == name


def test_an_unknown_term_is_named_with_the_closest_one():
    assert message(UnknownNameError, lambda: quantity("luminanse")).startswith(
        "unknown quantity 'luminanse'; did you mean 'luminance'? Known: bsdf, illuminance, "
    )
    assert "did you mean 'яркость'?" in message(UnknownNameError, lambda: quantity("яркасть"))


def test_the_steradian_catches_the_slips_of_formulas():
    radiance, f = Q("3 W/(m^2 sr)"), Q("0.3 1/sr")
    assert (radiance * Q("0.1 sr")).is_compatible_with(E.unit)  # dE = L cosθ dω
    assert not radiance.is_compatible_with(E.unit)  # dE = L cosθ, without dω
    assert (f * E("5 W/m^2")).is_compatible_with("W/(m^2 sr)")  # Lo = Σ f E_j
    assert not (f * radiance).is_compatible_with("W/(m^2 sr)")  # Lo = Σ f L_j cosθ_j
    assert (quantity("intensity")("2 W/sr") * Q(4 * np.pi, "sr")).is_compatible_with("W")


# ---------------------------------------------------------------- values that know their kind

ARRIVES_AND_LEAVES = (
    "irradiance is the flux that arrives per area [W/m^2], radiant exitance is the flux that leaves per area "
    "[W/m^2]; the unit is the same, the quantity is not"
)


@pytest.mark.parametrize(
    ("deed", "expected"),
    [
        (lambda a, b: a + b, "cannot add irradiance and radiant exitance: "),
        (lambda a, b: a - b, "cannot subtract radiant exitance from irradiance: "),
        (lambda a, b: a < b, "cannot compare irradiance with radiant exitance: "),
        (lambda a, b: a >= b, "cannot compare irradiance with radiant exitance: "),
        (lambda a, b: a == b, "cannot compare irradiance with radiant exitance: "),
        (lambda a, b: a != b, "cannot compare irradiance with radiant exitance: "),
    ],
)
def test_irradiance_and_exitance_do_not_mix(deed, expected):
    text = message(QuantityKindError, lambda: deed(E("5 W/m^2"), M("5 W/m^2")))
    assert text == expected + ARRIVES_AND_LEAVES


def test_kinds_of_other_units_do_not_mix_either():
    assert message(QuantityKindError, lambda: E("5 W/m^2") + FLUX("5 W")) == (
        "cannot add irradiance and radiant flux: irradiance is the flux that arrives per area [W/m^2], "
        "radiant flux is the energy per time [W]"
    )


@pytest.mark.parametrize("deed", [lambda a, b: a + b, lambda a, b: b + a])
def test_a_value_of_no_kind_does_not_mix(deed):
    assert message(QuantityKindError, lambda: deed(E("5 W/m^2"), Q("2 W/m^2"))) == (
        "cannot add irradiance and 2.0 W/m²: nothing says which quantity 2.0 W/m² is; "
        'if it is irradiance, write quantity("irradiance")("2.0 W/m²")'
    )
    for other in (Q("2 W/m^2"), 5.0, np.float64(5)):
        with pytest.raises(QuantityKindError):
            _ = E("5 W/m^2") == other
        with pytest.raises(QuantityKindError):
            _ = E("5 W/m^2") < other


def test_a_kind_is_not_changed_by_accident():
    assert message(QuantityKindError, lambda: E(M("5 W/m^2"))) == (
        "cannot take radiant exitance for irradiance: radiant exitance is the flux that leaves per area, "
        "irradiance is the flux that arrives per area"
    )
    assert E(M("5 W/m^2").quantity) == E("5 W/m^2") == E(E("5 W/m^2"))


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (
            ("5 W/sr",),
            "irradiance = 5.0 W/sr is not allowed: it must be in W/m^2 "
            "(W/sr is the unit of radiant intensity)",
        ),
        ((5, "W"), "irradiance = 5 W is not allowed: it must be in W/m^2 (W is the unit of radiant flux)"),
        ((5,), "irradiance = 5 is not allowed: it must be in W/m^2"),
        (("5 kg",), "irradiance = 5 kg is not allowed: it must be in W/m^2"),
    ],
)
def test_a_wrong_unit_is_told_the_right_one(arguments, expected):
    assert message(ParameterError, lambda: E(*arguments)) == expected


def test_one_kind_adds_compares_and_converts():
    a, b = E("5 W/m^2"), E("1 mW/cm^2")
    assert str(a + b) == str(sum([a, b])) == "15.0 W/m² (irradiance)"
    assert repr(a - b) == "<-5.0 W/m² (irradiance)>"
    assert a < b
    assert a <= b
    assert b > a
    assert b >= a
    assert a != b
    assert a == E("0.5 mW/cm^2")
    assert a.to("mW/cm^2").magnitude == a.magnitude_in("mW/cm^2") == 0.5
    assert f"{a:.3f}" == "5.000 W/m² (irradiance)"
    assert (a != None) is True  # noqa: E711 (the operator is what is tested)
    assert message(ParameterError, lambda: a.to("W")) == (
        "unit = 'W' is not allowed: it must be in W/m^2 (W is the unit of radiant flux)"
    )
    assert abs(-a) == a
    assert a.to_json() == {"quantity": "irradiance", "value": 5.0, "unit": "W/m²"}


@pytest.mark.parametrize("factor", [2, 2.0, np.float64(2), np.array(2.0), np.array([2.0, 2.0])])
def test_numbers_and_arrays_keep_the_kind(factor):
    for scaled in (factor * E("5 W/m^2"), E("5 W/m^2") * factor, E("20 W/m^2") / factor):
        assert isinstance(scaled, Tagged)
        assert scaled.kind is E
        assert np.all(scaled == E("10 W/m^2"))


def test_products_are_quantities_without_a_kind():
    a, area = E("5 W/m^2"), Q("2 m^2")
    for product in (a * area, area * a, a / (1 / area)):
        assert not isinstance(product, Tagged)
        assert product == Q("10 W")
    assert a / M("2 W/m^2") == Q("2.5")
    assert Q("10 W/m^2") / a == Q("2")
    assert a**2 == Q("25 W^2/m^4")
    assert (2 / a).is_compatible_with("m^2/W")


def test_arrays_of_one_kind():
    many = E(np.array([1.0, 2.0, 3.0]), "W/m^2")
    assert len(many) == 3
    assert many[1] == E("2 W/m^2")
    assert (many < E("2.5 W/m^2")).tolist() == [True, True, False]


def test_tagged_values_survive_pickling():
    again = pickle.loads(pickle.dumps(E("5 W/m^2")))
    assert again == E("5 W/m^2")
    with pytest.raises(QuantityKindError):
        _ = again == M("5 W/m^2")
    with pytest.raises(TypeError, match="unhashable"):
        hash(again)


def test_a_quantity_prints_as_text_and_as_a_table():
    radiance = quantity("radiance")
    assert str(radiance).splitlines()[0] == "radiance"
    assert "W/(m^2 sr)" in str(radiance)
    assert "энергетическая яркость" in radiance._repr_html_()
