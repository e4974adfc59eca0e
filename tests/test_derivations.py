"""Derivations: every step is verified, wrong steps are refused, and results are radiokit's own numbers."""

from __future__ import annotations

import json
import pickle
from dataclasses import replace

import numpy as np
import pytest
import sympy
from sympy import Integral, Le, Rational, cos, pi, sin

import radiokit as rk
from radiokit.faces.cli import main
from radiokit.faces.proofs import SHARE, verify_all
from radiokit.faces.validate import validate
from radiokit.faces.workers import SerialExecutor
from radiokit.facts.errors import ParameterError, UnknownNameError
from radiokit.facts.source import Source
from radiokit.facts.verdict import Evidence, Outcome
from radiokit.measure.proof import TimeIsUp
from radiokit.physics import fresnel, view_factor
from radiokit.physics.relations import SR, Derivation, Notation, Step, cache, catalogue, eq, follows, premise
from radiokit.physics.relations.steps import holds
from radiokit.physics.relations.verify import verify_step

SOME = ("lambertian-intensity", "reciprocity", "flux-balance")

NUMERIC = {"solid-angle-element"}
"""Derivations with a step that SymPy does not prove; every other one is proved throughout."""


@pytest.fixture(autouse=True)
def _own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("RADIOKIT_CACHE_DIR", str(tmp_path))


@pytest.mark.parametrize("name", rk.list_derivations())
def test_every_step_is_verified(name):
    found = rk.derive(name, fresh=True)
    wrong = [f"{s.relation}: {f.message}" for s, f in zip(found.steps, found.findings, strict=True)]
    assert found.ok, wrong
    assert found.verdict.ok
    assert all(verdict.ok for verdict in found.verdicts)
    evidence = Evidence.MEASURED if name in NUMERIC else Evidence.PROVED
    assert found.verdict.evidence is evidence, wrong
    for step, finding in zip(found.steps, found.findings, strict=True):
        assert (finding.how == "premise") == step.premise
    json.dumps(found.to_json(), allow_nan=False)


@pytest.mark.parametrize("name", rk.list_derivations())
def test_twice_the_result_is_refuted(name):
    right = catalogue.unverified(name)
    *earlier, last = right.steps
    relation = right.result
    if isinstance(relation, sympy.Eq):
        wrong = eq(relation.lhs, 2 * relation.rhs if relation.rhs else sympy.Integer(1))
    else:
        wrong = relation.func(200 * relation.lhs, relation.rhs, evaluate=False)
    outcome, how, message = verify_step(name, replace(last, relation=wrong), earlier, right.notation)
    assert (outcome, how) == (Outcome.VIOLATED, "refuted"), message


def test_enough_is_proved_symbolically():
    steps = sum(not s.premise for name in rk.list_derivations() for s in catalogue.unverified(name).steps)
    assert 1 - len(NUMERIC) / steps >= SHARE  # one step of each


def test_names_titles_and_tags():
    names = rk.list_derivations()
    assert len(names) == len(set(names)) >= 50
    assert set(rk.list_derivations(tag="lecture")) < set(names)
    with pytest.raises(UnknownNameError, match="did you mean 'reciprocity'"):
        rk.derive("reciprocal")


def planted(*steps, notation):
    return Derivation(
        name="planted",
        title="Planted",
        statement="",
        notation=notation,
        steps=steps,
        source=Source(authors="Nobody", year=2000, title="Nothing"),
    ).verified()


class Lambertian:
    """The symbols of M = π L."""

    def __init__(self):
        n = self.notation = Notation()
        self.L, self.M = n.quantity("L", "radiance"), n.quantity("M", "radiant_exitance")
        self.theta, self.phi, self.mu = n.angle("θ"), n.angle("φ"), n.symbol("μ")
        whole = Integral(
            self.L * cos(self.theta) * SR * sin(self.theta), (self.theta, 0, pi / 2), (self.phi, 0, 2 * pi)
        )
        self.definition = premise(self.M, whole, "definition")
        self.ring = Integral(cos(self.theta) * sin(self.theta), (self.theta, 0, pi / 2))
        self.rings = premise(self.M, 2 * pi * SR * self.L * self.ring, "definition, ring by ring")


def test_a_wrong_result_is_refuted():
    s = Lambertian()
    found = planted(s.definition, follows(s.M, 2 * pi * SR * s.L, "no cosine"), notation=s.notation)
    assert found.outcome is Outcome.VIOLATED
    assert found.verdict.evidence is Evidence.REFUTED
    assert "differ by 0.33 of their size" in found.findings[1].message
    assert "step 2" in str(found.verdict.witness)
    assert [verdict.outcome for verdict in found.verdicts] == [Outcome.VIOLATED]


