"""Black boxes: functions with every habit that functions have been seen to have."""

from __future__ import annotations

import sys
import time
import warnings

import numpy as np
import pytest

from radiokit.checks.judge import check
from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.bsdf import bsdf
from radiokit.facts.directions import spherical_to_cartesian
from radiokit.facts.errors import CallableError, ParameterError, RadiokitError
from radiokit.facts.verdict import Outcome

WI = spherical_to_cartesian([0.1, 0.5, 1.2, 0.9], [0.0, 2.0, 4.0, 5.0])
WO = spherical_to_cartesian([0.4, 0.2, 0.7, 1.4], [1.0, 3.0, 0.5, 2.0])


def smooth(wi, wo):
    return (1 + wi[..., 2] * wo[..., 2]) / (4 * np.pi)


def only_scalars(wi, wo):
    return float(1 + wi[2] * wo[2]) / (4 * np.pi)


def only_one_row(wi, wo):
    (row,), (other,) = wi, wo
    return only_scalars(row, other)


def branching(wi, wo):
    return only_scalars(wi, wo) if wi[2] > 0 else 0.0


BUFFER = np.empty(1 << 20)


def one_buffer(wi, wo):
    BUFFER[: len(wi)] = smooth(wi, wo)
    return BUFFER[: len(wi)]


def destructive(wi, wo):
    value = smooth(wi, wo)
    wi *= 0.0
    wo += 1.0
    return value


def warning(wi, wo):
    warnings.warn("watch out", stacklevel=2)
    np.log(np.zeros(1))  # NumPy's own warning
    return smooth(wi, wo)


def printing(wi, wo):
    print("hello", wi[0])  # noqa: T201
    sys.stderr.write("and here\n")
    return smooth(wi, wo)


@pytest.mark.parametrize(
    ("f", "note"),
    [
        (smooth, ""),
        (only_scalars, "is called pair by pair"),
        (only_one_row, "is called pair by pair"),
        (branching, "is called pair by pair"),
        (lambda wi, wo: list(smooth(wi, wo)), ""),
        (lambda wi, wo: smooth(wi, wo)[:, None], ""),
        (lambda wi, wo: smooth(wi, wo).astype(np.float32), "returns float32"),
        (lambda wi, wo: smooth(wi, wo) + 0j, ""),
        (one_buffer, ""),
        (destructive, "writes into its inputs"),
        (warning, "warns: UserWarning: watch out"),
        (printing, "prints: hello"),
    ],
    ids=lambda value: getattr(value, "__name__", None),
)
def test_any_habit_gives_the_same_values(f, note, capfd):
    model = as_bsdf(f, label="theirs")
    value = model(WI, WO)
    assert value == pytest.approx(smooth(WI, WO), rel=1e-6)
    again = model(WI[::-1], WO[::-1])
    assert value == pytest.approx(again[::-1], rel=1e-6)  # the first result was not overwritten
    assert any(note in text for text in model.notes) if note else not model.notes
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("f", [one_buffer, destructive, warning, printing], ids=lambda f: f.__name__)
def test_any_habit_gets_a_sensible_report(f, capfd):
    report = check(f)
    assert report.ok
    assert capfd.readouterr() == ("", "")


def test_channels_are_judged_one_by_one():
    report = check(lambda wi, wo: np.outer(smooth(wi, wo), [0.1, 1.0, 2.5]))
    assert report["energy"].outcome is Outcome.VIOLATED
    assert report["energy"].estimate.value == pytest.approx(2.5 * (1 / 4 + 1 / 6), rel=1e-9)
    assert report["reciprocity"].outcome is Outcome.HOLDS


def test_a_constant_and_a_length_are_not_mistaken_for_each_other():
    constant = as_bsdf(lambda wi, wo: 1 / np.pi)
    assert constant.mode == "batch"
    assert constant(WI, WO) == pytest.approx(np.full(4, 1 / np.pi))
    assert as_bsdf(lambda wi, wo: np.full(len(wi), 1 / np.pi)).mode == "batch"


def test_a_function_that_mixes_up_rows_is_called_pair_by_pair():
    model = as_bsdf(lambda wi, wo: np.sum(wi * wo) / 10)  # a dot product of whole arrays
    assert "mixes up the rows" in model.notes[0]
    assert model(WI, WO) == pytest.approx(np.sum(WI * WO, axis=1) / 10)


def test_float32_does_not_count_as_a_violation():
    report = check(lambda wi, wo: np.full(len(wi), 1 / np.pi, dtype=np.float32))
    assert report.ok
    assert report["energy"].details["tolerance"] > 1e-7


def test_float32_hides_no_violation_that_it_can_resolve():
    assert not check(lambda wi, wo: np.full(len(wi), 1.0001 / np.pi, dtype=np.float32)).ok


