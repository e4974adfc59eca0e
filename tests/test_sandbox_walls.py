"""The walls of the sandbox: the calls that are refused, the memory of all, and what is cleared up."""

from __future__ import annotations

import contextlib
import errno
import os
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pytest

from radiokit.faces.grading.isolation import descendants, landlock, seccomp
from radiokit.faces.grading.isolation.limits import Limits
from radiokit.faces.grading.isolation.sandbox import Sandbox

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="these walls are Linux's")

SUBMISSION = """
import ctypes, mmap, os, socket, subprocess, threading, time
import numpy as np

libc = ctypes.CDLL(None, use_errno=True)

def calls(numbers):
    found = []
    for number in numbers:
        ctypes.set_errno(0)
        found.append(ctypes.get_errno() if libc.syscall(ctypes.c_long(number), 0, 0, 0, 0, 0, 0) == -1 else 0)
    return found
def clones(flags):
    done = [libc.syscall(56, ctypes.c_ulong(flag), 0, 0, 0, 0) for flag in flags]
    return done
def families(numbers):
    found = []
    for number in numbers:
        try: socket.socket(number).close()
        except OSError as error: found.append(error.errno)
        else: found.append(0)
    return found
def everyday(x):
    thread = threading.Thread(target=lambda: x.__imul__(2))
    thread.start(); thread.join()
    one, other = socket.socketpair()
    one.send(b"x"); other.recv(1)
    subprocess.run(["/bin/sh", "-c", "exit 0"], check=True)
    return x
def pools(x):
    import multiprocessing
    with multiprocessing.get_context("fork").Pool(2) as pool:
        return np.array(pool.map(abs, x))
def swell(x):
    # four processes that together take more than one of them may
    for _ in range(4):
        if os.fork() == 0:
            kept = np.ones(int(x) << 17)
            time.sleep(20); os._exit(0)
    time.sleep(20)
def shares(x):
    # four that look at the same memory
    kept = np.ones(int(x) << 17)
    for _ in range(3):
        if os.fork() == 0:
            kept.sum(); time.sleep(0.4); os._exit(0)
    for _ in range(3): os.wait()
    return kept[:1]
def nests(x):
    os.chmod(".", 0o700)
    for _ in range(40):  # no path can name the last of them
        os.mkdir("d" * 250); os.chdir("d" * 250)
    open("file", "w").close()
    os.chmod("..", 0o100); os.chmod(".", 0)
    return x
def reaches(x, paths):
    # reading, listing and writing
    found = []
    for path in paths:
        try: found.append(bool(os.listdir(path) if os.path.isdir(path) else open(path, "rb").read(1)))
        except OSError: found.append(0)
    return found
def writes(x, paths):
    found = []
    for path in paths:
        try: open(path + "/written", "w").close(); found.append(1)
        except OSError: found.append(0)
    return found
def signals(x):
    found = []
    for pid in (os.getppid(), -1):
        try: os.kill(pid, 0); found.append(1)
        except OSError: found.append(0)
    return found
def forks(x):
    for _ in range(30):
        if os.fork() == 0:
            time.sleep(20); os._exit(0)
    time.sleep(20)
def orphans(x):
    for _ in range(40):
        if os.fork() == 0:
            if os.fork(): os._exit(0)
            time.sleep(0.01); os._exit(0)
        os.wait(); time.sleep(0.02)
    return x
def comets(x, name):
    # each is gone as soon as it is seen, and another is there
    libc.prctl(15, name.encode(), 0, 0, 0)
    end = time.monotonic() + 5
    for _ in range(2):
        if os.fork() == 0:
            os.setsid()
            while time.monotonic() < end:
                if os.fork(): os._exit(0)
            os._exit(0)
    return x
def crowds(x):
    end = time.monotonic() + 5
    for _ in range(int(x)):
        if os.fork() == 0:
            os.setsid()
            while time.monotonic() < end:
                pass
            os._exit(0)
    nice = os.getpriority(os.PRIO_PROCESS, 0)
    while x and os.getpriority(os.PRIO_PROCESS, 0) == nice and time.monotonic() < end:
        pass
    return os.getpriority(os.PRIO_PROCESS, 0)
def sleeps(x):
    open("left", "w").close(); time.sleep(20)
"""


