"""The sandbox: right answers come through, and no submission harms anything but itself."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import radiokit as rk
from radiokit.faces.cli import main
from radiokit.faces.grading.isolation.limits import PROTECTIONS, Limits
from radiokit.faces.grading.isolation.protocol import PREFIX, Assembler, MalformedError, pack, plain_text
from radiokit.faces.grading.isolation.remote import remote_bsdf
from radiokit.faces.grading.isolation.sandbox import Sandbox
from radiokit.facts.errors import CallableError, ParameterError, RadiokitError, TargetError

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="these attacks are written for Linux")

HONEST = """
import math
import numpy as np

def lambert(wi, wo, reflectance=0.5):
    return np.where((wi[..., 2] > 0) & (wo[..., 2] > 0), reflectance / np.pi, 0.0)

def scalar(wi, wo):
    h = [a + b for a, b in zip(wi, wo)]
    return 2 / math.pi * (h[2] / math.sqrt(sum(a * a for a in h))) ** 3 if wi[2] > 0 and wo[2] > 0 else 0.0

def single(wi, wo):
    return lambert(wi, wo)[0].item() if len(wi) == 1 else 1 / 0

def float32(wi, wo):
    return lambert(wi, wo).astype(np.float32)

def listed(wi, wo):
    return [float(value) for value in lambert(wi, wo)]

def sampled(wi, wo):
    return lambert(wi, wo)

def sample(u, wo):
    r, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
    wi = np.stack([r * np.cos(phi), r * np.sin(phi), np.sqrt(1 - u[:, 0])], axis=-1)
    return wi, np.full(len(u), 0.5)

sampled.sample, sampled.pdf = sample, lambda wi, wo: wi[:, 2].clip(0) / np.pi

def short(wi, wo):
    return np.ones((2, 2, 2))

def prints(wi, wo):
    print("debugging", len(wi))
    return lambert(wi, wo)

def raises(wi, wo):
    raise ZeroDivisionError("oh no")
"""

HOSTILE = """
import ctypes, os, shutil, signal, socket, sys, time
import numpy as np

def double(x): print("hello"); return 2 * x
def endless(x):
    while True: pass
def sleeps(x): time.sleep(20)
def forks(x):
    for _ in range(40):
        if os.fork() == 0:
            time.sleep(20); os._exit(0)
    return x
def memory(x): return np.ones(1 << 28)[:3]
def big_file(x):
    with open("big", "wb") as file:
        for _ in range(50): file.write(bytes(1 << 20))
    return x
def many_files(x):
    for i in range(50):
        with open(f"file{i}", "wb") as file: file.write(bytes(1 << 20))
    return x
def floods(x):
    for _ in range(200): os.write(1, b"x" * (1 << 16))
    return x
def exits(x): os._exit(3)
def leaves(x): sys.exit(5)
def kills_itself(x): os.kill(os.getpid(), signal.SIGKILL); time.sleep(20)
def stops_itself(x): os.kill(os.getpid(), signal.SIGSTOP)
def kills_its_launcher(x):
    os.kill(os.getppid(), signal.SIGKILL); time.sleep(0.05); return x
def patches(x):
    answer = 2 * x
    np.asarray = np.array = np.ndarray = np.stack = os.write = None
    return answer
def prints_answers(x):
    for descriptor in (1, 2): os.write(descriptor, sys.modules["_protocol"].pack({"id": "0"}, [x]))
    return 2 * x
def _to_all(data):
    for descriptor in range(3, 64):
        try: os.write(descriptor, data)
        except OSError: pass
    time.sleep(20)
def writes_noise(x): _to_all(b"x" * 100)
def writes_answers(x): _to_all(sys.modules["_protocol"].pack({"id": "0"}, [x]))
def claims_much(x): _to_all(sys.modules["_protocol"].PREFIX.pack(b"RKG1", 2, 1 << 62))
class Evil:
    def __array__(self, dtype=None, copy=None): raise SystemExit("evil")
class Objects:
    def __array__(self, dtype=None, copy=None): return np.array([object()], dtype=object)
class Liar(Exception):
    def __str__(self): raise SystemExit("never told")