def bad(result):
    return lambda wi, wo: result


@pytest.mark.parametrize(
    ("f", "says"),
    [
        (bad(None), "returned None: is a return statement missing?"),
        (bad("0.3"), "returned str that is no array of real numbers"),
        (bad({"f": 1}), "returned dict that is no array of real numbers"),
        (bad(1 + 1j), "returned complex that is no array of real numbers"),
        (bad([[1.0], [1.0, 2.0]]), "returned list that is no array of real numbers"),
        (bad(np.zeros((2, 2, 2))), r"returned shape \(2, 2, 2\)"),
        (bad(np.zeros(0)), "returned"),
        (lambda wi: wi, "raised TypeError"),
        (lambda wi, wo: missing_name, "raised NameError: name 'missing_name' is not defined"),  # noqa: F821
        (lambda wi, wo: sys.exit(3), "raised SystemExit: 3"),
    ],
)
def test_what_is_no_value_is_said_in_one_line(f, says):
    with pytest.raises(CallableError, match=says) as caught:
        as_bsdf(f, label="theirs")
    assert "\n" not in str(caught.value)
    assert str(caught.value).startswith("theirs ")


def test_an_exception_names_the_directions_that_raise_it():
    def picky(wi, wo):
        if np.any(wi[:, 2] < 0.01):
            raise ValueError("too low")
        return smooth(wi, wo)

    with pytest.raises(CallableError, match="raised ValueError: too low at wi = ") as caught:
        check(picky)
    offender = caught.value.fields["wi"]
    assert offender[2] < 0.01
    with pytest.raises(ValueError, match="too low"):
        picky(offender[None], caught.value.fields["wo"][None])


def test_nan_is_a_verdict_and_not_a_crash():
    report = check(lambda wi, wo: np.where(wi[:, 2] > 0.999, np.nan, 0.1))
    assert report["values"].outcome is Outcome.VIOLATED
    assert report["energy"].outcome is not Outcome.HOLDS
    assert report["reciprocity"].outcome is not Outcome.HOLDS


def test_a_slow_function_is_searched_more_coarsely_and_the_report_says_so():
    def slow(wi, wo):
        time.sleep(1e-5)
        return float(1 + wi[2] * wo[2]) / (4 * np.pi)

    start = time.perf_counter()
    report = check(slow, seconds=1.0)
    assert time.perf_counter() - start < 120
    assert report.ok
    assert any("searches are coarser" in note for note in report.notes)
    assert report["energy"].details["scan_step_deg"] > 0.15


def test_a_slow_function_is_still_convicted():
    def slow(wi, wo):
        time.sleep(1e-5)
        return 1.2 / np.pi

    assert check(slow, seconds=1.0)["energy"].outcome is Outcome.VIOLATED


def test_a_sampler_may_come_along():
    f = bsdf("ggx", alpha=0.2)
    model = as_bsdf(f.evaluate, pdf=f.pdf, sample=f.sample)
    assert check(model)["sampling"].outcome is Outcome.HOLDS
    wrong = as_bsdf(f.evaluate, pdf=f.pdf, sample=bsdf("lambert").sample)
    assert check(wrong)["sampling"].outcome is Outcome.VIOLATED


def test_an_object_with_pdf_and_sample_brings_its_sampler():
    class Theirs:
        model = bsdf("phong")

        def __call__(self, wi, wo):
            return self.model.evaluate(wi, wo)

        def pdf(self, wi, wo):
            return self.model.pdf(wi, wo)

        def sample(self, u, wo):
            return self.model.sample(u, wo)

    assert as_bsdf(Theirs()).has_sampler
    assert "Theirs" in repr(as_bsdf(Theirs()))


def test_a_sampler_of_the_wrong_shape_is_named():
    model = as_bsdf(smooth, pdf=lambda wi, wo: wi[:, 2] / np.pi, sample=lambda u, wo: (wo[0], 1.0))
    with pytest.raises(CallableError, match="returned shapes"):
        check(model)


def test_without_a_sampler_the_cosine_hemisphere_is_sampled(rng):
    model = as_bsdf(smooth)
    wo = np.broadcast_to(WO[0], (1 << 16, 3))
    wi, weight = model.sample(rng.random((1 << 16, 2)), wo)
    assert weight == pytest.approx(model.evaluate(wi, wo) * wi[:, 2] / model.pdf(wi, wo))
    assert "sampling" not in [verdict.check for verdict in check(model)]


def test_a_bsdf_is_returned_as_it_is():
    f = bsdf("lambert")
    assert as_bsdf(f) is f
    with pytest.raises(ParameterError, match="a BSDF or a callable"):
        as_bsdf(3.0)
    with pytest.raises(RadiokitError, match="no symbolic twin"):
        as_bsdf(smooth).symbolic()
