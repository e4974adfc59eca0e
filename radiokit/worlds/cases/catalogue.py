"""Catalogue: what a closed-form case is, how an answer to it is judged, and where cases are found."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache, partial
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import BSDF
from radiokit.contracts.emitter import Emitter
from radiokit.contracts.occluder import Occluder
from radiokit.facts.errors import RadiokitError, UnknownNameError
from radiokit.facts.estimate import Estimate
from radiokit.facts.jsonable import jsonable
from radiokit.facts.source import Source
from radiokit.facts.verdict import Evidence, Outcome, Verdict, Witness
from radiokit.measure.statistics import z_test
from radiokit.worlds.planning import METHODS, applies
from radiokit.worlds.scene import behind_all
from radiokit.worlds.shading import shade

__all__ = ["Case", "Scene", "case", "list_cases", "shading_case"]

Triple = tuple[float, float, float]
Method = Callable[..., Estimate]

SAMPLES = 1 << 18
"""Samples of a Monte Carlo method when none are asked for."""

RESOLUTION = 0.05
"""An error above this share of the exact value proves nothing either way."""

_FLOOR = 16 * float(np.finfo(float).eps)  # the exact value is itself a rounded number


@dataclass(frozen=True, kw_only=True)
class Scene:
    """A shading problem in numbers, so that another renderer can be given the same one."""

    f: BSDF
    emitters: tuple[Emitter, ...]
    wo: Triple = (0.0, 0.0, 1.0)
    normal: Triple = (0.0, 0.0, 1.0)
    position: Triple = (0.0, 0.0, 0.0)
    occluders: tuple[Occluder, ...] = ()

    def applies(self, method: str) -> bool:
        """Return whether one of the methods of ``radiokit.shade`` can be used."""
        lights = behind_all(self.emitters, self.occluders, self.position)
        return applies(method, self.f, lights, self.wo, normal=self.normal, position=self.position)

    def shade(
        self,
        method: str,
        *,
        rtol: float = 1e-8,
        rng: int | np.random.Generator | None = None,
        samples: int | None = None,
    ) -> Estimate:
        """Return the reflected radiance [W m⁻² sr⁻¹] by one of the methods of ``radiokit.shade``."""
        return shade(
            self.f,
            self.emitters,
            self.wo,
            normal=self.normal,
            position=self.position,
            method=method,
            rtol=rtol,
            rng=rng,
            samples=SAMPLES if samples is None else samples,
            occluders=self.occluders,
        )


@dataclass(frozen=True, kw_only=True)
class Case:
    """A problem with an exact answer, and every method of radiokit that can find it.

    Parameters
    ----------
    name, title : str
    setup : str
        The problem in words, complete enough to set it up in any renderer.
    exact : float
        The answer, correctly rounded or nearly so, in ``unit``.
    derivation : str
        How the answer comes out, with formulas in LaTeX between dollar signs.
    source : Source
    unit : str
    methods : mapping of str to callable
        Each takes ``rng`` and ``samples`` and returns an Estimate.
    tags : tuple of str
    scene : Scene, optional
        The problem in numbers, where it is one of shading.
    """

    name: str
    title: str
    setup: str
    exact: float
    derivation: str
    source: Source
    unit: str
    methods: Mapping[str, Method] = field(repr=False)
    tags: tuple[str, ...] = ()
    scene: Scene | None = field(default=None, repr=False)

    def __reduce_ex__(self, protocol: Any) -> Any:
        if _catalogue().get(self.name) is self:
            return (case, (self.name,))
        return super().__reduce_ex__(protocol)

    def run(
        self,
        method: str | None = None,
        rng: int | np.random.Generator | None = None,
        *,
        samples: int | None = None,
    ) -> Estimate:
        """Return the answer that a method finds; the first of ``methods`` when none is named.

        Raises
        ------
        UnknownNameError
            When the method does not apply to this case.

        >>> case("lambert-in-furnace").run("closed form").value
        0.5
        """
        name = next(iter(self.methods)) if method is None else method
        if name not in self.methods:
            raise UnknownNameError(f"method of case {self.name!r}", name, self.methods)
        return self.methods[name](rng=rng, samples=samples)

    def verdict(
        self,
        method: str | None = None,
        rng: int | np.random.Generator | None = None,
        *,
        samples: int | None = None,
        level: float = 1e-3,
    ) -> Verdict:
        """Run a method and judge its answer.

        >>> print(case("lambert-in-furnace").verdict("mis", rng=1).outcome)
        holds
        """
        return self.judge(self.run(method, rng, samples=samples), level=level)

    def judge(self, estimate: Estimate, *, level: float = 1e-3) -> Verdict:
        """Judge an answer, from whatever renderer.

        A bound is violated when the exact value lies outside it, a statistical estimate when a z-test
        rejects it at ``level``. What did not converge, or is too uncertain to tell, is inconclusive.

        >>> furnace = case("lambert-in-furnace")
        >>> print(furnace.judge(Estimate(0.55, 0.001, "statistical", evaluations=1000)).outcome)
        violated
        """
        value, error = np.asarray(estimate.value, float), np.asarray(estimate.error, float)
        difference = np.abs(value - self.exact)
        beyond = np.maximum(difference - _FLOOR * abs(self.exact), 0.0)
        p_value: float | None = None
        if not np.all(np.isfinite(value)):
            wrong, doubt = True, ""
        else:
            if estimate.is_bound:
                wrong = bool(np.any(beyond > error))
            else:
                p_value = float(np.min(z_test(Estimate(beyond, error, "statistical", dof=estimate.dof), 0.0)))
                wrong = p_value < level
            doubt = self._doubt(estimate, value, error)
        evidence = Evidence.BOUNDED if estimate.is_bound else Evidence.MEASURED
        unseen = not estimate.is_bound and bool(np.all(value == 0) and np.all(error == 0))
        if wrong and not (unseen and doubt):
            outcome, evidence = Outcome.VIOLATED, Evidence.REFUTED
        else:
            outcome = Outcome.INCONCLUSIVE if doubt else Outcome.HOLDS
        message = f"{estimate}, exact {self.exact!r}"
        return Verdict(
            check=self.name,
            claim=f"{self.title}: {self.exact!r} {self.unit}",
            outcome=outcome,
            evidence=evidence,
            message=f"{message}; {doubt}" if doubt and outcome is Outcome.INCONCLUSIVE else message,
            witness=self._witness(estimate) if outcome is Outcome.VIOLATED else None,
            estimate=estimate,
            limit=self.exact,
            p_value=p_value,
            evaluations=estimate.evaluations,
            seconds=estimate.seconds,
            details={"method": estimate.method, "level": level},
        )

    def _doubt(self, estimate: Estimate, value: Any, error: Any) -> str:
        """Return why an answer could not be trusted even if it is right; empty if it can."""
        if not estimate.converged:
            return estimate.note or "the method did not converge"
        if not estimate.is_bound and self.exact != 0 and np.all(value == 0) and np.all(error == 0):
            return "no sample found any light"
        if not estimate.is_bound and "of the variance" in estimate.note:
            return estimate.note
        if np.any(error > (RESOLUTION * abs(self.exact) if self.exact else 1e-12)):
            return f"the error is above {100 * RESOLUTION:g} % of the exact value"
        return ""

    def _witness(self, estimate: Estimate) -> Witness:
        places = {} if self.scene is None else {"wo": self.scene.wo, "normal": self.scene.normal}
        values = {"value": estimate.value, "error": estimate.error, "exact": self.exact}
        return Witness(places, values)

    def __str__(self) -> str:
        lines = [
            f"{self.name}: {self.title}",
            f"  setup: {self.setup}",
            f"  exact: {self.exact!r} {self.unit}",
            f"  because: {self.derivation}",
            f"  source: {self.source.cite()}",
            f"  methods: {', '.join(self.methods)}",
        ]
        return "\n".join(lines)

    def _repr_markdown_(self) -> str:
        return (
            f"**{self.title}** (`{self.name}`)\n\n{self.setup}\n\n"
            f"Exact: {self.exact!r} {self.unit}. {self.derivation}\n\n"
            f"*{self.source.cite()}* Methods: {', '.join(self.methods)}."
        )

    def to_json(self) -> dict[str, Any]:
        """Return the case as JSON-ready data."""
        data: dict[str, Any] = {
            "name": self.name,
            "title": self.title,
            "setup": self.setup,
            "exact": self.exact,
            "derivation": self.derivation,
            "source": self.source,
            "unit": self.unit,
            "methods": list(self.methods),
            "tags": self.tags,
        }
        return {key: jsonable(value) for key, value in data.items()}


def shading_case(
    *,
    name: str,
    title: str,
    setup: str,
    exact: float,
    derivation: str,
    source: Source,
    scene: Scene,
    tags: tuple[str, ...] = (),
    left_out: tuple[str, ...] = (),
) -> Case:
    """Return a case of shading, with every method that applies to it.

    ``left_out`` names methods that apply but cannot see the light, which ``setup`` then explains.
    """
    methods: dict[str, Method] = {
        method: partial(scene.shade, method)
        for method in METHODS
        if method not in ("auto", "mc", *left_out) and scene.applies(method)
    }
    return Case(
        name=name,
        title=title,
        setup=setup,
        exact=exact,
        derivation=derivation,
        source=source,
        unit="W/m^2/sr",
        methods=methods,
        tags=tags,
        scene=scene,
    )


@cache
def _catalogue() -> dict[str, Case]:
    """All cases, by name, in alphabetical order; each file of this folder gives its own as ``CASES``."""
    found: dict[str, Case] = {}
    package = importlib.import_module("radiokit.worlds.cases")
    for info in pkgutil.iter_modules(package.__path__):
        module = importlib.import_module(f"{package.__name__}.{info.name}")
        for item in getattr(module, "CASES", ()):
            if item.name in found:
                raise RadiokitError(f"two cases are called {item.name!r}", name=item.name)
            found[item.name] = item
    return dict(sorted(found.items()))


def list_cases() -> list[str]:
    """Return the names of all closed-form cases.

    >>> "lambert-in-furnace" in list_cases()
    True
    """
    return list(_catalogue())


def case(name: str) -> Case:
    """Return the closed-form case called ``name``.

    Raises
    ------
    UnknownNameError
        When there is no such case.

    >>> case("lambert-in-furnace").exact
    0.5
    """
    cases = _catalogue()
    if name not in cases:
        raise UnknownNameError("case", name, cases)
    return cases[name]
