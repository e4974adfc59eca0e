"""Formats of grades: each is read back by the tool or the schema that it is for, whatever a student wrote."""

from __future__ import annotations

import base64
import csv
import io
import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import jsonschema
import pytest
import yaml
from junitparser import JUnitXml
from junitparser.xunit2 import TestCase as Case
from markdown_it import MarkdownIt

import radiokit as rk
from radiokit.faces.grading.formats.phrases import PHRASES, protection
from radiokit.faces.grading.formats.text import to_rich
from radiokit.faces.grading.formats.writing import FORMATS, output, write_file
from radiokit.faces.grading.grades import Grade, PartGrade, QuestionGrade
from radiokit.faces.grading.isolation.limits import PROTECTIONS
from radiokit.faces.grading.isolation.protocol import plain_text
from radiokit.faces.grading.record import grade_schema, record
from radiokit.faces.grading.unfinished import nothing_yet, with_pending
from radiokit.facts.errors import ParameterError

HOSTILE = (
    "<script>alert(1)</script><img src=x onerror=alert(1)> & \"'</table> **b** [a](http://e.vil) `c` | $x$ "
    "http://e.vil www.e.vil <http://e.vil> ]]> \x1b[31m\x00\x08\ufffe\ud800\u202e =1+1"
)
HIDDEN = "differs at 3 of 20 inputs"
RIGHT = "gives 1, right is 2"


def part(
    name: str, score: float, points: float, text: str, visibility: str = "visible", **more: str
) -> PartGrade:
    title = {"ordinary": "ordinary inputs", "hard": "hard inputs"}.get(name, name)
    return PartGrade(
        name=name, title=title, score=score, points=points, visibility=visibility, text=text, **more
    )


GRADE = Grade(
    assignment="lamps",
    title="Lamps & caps",
    student="anna",
    language="en",
    questions=(
        QuestionGrade(
            name="irradiance",
            title="Irradiance",
            parts=(
                part("ordinary", 1.0, 1.0, "right"),
                part("hard", 0.5, 2.0, RIGHT, diagnosis="cosine-forgotten"),
                part("secret", 0.0, 1.0, HIDDEN, "hidden", diagnosis="pi-too-many"),
            ),
        ),
        QuestionGrade(
            name="solid_angle", title="Solid angle", parts=(part("ordinary", 2 / 3, 2.0, "close"),)
        ),
    ),
    problems=("line 3 raised NameError: name 'x' is not defined",),
    protections=("limits", "network"),
    missing=("user",),
)
EVIL = replace(
    GRADE,
    title=HOSTILE,
    student="=" + HOSTILE,
    questions=(
        QuestionGrade(
            name="irradiance",
            title=HOSTILE,
            parts=(replace(part("ordinary", 0.0, 1.0, HOSTILE), title=HOSTILE, diagnosis=HOSTILE),),
            review="ValueError: " + HOSTILE,
        ),
    ),
    problems=(HOSTILE,),
    protections=(HOSTILE,),
)
FULL = replace(
    GRADE, questions=(QuestionGrade(name="f", title="F", parts=(part("ordinary", 1.0, 1.0, "right"),)),)
)
PENDING = with_pending(
    nothing_yet(rk.grading.load_assignment("radiometry"), language="ru"),
    rk.grading.load_assignment("radiometry"),
)
ALL = {"ordinary": GRADE, "evil": EVIL, "full": FULL, "pending": PENDING}
MANY = pytest.mark.parametrize("grade", ALL.values(), ids=ALL)

RESULTS = json.loads(Path(__file__).with_name("gradescope.schema.json").read_text("utf-8"))


