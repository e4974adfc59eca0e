"""Notation: what the symbols of a formula mean: quantity, unit, and whether they are differentials."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import sympy

from radiokit.facts.errors import ParameterError
from radiokit.facts.quantities import quantity as find_quantity
from radiokit.physics.relations.dimension import NUMBER, Dimension

__all__ = ["HALF", "SR", "Meaning", "Notation", "greek", "latex_name"]

SR = sympy.Symbol("Ω_0", positive=True)
"""The unit solid angle, 1 sr, written out wherever a number becomes a solid angle: Ω = Ω₀ A/r²."""

HALF = Fraction(1, 2)
"""The order of a side of a two-dimensional element: dω = Ω₀ sinθ dθ dφ is one differential of solid angle."""

_NOUNS = {"m": "length", "m²": "area", "s": "time", "sr": "solid angle"}
_ORDERS = {HALF: "side", Fraction(2): "second differential", Fraction(3): "third differential"}
_PREPOSITIONS = ("at", "between", "from", "in", "of", "that", "which")

_LETTERS = "αβγδεζηθικλμνξπρστυφχψωΓΔΘΛΞΠΣΦΨΩ"
_COMMANDS = """
    alpha beta gamma delta varepsilon zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau upsilon
    varphi chi psi omega Gamma Delta Theta Lambda Xi Pi Sigma Phi Psi Omega
