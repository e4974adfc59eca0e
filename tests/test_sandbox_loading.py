"""Loading a submission: what fails in a script or notebook costs only itself, and is said with its place."""

from __future__ import annotations

import ast
import itertools
import json
import signal
import sys
from pathlib import Path

import numpy as np
import pytest

from radiokit.faces.grading.isolation import loading
from radiokit.faces.grading.isolation.limits import Limits
from radiokit.faces.grading.isolation.sandbox import Sandbox
from radiokit.faces.grading.isolation.sources import starts, without_magics
from radiokit.facts.errors import RadiokitError

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="the sandbox needs a POSIX system")

SCRIPT = '''\
"""Homework."""
from __future__ import annotations
import numpy as np, radiokit as rk, sys
def first(x): return 2 * x
print("loading\\t\\x1b[31m", end="\\r"); print("…", file=sys.stderr)
first(1)(2)
def second(x: Unknown):
    if np.any(x > 2):
        raise ValueError("too large")
    return x
class Third:
    def __call__(self, x): return x / 0
third = Third()
import sys; sys.exit(3)
exit()
return 4
_hidden = lambda x: x
raise BaseException
if __name__ == "__main__":
    raise ValueError("not run")
def last(x): return x + 1
where = __file__[-5:], __name__
'''

CELLS = [
    "%matplotlib inline\n!pip install nosuch  # it's (\nimport radiokit\nimport numpy as np",
    ["def first(x):\n", "    %time y = 2\n", "    text = '''\n%not magic\n'''\n", "    return 2 * x"],
    "def broken(x:\n    return x",
    "%%time\ndef second(x):\n    return np.sin(x)",
    "%%bash\nrm -rf /",
    "files = !ls\nprint(files)\nfirst?\n??np.sin",
    "get_ipython().run_line_magic('matplotlib', 'inline')\ndisplay(first)\nget_ipython().config.a = 3",
    "assert second(0) == 1, 'check'\ndef third(x):\n    display(x)\n    return first(x) @ 1",
    "import time\nwhile True: time.sleep(9)",
    "def last(x): return x",
]


def problems(result):
    return [(each["where"], each["raised"], each["message"]) for each in result.facts["problems"]]


def notebook(cells):
    code = [{"cell_type": "code", "source": source, "outputs": []} for source in cells]
    return {"cells": [{"cell_type": "markdown", "source": "# 1"}, *code], "nbformat": 4, "metadata": {}}


@pytest.fixture
def opened(tmp_path):
    """Open a sandbox with a submission of this text."""
    sandboxes = []

    def open_one(text, name="homework.py", **options):
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        sandboxes.append(Sandbox(path, **options))
        return sandboxes[-1]

    yield open_one
    for sandbox in sandboxes:
        sandbox.close()


def test_a_script_goes_on_after_what_raises(opened):
    sandbox = opened(SCRIPT)
    loaded = sandbox.load()
    assert loaded.ok
    assert loaded.output == "…\nloading ?[31m\n"
    assert loaded.facts["names"] == ["first", "second", "Third", "third", "last"]
    assert problems(loaded) == [
        ("line 3", "ModuleNotFoundError", "radiokit is not there for a submission, which must stand alone"),
        ("line 6", "TypeError", "'int' object is not callable"),
        ("line 14", "SystemExit", "3"),
        ("line 15", "SystemExit", ""),
        ("line 16", "SyntaxError", "'return' outside function"),
        ("line 18", "BaseException", ""),
    ]
    assert sandbox.call("last", 3).values[0] == 4
    raised = sandbox.call("second", [1.0, 5.0, 2.0], mode="row")
    assert (raised.where, raised.raised, raised.row) == ("line 9", "ValueError", 1)
    raised = sandbox.call("third", 1.0)
    assert (raised.error, raised.where) == ("raised ZeroDivisionError: float division by zero", "line 12")
    assert sandbox.call("nosuch", 1.0).error == "defines no function 'nosuch'"
    assert sandbox.load() is loaded


