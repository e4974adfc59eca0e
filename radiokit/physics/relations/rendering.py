"""Rendering: a derivation as aligned LaTeX, as Markdown for a notebook, and as text for a terminal."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import sympy

from radiokit.facts.verdict import Outcome
from radiokit.physics.relations.notation import greek, latex_name

if TYPE_CHECKING:
    from radiokit.physics.relations.derivation import Derivation

__all__ = ["aligned", "markdown", "plain"]

_MARKS = {Outcome.HOLDS: "✓", Outcome.VIOLATED: "✗", Outcome.INCONCLUSIVE: "?"}
_ESCAPED = {c: rf"\{c}" for c in "%_&#${}"}
_IN_MATHS = {
    "∫": r"\int ",
    "√": r"\surd ",
    "≤": r"\le ",
    "→": r"\to ",
    "·": r"\cdot ",
    "×": r"\times ",
    "−": "-",
    **{sign: f"^{digit}" for sign, digit in zip("²³⁴", "234", strict=True)},
    **{sign: f"_{digit}" for sign, digit in zip("₀₁₂", "012", strict=True)},
}


def aligned(derivation: Derivation) -> str:
    """Return the steps as an ``aligned`` environment; a left side that goes on is not repeated."""
    lines, last = [], None
    for step in derivation.steps:
        relation, latex = step.relation, derivation.notation.latex
        sign = {"==": "=", "<=": r"\le", ">=": r"\ge"}.get(relation.rel_op, relation.rel_op)
        left = "" if relation.lhs == last else latex(relation.lhs)
        lines.append(rf"{left} &{sign} {latex(relation.rhs)} && \text{{{latex_text(step.why)}}}")
        last = relation.lhs
    body = " \\\\\n".join(lines)
    return f"\\begin{{aligned}}\n{body}\n\\end{{aligned}}"


def latex_text(text: str) -> str:
    r"""Return plain text as LaTeX's text mode has it: Greek letters and signs become mathematics.

    >>> print(latex_text("μ = cosθ_i, 50 %"))
    $\mu$ = cos$\theta_{i}$, 50 \%
    """
    parts = [
        f"${latex_name(piece)}$" if i % 2 else "".join(map(_letter, piece))
        for i, piece in enumerate(re.split(r"(\w_\w+)", text))
    ]
    return "".join(parts).replace("$$", " ")


def _letter(letter: str) -> str:
    maths = _maths(letter).strip()
    return f"${maths}$" if maths else _ESCAPED.get(letter, letter)


def _maths(letter: str) -> str:
    """Return the LaTeX command of a Greek letter or a sign, or an empty string."""
    return _IN_MATHS.get(letter, "") or (greek(letter) if greek(letter) != letter else "")


def _how(derivation: Derivation, index: int) -> str:
    if not derivation.findings:
        return "premise" if derivation.steps[index].premise else "not verified"
    finding = derivation.findings[index]
    if finding.how == "premise":
        return "premise"
    return f"{_MARKS[finding.outcome]} {finding.how}: {finding.message}"


def markdown(derivation: Derivation) -> str:
    """Return the derivation as Markdown: statement, assumptions, symbols, and each step with its verdict."""
    lines = [f"### {derivation.title}", "", derivation.statement, ""]
    lines += [f"- {text}" for text in derivation.assumptions]
    lines += [""] if derivation.assumptions else []
    for i, step in enumerate(derivation.steps):
        lines += [f"{i + 1}. {step.why} *({_how(derivation, i)})*", ""]
        lines += [f"   $$ {derivation.notation.latex(step.relation)} $$", ""]
    symbols = "; ".join(derivation.notation.describe(symbol) for symbol in derivation.notation.meanings)
    lines += [f"Symbols: {symbols}.", "", f"Source: {derivation.source.cite()}"]
    return "\n".join(lines)


def plain(derivation: Derivation) -> str:
    """Return the derivation as text for a terminal."""
    lines = [derivation.title, f"  {derivation.statement}", ""]
    lines += [f"  assuming {text}" for text in derivation.assumptions]
    for i, step in enumerate(derivation.steps):
        lines += ["", f"  {i + 1}. {step.why}  [{_how(derivation, i)}]"]
        lines += [f"       {line}" for line in _pretty(step.relation).splitlines()]
    lines += ["", "  where"]
    lines += [f"    {derivation.notation.describe(symbol)}" for symbol in derivation.notation.meanings]
    lines += ["", f"  source: {derivation.source.cite()}"]
    return "\n".join(lines)


def _pretty(relation: Any) -> str:
    return str(sympy.pretty(relation, use_unicode=True, wrap_line=False))
