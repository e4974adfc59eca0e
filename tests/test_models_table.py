"""The table of models: what it says is so, the README shows it, and the command prints it three ways."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from radiokit.contracts.bsdf import KINDS, REGISTRY, list_bsdfs
from radiokit.faces.cli import main
from radiokit.faces.modeltable import COLUMNS, ModelTable, models_table

README = (Path(__file__).parent.parent / "README.md").read_text(encoding="utf-8")
COMMAND = "radiokit models --markdown --no-timing"


@pytest.fixture(scope="module")
def table():
    return models_table(timing=False)


def run(capsys, *words: str) -> str:
    with pytest.raises(SystemExit) as caught:
        main(["models", *words])
    assert caught.value.code == 0
    found = capsys.readouterr()
    assert found.err == ""
    return found.out


def test_the_readme_shows_the_table(table):
    (shown,) = re.findall(r"<!-- models -->\n(.*?)\n<!-- /models -->", README, flags=re.DOTALL)
    assert shown.strip() == table.markdown(), f"put the output of `{COMMAND}` between the marks in README.md"
    assert COMMAND in README


def test_every_model_is_there_and_says_its_kind(table):
    assert [row.name for row in table] == list_bsdfs()
    silent = [
        name
        for name, cls in REGISTRY.classes.items()
        if cls.__module__.startswith("radiokit.") and not cls.kind
    ]
    assert silent == [], f"give these a kind, one of {', '.join(KINDS)}"
    assert {row.kind for row in table} <= {"", *KINDS}


def test_the_scan_finds_what_is_claimed(table):
    for row in table:
        assert (row.supremum <= 1 + 1e-6) == row.conserves, row
        if row.lossless:
            assert row.where_deg is None, row
            assert row.supremum == pytest.approx(1.0, abs=1e-6)


def test_what_is_known_of_models(table):
    assert table["phong"].supremum == pytest.approx(1.0, abs=1e-6)
    assert table["phong"].where_deg == 0.0
    assert table["lambert"].sampling == "cosine"
    assert (table["lambert"].weight_largest, table["lambert"].weight_spread) == pytest.approx(
        (1.0, 0.0), abs=1e-12
    )
    assert table["dielectric"].weight_spread < 1e-12  # the factor n² is taken off: flux, not radiance
    assert table["dielectric"].reciprocity == "eta-scaled"
    assert table["ggx"].sampling == "own"


def test_a_table_that_is_off_would_be_noticed(table):
    """Planted: a row that says another albedo."""
    from dataclasses import replace

    rows = [replace(row, supremum=1.5) if row.name == "ggx" else row for row in table]
    with pytest.raises(AssertionError):
        test_the_scan_finds_what_is_claimed(ModelTable(tuple(rows)))
    with pytest.raises(AssertionError):
        test_the_readme_shows_the_table(ModelTable(tuple(rows)))


def test_the_command_prints_text_markdown_and_json(capsys):
    two = ("lambert", "dielectric")
    text = run(capsys, *two)
    assert "Nicodemus et al." in text
    assert " ns\n" in text
    markdown = run(capsys, *two, "--markdown", "--no-timing")
    assert markdown.splitlines()[0] == f"| {' | '.join(COLUMNS[:-1])} |"
    assert len(markdown.splitlines()) == 4
    first, second = json.loads(run(capsys, *two, "--json"))["models"]
    assert (first["name"], second["name"]) == two
    assert first["nanoseconds"] > 0
    assert second["source"]["year"] == 2023


@pytest.mark.parametrize(
    ("words", "message"),
    [(["velvet"], "velvet"), (["--json", "--markdown"], "--markdown and --json exclude each other")],
)
def test_a_wrong_word_is_named(words, message, capsys):
    with pytest.raises(SystemExit) as caught:
        main(["models", *words])
    assert caught.value.code == 2
    assert message in capsys.readouterr().err


def test_a_notebook_shows_a_table(table):
    assert table._repr_html_().count("<tr>") == len(table) + 1
    assert str(table).splitlines()[0].split()[:3] == ["model", "year", "source"]