class Page(HTMLParser):
    """The elements of a page, with their attributes, and its text."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.open: list[str] = []
        self.text = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        if tag != "meta":
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data

    def named(self, name: str) -> list[dict[str, str | None]]:
        return [attributes for tag, attributes in self.elements if tag == name]


@pytest.mark.parametrize("name", FORMATS)
@MANY
def test_every_format_takes_every_grade_and_encodes(grade, name):
    for reveal in (False, True):
        written = FORMATS[name](grade, reveal)
        assert written.endswith("\n")
        assert written == FORMATS[name](Grade.from_json(grade.to_json()), reveal)
        if grade is not EVIL or name not in ("json", "gradescope", "csv"):
            written.encode()


@pytest.mark.parametrize("name", ["text", "html", "markdown", "junit", "github"])
def test_hidden_findings_are_told_only_when_asked(name):
    def read(reveal: bool) -> str:
        written = FORMATS[name](GRADE, reveal)
        return base64.b64decode(written).decode() if name == "github" else written

    assert HIDDEN not in read(False)
    assert "pi-too-many" not in read(False)
    assert HIDDEN in read(True)
    assert RIGHT in read(False)


def test_the_schema_of_grades():
    schema = grade_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    check = jsonschema.Draft202012Validator(schema)
    for grade in ALL.values():
        check.validate(grade.to_json())
        check.validate(record(grade, "0" * 64))
    good = GRADE.to_json()
    parts = good["questions"][0]["parts"]
    wrong = [
        good | {"score": -1},
        good | {"seconds": 2.0},
        good | {"language": "de"},
        good | {"fingerprint": "0" * 64},
        {name: value for name, value in good.items() if name != "complete"},
        good | {"questions": [good["questions"][0] | {"parts": [parts[0] | {"visibility": "seen"}]}]},
        good | {"questions": [good["questions"][0] | {"parts": [parts[0] | {"confidence": 2}]}]},
    ]
    assert not any(map(check.is_valid, wrong))


@MANY
def test_gradescope_gets_what_it_specifies(grade):
    check = jsonschema.Draft202012Validator(RESULTS)
    results = rk.grading.to_gradescope(grade)
    check.validate(results)
    tests = results["tests"]
    assert sum(test["score"] for test in tests) == pytest.approx(grade.score, abs=1e-3)
    assert sum(test["max_score"] for test in tests) == pytest.approx(grade.points, abs=1e-3)
    assert len({test["number"] for test in tests}) == len(tests)
    assert results["stdout_visibility"] == "hidden"
    assert grade.student not in json.dumps(results) or not grade.student
    for wrong in ({"visibility": "seen"}, {"tests": [{"name": "no score"}]}, {"tests": []}, {"points": 1}):
        assert not check.is_valid(results | wrong)


def test_gradescope_hides_what_is_hidden():
    tests = rk.grading.to_gradescope(GRADE)["tests"]
    assert [test["visibility"] for test in tests] == ["visible", "visible", "hidden", "visible"]
    assert [test["status"] for test in tests] == ["passed", "failed", "failed", "failed"]
    assert [test["number"] for test in tests] == ["1.1", "1.2", "1.3", "2.1"]


@MANY
def test_junit_is_read_back(grade):
    text = rk.grading.to_junit(grade, reveal=True)
    read = JUnitXml.fromstring(text.encode("utf-8"))
    cases = [Case.fromelem(case) for suite in read for case in suite]
    parts = [part for question in grade.questions for part in question.parts]
    assert (read.tests, len(cases)) == (len(parts), len(parts))
    for case, each in zip(cases, parts, strict=True):
        points = {found.name: found.value for found in case.properties()}
        assert float(points["score"]) == pytest.approx(each.score, abs=1e-4)
        assert float(points["points"]) == pytest.approx(each.points, abs=1e-4)
        assert case.is_passed == each.full
    assert read.skipped == (len(parts) if grade is PENDING else 0)
    assert read.errors == (1 if grade is EVIL else 0)


def test_junit_tells_partial_credit_and_the_diagnosis():
    suite = next(iter(JUnitXml.fromstring(rk.grading.to_junit(GRADE).encode())))
    case = [Case.fromelem(case) for case in suite][1]
    (failure,) = case.result
    assert failure.message == f"0.5 / 2: {RIGHT}"
    assert failure.type == "cosine-forgotten"
    assert (suite.tests, suite.failures, suite.errors) == (3, 2, 0)


def test_what_xml_cannot_hold_is_replaced():
    bad = "\x00\x08\x1b\ufffe\uffff\ud800"
    with pytest.raises(ElementTree.ParseError):
        ElementTree.fromstring("<a>\x08</a>")
    problem = replace(GRADE.questions[0].parts[1], title=f"a{bad}b é Ω 𝛺")
    grade = replace(GRADE, title=bad, questions=(replace(GRADE.questions[0], title=bad, parts=(problem,)),))
    root = ElementTree.fromstring(rk.grading.to_junit(grade))
    assert root.find(".//testcase").get("name") == f"a{'?' * len(bad)}b é Ω 𝛺"


@MANY
@pytest.mark.parametrize("reveal", [False, True])
def test_the_page_is_sound_html(grade, reveal):
    page = Page(rk.grading.to_html(grade, reveal=reveal))
    assert page.open == []
    assert page.named("html") == [{"lang": grade.language}]
    headings = [int(tag[1]) for tag, _ in page.elements if re.fullmatch("h[1-6]", tag)]
    assert headings[0] == 1
    assert set(headings[1:]) == {2}
    known = {"html", "head", "meta", "title", "style", "body", "main", "header", "section", "h1", "h2", "p"}
    known |= {"div", "span", "code", "table", "thead", "tbody", "tr", "th", "td", "ul", "li"}
    assert {tag for tag, _ in page.elements} <= known
    names = {name for _, attributes in page.elements for name in attributes}
    assert names <= {
        "lang",
        "charset",
        "http-equiv",
        "content",
        "name",
        "class",
        "style",
        "aria-hidden",
        "scope",
    }
    rows = sum(len(question.parts) for question in grade.questions)
    assert [each["scope"] for each in page.named("th")].count("row") == rows
    assert "default-src 'none'" in str(page.named("meta"))


def test_the_page_shows_what_was_written_and_runs_none_of_it():
    page = Page(rk.grading.to_html(EVIL))
    assert "<script>alert(1)</script>" in page.text
    unsafe = Page("<p><script>alert(1)</script></p>")
    assert [tag for tag, _ in unsafe.elements] == ["p", "script"]  # what the test would have seen


def test_the_page_tells_points_protections_and_problems():
    text = Page(rk.grading.to_html(GRADE)).text
    for each in ("2.1667 / 6", "0.5 / 2", "anna", "there is no network", "NameError", "cosine-forgotten"):
        assert each in text
    assert protection("en", "user") in text.partition("Not granted")[2]
    russian = Page(rk.grading.to_html(replace(GRADE, language="ru"))).text
    assert "Итого: 2.1667 / 6" in russian
    assert "сети нет" in russian


def luminance(colour: str) -> float:
    digits = colour.lstrip("#") if len(colour) == 7 else "".join(2 * each for each in colour.lstrip("#"))
    parts = [int(digits[i : i + 2], 16) / 255 for i in (0, 2, 4)]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(first: str, second: str) -> float:
    """Return the contrast that WCAG defines."""
    low, high = sorted((luminance(first), luminance(second)))
    return (high + 0.05) / (low + 0.05)


def test_the_page_has_contrast():
    assert contrast("#fff", "#000") == pytest.approx(21)
    assert contrast("#ffffff", "#999999") < 4.5
    style = re.search("<style>(.*?)</style>", rk.grading.to_html(GRADE), re.DOTALL)[1]
    colours = set(re.findall(r"[; {]color: (#\w+)", style))
    backgrounds = set(re.findall(r"background: (#fff\w*)", style))
    assert len(colours) >= 4
    assert len(backgrounds) == 2
    assert min(contrast(one, other) for one in colours for other in backgrounds) >= 4.5


@MANY
def test_markdown_renders_as_tables_of_plain_text(grade):
    tokens = MarkdownIt("commonmark").enable("table").parse(rk.grading.to_markdown(grade, reveal=True))
    flat = [each for token in tokens for each in (token, *(token.children or ()))]
    kinds = {token.type for token in flat}
    assert not {kind for kind in kinds if kind.startswith(("html", "link", "image", "strong", "em_", "code"))}
    rows = [token for token in tokens if token.type == "tr_open"]
    assert len(rows) == sum(1 + len(question.parts) for question in grade.questions)
    cells = [token for token in tokens if token.type in ("td_open", "th_open")]
    assert len(cells) == 4 * len(rows)


def test_markdown_would_be_markup_unescaped():
    tokens = MarkdownIt("commonmark").parse("<b>x</b> **b** [a](http://e.vil) `c`")
    assert {token.type for token in tokens[1].children} >= {"html_inline", "strong_open", "link_open"}


def rows_of(text: str, delimiter: str = ",") -> list[list[str]]:
    return list(csv.reader(io.StringIO(text, newline=""), delimiter=delimiter))


def test_a_table_of_the_class():
    ben = replace(FULL, student="ben")
    head, *rows = rows_of(rk.grading.to_csv([ben, replace(GRADE, complete=False)]))
    assert head == ["student", "total", "points", "irradiance", "solid_angle", "f", "diagnosis", "note"]
    assert rows[0][:6] == ["anna", "2.1667", "6", "1.5", "0.6667", ""]
    assert rows[0][6] == "irradiance: cosine-forgotten"
    assert rows[0][7].startswith("incomplete; line 3")
    assert rows[1][:6] == ["ben", "1", "1", "", "", "1"]
    assert rk.grading.to_csv([ben, GRADE]) == rk.grading.to_csv([GRADE, ben])
    with pytest.raises(ParameterError, match="lamps, other"):
        rk.grading.to_csv([GRADE, replace(ben, assignment="other")])


@pytest.mark.parametrize("start", ["=", "+", "-", "@", "\t=", "\r=", " =", "\n+"])
def test_no_cell_becomes_a_formula(start):
    evil = start + 'HYPERLINK("http://e.vil")'
    grade = replace(GRADE, student=evil, problems=(evil,))
    (_, row) = rows_of(rk.grading.to_csv([grade]))
    assert row[0] == f"'{evil.strip()}"
    assert not [cell for cell in row if cell.lstrip().startswith(("=", "+", "-", "@"))]


EVIL_PARTS = ('x;=CMD("a")', "x, @SUM(1)", 'x;" -2+3+A1', "x|+A1|A1", "＝1+1", "x; -A1")
EVIL_NUMBERS = ("x;-1 +CMD|' /C calc'!A0", "x;-1,5+SUM(A1);y", "x, -1.5 &A1", "x|-1 -A1", 'x;"-inf *A1')
"""Numbers as they stand within texts, and an operator behind them."""


@pytest.mark.parametrize("evil", EVIL_PARTS + EVIL_NUMBERS)
def test_no_part_of_a_cell_becomes_a_formula_where_others_cut(evil):
    (_, row) = rows_of(rk.grading.to_csv([replace(GRADE, problems=(evil,))]))
    assert "'" in row[-1]
    assert not [each for each in re.split(r"[;,|]", row[-1]) if each.strip(' "').startswith(tuple("=+-@＝"))]


def test_numbers_in_a_cell_are_left():
    told = "line 3 raised ValueError: (3, -4.5, +1e-3, -inf), x = -1; -2"
    (_, row) = rows_of(rk.grading.to_csv([replace(GRADE, problems=(told,))]))
    assert row[-1] == told


COMMANDS = (
    "::error::x",
    "  ::set-output name=a::b",
    "a ##[set-output name=result;]b",
    "##vso[task.complete]",
)


@pytest.mark.parametrize("name", FORMATS)
@pytest.mark.parametrize("evil", COMMANDS)
def test_no_log_takes_a_line_for_a_command(name, evil):
    """As GitHub's runner reads them: two colons at a line's beginning, ##[ anywhere; Azure's has ##vso[."""
    assert re.search(r"^\s*::|##\w*\[", evil)
    review = tuple(replace(each, review=evil) for each in GRADE.questions)
    grade = replace(GRADE, problems=(plain_text(evil),), questions=review)
    if name == "json":
        grade = replace(grade, questions=GRADE.questions)
    assert not re.search(r"^\s*::|##\w*\[", FORMATS[name](grade, True), re.MULTILINE)


