"""Request: finds the relation from what is given to what is wanted, or says what is missing or too much."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np

from radiokit.facts.errors import RadiokitError, UnknownNameError
from radiokit.facts.quantities import Quantity, quantity
from radiokit.facts.tagged import Tagged
from radiokit.physics.relate.givens import GIVENS, read_givens, role_of
from radiokit.physics.relate.relation import Relation
from radiokit.physics.relate.table import RELATIONS

__all__ = ["Related", "list_relations", "relate"]


@dataclass(frozen=True)
class Related:
    """A quantity, and the relation that gave it.

    Parameters
    ----------
    value : Tagged
        As ``radiokit.quantity`` makes it.
    relation : Relation
    fails : str or None
        Why the condition does not hold; empty where it does, None where what is given does not tell.
    """

    value: Tagged
    relation: Relation
    fails: str | None

    @property
    def formula(self) -> str:
        """The formula in LaTeX."""
        return self.relation.formula

    @property
    def condition(self) -> str:
        """When the relation holds."""
        return self.relation.condition

    @property
    def derivation(self) -> str:
        """The name of the derivation, for ``radiokit.derive``."""
        return self.relation.derivation

    @property
    def condition_holds(self) -> bool | None:
        """Whether it does here; None where what is given does not tell."""
        return None if self.fails is None else not self.fails

    def __str__(self) -> str:
        shown = f"{self.value:.6g}" if not getattr(self.value.magnitude, "ndim", 0) else str(self.value)
        state = {None: "holds if", True: "holds:", False: "does not hold:"}[self.condition_holds]
        words = self.condition if not self.fails else f"{self.fails} ({self.condition})"
        lines = [shown, f"  by {self.relation.name}: {self.formula}", f"  {state} {words}"]
        return "\n".join([*lines, f"  derivation: {self.derivation}"])

    def _repr_html_(self) -> str:
        return f"<pre>{escape(str(self))}</pre>"

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON-ready data."""
        return {
            **self.value.to_json(),
            "relation": self.relation.name,
            "formula": self.formula,
            "condition": self.condition,
            "condition_holds": self.condition_holds,
            "fails": self.fails,
            "derivation": self.derivation,
        }


def list_relations(target: str | None = None) -> list[str]:
    """Return the names of all relations, or of those that lead to a quantity.

    >>> list_relations("solid angle")
    ['solid-angle-of-area', 'solid-angle-of-cone', 'solid-angle-of-sphere']
    """
    role = None if target is None else _role(quantity(target))
    return [relation.name for relation in RELATIONS if role in (None, relation.target)]


def relate(target: str, *, by: str | None = None, **givens: Any) -> Related:
    """Return a quantity from what is known, with the relation that leads there and its condition.

    Photometric values take the same relations: an intensity in cd gives an illuminance in lx.

    Parameters
    ----------
    target : str
        What is wanted, as ``quantity`` takes it.
    by : str, optional
        The relation's name, where several fit.
    **givens
        ``flux``, ``intensity``, ``irradiance``, ``radiance``, ``distance``, ``area``, ``solid_angle`` and so
        on, quantities or text with a unit. Numbers suffice for ``reflectance``, ``f_number``,
        ``transmittance``, ``port_share``, and for angles in degrees, ``angle_deg`` and ``half_angle_deg``.

    Raises
    ------
    ParameterError
        When a value has no unit, a wrong one, or is out of range.
    RadiokitError
        When something is missing or too much, or several relations fit.
    UnknownNameError
        When there is no such quantity, given or relation.

    >>> found = relate("irradiance", intensity="5 W/sr", distance="2 m", angle_deg=60)
    >>> print(f"{found.value:.4f}", found.derivation)
    0.6250 W/m² (irradiance) irradiance-from-intensity
    >>> relate("irradiance", intensity="5 W/sr")
    Traceback (most recent call last):
    radiokit.facts.errors.RadiokitError: for an irradiance from an intensity the distance is missing
    """
    from radiokit.facts.units import parse

    wanted = quantity(target)
    role = _role(wanted)
    values, kinds = read_givens(givens)
    chosen = _choose(wanted, role, values, kinds, by)
    arguments = {name: values[name] for name in (*chosen.needs, *chosen.may) if name in values}
    for name, number in chosen.may.items():
        arguments.setdefault(name, parse(name, number, "" if GIVENS[name].unit == "1" else GIVENS[name].unit))
    notes = {name: values[name] for name in chosen.notes if name in values}
    fails = chosen.judge(**arguments, **notes) if chosen.judge is not None else None
    return Related(wanted(_computed(chosen, arguments, wanted)), chosen, fails)


def _computed(chosen: Relation, arguments: Mapping[str, Any], wanted: Quantity) -> Any:
    """Return the value in the target's unit; what divides by 0 is refused."""
    try:
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            found = chosen.compute(**arguments).to("" if wanted.unit == "1" else wanted.unit)
    except ZeroDivisionError:
        found = None
    if found is None or not np.all(np.isfinite(found.magnitude)):
        shown = ", ".join(f"{name} = {value}" for name, value in arguments.items())
        raise RadiokitError(f"{chosen.formula} has no finite value for {shown}")
    return found