def test_a_wrong_step_between_right_ones_is_refuted():
    s = Lambertian()
    found = planted(
        s.definition,
        follows(s.M, 2 * pi * SR * s.L * s.ring, "azimuth"),
        follows(s.M, 2 * pi * SR * s.L * Integral(s.mu**2, (s.mu, 0, 1)), "μ", change={s.mu: cos(s.theta)}),
        notation=s.notation,
    )
    assert [f.how for f in found.findings] == ["premise", "proved", "refuted"]


def test_a_change_of_variable_needs_the_right_bounds():
    s = Lambertian()
    wrong = 2 * pi * SR * s.L * Integral(s.mu, (s.mu, 1, sympy.sqrt(2)))  # of the right value
    found = planted(
        s.definition,
        follows(s.M, 2 * pi * SR * s.L * s.ring, "azimuth"),
        follows(s.M, wrong, "μ", change={s.mu: cos(s.theta)}),
        notation=s.notation,
    )
    assert found.outcome is Outcome.VIOLATED
    assert "μ from 1 to sqrt(2) is not allowed" in found.findings[2].message.replace("'", "")


def test_a_wrong_antiderivative_is_refuted():
    n = Notation()
    a, x, area = n.symbol("a", "m"), n.symbol("x", "m"), n.symbol("A", "m^2")
    steps = (premise(area, Integral(x, (x, 0, a)), ""), follows(area, a**2 / 2, "", antiderivative=(x, x**2)))
    found = planted(*steps, notation=n)
    assert found.findings[1].how == "refuted"
    assert "antiderivative = x**2" in found.findings[1].message


def test_an_antiderivative_that_jumps_is_refuted():
    n = Notation()
    x, t, y = n.symbol("x"), n.symbol("t"), n.symbol("y")
    jumps = sympy.atan(2 * sympy.tan(x / 2)) / 2  # at π, between the bounds
    steps = (
        premise(y, Integral(1 / (5 - 3 * cos(x)), (x, 0, 2 * pi), (t, 0, 1)), ""),
        follows(y, 0, "", antiderivative=(x, jumps)),
    )
    assert planted(*steps, notation=n).outcome is Outcome.VIOLATED


def test_what_is_not_declared_is_not_used():
    n = Notation()
    E, F, A = n.quantity("E", "irradiance"), n.quantity("Φ", "radiant_flux"), n.symbol("A", "m^2")
    assert planted(follows(E, F / A, "but why?"), notation=n).outcome is Outcome.VIOLATED
    unused = planted(premise(F, E * A, "flux"), follows(E, F / A, "but why?"), notation=n)
    assert unused.outcome is Outcome.VIOLATED
    assert planted(premise(F, E * A, "flux"), follows(E, F / A, "solved", ("Φ", E)), notation=n).ok
    missing = planted(follows(E, F / A, "", "Φ"), notation=n)
    assert "the label of an earlier step" in missing.findings[0].message


def test_a_premise_is_checked_for_dimensions():
    n = Notation()
    E, L = n.quantity("E", "irradiance"), n.quantity("L", "radiance")
    found = planted(premise(E, pi * L, "no steradian"), follows(E, pi * L, "the same"), notation=n)
    assert found.outcome is Outcome.VIOLATED
    assert "sr" in found.findings[0].message


def test_a_wrong_limit_is_not_accepted():
    n = Notation()
    x = n.symbol("x", within=(0.1, 2.0))
    e = n.symbol("e")
    step = holds(Le(e, Rational(1, 2), evaluate=False), "")
    found = planted(premise(e, x / (1 + x), ""), step, notation=n)
    assert found.outcome is Outcome.VIOLATED
    assert "beyond the limit by" in found.findings[1].message  # false from x = 1 on
    unknown = holds(Le(e, x + sympy.exp(-x), evaluate=False), "")
    assert planted(premise(e, 1, ""), unknown, notation=n).outcome is Outcome.INCONCLUSIVE  # true, not shown
    one = holds(Le(e, 1, evaluate=False), "")
    assert planted(premise(e, x / (1 + x), ""), one, notation=n).ok


