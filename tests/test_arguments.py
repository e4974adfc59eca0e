"""Arguments: a wrong one is named, with its value and what would be right, wherever it is given."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

import radiokit as rk

GGX = rk.bsdf("ggx", alpha=0.3)
SKY = rk.emitter("constant", radiance=1.0)
ROOM = rk.enclosure.Box(walls=rk.enclosure.Wall())
WO = (0.0, 0.6, 0.8)


def cosine(w: Any) -> Any:
    return w[:, 2]


def uniform(generator: np.random.Generator, n: int) -> Any:
    return generator.random(n)


def verdict(outcome: Any = "holds", evidence: Any = "proved") -> rk.Verdict:
    return rk.Verdict(check="sum", claim="1 + 1 = 2", outcome=outcome, evidence=evidence)


WRONG: tuple[tuple[Callable[[], Any], str], ...] = (
    (lambda: rk.albedo(GGX, WO, rtol=-1), "rtol = -1 .* above 0"),
    (lambda: rk.albedo(GGX, WO, rtol=0), "rtol = 0 .* above 0"),
    (lambda: rk.albedo(GGX, WO, rtol="fine"), "rtol = 'fine' .* above 0"),
    (lambda: rk.albedo(GGX, WO, method="mc", seconds="few"), "seconds = 'few' .* above 0"),
    (lambda: rk.albedo(GGX, WO, method="mc", rng="seed"), "rng = 'seed' .*Generator"),
    (lambda: rk.shade(GGX, 3, WO), "emitter = 3 .* an emitter"),
    (lambda: rk.explain(GGX, SKY, WO, rtol="fine"), r"rtol = 'fine' .* \(0, 1\)"),
    (lambda: rk.check(GGX, seconds="few"), "seconds = 'few' .* greater than 0"),
    (lambda: rk.check(GGX, tolerance="small"), r"tolerance = 'small' .* \[0, 1\)"),
    (lambda: rk.coated(GGX, coat=3), "coat = 3 .* a BSDF"),
    (lambda: rk.diagnose([1.0], [2.0], inputs=3), "inputs = 3 .* a mapping"),
    (lambda: rk.diagnose([1.0], [2.0], rtol="fine"), r"rtol = 'fine' .* \(0, 0.1\]"),
    (lambda: rk.enclosure.Box(walls=3), "walls = 3 .* one Wall, or six"),
    (lambda: rk.enclosure.Box(walls=rk.enclosure.Wall(), lights=3), "lights = 3 .* point lights"),
    (lambda: rk.enclosure.Sphere(wall=rk.enclosure.Wall(), radius="wide"), "radius = 'wide' .* a number"),
    (lambda: rk.enclosure.irradiance(ROOM, position=(0, 0.5, 0.5), rtol=-1), "rtol = -1 .* above 0"),
    (lambda: rk.irradiance(SKY, rtol="fine"), r"rtol = 'fine' .* \(0, 1\)"),
    (lambda: rk.lecture_claims(slide=1.5), "slide = 1.5 .* from 1 to 50"),
    (lambda: rk.montecarlo.mean(3, samples=10), "draw = 3 .* a function"),
    (lambda: rk.montecarlo.mean(uniform, samples=10, rtol="fine"), "rtol = 'fine' .* above 0"),
    (lambda: rk.quadrature.hemisphere(3), "integrand = 3 .* a function"),
    (lambda: rk.quadrature.hemisphere(cosine, rtol=-1), "rtol = -1 .* at least 0"),
    (lambda: rk.quadrature.hemisphere(cosine, width=-1), "width = -1 .* above 0"),
    (lambda: rk.quadrature.hemisphere(cosine, wo="up"), "wo = 'up' .* above the horizon"),
    (lambda: rk.quadrature.hemisphere(cosine, wo=(0, 0, -1)), "wo = .* above the horizon"),
    (lambda: rk.quadrature.box(cosine, "left", (1, 1)), "low = 'left' .* finite"),
    (lambda: rk.quadrature.box(cosine, (0, 0), (1, 1), atol=-1), "atol = -1 .* at least 0"),
    (lambda: rk.Twin(3), "expression = 3 .* SymPy"),
    (
        lambda: verdict(outcome="maybe"),
        "outcome = 'maybe' .* holds",
    ),
    (
        lambda: verdict(evidence="guess"),
        "evidence = 'guess' .* proved",
    ),
)


@pytest.mark.parametrize(("call", "message"), WRONG, ids=[message for _, message in WRONG])
def test_a_wrong_argument_is_named(call: Callable[[], Any], message: str) -> None:
    with pytest.raises(rk.errors.ParameterError, match=message):
        call()


@pytest.mark.parametrize("find", [rk.bsdf, rk.emitter, rk.occluder, rk.case, rk.quantity, rk.derive])
def test_a_name_that_is_no_text_is_an_unknown_name(find: Callable[[Any], Any]) -> None:
    with pytest.raises(rk.errors.UnknownNameError, match=r"unknown \w+ 3\. Known: "):
        find(3)


def test_one_name_may_stand_for_several() -> None:
    report = rk.check(rk.bsdf("lambert"), laws="reciprocity", evaluations=10_000)
    assert [verdict.check for verdict in report.verdicts] == ["reciprocity"]
    assert [row.name for row in rk.models_table("mirror", timing=False).rows] == ["mirror"]


def test_a_verdict_knows_its_outcome_by_its_text() -> None:
    assert verdict().ok


def signatures() -> Iterator[tuple[str, str]]:
    for name in dir(rk):
        found = getattr(rk, name)
        names = getattr(found, "__all__", ()) if inspect.ismodule(found) else ()
        for each, value in ((name, found), *((f"{name}.{inner}", getattr(found, inner)) for inner in names)):
            if inspect.isfunction(value) or (
                inspect.isclass(value) and value.__module__.startswith("radiokit")
            ):
                yield each, str(inspect.signature(value))


def test_signatures_can_be_read() -> None:
    found = dict(signatures())
    assert len(found) > 100
    assert {name for name, text in found.items() if len(text) > 1000 or " object at 0x" in text} == set()