def test_a_notebook_goes_on_after_what_raises(opened):
    sandbox = opened(json.dumps(notebook(CELLS)), "homework.ipynb")
    loaded = sandbox.load(timeout=3.0)
    assert loaded.facts["names"] == ["first", "second", "third", "last"]
    assert problems(loaded) == [
        (
            "cell 1, line 3",
            "ModuleNotFoundError",
            "radiokit is not there for a submission, which must stand alone",
        ),
        ("cell 3, line 1", "SyntaxError", "'(' was never closed"),
        ("cell 5, line 1", "", "%%bash is left out: IPython alone knows it"),
        ("cell 6, line 1", "", "files = !ls is left out: IPython alone knows it"),
        ("cell 6, line 2", "NameError", "name 'files' is not defined"),
        ("cell 8, line 1", "AssertionError", "check"),
        ("cell 9, line 2", "", "it was stopped, as it took too long"),
    ]
    assert loaded.output == ""
    raised = sandbox.call("third", 1.0)
    assert (raised.raised, raised.where) == ("TypeError", "cell 8, line 4")
    assert sandbox.call("second", 0.0).values[0] == 0


def test_a_notebook_of_format_3_is_read(opened):
    cells = [{"cell_type": "code", "input": "def f(x):\r\n    return x"}, {"cell_type": "heading"}]
    sandbox = opened(json.dumps({"worksheets": [{"cells": cells}], "nbformat": 3}), "old.ipynb")
    assert sandbox.load().facts == {"names": ["f"], "problems": []}


@pytest.mark.parametrize(
    "text", [b"", b"{", b"[]", b'{"cells": 3}', b'{"cells": [{"cell_type": "code", "source": [1]}]}', b"\xff"]
)
def test_what_is_no_notebook_has_no_names(opened, text):
    loaded = opened(text, "broken.ipynb").load()
    assert loaded.facts["names"] == []
    assert problems(loaded) == [("", "", "it is no Jupyter notebook of format 3 or 4")]


@pytest.mark.parametrize(
    ("broken", "where", "message"),
    [
        ("def bad(x)\n    return x\n", "line 6", "expected ':'"),
        ("def bad(x):\n    return (x\n", "line 7", "'(' was never closed"),
        (
            "def bad(x):\nbad = 3\n",
            "line 7",
            "expected an indented block after function definition on line 6",
        ),
        ("@first\n@second\ndef bad(x): x +\n", "line 8", "invalid syntax"),
        ("if first:\n    pass\nelse\n    pass\n", "line 8", "expected ':'"),
        ("bad = 'never ended\n", "line 6", "unterminated string literal (detected at line 6)"),
        ("  bad = 1\n", "line 6", "unindent does not match any outer indentation level"),
        ("bad = [1, 2\n", "line 6", "'[' was never closed"),
    ],
)
def test_a_syntax_error_costs_its_statement(opened, broken, where, message):
    before = "import math\n\ndef first(x):\n    return (2 *\n            x)\n"
    after = "def second(x):\n    return x\n\nclass Third: pass\n"
    loaded = opened(before + broken + after).load()
    kept = [name for name in ("first", "second", "Third") if broken != "  bad = 1\n" or name != "first"]
    assert loaded.facts["names"] == kept
    assert problems(loaded)[0] == (where, problems(loaded)[0][1], message)
    assert len(problems(loaded)) <= 2


def test_strange_bytes_are_read_as_far_as_they_can_be(opened):
    loaded = opened(b"# caf\xe9\r\ndef f(x):\r\n    return x\r\n").load()
    assert loaded.facts["names"] == ["f"]
    assert problems(loaded)[0][1] in ("UnicodeDecodeError", "SyntaxError")
    assert opened("\ufeff# é\ndef f(x): return x".encode()).load().facts == {"names": ["f"], "problems": []}
    assert opened("# -*- coding: latin-1 -*-\nx = 'é'".encode("latin-1")).load().facts["problems"] == []
    assert "null bytes" in problems(opened(b"a = 1\x00").load())[0][2]
    assert problems(opened("f = " + "(" * 300).load())[0][:1] == ("line 1",)


def test_problems_are_bounded(opened):
    lines = ["raise ValueError('\x1b[31m' + '\U0001f600' * 10**5)"] * 100
    lines += [f"def {'é' * 50}{i}(): pass" for i in range(300)]
    loaded = opened("\n".join(lines)).load()
    assert loaded.ok
    assert len(loaded.facts["problems"]) == 20
    assert len(loaded.facts["names"]) == 60
    assert all(len(words) <= 300 and words.isprintable() for each in problems(loaded) for words in each)


