"""Importing radiokit is cheap, and its public names are what its stub says."""

from __future__ import annotations

import importlib
import json
import subprocess
import sys

import pytest

import radiokit

HEAVY = (
    "colour",
    "matplotlib",
    "mpmath",
    "numba",
    "pint",
    "pyvista",
    "rich",
    "scipy",
    "sympy",
    "typer",
    "vtk",
)


def modules_after(code: str) -> set[str]:
    """Return the top-level modules that a fresh interpreter has loaded after running ``code``."""
    show = "import json, sys; print(json.dumps(sorted({name.split('.')[0] for name in sys.modules})))"
    run = subprocess.run(
        [sys.executable, "-c", f"{code}\n{show}"], capture_output=True, text=True, check=True
    )
    return set(json.loads(run.stdout.splitlines()[-1]))


def test_importing_radiokit_loads_numpy_and_nothing_heavier():
    assert not modules_after("import radiokit") & set(HEAVY)


@pytest.mark.parametrize(
    ("code", "allowed"),
    [
        ("radiokit.list_bsdfs(); radiokit.bsdf('ggx')((0, 0, 1), (0, 0, 1))", set()),
        ("radiokit.albedo(radiokit.bsdf('ggx'), (0, 0, 1))", set()),
        ("radiokit.directions.reflect", set()),
        ("radiokit.quantity('radiance')", set()),
        ("radiokit.emitter('point', position=(0, 0, 1), intensity=1)", set()),
        ("radiokit.check(radiokit.bsdf('ggx'))", {"scipy", "sympy", "mpmath"}),
    ],
)
def test_ordinary_use_loads_only_what_it_needs(code, allowed):
    assert not modules_after(f"import radiokit; {code}") & (set(HEAVY) - allowed)


def test_every_public_name_exists():
    for name in radiokit.__all__:
        assert getattr(radiokit, name) is not None
    assert set(radiokit.__all__) <= set(dir(radiokit))


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="nothing_like_it"):
        _ = radiokit.nothing_like_it
    with pytest.raises(AttributeError, match=r"radiokit\.bsdfs has no class 'Gxg'; it has: .*GGX, "):
        _ = radiokit.bsdfs.Gxg


def test_models_are_reached_by_class_and_by_name():
    assert radiokit.bsdfs.GGX(alpha=0.3) == radiokit.bsdf("ggx", alpha=0.3)
    assert "Point" in dir(radiokit.emitters)


def test_every_module_says_in_its_first_line_what_belongs_in_it():
    for name in (
        "facts",
        "measure",
        "physics",
        "contracts",
        "bsdfs",
        "emitters",
        "occluders",
        "checks",
        "worlds",
        "faces",
    ):
        doc = importlib.import_module(f"radiokit.{name}").__doc__
        assert doc.split(":")[0].lower() == name
