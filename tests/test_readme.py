"""The README: its tour runs as written, and names what there is."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

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


@pytest.mark.parametrize("target", re.findall(r"\]\(([^)#:]+)\)", TEXT))
def test_every_link_leads_somewhere(target):
    assert (ROOT / target).exists()