def test_a_submission_that_cannot_be_loaded_is_loaded_once(opened, monkeypatch):
    sandbox = opened("import os\nos._exit(4)\n")
    first = sandbox.call("f", 1.0)
    assert first.error == "could not be loaded: it ended its process with exit code 4"
    with monkeypatch.context() as patch:
        patch.setattr(sandbox, "_started", None)
        assert sandbox.call("f", 1.0).error == first.error
    assert sandbox.load().error == "ended its process with exit code 4"


def test_loading_has_a_time_of_its_own(opened):
    stubborn = "import signal, time; signal.signal(signal.SIGALRM, signal.SIG_IGN)\ntime.sleep(20)"
    sandbox = opened(stubborn, limits=Limits(load_seconds=0.2))
    assert sandbox.call("f", 1.0).error == "could not be loaded: it took longer than 0.2 s"
    sandbox = opened("import time; time.sleep(0.6)\ndef f(x): return x")
    assert sandbox.call("f", 1.0, timeout=0.5).ok


def test_time_in_which_the_whole_machine_stands_still_is_not_a_statements():
    alarm, hours = loading._Alarm(), itertools.count(step=3600)
    alarm._wall, alarm._spent = (lambda: next(hours)), (lambda: 0.0)
    alarm.start(8000.0)
    for _ in range(loading.TURNS - 1):
        alarm(0, None)
    assert alarm.stop() == 0  # as much as all turns, and no hour more
    alarm(0, None)  # it came too late to be heard
    alarm.start(8000.0)
    alarm._spent = itertools.count(step=3600).__next__
    for _ in range(2):  # what is computed is no standstill
        alarm(0, None)
    with pytest.raises(loading._LateError):
        alarm(0, None)
    assert signal.setitimer(signal.ITIMER_REAL, 0)[0] > 0
    alarm(0, None)  # once is enough


def test_the_name_of_a_submission_hides_no_module(opened):
    for name in ("random.py", "child.py", "numpy.py", "json.py"):
        sandbox = opened("def f(x): return 2 * x", name)
        assert sandbox.call("f", 1.0, seed=1).values[0] == 2


def test_files_may_lie_beside_it(opened, tmp_path):
    (tmp_path / "helper.py").write_text("def twice(x): return 2 * x\ndef fails(x): raise ValueError")
    sandbox = opened("import helper\ndef f(x): return helper.twice(x)\ndef g(x):\n    return helper.fails(x)")
    assert problems(sandbox.load())[0][1] == "ModuleNotFoundError"
    sandbox = opened(
        "import helper\ndef f(x): return helper.twice(x)\ndef g(x):\n    return helper.fails(x)",
        files=[tmp_path / "helper.py"],
    )
    assert sandbox.call("f", 1.0).values[0] == 2
    assert sandbox.call("g", 1.0).where == "line 4"


def test_a_file_that_is_too_large_is_refused(opened, tmp_path):
    with (tmp_path / "large.py").open("wb") as file:
        file.truncate(1 << 29)
    with pytest.raises(RadiokitError, match="more than 268435456 bytes"):
        Sandbox(tmp_path / "large.py")


def test_every_statement_of_a_file_is_seen_to_begin():
    source = Path(np.ma.core.__file__).read_text(encoding="utf-8")
    found = starts(source.split("\n"))
    assert all(found[statement.lineno - 1] for statement in ast.parse(source).body)
    inside = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Constant)]
    for node in inside:
        assert not any(found[node.lineno : node.end_lineno]), node.lineno


@pytest.mark.parametrize(
    ("source", "left", "noted"),
    [
        ("%cd ..\nx = 1", "pass\nx = 1", []),
        ("a = b \\\n% c\n%pwd", "a = b \\\n% c\npass", []),
        ("x = (1\n% 2)\n!ls", "x = (1\n% 2)\npass", []),
        ("!pip install \\\n  a \\\n  b\ny = 2", "pass\n\n\ny = 2", []),
        ("\n%%capture out\nx = 1", "\n\nx = 1", []),
        ("%%writefile a.py\nx = 1", "", [(1, "%%writefile a.py")]),
        ("%run a.py", "pass", [(1, "%run a.py")]),
        ("a = %time f(x)", "pass", [(1, "a = %time f(x)")]),
        ("f?\n  a.b??\n?c", "pass\n  pass\npass", []),
        ("'''\n%a\n''' # ?\n%b", "'''\n%a\n''' # ?\npass", []),
        ("", "", []),
    ],
)
def test_magics_are_left_out(source, left, noted):
    assert without_magics(source) == (left, noted)