def test_markdown_notifies_nobody():
    told = rk.grading.to_markdown(replace(GRADE, problems=("@team (@me) #12 owner/x#3 anna@uni.ru",)))
    assert not re.search(r"(?<!\w)@\w|#\d", told)
    assert "anna@uni.ru" in told


def test_excel_gets_its_dialect():
    plain = rk.grading.to_csv([GRADE])
    assert rk.grading.to_csv([GRADE], excel="en") == "\ufeff" + plain
    russian = rk.grading.to_csv([GRADE], excel="ru")
    assert rows_of(russian.removeprefix("\ufeff"), ";")[1][:4] == ["anna", "2,1667", "6", "1,5"]
    with pytest.raises(ParameterError, match="excel"):
        rk.grading.to_csv([GRADE], excel="de")


@pytest.mark.parametrize(
    ("grade", "status"),
    [(GRADE, "fail"), (FULL, "pass"), (PENDING, "error")],
    ids=["some", "full", "pending"],
)
def test_github_gets_a_runners_results(grade, status):
    results = json.loads(base64.b64decode(FORMATS["github"](grade, False)))
    assert results == rk.grading.to_github(grade)
    assert (results["version"], results["status"], results["max_score"]) == (1, status, grade.points)
    assert sum(test["score"] for test in results["tests"]) == pytest.approx(grade.score, abs=1e-3)
    for test in results["tests"]:
        assert test["status"] in ("pass", "fail", "error")
        assert isinstance(test["name"], str)
        assert isinstance(test["message"], str)


