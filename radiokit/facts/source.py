"""Source: where a formula comes from, as an object that travels with it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

__all__ = ["Source"]


@dataclass(frozen=True, kw_only=True)
class Source:
    """A publication, the equation used, and the errata found while using it.

    Parameters
    ----------
    authors : str
        Family names, as a citation gives them.
    year : int
    title : str
    doi : str
        Without the resolver's address; empty where there is none.
    equation : str
        Which equation, section or table the code follows.
    errata : str
        What is wrong in print, and what is right.

    >>> Source(authors="Lambert", year=1760, title="Photometria").cite()
    'Lambert (1760). Photometria.'
    """

    authors: str
    year: int
    title: str
    doi: str = ""
    equation: str = ""
    errata: str = ""

    def cite(self) -> str:
        """Return the source as one line of text."""
        parts = [f"{self.authors} ({self.year}). {self.title}."]
        if self.equation:
            parts.append(f"{self.equation}.")
        if self.doi:
            parts.append(f"doi:{self.doi}")
        return " ".join(parts)

    def to_json(self) -> dict[str, Any]:
        """Return the source as JSON-ready data."""
        return {name: getattr(self, name) for name in self.__dataclass_fields__}
