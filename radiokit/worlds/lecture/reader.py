"""Reader: reads the LaTeX of a slide into SymPy, each symbol with the meaning that it has there."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import sympy

from radiokit.facts.errors import ParameterError
from radiokit.facts.quantities import list_quantities
from radiokit.physics.relations.notation import SR, Notation

__all__ = ["SYMBOLS", "Reading", "read"]

SYMBOLS: Mapping[str, str] = {
    "Q": "radiant_energy",
    "t": "s",
    "Φ": "radiant_flux",
    "I": "radiant_intensity",
    "E": "irradiance",
    "M": "radiant_exitance",
    "L": "radiance",
    "f": "bsdf",
    "S": "m^2",
    "ω": "sr",
    "θ": "rad",
}
"""What the lecture's symbols stand for, by its own slides: a quantity or a unit."""

_GREEK = {
    "omega": "ω", "theta": "θ", "Phi": "Φ", "phi": "φ", "rho": "ρ", "alpha": "α", "lambda": "λ", "Omega": "Ω",
    "Delta": "Δ", "eta": "η", "delta": "δ", "tau": "τ",
}  # fmt: skip
_RELATIONS = {"=": "=", r"\leq": "≤", r"\le": "≤", r"\geq": "≥", r"\ge": "≥", r"\propto": "∝"}
_SPACES = re.compile(r"\\[ ,;!]|\\quad|\$|\s+")
_TOKEN = re.compile(r"\\[a-zA-Z]+|\d+(?:\.\d+)?|[А-Яа-яЁё]+(?: [А-Яа-яЁё]+)*|[A-Za-z]|[{}()^_=+\-*/,'|]")
_FUNCTIONS = {r"\cos": sympy.cos, r"\sin": sympy.sin, r"\tan": sympy.tan}
_PLAIN_ARGUMENTS = re.compile(r"[^+\-*/=()]*")


@dataclass
class Reading:
    """A printed formula in SymPy: its sides, the signs between them, and what its symbols mean."""

    notation: Notation
    sides: list[Any] = field(default_factory=list)
    signs: list[str] = field(default_factory=list)

    @property
    def relations(self) -> list[tuple[Any, str, Any]]:
        """The first side with each of the others."""
        return [(self.sides[0], sign, side) for sign, side in zip(self.signs, self.sides[1:], strict=True)]


def read(latex: str, symbols: Mapping[str, str] | None = None) -> Reading:
    r"""Return a printed formula in SymPy.

    Directions and places in parentheses after a symbol are no factors; d before a symbol makes a
    differential, and ∫ takes one of them.

    Parameters
    ----------
    latex : str
        A chain of =, ≤ and ∝, of sums, products, fractions, powers, cosines, ∫ and Σ.
    symbols : mapping of str to str, optional
        What symbols stand for where ``SYMBOLS`` does not say it: a quantity, or a unit. A symbol with
        indices that are not listed means what it means without them. "π" in "sr" is a number of steradians.

    Raises
    ------
    ParameterError
        When the formula cannot be read, or nothing says what a symbol means.

    >>> reading = read(r"dE(p, \omega_i) = L_i(p, \omega_i) \cos \theta_i")
    >>> print(*reading.sides, sep=" = ")
    dE = L_i*cos(θ_i)
    """
    return _Reader(latex, {**SYMBOLS, **(symbols or {})}).relation()


