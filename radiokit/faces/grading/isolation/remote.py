"""Remote functions: a submission's f(wi, wo) as a BSDF whose values come from a sandbox."""

from __future__ import annotations

import dataclasses
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from radiokit.contracts.blackbox import BlackBox, as_bsdf
from radiokit.contracts.bsdf import BSDF, FloatArray
from radiokit.contracts.calling import Mode
from radiokit.faces.grading.isolation.limits import Limits
from radiokit.faces.grading.isolation.protocol import plain_text
from radiokit.faces.grading.isolation.sandbox import Sandbox
from radiokit.faces.grading.isolation.signature import renamed
from radiokit.facts.errors import CallableError, TargetError, suggestion

__all__ = ["is_pairwise", "open_isolated", "remote_bsdf"]

BLOCK = 4096
"""How many pairs are sent at a time to a function that takes one, so that each call ends in time."""

LEAST = 1e-100
"""The least refractive index, and the reciprocal of the largest."""


class _Remote:
    """A function in a sandbox, that is called as if it were here."""

    def __init__(
        self, sandbox: Sandbox, name: str, parameters: Mapping[str, Any], mode: Mode = "batch"
    ) -> None:
        self._sandbox, self._name, self._parameters, self.mode = sandbox, name, parameters, mode
        self.__name__ = name
        self._shape: tuple[int, ...] | None = None

    def looped(self, mode: Mode) -> _Remote:
        """Return the function with its loop over pairs on the other side, so that blocks are sent."""
        return _Remote(self._sandbox, self._name, self._parameters, mode)

    def __call__(self, first: FloatArray, second: FloatArray) -> Any:
        if self.mode == "batch" or len(first) <= BLOCK:
            return self._ask(first, second)
        parts = [slice(start, start + BLOCK) for start in range(0, len(first), BLOCK)]
        return np.concatenate([self._ask(first[part], second[part]) for part in parts])

    def _ask(self, first: FloatArray, second: FloatArray) -> Any:
        result = self._sandbox.call(self._name, first, second, mode=self.mode, parameters=self._parameters)
        if result.output:  # printed here too: the black box takes note of it
            sys.stdout.write(plain_text(result.output) + "\n")
        if result.raised:  # raised here too, so that the pair that did it is looked for
            kind = type(result.raised if result.raised.isidentifier() else "Exception", (Exception,), {})
            raise kind(result.error.removeprefix(f"raised {result.raised}").removeprefix(": "))
        if not result.ok:
            raise CallableError(self._name, result.error)
        answer = result.values[0]
        if len(result.values) > 1:
            return result.values
        if len(first) > 1 and answer.shape[:1] == (len(first),):
            self._shape = answer.shape[1:] if self._shape is None else self._shape
            if answer.shape[1:] != self._shape:
                raise CallableError(
                    self._name, f"returned shape {answer.shape} after {(len(first), *self._shape)}"
                )
        return answer


def remote_bsdf(
    sandbox: Sandbox,
    function: str,
    *,
    parameters: Mapping[str, Any] | None = None,
    by_position: bool = False,
) -> BSDF:
    """Return a function in a sandbox as a BSDF, for the judges and whatever else takes one.

    It is ``as_bsdf`` of a function that happens to run elsewhere: its ``pdf``, ``sample``, ``transmissive``
    and ``eta`` count, and a function of single pairs is looped over there. The sandbox must stay open.

    Parameters
    ----------
    sandbox : Sandbox
    function : str
        The function's name.
    parameters : dict, optional
        Its keyword arguments.
    by_position : bool
        Whether those whose names it does not know are given to its other parameters in their order, where
        they are as many.

    Raises
    ------
    TargetError
        When the file does not run, or has no such function.
    CallableError
        When the function raises, is stopped, or returns what is no value.
    """
    found = sandbox.facts(function)
    if not found.ok:
        raise TargetError(f"the submission {found.error}")
    facts = found.facts
    if not facts["callable"]:
        loaded = sandbox.load().facts
        names = loaded["names"]
        raise TargetError(
            f"the submission has no function {function!r}{suggestion(function, names) or '.'} "
            f"It defines: {', '.join(names) or 'no function'}" + _first(loaded["problems"])
        )
    given = dict(parameters or {})
    extra = {
        name: _Remote(sandbox, f"{function}.{name}", {})
        for name in ("pdf", "sample")
        if facts[name] and not given  # they would not know the parameters
    }
    transmissive = bool(given.get("transmissive", facts["transmissive"]))
    eta = facts["eta"]
    if transmissive and "eta" not in given and eta is not None and not LEAST <= eta <= 1 / LEAST:
        raise CallableError(function, f"has eta = {eta:g}, which is no refractive index")
    passed = renamed(facts["parameters"], given) if by_position else given
    remote = _Remote(sandbox, function, passed)
    model = as_bsdf(
        remote,
        label=function,
        transmissive=transmissive,
        eta=given.get("eta", eta) if transmissive else None,
        **extra,
    )
    if not isinstance(model, BlackBox) or model.mode == "batch":
        return model
    pdf = extra.get("pdf")
    return dataclasses.replace(
        model,
        function=remote.looped(model.mode),
        pdf_function=None if pdf is None else pdf.looped(model.mode),
        mode="batch",
    )


def is_pairwise(model: BSDF) -> bool:
    """Return whether a BSDF in a sandbox is a function of one pair, and so slower than one of arrays."""
    function = getattr(model, "function", None)
    return isinstance(function, _Remote) and function.mode != "batch"


def _first(problems: Sequence[Mapping[str, str]]) -> str:
    """Return the first of a submission's problems as the end of a sentence."""
    if not problems:
        return ""
    words = (problems[0][name] for name in ("where", "raised", "message"))
    return f" ({': '.join(word for word in words if word)})"


@contextmanager
def open_isolated(target: str, parameters: Mapping[str, Any], limits: Limits | None = None) -> Iterator[BSDF]:
    """Open a sandbox for ``file.py:function``, and yield the function as a BSDF; the file must stand alone.

    It may be a notebook too, ``file.ipynb:function``.

    Raises
    ------
    TargetError
        When the target is no function in a file.
    """
    path, colon, name = target.rpartition(":")
    if not colon or Path(path).suffix.lower() not in (".py", ".ipynb"):
        raise TargetError(f"cannot isolate {target!r}: only file.py:function is run in a sandbox")
    if not Path(path).is_file():
        raise TargetError(f"no such file: {path}")
    with Sandbox(path, limits=limits) as sandbox:
        yield remote_bsdf(sandbox, name, parameters=parameters)