@pytest.fixture
def path(tmp_path):
    file = tmp_path / "theirs.py"
    file.write_text(SUBMISSION)
    return file


def until(condition, seconds=60.0):
    deadline = time.monotonic() + seconds
    while not condition() and time.monotonic() < deadline:
        time.sleep(0.01)
    return condition()


def names():
    """The names of all processes of this machine."""
    found = set()
    for comm in Path("/proc").glob("[0-9]*/comm"):
        with contextlib.suppress(OSError):
            found.add(comm.read_text().strip())
    return found


def judged(steps: bytes, architecture: int, number: int, *arguments: int) -> int:
    """What a filter says of a call, by an interpreter of its own."""
    shown = struct.pack("<IIQ6Q", number, architecture, 0, *arguments, *[0] * (6 - len(arguments)))
    at = register = 0
    while True:
        code, yes, no, value = struct.unpack_from("<HBBI", steps, 8 * at)
        at += 1
        if code == 0x06:
            return value
        if code == 0x20:
            register = struct.unpack_from("<I", shown, value)[0]
        else:
            true = {0x15: register == value, 0x35: register >= value, 0x45: register & value != 0}[code]
            at += yes if true else no


@pytest.mark.parametrize(
    ("machine", "architecture", "numbers"),
    [  # read, write, execve, fork or wait4, socketpair, clone, ptrace, socket
        ("x86_64", 0xC000003E, (0, 1, 59, 57, 53, 56, 101, 41)),
        ("aarch64", 0xC00000B7, (63, 64, 221, 260, 199, 220, 117, 198)),
    ],
)
def test_the_filter_refuses_what_it_says(machine, architecture, numbers):
    steps = seccomp.program(machine)
    allow, refuse, unknown = 0x7FFF0000, 0x50000 | errno.EPERM, 0x50000 | errno.ENOSYS
    *fine, pair, clone, ptrace, sockets = numbers
    for number in (*fine, 424, 436, 449, 0x3FFFFFFF):
        assert judged(steps, architecture, number) == allow
        assert judged(steps, architecture ^ 1, number) == refuse
        assert judged(steps, architecture, number | 0x40000000) == refuse
    column = machine == "aarch64"
    for both in seccomp.REFUSED.values():
        assert both[column] is None or judged(steps, architecture, both[column]) == refuse
    assert {judged(steps, architecture, number) for number in (ptrace, sockets)} == {refuse}
    assert judged(steps, architecture, pair, socket.AF_UNIX) == allow
    assert judged(steps, architecture, pair, socket.AF_INET) == refuse
    threads, children = 0x003D0F00, signal.SIGCHLD
    assert {judged(steps, architecture, clone, flags) for flags in (threads, children)} == {allow}
    for bit in (0x80, 0x20000, 0x2000000, 0x4000000, 0x8000000, 0x10000000, 0x20000000, 0x40000000):
        assert judged(steps, architecture, clone, children | bit) == refuse
    assert judged(steps, architecture, 435) == unknown
    own = [both[column] for both in seccomp.REFUSED.values() if both[column] is not None]
    assert len(set(own)) == len(own)


@pytest.mark.parametrize("namespaces", [True, False])
def test_calls_are_refused_and_everyday_ones_are_not(path, namespaces):
    with Sandbox(path, namespaces=namespaces) as sandbox:
        np.testing.assert_array_equal(sandbox.call("everyday", np.array([1, 2])).values[0], [2, 4])
        if namespaces and "root" in sandbox.load().protections:  # elsewhere /dev/shm is everybody's
            np.testing.assert_array_equal(sandbox.call("pools", np.array([1, -2])).values[0], [1, 2])
        protections = sandbox.load().protections
        if os.uname().machine in seccomp.ARCHITECTURES:
            assert {"calls", "network"} <= set(protections)
        if "calls" in protections and os.uname().machine == "x86_64":
            harmless = [pair[0] for name, pair in seccomp.REFUSED.items() if name != "vhangup"]
            assert set(sandbox.call("calls", harmless).values[0]) == {errno.EPERM}
            assert set(sandbox.call("clones", [0x10000011, 0x20011]).values[0]) == {-1}
            assert list(sandbox.call("calls", [435, 39]).values[0]) == [errno.ENOSYS, 0]
        if "network" in protections:
            kinds = [socket.AF_INET, socket.AF_INET6, socket.AF_UNIX, socket.AF_NETLINK]
            assert errno.EPERM in sandbox.call("families", kinds).values[0]