def evil(x): return Evil()
def objects(x): return Objects()
def text(x): return "0.5"
def nothing(x): pass
def lies(x): raise Liar
def colours(x): raise ValueError("\\x1b[31m" + "x" * 10000 + "\\n")
def deletes(x): shutil.rmtree(os.getcwd(), ignore_errors=True); return 2 * x
def snoops(x, path, pid):
    found = 0.0
    for file in (path, f"/proc/{pid}/environ", f"/proc/{os.getppid()}/environ"):
        try:
            with open(file, "rb") as opened: found += b"s3cret" in opened.read()
        except OSError: pass
    return found
def environment(x): return float("s3cret" in str(os.environ))
def references(x):
    try: import radiokit
    except ImportError: return 0.0
    return 1.0
def connects(x, port):
    try: socket.create_connection(("127.0.0.1", port), 20).close()
    except OSError: return 0.0
    return 1.0
def daemon(x, name):
    read, write = os.pipe()
    if os.fork() == 0:
        os.setsid()
        if os.fork() == 0:
            ctypes.CDLL(None).prctl(15, name.encode(), 0, 0, 0)
            os.write(write, b"x"); time.sleep(20)
        os._exit(0)
    os.read(read, 1)
    return x
def named_endless(x, name):
    ctypes.CDLL(None).prctl(15, name.encode(), 0, 0, 0)
    while True: pass