def test_what_sympy_cannot_prove_is_tried_at_fifty_digits(monkeypatch):
    n = Notation()
    x, y = n.symbol("x"), n.symbol("y", real=True)
    right = Step(relation=eq(y, sympy.gamma(x + Rational(1, 2)) * sympy.gamma(x)), why="", premise=True)
    doubled = 2 ** (1 - 2 * x) * sympy.sqrt(pi) * sympy.gamma(2 * x)
    n.meanings[sympy.gamma] = n.meaning(x)
    found = planted(right, follows(y, doubled, "Legendre's duplication"), notation=n)
    assert found.outcome is not Outcome.HOLDS  # the checker knows no gamma function
    shown = Integral(sympy.exp(-(x**2) * sympy.cosh(x)), (x, 0, 1))
    same = Integral(2 * x * sympy.exp(-(x**4) * sympy.cosh(x**2)), (x, 0, 1))

    def endless(*given):
        raise TimeIsUp

    monkeypatch.setattr("radiokit.physics.relations.verify.proof", endless)
    found = planted(premise(y, shown, ""), follows(y, same, "x → x²"), notation=n)
    assert found.findings[1].how == "numerically at 50 digits"
    assert found.verdict.evidence is Evidence.MEASURED


def test_a_step_that_takes_too_long_is_inconclusive():
    n = Notation()
    x, y, a = n.symbol("x"), n.symbol("y"), n.symbol("a")
    hard = Integral(sympy.exp(-(sin(x * a) ** 2) * sympy.cosh(x * y)), (x, 0, 1), (y, 0, 1))
    slow = Step(relation=eq(a, hard + 1 - 1 * hard.subs(a, 2 * a)), why="", seconds=1e-3)
    assert planted(slow, notation=n).outcome is Outcome.INCONCLUSIVE


def test_a_derivation_ends_with_something_shown():
    s = Lambertian()
    with pytest.raises(ParameterError, match="ended by a step that follows"):
        planted(s.definition, notation=s.notation)


def test_proofs_are_kept_and_a_corrupt_cache_is_ignored(monkeypatch):
    first = rk.derive("reciprocity")
    file = cache.folder() / "reciprocity.json"
    assert file.is_file()

    def never(*args):
        raise AssertionError("verified anew")

    with monkeypatch.context() as patch:
        patch.setattr("radiokit.physics.relations.derivation.verify", never)
        assert rk.derive("reciprocity").findings == first.findings
        with pytest.raises(AssertionError, match="verified anew"):
            rk.derive("reciprocity", fresh=True)
    kept = json.loads(file.read_text(encoding="utf-8"))
    for text in (
        "",
        "not JSON",
        "[]",
        json.dumps(kept | {"key": "0"}),
        json.dumps(kept | {"findings": kept["findings"][1:]}),
        json.dumps(kept | {"findings": [{**f, "how": "guessed"} for f in kept["findings"]]}),
    ):
        file.write_text(text, encoding="utf-8")
        assert cache.load(catalogue.unverified("reciprocity")) is None
    assert rk.derive("reciprocity").ok
    assert json.loads(file.read_text(encoding="utf-8"))["key"] == kept["key"]