class _Reader:
    def __init__(self, latex: str, symbols: Mapping[str, str]) -> None:
        text = re.sub(r"\\forall.*?\\ |\\left|\\right|\\mathrm|\\text", " ", latex)
        text = re.sub(r"\s+", " ", _SPACES.sub(" ", text))
        self.latex, self.symbols = latex, symbols
        self.tokens = _TOKEN.findall(text)
        if re.sub(r"\s", "", "".join(self.tokens)) != re.sub(r"\s", "", text):
            raise ParameterError("latex", latex, "of signs that the reader knows")
        self.place = 0
        self.notation = Notation()
        self.made: dict[tuple[str, int], Any] = {}

    @property
    def next(self) -> str:
        return self.tokens[self.place] if self.place < len(self.tokens) else ""

    def take(self, wanted: str = "") -> str:
        token = self.next
        if not token or (wanted and token != wanted):
            raise ParameterError(
                "latex", self.latex, f"complete: {wanted or 'more'!r} is expected, not {token!r}"
            )
        self.place += 1
        return token

    def relation(self) -> Reading:
        reading = Reading(self.notation, [self.sum()])
        while self.next in _RELATIONS:
            reading.signs.append(_RELATIONS[self.take()])
            reading.sides.append(self.sum())
        if self.next or not reading.signs:
            raise ParameterError("latex", self.latex, f"an equation or an inequality, without {self.next!r}")
        return reading

    def sum(self) -> Any:
        parts = [self.product()]
        while self.next in ("+", "-"):
            sign = -1 if self.take() == "-" else 1
            parts.append(sign * self.product())
        return sympy.Add(*parts)

    def product(self) -> Any:
        factors: list[Any] = []
        while True:
            if self.next in ("*", r"\cdot"):
                self.take()
            elif self.next == "/":
                self.take()
                factors.append(1 / self.factor())
            elif self.next in (r"\int", r"\sum"):
                factors.append(self.integral() if self.next == r"\int" else self.discrete())
            elif not self.next or self.next in (*_RELATIONS, "+", "-", ")", "}", ","):
                if not factors:
                    raise ParameterError(
                        "latex", self.latex, f"complete: nothing stands before {self.next!r}"
                    )
                return sympy.Mul(*factors)
            else:
                factors.append(self.factor())

    def integral(self) -> Any:
        """Read ∫ … dx: of the factors that follow, the last differential is the variable's."""
        self.take()
        self.skip_limits()
        body = self.product()
        factors = sympy.Mul.make_args(body)
        orders = {made: order for (_, order), made in self.made.items()}
        variables = [factor for factor in factors if orders.get(factor) == 1]
        if not variables:
            return body  # nothing to integrate over: let the units tell
        last = max(variables, key=lambda symbol: list(self.made.values()).index(symbol))
        name = next(name for (name, order), made in self.made.items() if made == last)
        return sympy.Integral(body / last, self.symbol(name, 0))

    def discrete(self) -> Any:
        self.take()
        self.skip_limits()
        index = sympy.Symbol("j", integer=True)
        return sympy.Sum(self.product(), (index, 0, sympy.Symbol("n", integer=True) - 1))

    def skip_limits(self) -> None:
        while self.next in ("_", "^"):
            self.take()
            self.group()

    def group(self) -> str:
        """Return the text of {…}, or of the next token."""
        if self.next != "{":
            return self.spelled(self.take())
        self.take("{")
        depth, parts = 1, []
        while depth:
            token = self.take()
            depth += {"{": 1, "}": -1}.get(token, 0)
            parts.append(self.spelled(token))
        return "".join(part for part in parts if part not in "{}")

    def spelled(self, token: str) -> str:
        return _GREEK.get(token[1:], token) if token.startswith("\\") else token

    def factor(self) -> Any:
        token = self.next
        if token == r"\frac":
            self.take()
            above, below = self.braced(), self.braced()
            return above / below
        if token in _FUNCTIONS:
            self.take()
            return self.powered(_FUNCTIONS[token], self.factor)
        if token in ("(", "{"):
            self.take()
            inner = self.sum()
            self.take(")" if token == "(" else "}")
            return self.raised(inner)
        if re.fullmatch(r"\d.*", token):
            return self.raised(sympy.nsimplify(self.take()))
        if token == r"\pi":
            self.take()
            return self.raised(sympy.pi * (SR if self.symbols.get("π") == "sr" else 1))
        return self.named()

    def powered(self, function: Any, argument: Any) -> Any:
        power = 1
        if self.next == "^":
            self.take()
            power = sympy.nsimplify(self.group())
        return function(argument()) ** power

    def braced(self) -> Any:
        self.take("{")
        inner = self.sum()
        self.take("}")
        return inner

    def raised(self, base: Any) -> Any:
        if self.next != "^":
            return base
        self.take()
        return base ** sympy.nsimplify(self.group())

    def named(self) -> Any:
        order = 0
        if self.next in ("d", "D") and self.place + 1 < len(self.tokens) and self.differential_follows():
            self.take()
            order = 1
            if self.next == "^":
                self.take()
                order = int(self.group())
        token = self.take()
        if not re.match(r"\\|[A-Za-zА-Яа-яЁё]", token):
            raise ParameterError("latex", self.latex, f"of symbols and numbers, without {token!r} there")
        name, power = self.spelled(token), 1
        if name == "Δ":
            name += self.spelled(self.take())
        while self.next in ("_", "^", "'"):
            mark = self.take()
            if mark == "'":
                name += "'"
                continue
            index = self.group()
            if mark == "^" and index.isdigit():
                power = int(index)
            elif index == r"\prime":
                name += "'"
            else:
                name += f"_{index}"
        self.skip_arguments()
        return self.symbol(name, order) ** power

    def differential_follows(self) -> bool:
        following = self.tokens[self.place + 1]
        return following.startswith("\\") or following == "^" or following.isalpha()

    def skip_arguments(self) -> None:
        """Pass over (p, ω_i): names and commas only."""
        if self.next != "(":
            return
        end = self.place + 1
        while end < len(self.tokens) and self.tokens[end] != ")":
            end += 1
        if _PLAIN_ARGUMENTS.fullmatch("".join(self.tokens[self.place + 1 : end])):
            self.place = end + 1

    def symbol(self, name: str, order: int) -> Any:
        if name == "Ω_0":
            return SR
        if (name, order) not in self.made:
            means = self.meaning(name)
            prefix = {0: "", 1: "d"}.get(order, f"d{order}")
            if means in list_quantities():
                made = self.notation.quantity(f"{prefix}{name}", means, order=order)
            else:
                made = self.notation.symbol(f"{prefix}{name}", means, order=order)
            self.made[name, order] = made
        return self.made[name, order]

    def meaning(self, name: str) -> str:
        shorter = name
        while shorter not in self.symbols:
            cut = re.sub(r"(?:'|_[^_]*)$", "", shorter)
            if cut == shorter:
                raise ParameterError("symbols", name, f"explained; known are {', '.join(self.symbols)}")
            shorter = cut
        return self.symbols[shorter]