@pytest.mark.parametrize("namespaces", [True, False])
def test_memory_is_that_of_all_processes(path, namespaces):
    with Sandbox(path, limits=Limits(memory_bytes=1 << 29, seconds=30), namespaces=namespaces) as sandbox:
        assert sandbox.call("shares", 180).ok
        swollen = sandbox.call("swell", 180)
        if "memory" in swollen.protections or not namespaces:
            assert swollen.error == "used more than 0.5 GiB of memory"
        assert sandbox.call("everyday", np.array([1, 2])).ok


@pytest.mark.parametrize("namespaces", [True, False])
def test_processes_are_few(path, namespaces):
    with Sandbox(path, namespaces=namespaces) as sandbox:
        result = sandbox.call("forks", 1.0)
        assert result.error == "ran more than 16 processes" or result.raised == "BlockingIOError"
        assert result.raised == "BlockingIOError" or "limits" not in result.protections


@pytest.mark.parametrize("namespaces", [True, False])
def test_orphans_are_buried(path, namespaces):
    with Sandbox(path, namespaces=namespaces) as sandbox:
        assert sandbox.call("orphans", 1.0).ok


@pytest.mark.parametrize("namespaces", [True, False])
def test_what_flees_is_caught(path, namespaces, seed):
    name = f"rk-{seed % 10**4}-{os.getpid()}"
    with Sandbox(path, namespaces=namespaces) as sandbox:
        result = sandbox.call("comets", 1.0, parameters={"name": name})
        assert result.ok
        assert name in names()
    assert name not in names() or "processes" not in result.protections


def test_memory_that_is_shared_is_counted_once():
    proc = os.open("/proc", os.O_RDONLY)
    kept = np.ones(1 << 23)  # 64 MiB
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        os.read(read, 1)
        os._exit(0)
    try:
        assert descendants.tree(proc, os.getpid())[1:] == [child] or child in descendants.tree(
            proc, os.getpid()
        )
        pair = [os.getpid(), child]
        quick, exact = descendants.used(proc, pair, 1 << 62), descendants.used(proc, pair, 0)
        assert quick - exact > 0.9 * kept.nbytes
        assert exact > kept.nbytes
    finally:
        os.write(write, b"x")
        os.waitpid(child, 0)
        for descriptor in (proc, read, write):
            os.close(descriptor)


def test_the_end_of_a_child_is_told_without_waitid(monkeypatch):
    for missing in (False, True):
        if missing:
            monkeypatch.delattr(os, "waitid")
        for wanted in (3, 128 + signal.SIGKILL):
            with subprocess.Popen(["/bin/sh", "-c", "read x; exit 3"], stdin=subprocess.PIPE) as process:
                assert descendants.ended(process.pid) is None
                if wanted == 3:
                    process.stdin.close()
                else:
                    process.kill()
                found = None
                while found is None:
                    found = descendants.ended(process.pid)
                assert found == wanted


@pytest.mark.parametrize("namespaces", [True, False])
def test_folders_of_any_depth_are_removed(path, namespaces):
    with Sandbox(path, namespaces=namespaces) as sandbox:
        assert sandbox.call("nests", 1.0).ok
        folder = Path(sandbox._child.folder)
        assert folder.is_dir()
    assert not folder.exists()


@pytest.mark.parametrize("namespaces", [True, False])
def test_a_killed_parent_leaves_no_folder(path, tmp_path, namespaces):
    code = (
        "import sys, numpy as np\n"
        "from radiokit.faces.grading.isolation.sandbox import Sandbox\n"
        "with Sandbox(sys.argv[1], namespaces=bool(int(sys.argv[2]))) as sandbox:\n"
        "    sandbox.load()\n"
        "    print(flush=True)\n"
        "    sandbox.call('sleeps', 1.0)\n"
    )
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    words = [sys.executable, "-c", code, str(path), str(int(namespaces))]
    environment = {**os.environ, "TMPDIR": str(temporary)}
    with subprocess.Popen(words, env=environment, stdout=subprocess.PIPE) as parent:
        assert parent.stdout.readline() == b"\n"
        assert list(temporary.iterdir())
        parent.send_signal(signal.SIGKILL)
    assert until(lambda: not list(temporary.iterdir()))