def test_the_workflow_is_what_the_reporter_wants():
    workflow = yaml.safe_load(rk.grading.github_workflow("radiometry", "work/homework.ipynb", language="ru"))
    assert workflow["name"] == "Autograding Tests"
    assert list(workflow["jobs"]) == ["run-autograding-tests"]
    steps = workflow["jobs"]["run-autograding-tests"]["steps"]
    (grading,) = [step for step in steps if step.get("id") == "radiokit"]
    assert "radiokit grade work/homework.ipynb --assignment radiometry" in grading["run"]
    reporter = steps[-1]
    assert reporter["with"] == {"runners": "radiokit"}
    assert reporter["env"] == {"RADIOKIT_RESULTS": "${{ steps.radiokit.outputs.result }}"}
    assert f"radiokit[grading]=={rk.__version__}" in steps[2]["run"]


@pytest.mark.parametrize("word", ["a b", "$(rm)", "a;b", "`a`", "-r", "a'b", "a\nb", "${{x}}", ""])
def test_the_workflow_takes_no_shell(word):
    with pytest.raises(ParameterError, match="submission"):
        rk.grading.github_workflow("radiometry", word)


def test_text_for_people():
    text = rk.grading.to_text(GRADE)
    assert text.splitlines()[0] == "Lamps & caps: 2.1667 / 6"
    assert "    ~ hard inputs: 0.5 / 2  gives 1, right is 2" in text.splitlines()
    assert "\x1b" not in rk.grading.to_text(EVIL, reveal=True)
    assert len(rk.grading.to_text(EVIL, reveal=True).splitlines()) == 5
    assert "ещё не проверено" in rk.grading.to_text(PENDING)


