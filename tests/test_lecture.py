"""The lecture's ledger: its verdicts come from the checks, which find printed and planted slips."""

from __future__ import annotations

import json
import pickle
from dataclasses import replace

import pytest

import radiokit as rk
from radiokit.faces.cli import main
from radiokit.faces.validate import validate
from radiokit.facts.errors import ParameterError, UnknownNameError
from radiokit.facts.verdict import Evidence, Outcome
from radiokit.worlds.lecture.deciding import Derived, Evaluated, Experiment, Formula, Term, Unit, found
from radiokit.worlds.lecture.entry import TITLES, Entry, Word
from radiokit.worlds.lecture.experiments.beams import hemisphere
from radiokit.worlds.lecture.experiments.materials import diffuse_albedo, sum_of_lamps
from radiokit.worlds.lecture.experiments.quantities import total_flux
from radiokit.worlds.lecture.ledger import Claim, entries
from radiokit.worlds.lecture.printed import clashes, read, values

ENTRIES = {entry.name: entry for entry in entries()}


@pytest.fixture(scope="module", autouse=True)
def proofs(tmp_path_factory):
    """Proofs are kept between these tests, and away from the user's cache."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("RADIOKIT_CACHE_DIR", str(tmp_path_factory.mktemp("proofs")))
        yield


@pytest.fixture(scope="module")
def ledger():
    return rk.lecture_claims()


# --- the ledger ---


@pytest.mark.parametrize("name", ENTRIES)
def test_every_check_says_what_the_reading_says(ledger, name):
    claim = ledger[name]
    assert claim.ok, f"{claim.verdict}: {claim.found.message}; {claim.amended and claim.amended.message}"
    assert (claim.found.witness is not None) == (claim.found.outcome is Outcome.VIOLATED)
    assert claim.judgement.outcome is Outcome.HOLDS
    assert claim.judgement.evidence is not Evidence.REFUTED
    assert pickle.loads(pickle.dumps(claim.judgement)) == claim.judgement


def test_the_ledger_is_large_and_goes_by_slides(ledger):
    slides = [claim.entry.slide for claim in ledger]
    assert len(ledger) >= 45
    assert slides == sorted(slides)
    assert set(ledger.counts()) == {"holds", "holds only if", "misprint"}
    assert sum(ledger.counts().values()) == len(ledger)
    assert ledger.ok
    assert len(TITLES) == 50


@pytest.mark.parametrize("name", ENTRIES)
def test_every_line_is_told_in_both_languages_and_names_what_exists(name):
    entry = ENTRIES[name]
    cyrillic = set("абвгдежзийклмнопрстуфхцчшщъыьэюя")
    assert set(entry.russian.lower()) & cyrillic or "∫" in entry.russian
    assert entry.english
    assert not set(entry.english.lower()) & cyrillic
    assert not entry.derivation or entry.derivation in rk.list_derivations()
    assert not entry.case or entry.case in rk.list_cases()
    named = [check.name for check in (*entry.checks, *entry.amended) if isinstance(check, Derived)]
    assert not named or entry.derivation


@pytest.mark.parametrize("name", [name for name, entry in ENTRIES.items() if entry.condition])
def test_every_condition_is_needed(name):
    """Each check of the printed line that has its like with the condition fails without it."""
    entry = ENTRIES[name]
    for check in entry.checks:
        alike = [other for other in entry.amended if type(other) is type(check)]
        if check not in alike and alike:
            assert check.judge(entry.printed).outcome is Outcome.VIOLATED


# --- the known slips, found on the printed formulas ---


SLIPS = {
    "irradiance-of-a-beam": ("unit", "a solid angle dω is missing on the right"),
    "brdf": ("order", "L_i, not dL_i, is meant"),
    "brdf-again": ("order", "L_i, not dL_i, is meant"),
    "sum-over-lamps": ("unit", "Δω_j"),
    "flux-of-a-point-source": ("unit", "Ω₀ = 1 sr"),
    "diffuse-one-over-pi": ("unit", "Ω₀ = 1 sr"),
    "sum-of-reflections": ("unit", "W/m²"),
}


@pytest.mark.parametrize("name", SLIPS)
def test_the_checker_finds_the_slip_on_the_printed_formula(name):
    entry = ENTRIES[name]
    symbols = next(check.symbols for check in entry.checks if isinstance(check, Formula))
    (clash,) = clashes(read(entry.printed, symbols))
    code, words = SLIPS[name]
    assert clash.code == code
    assert words in str(clash)
    amended = next(check for check in entry.amended if isinstance(check, Formula))
    assert not clashes(read(entry.corrected or entry.printed, amended.symbols))


def test_the_slips_that_no_unit_shows_are_found_by_experiment():
    """A mirror without a delta, a lamp that is not isotropic, a grey surface, a lumen of 2 cd."""
    for name, words in (
        ("mirror-brdf", "radiance 3.2e-08 of 1 is seen"),
        ("flux-of-a-point-source", "a flat Lambertian lamp of 1 W/sr along its axis gives 3.1416 W"),
        ("diffuse-one-over-pi", "f = 0.5/π"),
        ("lumen", "2 cd into 1 sr is 2 lm"),
        ("no-subsurface-scattering", "GGX has f ="),
    ):
        claim = Claim(ENTRIES[name])
        assert claim.found.outcome is Outcome.VIOLATED
        assert words in claim.found.message
    assert Formula().judge(ENTRIES["mirror-brdf"].printed).ok


def test_terms_and_units_are_looked_up():
    assert "is luminous energy [lm s]" in Term("световая энергия", "radiant energy").judge("").message
    assert Term("энергия излучения", "radiant energy").judge("").ok
    assert "no term" in Term("излучение", "radiance").judge("").message
    assert "Ст" in Unit("radiant_intensity").judge("Вт / Ст").message
    assert "W/sr" in Unit("radiant_intensity").judge("Вт").message
    assert Unit("radiant_intensity").judge("Вт / ср").ok


# --- verdicts are computed ---


def test_a_misprint_that_is_put_right_holds_and_is_reported():
    entry = ENTRIES["irradiance-of-a-beam"]
    claim = Claim(replace(entry, printed=entry.corrected))
    assert claim.verdict is Word.HOLDS
    assert not claim.ok
    assert claim.judgement.outcome is Outcome.VIOLATED
    assert claim.judgement.witness is not None


def test_a_correction_that_is_wrong_too_is_reported():
    entry = ENTRIES["irradiance-of-a-beam"]
    claim = Claim(replace(entry, corrected=r"dE(p, \omega_i) = L_i(p, \omega_i) d\omega_i dS"))
    assert claim.verdict is Word.WRONG
    assert not claim.ok


def test_a_planted_slip_in_a_right_formula_is_wrong():
    entry = ENTRIES["radiance"]
    claim = Claim(replace(entry, printed=r"L = \frac{d\Phi}{d\omega dS \cos\theta}"))
    assert claim.verdict is Word.WRONG
    assert claim.judgement.outcome is Outcome.VIOLATED


@pytest.mark.parametrize(
    ("name", "right", "wrong"),
    [
        ("radiance", r"\cos\theta", r"2 \cos\theta"),
        ("radiance-from-others", r"\frac{dM}{", r"\frac{dM}{2 "),
        ("intensity", r"\frac{d\Phi}", r"\frac{2 d\Phi}"),
        ("irradiance", r"\frac{d\Phi}", r"\frac{2 d\Phi}"),
        ("exitance", r"\frac{d\Phi}", r"\frac{2 d\Phi}"),
        ("flux-of-a-point-source", r"4\pi", r"2\pi"),
        ("diffuse-one-over-pi", r"\pi", r"2 \pi"),
        ("sum-over-lamps", r"\sum", r"2 \sum"),
        ("reflection-integral", r"\cos \theta_i", r"\cos^2 \theta_i"),
        ("reflection-integral", r"L_i", r"2 L_i"),
        ("brdf-conserves-energy", r"\cos \theta'", r"2 \cos \theta'"),
    ],
)
def test_a_planted_factor_that_no_unit_shows_is_wrong(name, right, wrong):
    entry = ENTRIES[name]
    assert right in entry.printed
    assert Claim(replace(entry, printed=entry.printed.replace(right, wrong, 1))).verdict is Word.WRONG


@pytest.mark.parametrize("name", ["irradiance-of-a-beam", "brdf", "brdf-again"])
def test_a_planted_factor_in_a_correction_is_wrong(name):
    entry = ENTRIES[name]
    assert Claim(replace(entry, corrected=entry.corrected.replace("L_i", "2 L_i"))).verdict is Word.WRONG


def test_a_formula_that_gives_out_more_than_it_gets_breaks_the_limit():
    numbers = {"name": "blinn_phong", "exponent": 10.0, "normalization": "n+8"}
    printed = ENTRIES["brdf-conserves-energy"].printed
    assert Evaluated(hemisphere, {"name": "blinn_phong", "exponent": 10.0}).judge(printed).ok
    assert Evaluated(hemisphere, numbers).judge(printed).outcome is Outcome.VIOLATED


def test_a_symbol_without_a_number_is_said():
    with pytest.raises(ParameterError, match="known are E"):
        values(read("E = M"), {"E": 1.0})


def test_a_condition_that_is_not_needed_is_reported():
    entry = ENTRIES["flux-of-a-point-source"]
    symbols = {"Полный поток": "radiant_flux", "π": "sr"}
    needless = (Formula(symbols), Experiment(total_flux, {"isotropic": True}))
    claim = Claim(replace(entry, checks=needless))
    assert claim.verdict is Word.HOLDS
    assert not claim.ok


def test_a_condition_that_does_not_help_is_wrong():
    entry = ENTRIES["sum-over-lamps"]
    claim = Claim(replace(entry, amended=(Experiment(sum_of_lamps, {"factor": "radiance"}),)))
    assert claim.verdict is Word.WRONG


def test_what_is_not_decided_is_no_verdict():
    entry = ENTRIES["diffuse-one-over-pi"]

    def open_question():
        return replace(diffuse_albedo(1.0)[0], outcome=Outcome.INCONCLUSIVE)

    claim = Claim(replace(entry, checks=(Experiment(open_question),)))
    assert claim.verdict is Word.UNDECIDED
    assert claim.judgement.outcome is Outcome.INCONCLUSIVE


def test_a_number_outside_its_bound_is_refuted():
    assert found("near", 1.0, 1.1, 0.2).ok
    assert found("near", 1.0, 1.1, 0.05).witness is not None
    assert not found("near", float("nan"), 1.0, 0.05).ok


def test_an_entry_must_show_what_it_adds():
    entry = ENTRIES["radiance"]
    with pytest.raises(ParameterError, match="amended"):
        replace(entry, condition="always", condition_ru="всегда")
    with pytest.raises(ParameterError, match="both languages"):
        replace(entry, condition="always", amended=(Formula(),))
    with pytest.raises(ParameterError, match="from 1 to 50"):
        Entry(name="x", slide=51, printed="x", english="x", russian="ы", checks=())


# --- reading what is printed ---


@pytest.mark.parametrize(
    ("latex", "right"),
    [
        (r"\Phi = dQ / dt", True),
        (r"\Phi = Q / dt", False),
        (r"\Phi = dQ", False),
        (r"L = \frac{d^2\Phi}{d\omega dS \cos\theta}", True),
        (r"L = \frac{d\Phi}{d\omega dS \cos\theta}", False),
        (r"L = \frac{d^2\Phi}{dS \cos\theta}", False),
        (r"L = \frac{dI}{dS \cos \theta} = \frac{dE}{d\omega \cos \theta}", True),
        (r"L = \frac{dI}{dS \cos \theta} = \frac{dE}{dS \cos \theta}", False),
        (r"L = \frac{I}{dS \cos \theta}", False),
        (r"\int f_r \cos \theta' d\omega' \leq 1", True),
        (r"\int f_r \cos \theta' \leq 1", False),
        (r"\int f_r L \cos \theta' d\omega' \leq 1", False),
        (r"dL_o(p, \omega_o) \propto dE(p, \omega_i)", True),
        (r"dL_o(p, \omega_o) \propto E(p, \omega_i)", False),
        (r"L = \sum_{j=0}^{n-1} f_r L_i^j \cos \theta_i^j d\omega_j", False),
        (r"D\Phi_R = D\Phi_O + \Phi_T", False),
        (r"E = M", False),
        (r"\cos \omega = 1", False),
    ],
)
def test_printed_formulas_right_and_wrong(latex, right):
    assert (not clashes(read(latex))) is right


@pytest.mark.parametrize(
    ("latex", "words"),
    [
        (r"E = ", "complete"),
        (r"E = \frac{I}", "complete"),
        ("E", "an equation"),
        ("E = X", "explained"),
        ("E = 3 & 4", "signs that the reader knows"),
        (r"E = L )", "an equation"),
    ],
)
def test_what_cannot_be_read_is_said(latex, words):
    with pytest.raises(ParameterError, match=words):
        read(latex)


# --- how it is shown ---


def test_slides_are_found_by_number_and_by_title():
    assert {claim.entry.slide for claim in rk.lecture_claims(slide=38)} == {38}
    assert {claim.entry.slide for claim in rk.lecture_claims(slide="ДФО (")} == {38, 39}
    with pytest.raises(ParameterError, match="from 1 to 50"):
        rk.lecture_claims(slide=0)
    with pytest.raises(ParameterError, match="part of a slide's title"):
        rk.lecture_claims(slide="no such title")
    with pytest.raises(ParameterError, match="misprint"):
        rk.lecture_claims(slide=38, verdict="typo")
    with pytest.raises(UnknownNameError, match="did you mean 'radiance'"):
        rk.lecture_claims()["radianse"]


def test_a_line_and_the_ledger_show_themselves(ledger):
    text = str(ledger["flux-of-a-point-source"])
    assert "holds only if the source is isotropic" in text
    assert "derivation: isotropic-flux" in text
    assert "источник изотропный" in text
    assert "misprint" in ledger._repr_html_()
    assert "<pre>" in ledger[0]._repr_html_()
    data = json.loads(json.dumps(ledger.to_json(), allow_nan=False))
    assert data["ok"]
    assert len(data["claims"]) == len(ledger)


def test_the_command_lists_filters_and_explains(capsys):
    def run(*words):
        with pytest.raises(SystemExit) as caught:
            main(["lecture", *words])
        shown = capsys.readouterr()
        assert not shown.err or caught.value.code == 2
        return caught.value.code, shown.out or shown.err

    code, text = run("--slide", "38", "--verdict", "misprint", "--json")
    claims = json.loads(text)["claims"]
    assert code == 0
    assert [claim["name"] for claim in claims] == ["irradiance-of-a-beam"]
    assert claims[0]["found"]["witness"]["values"]["clash"]
    code, text = run("brdf")
    assert code == 0
    assert "L_i, not dL_i, is meant" in text
    code, text = run("--slide", "39")
    assert code == 0
    assert "misprint: 1" in text
    assert run("--slide", "99")[0] == 2


def test_validate_takes_the_lecture(monkeypatch):
    part = tuple(ENTRIES[name] for name in ("brdf", "lumen", "radiance"))
    monkeypatch.setattr("radiokit.worlds.lecture.ledger.entries", lambda: part)
    run = validate(names=["lecture"])
    assert [verdict.check for verdict in run.lecture] == ["brdf", "lumen", "radiance"]
    assert run.outcome is Outcome.HOLDS
    assert len(run.to_json()["lecture"]) == 3
    wrong = replace(part[2], printed=r"L = \frac{d\Phi}{d\omega dS}")
    monkeypatch.setattr("radiokit.worlds.lecture.ledger.entries", lambda: (wrong,))
    assert validate(names=["lecture"]).exit_code == 1