def _role(wanted: Quantity) -> str:
    role = role_of(wanted)
    if role is None or role not in {relation.target for relation in RELATIONS}:
        targets = dict.fromkeys(GIVENS[relation.target].kind for relation in RELATIONS)
        raise UnknownNameError("target", wanted.name, targets)
    return role


def _choose(
    wanted: Quantity, role: str, values: Mapping[str, Any], kinds: Mapping[str, Quantity], by: str | None
) -> Relation:
    known = [relation for relation in RELATIONS if relation.target == role]
    if by is not None:
        known = [relation for relation in known if relation.name == by]
        if not known:
            raise UnknownNameError(f"relation to {wanted.english}", by, list_relations(wanted.name))
    crossing = "luminous_efficacy" in values
    known = [each for each in known if not each.crosses or each.crosses == wanted.kind] or known
    fitting = [each for each in known if not _missing(each, values) and not _extra(each, values)]
    if not fitting:
        raise RadiokitError(_complaint(wanted, known, values), target=wanted.name, given=sorted(values))
    _check_system(wanted, kinds, crossing)
    if len(fitting) > 1:
        ways = "; ".join(f"by={each.name!r}: {each.formula}, {each.condition}" for each in fitting)
        raise RadiokitError(
            f"{_count(len(fitting))} relations lead from {_list(values, 'and')} to {_a(wanted.english)}: "
            f"choose one. {ways}",
            relations=[each.name for each in fitting],
        )
    return fitting[0]


def _check_system(wanted: Quantity, kinds: Mapping[str, Quantity], crossing: bool) -> None:
    """Refuse watts for lumens: givens must be of the target's system, or of the other with an efficacy."""
    for name, kind in kinds.items():
        if not kind.twin:
            continue
        others = [each for each in kinds.values() if each.twin and each.kind != kind.kind]
        if others:
            raise RadiokitError(
                f"{kind.english} [{kind.unit}] and {others[0].english} [{others[0].unit}] do not go "
                f"together: "
                "one is radiometric, the other photometric"
            )
        if wanted.twin and (kind.kind == wanted.kind) == crossing:
            if crossing:
                raise RadiokitError(
                    f"{name} is given as {kind.english}, which is {wanted.kind} already: no luminous "
                    f"efficacy is needed"
                )
            raise RadiokitError(
                f"{_a(kind.english)} [{kind.unit}] gives {_a(wanted.twin.replace('_', ' '))}, not "
                f"{_a(wanted.english)}: "
                f"ask for {wanted.twin!r}, or turn it by its luminous_efficacy first"
            )


def _missing(relation: Relation, values: Iterable[str]) -> list[str]:
    return [name for name in relation.needs if name not in values]


def _extra(relation: Relation, values: Iterable[str]) -> list[str]:
    return [name for name in values if name not in (*relation.needs, *relation.may, *relation.notes)]


def _complaint(wanted: Quantity, known: Sequence[Relation], values: Mapping[str, Any]) -> str:
    if not values:
        return f"for {_a(wanted.english)} nothing is given; {_ways(known)}"
    used = {each.name: [name for name in values if name in each.needs] for each in known}

    def far(relation: Relation) -> tuple[int, int, int]:
        missing, extra = _missing(relation, values), _extra(relation, values)
        return len(extra), len(missing), -len(used[relation.name])

    best = min(known, key=far)
    if not used[best.name]:
        verb = "does" if len(values) == 1 else "do"
        return f"{_list(values, 'and')} {verb} not lead to {_a(wanted.english)}; {_ways(known)}"
    alike = [each for each in known if far(each) == far(best)]
    missing = list(
        dict.fromkeys(_list(_missing(each, values), "and") for each in alike if _missing(each, values))
    )
    source = " and ".join(_a(_words(name)) for name in used[best.name])
    parts = []
    if missing:
        plural = len(missing) == 1 and len(_missing(best, values)) > 1
        parts.append(f"the {' or the '.join(missing)} {'are' if plural else 'is'} missing")
    extra = _extra(best, values)
    if extra:
        parts.append(f"the {_list(extra, 'and')} {'is' if len(extra) == 1 else 'are'} too much")
    return f"for {_a(wanted.english)} from {source} {', and '.join(parts)}"


def _ways(known: Iterable[Relation]) -> str:
    ways = dict.fromkeys(_list(relation.needs, "and") for relation in known)
    return f"what does: {'; '.join(ways)}"


def _words(name: str) -> str:
    return name.removesuffix("_deg").replace("_", " ")


def _a(words: str) -> str:
    return f"{'an' if words[0] in 'aeiou' else 'a'} {words}"


def _list(names: Iterable[str], last: str) -> str:
    words = [_words(name) for name in names]
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} {last} {words[-1]}"


def _count(number: int) -> str:
    return {2: "two", 3: "three"}.get(number, str(number))
