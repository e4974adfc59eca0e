"""Hints: what a part of a formula is, in words, and what is probably missing where two sides differ."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from radiokit.physics.relations.dimension import NUMBER, Dimension

__all__ = ["Found", "describe", "equation_clash", "kind_difference", "kinds_differ"]

_ELEMENTS = (
    ("sr", "a solid angle dω", "a solid angle (Δω_j, or Ω₀ = 1 sr)"),
    ("m^2", "an area dA", "an area"),
    ("s", "a time dt", "a time"),
    ("m", "a length or a wavelength dλ", "a length or a wavelength"),
    ("m^2 sr", "an area and a solid angle, dA dω,", "an area and a solid angle"),
    ("sr^2", "two solid angles, dω_i dω_o,", "two solid angles"),
)
_PLAIN = {"m": "a length", "m^2": "an area", "m^3": "a volume", "s": "a time", "sr": "a solid angle"}


@dataclass(frozen=True)
class Found:
    """A sub-expression's dimension (None: any, as of 0), its quantity, and its order of differentials."""

    dimension: Dimension | None = NUMBER
    kind: str = ""
    order: Fraction | None = Fraction(0)


def describe(found: Found) -> str:
    """Return what a part is, such as ``"a differential of irradiance [W/m²]"``.

    >>> describe(Found(Dimension.of("m"))), describe(Found(Dimension.of("W/m^2"), "irradiance", Fraction(1)))
    ('a length [m]', 'a differential of irradiance [W/m²]')
    """
    if found.dimension is None:
        return "of any unit"
    names = [words for unit, words in _PLAIN.items() if Dimension.of(unit) == found.dimension]
    words = found.kind or (names[0] if names else "a number" if not found.dimension else "a quantity")
    if found.order:
        named = {1: "a differential", -1: "one over a differential", 2: "a second-order differential"}
        order = {Fraction(power): text for power, text in named.items()}
        words = f"{order.get(found.order, f'a differential of order {found.order}')} of {words}"
    return f"{words} [{found.dimension}]" if found.dimension else words


def kinds_differ(left: Found, right: Found) -> bool:
    """Return whether two parts of one unit are different quantities; shares, such as R and T, do add."""
    return bool(left.dimension and left.kind and right.kind and left.kind != right.kind)


def kind_difference(left: Found, right: Found) -> str:
    """Return why two quantities of one unit are not the same."""
    from radiokit.facts.quantities import quantity

    try:
        first, second = quantity(left.kind), quantity(right.kind)
    except LookupError:
        return "the unit is the same, the quantity is not"
    return (
        f"the unit is the same, the quantity is not: {first.english} is {first.meaning}, "
        f"{second.english} is {second.meaning}"
    )


def equation_clash(
    left: Found, right: Found, below_left: Sequence[str], below_right: Sequence[str]
) -> tuple[str, str, str] | None:
    """Return code, expectation and hint where the two sides differ, or None where they agree.

    Parameters
    ----------
    left, right : Found
    below_left, below_right : sequence of str
        The differentials of quantities that stand below a fraction bar on either side.
    """
    if left.dimension is None or right.dimension is None:
        return None
    order = Fraction(0)
    if left.order is not None and right.order is not None:
        order = left.order - right.order
    if left.dimension != right.dimension:
        return "unit", "the same unit on both sides", _missing(left.dimension / right.dimension, order)
    if order:
        return (
            "order",
            "differentials of the same order on both sides",
            _order_hint(order, below_left, below_right),
        )
    if kinds_differ(left, right):
        return "kind", "the same quantity on both sides", kind_difference(left, right)
    return None


def _missing(ratio: Dimension, order: Fraction) -> str:
    for unit, element, amount in _ELEMENTS:
        dimension = Dimension.of(unit)
        for side, factor, orders in (("right", dimension, order), ("left", dimension**-1, -order)):
            if ratio == factor:
                words = element if orders > 0 else amount
                verb = "are" if words.startswith("two") or " and " in words else "is"
                return f"{words} {verb} missing on the {side}"
    return f"a factor in {ratio} is missing on the right"


def _order_hint(order: Fraction, below_left: Sequence[str], below_right: Sequence[str]) -> str:
    short, long, below = ("right", "left", below_right) if order > 0 else ("left", "right", below_left)
    count = "a differential is" if abs(order) == 1 else f"differentials of order {abs(order)} are"
    meant = [f"{name.removeprefix('d')}, not {name}, is meant below the fraction bar" for name in below]
    return f"{count} missing on the {short}, or " + (" or ".join(meant) or f"too many stand on the {long}")