"""

X = np.array([1.0, 2.0, 3.0])
LIMITS = Limits(memory_bytes=1 << 30, file_bytes=2 << 20, disk_bytes=1 << 23, printed_bytes=1 << 18)


@pytest.fixture
def honest(tmp_path):
    (tmp_path / "honest.py").write_text(HONEST, encoding="utf-8")
    with Sandbox(tmp_path / "honest.py") as sandbox:
        yield sandbox


@pytest.fixture
def hostile(tmp_path):
    (tmp_path / "hostile.py").write_text(HOSTILE, encoding="utf-8")
    with Sandbox(tmp_path / "hostile.py", limits=LIMITS) as sandbox:
        yield sandbox


@pytest.fixture
def name(seed):
    return f"rk-{seed % 10**4}-{os.getpid()}"  # 15 characters at most; another run has others


def running(name: str) -> bool:
    """Whether a process of this name runs anywhere on this machine."""
    for comm in Path("/proc").glob("[0-9]*/comm"):
        with contextlib.suppress(OSError):
            if comm.read_text().strip() == name:
                return True
    return False


def assembled(data):
    whole = Assembler(limit=1000)
    while whole.wanted:
        step, data = data[: whole.wanted], data[whole.wanted :]
        whole.feed(step)
    return whole.message()


def until(condition, seconds=60.0):
    deadline = time.monotonic() + seconds
    while not condition() and time.monotonic() < deadline:
        time.sleep(0.01)
    return condition()


def test_remote_functions_are_worth_what_they_are_here(honest, rng):
    found = {}
    exec(compile(HONEST, "honest.py", "exec"), found)
    u = rng.random((50, 2))
    wi, wo = (rk.directions.spherical_to_cartesian(1.5 * u[:, i], 6 * u[:, 1 - i]) for i in (0, 1))
    for function in ("lambert", "scalar", "single", "float32", "listed", "sampled"):
        here, there = rk.as_bsdf(found[function]), remote_bsdf(honest, function)
        np.testing.assert_array_equal(there(wi, wo), here(wi, wo))
        assert there.precision == here.precision
        assert there.has_sampler == here.has_sampler
        for mine, theirs in zip(here.sample(u, wo), there.sample(u, wo), strict=True):
            np.testing.assert_array_equal(theirs, mine)
    parameters = {"reflectance": 0.25}
    assert remote_bsdf(honest, "lambert", parameters=parameters)(wi[0], wo[0]) == 0.25 / np.pi


def test_a_scalar_function_is_sent_blocks(honest, monkeypatch):
    f = remote_bsdf(honest, "scalar")
    calls = []
    request = honest._called
    monkeypatch.setattr(honest, "_called", lambda *a, **k: calls.append(a) or request(*a, **k))
    wi, wo = np.tile([0.0, 0.0, 1.0], (5000, 1)), np.tile([0.0, 0.6, 0.8], (5000, 1))
    values = f.evaluate(wi, wo)
    assert values.shape == (5000,)
    assert np.all(values == values[0])
    assert len(calls) == 2


def test_what_a_remote_function_does_wrong_is_said_as_of_a_local_one(honest):
    with pytest.raises(CallableError, match=r"raises raised ZeroDivisionError: oh no at wi = \("):
        remote_bsdf(honest, "raises")
    with pytest.raises(CallableError, match=r"returned shape \(2, 2, 2\) for 5 pairs"):
        remote_bsdf(honest, "short")
    with pytest.raises(TargetError, match=r"no function 'lamber'; did you mean 'lambert'\? It defines: lam"):
        remote_bsdf(honest, "lamber")
    assert "prints prints: debugging 5" in remote_bsdf(honest, "prints").notes


@pytest.mark.parametrize(
    ("function", "error"),
    [
        ("endless", r"took longer than 0\.3 s"),
        ("sleeps", r"took longer than 0\.3 s"),
        ("memory", r"raised (_Array)?MemoryError: Unable to allocate"),
        ("big_file", r"raised OSError: \[Errno 27\] File too large"),
        ("floods", "printed more than 262144 bytes"),
        ("stops_itself", r"took longer than 0\.3 s"),
        ("exits", "ended its process with exit code 3"),
        ("leaves", "raised SystemExit: 5"),
        ("kills_itself", "was ended by SIGKILL"),
        ("writes_noise", "gave an answer that is not believed: what came is no message"),
        ("writes_answers", "gave an answer that is not believed: it answers what was not asked"),
        ("claims_much", "gave an answer that is not believed: 4611686018427387904 bytes are claimed"),
        ("evil", "raised SystemExit: evil"),
        ("objects", "returned Objects that is no array of numbers"),
        ("text", "returned str that is no array of numbers"),
        ("nothing", "returned None"),
        ("lies", "raised Liar: its message cannot be read"),
        ("colours", r"raised ValueError: \?\[31mx+…"),
    ],
)
def test_harm_is_explained_in_a_line_and_the_next_call_is_answered(hostile, function, error):
    patience = 0.3 if "took longer" in error else None
    result = hostile.call(function, X, timeout=patience)
    assert re.match(error, result.error), result.error
    assert not result.ok
    assert result.error.isprintable()
    assert len(result.error) < 400
    assert set(result.protections) | set(result.missing) == set(PROTECTIONS)
    np.testing.assert_array_equal(hostile.call("double", X).values[0], 2 * X)


def test_walls_are_there_where_they_can_be(hostile):
    code = "from radiokit.faces.grading.isolation.namespaces import unshare; unshare()"
    granted = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False).returncode == 0
    protections = hostile.call("double", X).protections
    assert {"processes", "network", "root", "privileges"} <= set(protections) or not granted


@pytest.mark.parametrize("function", ["patches", "prints_answers", "deletes"])
def test_what_a_submission_breaks_of_its_own_does_not_matter(hostile, function):
    np.testing.assert_array_equal(hostile.call(function, X).values[0], 2 * X)


def test_what_is_printed_comes_with_the_result(hostile):
    assert hostile.call("double", X).output == "hello\n"


def test_processes_are_few(hostile):
    result = hostile.call("forks", X)
    if "limits" in result.protections:
        assert result.error.startswith("raised BlockingIOError")


def test_files_are_few(hostile):
    result = hostile.call("many_files", X)
    if "root" in result.protections:
        assert result.error.startswith("raised OSError: [Errno 28] No space left")


def test_the_launcher_may_be_attacked(hostile):
    result = hostile.call("kills_its_launcher", X)
    assert result.ok or result.error.startswith(("raised PermissionError", "was ended by SIGKILL"))
    assert hostile.call("double", X).ok


def test_secrets_stay_secret(hostile, tmp_path, monkeypatch):
    monkeypatch.setenv("SECRET", "s3cret")
    secret = tmp_path / "answers.txt"
    secret.write_text("s3cret", encoding="utf-8")
    where = {"path": str(secret), "pid": os.getpid()}
    result = hostile.call("snoops", X, parameters=where)
    if "root" in result.protections:
        assert result.values[0] == 0
        assert hostile.call("references", X).values[0] == 0
    assert hostile.call("environment", X).values[0] == 0
    with Sandbox(tmp_path / "hostile.py", namespaces=False) as open_one:
        result = open_one.call("snoops", X, parameters=where)
        assert result.values[0] == 0 or {"files", "user"} & set(result.missing)
    here = {}
    exec(compile(HOSTILE, "hostile.py", "exec"), here)
    assert here["snoops"](X, **where) >= 1  # the test can see it


def test_there_is_no_network(hostile, tmp_path):
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = {"port": server.getsockname()[1]}
        result = hostile.call("connects", X, parameters=port)
        assert result.values[0] == ("network" in result.missing)
        with Sandbox(tmp_path / "hostile.py", namespaces=False) as open_one:
            result = open_one.call("connects", X, parameters=port)
            assert result.values[0] == ("network" in result.missing)
        here = {}
        exec(compile(HOSTILE, "hostile.py", "exec"), here)
        assert here["connects"](X, **port) == 1  # the test can see it


@pytest.mark.parametrize("namespaces", [True, False])
def test_nothing_outlives_the_sandbox(tmp_path, name, namespaces):
    (tmp_path / "hostile.py").write_text(HOSTILE, encoding="utf-8")
    with Sandbox(tmp_path / "hostile.py", namespaces=namespaces) as sandbox:
        assert sandbox.call("daemon", X, parameters={"name": name}).ok
        assert running(name)
        box = Path(sandbox._child.folder)
        assert box.is_dir()
    assert not running(name)
    assert not box.exists()


def test_nothing_outlives_a_killed_parent(tmp_path, name):
    (tmp_path / "hostile.py").write_text(HOSTILE, encoding="utf-8")
    code = (
        "import sys, numpy as np\n"
        "from radiokit.faces.grading.isolation.sandbox import Sandbox\n"
        "with Sandbox(sys.argv[1]) as sandbox:\n"
        "    sandbox.call('named_endless', np.ones(3), parameters={'name': sys.argv[2]})\n"
    )
    environment = {**os.environ, "TMPDIR": str(tmp_path)}
    words = [sys.executable, "-c", code, str(tmp_path / "hostile.py"), name]
    with subprocess.Popen(words, env=environment) as parent:
        assert until(lambda: running(name))
        parent.send_signal(signal.SIGKILL)
    assert until(lambda: not running(name))


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"x" * PREFIX.size, "no message"),
        (PREFIX.pack(b"RKG1", 1 << 30, 0), "a header of 1073741824 bytes"),
        (PREFIX.pack(b"RKG1", 0, 0), "a header of 0 bytes"),
        (PREFIX.pack(b"RKG1", 2, 1 << 50), "bytes are claimed"),
        *(
            (PREFIX.pack(b"RKG1", len(head), 8) + head + bytes(8), message)
            for head, message in [
                (b"[" * 60000, "no JSON"),
                (b"\xff", "no JSON"),
                (b"[]", "no object"),
                (b"{}", "lists no arrays"),
                (b'{"arrays": [1]}', "not described"),
                (b'{"arrays": [["|O8", [1]]]}', "not carried"),
                (b'{"arrays": [["<f8", [-1]]]}', "not of lengths"),
                (b'{"arrays": [["<f8", [true]]]}', "not of lengths"),
                (b'{"arrays": [["<f8", [1e300]]]}', "not of lengths"),
                (b'{"arrays": [["<f8", [1099511627775, 1099511627775]]]}', "are claimed, 8 came"),
                (b'{"arrays": [["<f8", [1, 1, 1, 1, 1]]]}', "more than 4 dimensions"),
                (b'{"arrays": [["<f8", [0, 549755813888, 549755813888]]]}', "too large"),
                (b'{"arrays": [["<f8", [2]]]}', "16 bytes are claimed, 8 came"),
            ]
        ),
    ],
)
def test_bytes_that_are_no_message_are_refused(data, message):
    with pytest.raises(MalformedError, match=message):
        assembled(data)


def test_every_type_comes_through(rng):
    arrays = [rng.random((2, 3)), rng.random(4).astype("f4"), rng.random(2) * 1j, np.arange(3), X > 1.5]
    for found, sent in zip(assembled(pack({"id": "a"}, arrays))[1], arrays, strict=True):
        np.testing.assert_array_equal(found, sent)
        assert found.dtype == sent.dtype
    with pytest.raises(MalformedError, match="object"):
        pack({}, [np.array([None])])
    with pytest.raises(MalformedError, match="too long"):
        pack({"text": "x" * (1 << 16)})
    assert plain_text("x" * 1000, 10) == "x" * 9 + "…"


def test_limits_and_files_are_checked(tmp_path):
    with pytest.raises(ParameterError, match="seconds = 0"):
        Limits(seconds=0)
    with pytest.raises(ParameterError, match="open_files = 3"):
        Limits(open_files=3)
    with pytest.raises(RadiokitError, match=r"no such file: .*nosuch\.py"):
        Sandbox(tmp_path / "nosuch.py")


@pytest.mark.parametrize(
    ("target", "code", "text"),
    [
        ("lambert", 0, "reciprocity"),
        ("raises", 2, "raises raised ZeroDivisionError: oh no"),
        ("nosuch", 2, "has no function 'nosuch'"),
    ],
)
def test_check_judges_in_isolation(tmp_path, monkeypatch, capsys, target, code, text):
    (tmp_path / "honest.py").write_text(HONEST, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as ended:
        main(["check", f"honest.py:{target}", "--isolated", "--law", "reciprocity"])
    assert ended.value.code == code
    found = capsys.readouterr()
    assert text in found.out + found.err


def test_only_files_are_isolated(capsys):
    with pytest.raises(SystemExit):
        main(["check", "ggx", "--isolated"])
    assert "only file.py:function is run in a sandbox" in capsys.readouterr().err


def test_what_is_done_apart_is_forgotten(tmp_path):
    code = "seen = []\ndef count(x): seen.append(x); return len(seen)\ndef end(x): import os; os._exit(90)"
    (tmp_path / "counting.py").write_text(code, encoding="utf-8")
    with Sandbox(tmp_path / "counting.py") as sandbox:
        found = [sandbox.call("count", X).values[0] for _ in range(2)]
        for _ in range(2):
            with sandbox.apart():
                found += [sandbox.call("count", X).values[0] for _ in range(2)]
        with sandbox.apart():
            assert "not believed: it answers what was not asked" in sandbox.call("end", X).error
        with sandbox.apart():
            found.append(sandbox.call("count", X).values[0])
        assert found == [1, 2, 3, 4, 3, 4, 1]


LEAVING = """
import os, signal, time
def leave(x, doing):
    read, write = os.pipe()
    if os.fork() == 0:
        os.setsid()
        if os.fork() == 0:
            parent = os.getppid()
            os.write(write, b"x")
            while True:
                time.sleep(0.002)
                doing(parent)
        os._exit(0)
    os.read(read, 1)
    return x
