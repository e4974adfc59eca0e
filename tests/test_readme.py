"""The README: its tour runs as written, and names what there is."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import radiokit as rk

ROOT = Path(__file__).parent.parent
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")


def block(language: str, number: int = 0) -> str:
    return re.findall(rf"^```{language}\n(.*?)^```", TEXT, flags=re.MULTILINE | re.DOTALL)[number]


def test_the_tour_runs(capsys):
    exec(compile(block("python"), "README.md", "exec"), {})
    printed = capsys.readouterr().out
    assert "the two values differ" in printed
    assert "5.0 W/m²/sr (radiance)" in printed


def test_every_command_of_the_tour_exists():
    from radiokit.faces.cli import app

    known = {command.name or command.callback.__name__ for command in app.registered_commands}
    used = {line.split()[1] for line in block("sh", 2).splitlines() if line.startswith("radiokit ")}
    assert used == known


def test_the_example_of_an_assignment_grades(tmp_path):
    (tmp_path / "light.py").write_text(block("python", 1), encoding="utf-8")
    homework = """
import numpy as np
def irradiance(intensity, distance, theta): return intensity / distance**2
def matt(wi, wo): return np.full(len(wi), 0.5 / np.pi)
def lobe(exponent, samples, seed):
    f = 2 * np.pi * np.random.default_rng(seed).random(samples) ** exponent
    return f.mean(), f.std(ddof=1) / np.sqrt(samples)
"""
    (tmp_path / "homework.py").write_text(homework, encoding="utf-8")
    found = rk.grading.grade(tmp_path / "light.py", tmp_path / "homework.py")
    assert found["irradiance"].diagnosis == "cosine-forgotten"
    assert (found.score, found.points) == (5, 7)


@pytest.mark.parametrize("target", re.findall(r"\]\(([^)#:]+)\)", TEXT))
def test_every_link_leads_somewhere(target):
    assert (ROOT / target).exists()