def test_text_for_a_terminal():
    from rich.console import Console

    console = Console(width=100, file=io.StringIO(), force_terminal=True)
    for grade in ALL.values():
        console.print(to_rich(grade, reveal=True))
    printed = console.file.getvalue()
    assert "Lamps & caps" in printed
    assert "cosine" not in printed  # the line itself says it
    assert "\x1b[31m\x00" not in printed


def test_no_log_takes_a_line_for_a_command_where_a_note_is_wrapped():
    from rich.console import Console

    for length in range(20):
        console = Console(width=60, file=io.StringIO(), force_terminal=True, color_system=None)
        console.print(to_rich(replace(GRADE, problems=("x " * (20 + length) + "::error::y",))))
        assert "error" in console.file.getvalue()
        assert not re.search(r"^\W*::", re.sub(r"\x1b\[\d*m", "", console.file.getvalue()), re.MULTILINE)


@pytest.mark.parametrize(
    ("target", "told"),
    [
        ("a.pdf", "ends in"),
        ("pdf=a.pdf", "one of text, json"),
        ("html=", "a file"),
        ("no/where.html", "folder that is there"),
        (".", "ends in"),
    ],
)
def test_a_target_that_is_none_is_told(target, told, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ParameterError, match=told):
        output(target)


def test_targets(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for target, name in (
        ("a.HTML", "html"),
        ("x=y.xml", None),
        ("github=a", "github"),
        ("a-b=c.md", "markdown"),
    ):
        if name is None:
            with pytest.raises(ParameterError):
                output(target)
        else:
            assert output(target).format == name
    (tmp_path / "taken").mkdir()
    with pytest.raises(ParameterError, match="folder"):
        output("text=taken")
    with pytest.raises(ParameterError, match="can be written"):
        write_file(tmp_path / "taken", "text")
    assert [path.name for path in tmp_path.iterdir()] == ["taken"]


def test_phrases_have_both_languages():
    assert all(set(each) == {"en", "ru"} and all(each.values()) for each in PHRASES.values())
    assert all(protection("ru", name) != protection("en", name) for name in PROTECTIONS)
    assert protection("ru", "new") == "new"
