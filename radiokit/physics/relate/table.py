"""Table: all relations, each from what is known to what is wanted, and those between watts and lumens."""

from __future__ import annotations

from radiokit.physics.relate import receivers, sources, surfaces
from radiokit.physics.relate.relation import Relation

__all__ = ["RELATIONS"]


def _crossing(role: str, symbol: str) -> tuple[Relation, Relation]:
    condition = "the efficacy K is that of the light's spectrum: 683 lm/W times the mean of V(λ)"
    kinds = (role, "luminous_efficacy")
    return (
        Relation(
            name=f"photometric-{role}",
            target=role,
            needs=kinds,
            formula=rf"{symbol}_v = K {symbol}_e",
            compute=lambda luminous_efficacy, **light: light[role] * luminous_efficacy,
            condition=condition,
            derivation="luminous-flux",
            crosses="photometric",
        ),
        Relation(
            name=f"radiometric-{role}",
            target=role,
            needs=kinds,
            formula=rf"{symbol}_e = \frac{{{symbol}_v}}{{K}}",
            compute=lambda luminous_efficacy, **light: light[role] / luminous_efficacy,
            condition=condition,
            derivation="luminous-flux",
            crosses="radiometric",
        ),
    )


_TWINS = tuple(
    relation
    for role, symbol in (
        ("energy", "Q"),
        ("flux", r"\Phi"),
        ("intensity", "I"),
        ("irradiance", "E"),
        ("exitance", "M"),
        ("radiance", "L"),
    )
    for relation in _crossing(role, symbol)
)

RELATIONS: tuple[Relation, ...] = (
    *sources.RELATIONS,
    *receivers.RELATIONS,
    *surfaces.RELATIONS,
    *_TWINS,
)
