"""Cells: a notebook as a list of cells, and its two forms as text: notebook (.ipynb) and script (.py)."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

__all__ = ["Cell", "code", "markdown", "notebook", "raw", "script"]

IDENTIFIER = re.compile(r"[a-zA-Z0-9_-]{1,64}")


@dataclass(frozen=True, kw_only=True)
class Cell:
    """A cell; ``key`` says which one it is, in every copy of every version, and becomes its id."""

    kind: Literal["markdown", "code", "raw"]
    key: str
    source: str
    metadata: Mapping[str, Any] = field(default_factory=dict)

    @property
    def id(self) -> str:
        """The key if it can be a cell's id, else its digest.

        >>> markdown("intro", "").id, markdown("ω", "").id
        ('intro', 'faed5da5f84f2ee9')
        """
        if IDENTIFIER.fullmatch(self.key):
            return self.key
        return hashlib.sha256(self.key.encode()).hexdigest()[:16]


def markdown(key: str, source: str, **metadata: Any) -> Cell:
    """Return a cell of text."""
    return Cell(kind="markdown", key=key, source=source.strip(), metadata=metadata)


def code(key: str, source: str, **metadata: Any) -> Cell:
    """Return a cell of code."""
    return Cell(kind="code", key=key, source=source.strip("\n"), metadata=metadata)


def raw(key: str, source: str, **metadata: Any) -> Cell:
    """Return a cell that is neither."""
    return Cell(kind="raw", key=key, source=source.strip(), metadata=metadata)


def notebook(cells: Sequence[Cell]) -> str:
    """Return a notebook without outputs, byte by byte the same for the same cells.

    >>> json.loads(notebook([code("sum", "1 + 1")]))["cells"][0]["source"]
    ['1 + 1']
    """
    listed = []
    for cell in cells:
        data: dict[str, Any] = {"cell_type": cell.kind, "id": cell.id, "metadata": dict(cell.metadata)}
        data["source"] = cell.source.splitlines(keepends=True)
        if cell.kind == "code":
            data |= {"execution_count": None, "outputs": []}
        listed.append(data)
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    metadata = {"kernelspec": kernel, "language_info": {"name": "python"}}
    whole = {"cells": listed, "metadata": metadata, "nbformat": 4, "nbformat_minor": 5}
    return json.dumps(whole, ensure_ascii=False, indent=1, sort_keys=True) + "\n"


def script(cells: Sequence[Cell]) -> str:
    r"""Return a script whose cells begin with ``# %%``, as editors and Jupytext read them.

    >>> print(script([markdown("a", "Text,\n\nmore"), code("b", "x = 1")]), end="")
    # %% [markdown]
    # Text,
    #
    # more
    <BLANKLINE>
    # %%
    x = 1
    """
    parts = []
    for cell in cells:
        if cell.kind == "code":
            parts.append(f"# %%\n{cell.source}\n")
        else:
            lines = [f"# {line}".rstrip() for line in cell.source.split("\n")]
            parts.append("\n".join([f"# %% [{cell.kind}]", *lines, ""]))
    return "\n".join(parts)