"""
_GREEK = dict(zip(_LETTERS, _COMMANDS.split(), strict=True))


@dataclass(frozen=True)
class Meaning:
    """What one symbol stands for.

    Parameters
    ----------
    dimension : Dimension
    kind : str
        Its quantity in English, such as ``"irradiance"``: what has another kind is another thing, whatever
        its unit. Empty for plain lengths, areas, angles and numbers.
    order : Fraction
        How many differentials it is: 1 for dω, dA, dt, dE; 2 for d²Φ; ½ for a side of an element, dθ.
    words : str
        For the reader, such as ``"of the angle of incidence"``.
    arguments : tuple of Dimension
        Of a function's arguments.
    """

    dimension: Dimension
    kind: str = ""
    order: Fraction = Fraction(0)
    words: str = ""
    arguments: tuple[Dimension, ...] = ()


class Notation:
    r"""The symbols of a formula. Each method adds one and returns it, a SymPy symbol or function.

    Symbols are positive unless assumptions say otherwise. ``within`` is the range from which random
    values are drawn where a formula is tried in numbers.

    >>> n = Notation()
    >>> E, theta = n.quantity("E", "irradiance"), n.angle("θ")
    >>> print(n.meaning(E).dimension, n.latex(E * sympy.cos(theta)))
    W/m² E \cos{\left(\theta \right)}
    """

    def __init__(self) -> None:
        unit = Meaning(Dimension.of("sr"), words="the unit solid angle, 1 sr")
        self.meanings: dict[Any, Meaning] = {SR: unit}
        self.ranges: dict[Any, tuple[float, float]] = {}

    def quantity(
        self,
        name: str,
        kind: str,
        words: str = "",
        *,
        order: int | Fraction = 0,
        of: Sequence[sympy.Symbol] = (),
        within: tuple[float, float] | None = None,
        **assumptions: bool,
    ) -> Any:
        """Add a quantity, ``kind`` as ``radiokit.quantity`` takes it; ``of`` makes it a function."""
        found = find_quantity(kind)
        return self._add(name, found.unit, found.english, words, order, of, within, assumptions)

    def symbol(
        self,
        name: str,
        unit: str = "1",
        words: str = "",
        *,
        kind: str = "",
        order: int | Fraction = 0,
        of: Sequence[sympy.Symbol] = (),
        within: tuple[float, float] | None = None,
        **assumptions: bool,
    ) -> Any:
        """Add a length, an area, a number, or whatever has a unit; ``kind`` is free text."""
        return self._add(name, unit, kind, words, order, of, within, assumptions)

    def angle(self, name: str, words: str = "", within: tuple[float, float] = (0.1, 1.4), **more: Any) -> Any:
        """Add a plane angle [rad]; a direction's functions are cosθ and sinθ."""
        return self.symbol(name, "rad", f"angle {words}".strip(), within=within, **more)

    def differential(
        self, name: str, unit: str, words: str = "", *, kind: str = "", order: int | Fraction = 1
    ) -> Any:
        """Add a differential: dω in sr, dA in m^2, dt in s; a side of an element has ``order=HALF``."""
        return self._add(name, unit, kind, words, order, (), None, {})

    def _add(
        self,
        name: str,
        unit: str,
        kind: str,
        words: str,
        order: int | Fraction,
        of: Sequence[sympy.Symbol],
        within: tuple[float, float] | None,
        assumptions: dict[str, bool],
    ) -> Any:
        assumptions = assumptions or {"positive": True}
        made = sympy.Function(name, **assumptions) if of else sympy.Symbol(name, **assumptions)
        if any(str(known) == name for known in self.meanings):
            raise ParameterError("name", name, "one that this notation does not have yet")
        arguments = tuple(self.meaning(argument).dimension for argument in of)
        self.meanings[made] = Meaning(Dimension.of(unit), kind, Fraction(order), words, arguments)
        if within is not None:
            self.ranges[made] = within
        return made

    def meaning(self, symbol: Any) -> Meaning:
        """Return what a symbol or a function stands for.

        Raises
        ------
        ParameterError
            When the notation has no such symbol.
        """
        if symbol not in self.meanings:
            known = ", ".join(map(str, self.meanings))
            raise ParameterError("symbol", symbol, f"one of the notation's ({known})")
        return self.meanings[symbol]

    def latex(self, expression: Any) -> str:
        """Return LaTeX in which Greek letters are commands and a differential's d is upright."""
        atoms = {a for a in sympy.preorder_traversal(expression) if isinstance(a, sympy.Symbol)}
        names = {symbol: latex_name(symbol.name) for symbol in atoms}
        text = str(sympy.latex(expression, symbol_names=names))
        return "".join(greek(letter) for letter in text)

    def describe(self, symbol: Any) -> str:
        """Return one line for a list of symbols, such as ``"E: irradiance [W/m²]"``."""
        meaning = self.meaning(symbol)
        noun = meaning.kind or _NOUNS.get(str(meaning.dimension), "number")
        if meaning.kind:
            words = f"{noun}, {meaning.words}" if meaning.words else noun
        elif not meaning.words or meaning.words.split(" ")[0] in _PREPOSITIONS:
            words = f"{noun} {meaning.words}".strip()
        else:
            words = meaning.words
        if meaning.order:
            words = f"{_ORDERS.get(meaning.order, 'differential')} of {words}"
        unit = f" [{meaning.dimension}]" if meaning.dimension != NUMBER else ""
        return f"{symbol}: {words}{unit}"


def latex_name(name: str) -> str:
    r"""Return a symbol's name as LaTeX.

    >>> print(latex_name("dω_i"), latex_name("d2Φ"), latex_name("L_λ"))
    \mathrm{d}\omega_{i} \mathrm{d}^{2}\Phi L_{\lambda}
    """
    head, *subscripts = name.split("_")
    found = re.fullmatch(r"d(\d?)(\w+)", head)
    if found and len(head) > 1:
        power = f"^{{{found[1]}}}" if found[1] else ""
        head = rf"\mathrm{{d}}{power}" + "".join(map(greek, found[2])).strip()
    else:
        head = "".join(map(greek, head)).strip()
    below = ",".join("".join(map(greek, part)).strip() for part in subscripts)
    return f"{head}_{{{below}}}" if below else head


def greek(letter: str) -> str:
    """Return a Greek letter's command, with a space behind it, and any other letter as it is."""
    return f"\\{_GREEK[letter]} " if letter in _GREEK else letter
