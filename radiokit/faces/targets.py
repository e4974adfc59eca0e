"""Targets: what a command may be pointed at: a model's name, or a function in a file."""

from __future__ import annotations

import contextlib
import functools
import importlib.util
import inspect
import io
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.bsdf import BSDF, bsdf, list_bsdfs
from radiokit.facts.errors import TargetError, suggestion

__all__ = ["load_target", "parse_parameters"]

FORMS = "a model's name, or file.py:function"


def parse_parameters(arguments: list[str]) -> dict[str, Any]:
    """Turn ``["--alpha", "0.3", "--eta=1.5"]`` into keyword parameters.

    >>> parse_parameters(["--alpha", "0.3", "--eta=1.5"])
    {'alpha': 0.3, 'eta': 1.5}
    """
    found: dict[str, Any] = {}
    rest = list(arguments)
    while rest:
        word = rest.pop(0)
        if not word.startswith("--") or len(word) < 3:
            raise TargetError(f"unexpected argument {word!r}: parameters are given as --name VALUE")
        name, equals, text = word[2:].partition("=")
        if not equals:
            if not rest:
                raise TargetError(f"parameter --{name} has no value: give --{name} VALUE")
            text = rest.pop(0)
        found[name.replace("-", "_")] = _value(text)
    return found


def _value(text: str) -> Any:
    for kind in (int, float):
        with contextlib.suppress(ValueError):
            return kind(text)
    return text


def load_target(target: str, parameters: dict[str, Any]) -> BSDF:
    """Return the BSDF that a command-line target names.

    Parameters
    ----------
    target : str
        A model's name, or ``file.py:function``. A function may also be a BSDF object, or a BSDF class.
    parameters : dict
        Keyword parameters of the model or of the function.

    Raises
    ------
    TargetError
        When the file, the function, or the name is not there, or the file does not run.
    RadiokitError
        When a parameter is not allowed.
    """
    path, colon, name = target.rpartition(":")
    if not colon and (target.endswith(".py") or "/" in target):
        path, name = target, ""
    elif not colon:
        return _model(target, parameters)
    file = Path(path)
    if file.suffix != ".py":
        raise TargetError(f"cannot check {target!r}: a target is {FORMS}")
    if not file.is_file():
        raise TargetError(f"no such file: {path}")
    module = _import(file)
    found = getattr(module, name, None) if name else None
    if found is None:
        known = [key for key, value in vars(module).items() if _defined_here(module, key, value)]
        listed = f"It defines: {', '.join(known) or 'no function'}"
        if not name:
            raise TargetError(f"name the function, as in {path}:FUNCTION. {listed}")
        raise TargetError(f"{path} has no function {name!r}{suggestion(name, known) or '.'} {listed}")
    if inspect.isclass(found) and issubclass(found, BSDF):
        return _called(found, parameters, target)
    if isinstance(found, BSDF) and not parameters:
        return found
    if not callable(found):
        raise TargetError(f"{target} is no function: it is {type(found).__name__}")
    if parameters:
        _bind(found, parameters, target)
        found = functools.partial(found, **parameters)
    return as_bsdf(found, label=name)


def _model(name: str, parameters: dict[str, Any]) -> BSDF:
    if name not in list_bsdfs():
        hint = suggestion(name, list_bsdfs()) or "."
        raise TargetError(
            f"unknown model {name!r}{hint} Known: {', '.join(list_bsdfs())}; or give file.py:function"
        )
    return bsdf(name, **parameters)


def _called(cls: type, parameters: dict[str, Any], target: str) -> BSDF:
    try:
        model: BSDF = cls(**parameters)
    except TypeError as error:
        raise TargetError(f"{target}: {error}") from None
    return model


def _bind(function: Any, parameters: dict[str, Any], target: str) -> None:
    """Refuse parameters that the function does not take, by name."""
    try:
        inspect.signature(function).bind("wi", "wo", **parameters)
    except TypeError as error:
        raise TargetError(f"{target}: {error}") from None
    except ValueError:  # a builtin has no signature: then it says itself what it does not take
        return


def _defined_here(module: ModuleType, name: str, value: Any) -> bool:
    return (
        callable(value) and not name.startswith("_") and getattr(value, "__module__", "") == module.__name__
    )


def _import(file: Path) -> ModuleType:
    """Run a file as a module of its own, with its folder importable, and without its prints."""
    name = f"_radiokit_target_{file.stem}"
    spec = importlib.util.spec_from_file_location(name, file)
    if spec is None or spec.loader is None:
        raise TargetError(f"cannot import {file}")
    module = importlib.util.module_from_spec(spec)
    sys.path.insert(0, str(file.resolve().parent))
    sys.modules[name] = module
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            spec.loader.exec_module(module)
    except SyntaxError as error:
        raise TargetError(f"{file}, line {error.lineno}: syntax error: {error.msg}") from None
    except (Exception, SystemExit) as error:
        line = _line_of(error, file)
        where = f"{file}, line {line}" if line else str(file)
        raise TargetError(f"{where}: {type(error).__name__} while it was imported: {error}") from None
    finally:
        sys.path.remove(str(file.resolve().parent))
    return module


def _line_of(error: BaseException, file: Path) -> int | None:
    line, trace = None, error.__traceback__
    while trace is not None:
        if Path(trace.tb_frame.f_code.co_filename).resolve() == file.resolve():
            line = trace.tb_lineno
        trace = trace.tb_next
    return line