def test_files_need_no_namespaces(path, tmp_path):
    beside = tmp_path / "beside"
    beside.mkdir()
    (beside / "answers").write_text("s3cret")
    here = Path(descendants.__file__).parents[2]
    with Sandbox(path, namespaces=False) as sandbox:
        protections = sandbox.load().protections
        closed = [
            "/",
            "/etc",
            "/proc",
            str(tmp_path),
            str(beside),
            str(beside / "answers"),
            str(here / "__init__.py"),
        ]
        seen = [np.__file__, str(Path(np.__file__).parent), "/usr", "/dev/zero", "theirs.py", "."]
        found = sandbox.call("reaches", 1.0, parameters={"paths": closed + seen}).values[0]
        assert list(found[-len(seen) :]) == [1] * len(seen)
        assert not any(found[: len(closed)]) or "files" not in protections
        places = [str(beside), "/tmp", "/dev/shm", str(Path(np.__file__).parent), "."]
        found = sandbox.call("writes", 1.0, parameters={"paths": places}).values[0]
        assert found[-1] or os.getuid() != 0
        assert not any(found[:-1]) or "files" not in protections
        if "processes" in protections:
            assert not sandbox.call("signals", 1.0).values[0][0]
    assert "files" in protections or not landlocked()


@pytest.mark.parametrize("namespaces", [True, False])
def test_a_crowd_is_slowed_so_that_others_are_not(path, namespaces):
    with Sandbox(path, namespaces=namespaces) as sandbox:
        protections, nice = sandbox.load().protections, []
        for crowd in (0, 7, 0):
            with sandbox.apart():
                nice += sandbox.call("crowds", crowd).values
    alone, many, after = (int(each) for each in nice)
    assert many > alone or alone == 19 or "memory" not in protections
    assert after == alone


@pytest.mark.parametrize("namespaces", [True, False])
def test_what_is_handed_in_is_nobody_else_s(tmp_path, monkeypatch, namespaces):
    """Two at once run as two users, and no other user of the machine can look into their folders."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    code = b"import os\ndef user(x): return os.getuid()"
    one, two = (Sandbox(name, content=code, namespaces=namespaces) for name in ("a.py", "b.py"))
    with one, two:
        users = [each.call("user", 1.0) for each in (one, two)]
        modes = [path.stat().st_mode for path in tmp_path.iterdir()]
    assert "user" not in users[0].protections or users[0].values != users[1].values
    assert [mode & 0o7 for mode in modes] == [0, 0]


def landlocked():
    """Whether Landlock is on, seen in a process of its own."""
    code = "from radiokit.faces.grading.isolation.landlock import restrict\nprint(restrict(['/usr'], [], []))"
    done = subprocess.run(
        [sys.executable, "-c", f"import ctypes; ctypes.CDLL(None).prctl(38, 1, 0, 0, 0)\n{code}"],
        capture_output=True,
        text=True,
        check=True,
    )
    return "files" in done.stdout


def test_what_is_hidden_is_in_no_rule(tmp_path):
    for name in ("numpy", "radiokit/faces", "other"):
        (tmp_path / name).mkdir(parents=True)
    (tmp_path / "radiokit/faces/a.py").write_text("")
    site = str(tmp_path)
    rules = dict(landlock.allowed(site, [f"{site}/radiokit", "/elsewhere"]))
    assert rules == {site: landlock.READ_DIR, f"{site}/numpy": landlock.READ, f"{site}/other": landlock.READ}
    assert f"{site}/radiokit" in dict(landlock.allowed(site, [f"{site}/radiokit/faces"]))
    assert dict(landlock.allowed(site, [f"{site}/rad"])) == {site: landlock.READ_DIR} | {
        f"{site}/{name}": landlock.READ for name in ("numpy", "other", "radiokit")
    }