def talk(pid):
    for descriptor in range(3, 64):
        try: os.write(descriptor, b"RKG1" + bytes(12))
        except OSError: pass
def listen(pid):
    for descriptor in range(3, 64):
        try: os.set_blocking(descriptor, False); os.read(descriptor, 1 << 16)
        except OSError: pass
def leaves_one_who_listens(x): return leave(x, listen)
def leaves_one_who_talks(x): time.sleep(0.02); return leave(x, talk)
def honest(x): time.sleep(0.05); return 2 * x
"""


@pytest.mark.parametrize("function", ["listens", "talks"])
def test_what_a_copy_leaves_behind_harms_no_later_one(tmp_path, function):
    (tmp_path / "leaving.py").write_text(LEAVING, encoding="utf-8")
    with Sandbox(tmp_path / "leaving.py") as sandbox:
        with sandbox.apart():
            sandbox.call(f"leaves_one_who_{function}", X)
        for _ in range(2):
            with sandbox.apart():
                for _ in range(3):
                    result = sandbox.call("honest", X)
                    assert result.ok, result.error
                    np.testing.assert_array_equal(result.values[0], 2 * X)


@pytest.mark.parametrize("function", ["exits", "kills_itself"])
def test_a_copy_ends_as_the_process_itself_would(hostile, function):
    alone = hostile.call(function, X).error
    with hostile.apart():
        assert hostile.call(function, X).error == alone
        assert hostile.call("double", X).ok
    assert hostile.call("double", X).ok