def test_nowhere_to_keep_proofs(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("", encoding="utf-8")
    monkeypatch.setenv("RADIOKIT_CACHE_DIR", str(tmp_path / "file"))
    assert rk.derive("reciprocity").ok


def test_a_changed_step_is_not_remembered():
    s = Lambertian()
    right = planted(s.rings, follows(s.M, pi * SR * s.L, ""), notation=s.notation)
    wrong = planted(s.rings, follows(s.M, pi * SR * s.L / 2, ""), notation=s.notation)
    cache.store(right)
    assert cache.load(right) == right.findings
    assert cache.load(wrong) is None


def test_how_a_derivation_is_shown():
    found = rk.derive("lambertian-exitance")
    assert found._repr_latex_().startswith("$$\n\\begin{aligned}\nM &= ")
    assert r"\text{$\mu$ = cos$\theta$}" in found.latex()
    assert "proved: change of variable" in found._repr_markdown_()
    text = str(found)
    assert "1. M = ∫ L cosθ dω over the hemisphere" in text
    assert "[premise]" in text
    assert "L: radiance" in text
    assert repr(found) == "<Derivation 'lambertian-exitance': holds>"
    assert catalogue.unverified("lambertian-exitance").outcome is Outcome.INCONCLUSIVE
    assert pickle.loads(pickle.dumps(found.findings)) == found.findings


def run(capsys, *words):
    with pytest.raises(SystemExit) as stop:
        main(["derive", *words])
    return stop.value.code, *capsys.readouterr()


def test_the_command(capsys, monkeypatch):
    code, out, err = run(capsys)
    assert code == 0
    assert "reciprocity" in out
    assert not err
    code, out, _ = run(capsys, "reciprocity", "--json")
    assert (code, json.loads(out)["outcome"]) == (0, "holds")
    code, out, _ = run(capsys, "reciprocity", "--latex")
    assert code == 0
    assert r"\begin{aligned}" in out
    assert run(capsys, "reciprocal")[0] == run(capsys, "reciprocity", "--all")[0] == 2
    monkeypatch.setattr(catalogue, "list_derivations", lambda: list(SOME))
    code, out, _ = run(capsys, "--all", "--fresh", "--json", "--workers", "1")
    data = json.loads(out)
    assert (code, data["outcome"], data["share_proved"]) == (0, "holds", 1.0)
    assert [each["name"] for each in data["derivations"]] == list(SOME)
    code, out, _ = run(capsys, "--all", "--workers", "1")
    assert code == 0
    assert "3 derivations, 5 of 5 steps (100.0%) proved symbolically" in out


@pytest.mark.parametrize(("outcome", "expected"), [("violated", 1), ("inconclusive", 3)])
def test_exit_codes(outcome, expected, capsys, monkeypatch):
    s = Lambertian()
    steps = {
        "violated": follows(s.M, s.L * SR, "wrong"),
        "inconclusive": Step(relation=Le(s.M, 4 * SR * s.L + s.M * s.L / s.L - s.M, evaluate=False), why="?"),
    }
    bad = planted(s.rings, steps[outcome], notation=s.notation)
    monkeypatch.setitem(catalogue._catalogue(), "planted", bad)
    if outcome == "inconclusive":
        monkeypatch.setattr("radiokit.physics.relations.verify.proof", lambda *_: "")
    code, out, _ = run(capsys, "planted", "--fresh", "--json")
    assert (json.loads(out)["outcome"], code) == (outcome, expected)
    found = validate(names=["planted"])
    assert found.exit_code == expected
    assert verify_all(["planted"], executor=SerialExecutor()).exit_code == expected


def test_the_main_job_verifies_derivations():
    found = validate(names=SOME)
    assert {each.name for each in found.derivations} == set(SOME)
    assert found.exit_code == 0
    data = json.loads(json.dumps(found.to_json(), allow_nan=False))
    assert {row["details"]["derivation"] for row in data["derivations"]} == set(SOME)


# What the results say, beside what radiokit computes.

UP, DOWN = (0, 0, 1), (0, 0, -1)


def result(name, **values):
    """Return the right side of a derived formula at these values, the unit solid angle being 1."""
    found = catalogue.unverified(name)
    numbers = {str(SR): 1.0} | values
    right = found.result.rhs
    return float(right.subs({s: numbers[str(s)] for s in right.free_symbols}))


def close(value, estimate):
    assert float(getattr(estimate, "value", estimate)) == pytest.approx(value, rel=1e-12)


def test_disk_plane_and_camera(rng):
    R, d, L = rng.uniform(0.5, 2, 3)
    disk = rk.emitter("disk", center=(0, 0, d), normal=DOWN, radius=R, radiance=L)
    close(result("irradiance-under-disk", L=L, R=R, d=d), rk.irradiance(disk, normal=UP))
    share = view_factor.differential_to_disk(radius=R, distance=d)
    close(result("irradiance-under-disk", L=1 / np.pi, R=R, d=d), share)
    alpha = np.arctan2(R, d)
    close(result("solid-angle-of-cone", α=alpha), rk.solid_angle(disk))
    far = rk.emitter("disk", center=(0, 0, 1e-9), normal=DOWN, radius=1e3, radiance=L)
    close(result("irradiance-under-plane", L=L), rk.irradiance(far, normal=UP))


def test_sphere_and_sky(rng):
    R, beta, L = rng.uniform(0.2, 0.6), rng.uniform(0.1, 0.8), rng.uniform(1, 3)
    sphere = rk.emitter("sphere", center=(0, 0, 1.5), radius=R, radiance=L)
    normal = (np.sin(beta), 0, np.cos(beta))
    close(result("irradiance-from-sphere", L=L, R=R, d=1.5, β=beta), rk.irradiance(sphere, normal=normal))
    sky = rk.emitter("constant", radiance=L, normal=UP)
    close(result("irradiance-from-tilted-sky", L=L, β=beta), rk.irradiance(sky, normal=normal))
    close(result("irradiance-from-hemisphere", L=L), rk.irradiance(sky, normal=UP))


def test_rectangle_and_triangle(rng):
    a, b, d, L = rng.uniform(0.5, 2, 4)
    light = rk.emitter(
        "rectangle", center=(a / 2, b / 2, d), normal=DOWN, width=a, height=b, up=(0, 1, 0), radiance=L
    )
    close(result("irradiance-from-rectangle", L=L, a=a, b=b, d=d), rk.irradiance(light, normal=UP))
    close(result("solid-angle-of-rectangle", a=a, b=b, d=d), rk.solid_angle(light))
    corners = rng.uniform(-1, 1, (3, 3)) + np.array([0, 0, 2])
    u, v, w = corners / np.linalg.norm(corners, axis=1, keepdims=True)
    triple = abs(np.linalg.det([u, v, w]))
    tangent = result("solid-angle-of-triangle", D=triple, a=np.arccos(u @ v), b=np.arccos(u @ w), k=v @ w)
    triangle = rk.emitter("triangle", vertices=corners.tolist(), radiance=L)
    back = rk.emitter("triangle", vertices=corners[::-1].tolist(), radiance=L)
    seen = max(float(rk.solid_angle(each).value) for each in (triangle, back))
    assert 2 * np.arctan(tangent) == pytest.approx(seen, rel=1e-9)  # for the arccosines above


def test_polygon(rng):
    L, corners = 2.0, rng.uniform(-1, 1, (3, 3)) + np.array([0, 0, 2])
    found = catalogue.unverified("irradiance-from-polygon").result.rhs
    total = found.subs({SR: 1, sympy.Symbol("L", positive=True): L}).atoms(sympy.Sum).pop()
    assert str(total.function) == "c(j)*Θ(j)"
    v = corners / np.linalg.norm(corners, axis=1, keepdims=True)
    sums = 0.0
    for p, q in zip(v, np.roll(v, -1, axis=0), strict=True):
        outward = np.cross(p, q) * -np.sign(np.linalg.det(v))
        sums += np.arctan2(np.linalg.norm(outward), p @ q) * outward[2] / np.linalg.norm(outward)
    lights = [rk.emitter("triangle", vertices=c.tolist(), radiance=L) for c in (corners, corners[::-1])]
    seen = max(float(rk.irradiance(each, normal=UP).value) for each in lights)
    assert -L / 2 * sums == pytest.approx(seen, rel=1e-12)


def test_point_sources(rng):
    intensity, r, theta = rng.uniform(0.5, 1.4, 3)
    lamp = rk.emitter("point", position=(0, 0, r), intensity=intensity)
    normal = (np.sin(theta), 0, np.cos(theta))
    close(result("irradiance-from-intensity", I=intensity, r=r, θ=theta), rk.irradiance(lamp, normal=normal))
    close(result("isotropic-flux", I=intensity), 4 * np.pi * intensity)


def test_fresnel(rng):
    n1, n2, cosine = 1.0, rng.uniform(1.2, 2), rng.uniform(0.1, 1)
    t1, t2 = np.arccos(cosine), np.arcsin(np.sqrt(1 - cosine**2) / n2)
    shares = []
    for name in ("fresnel-s", "fresnel-p"):
        steps = catalogue.unverified(name).steps
        r = next(s.relation.rhs for s in steps if str(s.relation.lhs) == "r")
        numbers = dict(zip(("n_1", "n_2", "θ_1", "θ_2"), (n1, n2, t1, t2), strict=True))
        shares.append(float(r.subs({s: numbers[str(s)] for s in r.free_symbols})) ** 2)
    close(np.mean(shares), fresnel.dielectric(cosine, n2 / n1))
    close(result("fresnel-at-normal-incidence", n_1=n1, n_2=n2), fresnel.dielectric(1.0, n2 / n1))


def test_reflection(rng):
    rho, L = rng.uniform(0.2, 0.9, 2)
    f = rk.bsdf("lambert", reflectance=rho)
    close(result("lambertian-brdf", ρ=rho), f(np.array([UP]), np.array([UP]))[0])
    sky = rk.emitter("constant", radiance=L)
    close(result("white-furnace", ρ=rho, L=L), rk.shade(f, [sky], UP))
    walls = rk.enclosure_radiance(f, emitted=L, samples=4096, rng=rng)
    steps = catalogue.unverified("closed-enclosure").steps
    total = next(s.relation.rhs for s in steps if s.label == "sum")
    exact = float(total.subs({s: {"ρ": rho, "L_e": L}[str(s)] for s in total.free_symbols}))
    assert abs(float(walls.value) - exact) <= 6 * float(walls.error) + 1e-9 * exact
