"""Models of other packages: found through their entry points, judged like ours, and told what is wrong."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import radiokit

MODEL = '''"""Felt: a diffuse cloth, to show what a model in another package needs."""

from dataclasses import dataclass

import numpy as np

import radiokit as rk

SOURCE = rk.Source(authors="Weaver", year=2026, title="On cloth", equation="(1)")
COSINE = rk.warps.CosineHemisphere()


@dataclass(frozen=True, kw_only=True)
class Felt(rk.BSDF):
    """A cloth that scatters evenly."""

    name = "felt"
    SOURCE = SOURCE
    reflectance: float = rk.parameter("[0, 1]", "1", "reflectance", default=0.5)

    def symbolic(self):
        import sympy

        rho = sympy.Symbol("rho", nonnegative=True)
        return rk.Twin(rho / sympy.pi, {rho: self.reflectance})

    def evaluate(self, wi, wo):
        return np.where((wi[:, 2] > 0) & (wo[:, 2] > 0), self.reflectance / np.pi, 0.0)

    def pdf(self, wi, wo):
        return COSINE.pdf(wi)

    def sample(self, u, wo):
        return COSINE.sample(u), np.where(wo[:, 2] > 0, self.reflectance, 0.0)

    @property
    def claims(self):
        return rk.Claims(reciprocity="yes", conserves=True, lossless=False)
'''


def install(folder: Path, text: str) -> None:
    """Lay a package out as an installer does: its module, and its metadata with an entry point."""
    (folder / "felt.py").write_text(text)
    data = folder / "felt-1.0.dist-info"
    data.mkdir()
    (data / "METADATA").write_text("Metadata-Version: 2.1\nName: felt\nVersion: 1.0\n")
    (data / "entry_points.txt").write_text("[radiokit.bsdfs]\nfelt = felt:Felt\n")


def radiokit_with(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    program = "import sys; from radiokit.faces.cli import main; sys.exit(main())"
    if words[0] == "-c":
        program, words = words[1], ()
    root = str(Path(radiokit.__file__).parents[1])
    return subprocess.run(
        [sys.executable, "-c", program, *words],
        env={**os.environ, "PYTHONPATH": os.pathsep.join((str(folder), root))},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


def test_a_model_of_another_package_is_listed_and_judged(tmp_path):
    install(tmp_path, MODEL)
    listed = radiokit_with(tmp_path, "-c", "import radiokit; print(*radiokit.list_bsdfs())")
    assert "felt" in listed.stdout.split()
    found = radiokit_with(tmp_path, "check", "felt", "--reflectance", "0.9", "--json")
    assert (found.returncode, found.stderr) == (0, "")
    report = json.loads(found.stdout)
    assert "felt" in report["subject"].lower()
    assert {verdict["outcome"] for verdict in report["verdicts"]} == {"holds"}


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("lossless=False", "lossless=True", "lossless: claimed yes, observed violated"),
        ('reciprocity="yes"', 'reciprocity="no"', "reciprocity: claimed no, observed holds"),
    ],
)
def test_a_wrong_claim_of_another_package_is_found(old, new, message, tmp_path):
    assert old in MODEL
    install(tmp_path, MODEL.replace(old, new))
    found = radiokit_with(tmp_path, "validate", "felt", "--json", "--workers", "1", "--no-figures")
    assert found.returncode == 1, found.stderr
    (report,) = json.loads(found.stdout)["models"]
    (verdict,) = [v for v in report["verdicts"] if v["check"] == "claims"]
    assert verdict["outcome"] == "violated"
    assert message in verdict["message"]


def test_a_module_that_cannot_be_loaded_is_named(tmp_path):
    install(tmp_path, "import no_such_loom")
    found = radiokit_with(tmp_path, "check", "lambert")
    assert found.returncode == 2
    assert "felt:Felt cannot be loaded: No module named 'no_such_loom'" in " ".join(found.stderr.split())
