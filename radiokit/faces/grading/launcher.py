"""The launcher: the program that puts the child behind its walls, and clears up behind it.

It is started as ``python -I -B -S launcher.py SPEC``, SPEC being JSON. It unshares what Linux can unshare,
builds a root that holds Python and the submission alone, sets limits, gives up its rights and starts the
child. It waits for the child, then kills every descendant; SIGTERM makes it do so at once. It imports the
standard library alone, and nothing that the submission wrote.
"""

from __future__ import annotations

import contextlib
import importlib.util
import json
import os
import resource
import select
import signal
import sys
import time
from pathlib import Path
from typing import Any, NoReturn

__all__: list[str] = []

FAILED = 97
"""Exit code when the walls that were asked for cannot be built here."""


def _beside(name: str) -> Any:
    """Import a file of this folder, which is on no path."""
    spec = importlib.util.spec_from_file_location(name, Path(__file__).with_name(f"{name}.py"))
    if spec is None or spec.loader is None:
        raise ImportError(f"cannot import {name}")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


namespaces = _beside("namespaces")


def _threads(uid: int) -> int:
    """Return how many threads a user already runs: they count towards his limit."""
    count = 0
    for status in Path("/proc").glob("[0-9]*/status"):
        with contextlib.suppress(OSError, IndexError, ValueError):
            words = dict(line.split(":", 1) for line in status.read_text().splitlines())
            count += int(words["Threads"]) if int(words["Uid"].split()[0]) == uid else 0
    return count


def _set_limits(limits: dict[str, int], processes: int) -> None:
    wanted = {
        "RLIMIT_CPU": limits["cpu_seconds"],
        "RLIMIT_AS": limits["memory_bytes"],
        "RLIMIT_NPROC": processes,
        "RLIMIT_NOFILE": limits["open_files"],
        "RLIMIT_FSIZE": limits["file_bytes"],
        "RLIMIT_CORE": 0,
    }
    for name, value in wanted.items():
        kind = getattr(resource, name, None)
        if kind is not None:
            hard = resource.getrlimit(kind)[1]
            value = value if hard == resource.RLIM_INFINITY else min(value, hard)
            with contextlib.suppress(OSError, ValueError):  # macOS refuses RLIMIT_AS
                resource.setrlimit(kind, (value, value))


def _may_read(uid: int, paths: list[str]) -> bool:
    """Return whether another user could open these files."""
    os.setegid(uid)
    os.seteuid(uid)
    try:
        for path in paths:
            with Path(path).open("rb"):
                pass
        return True
    except OSError:
        return False
    finally:
        os.seteuid(0)
        os.setegid(0)


def _give_up_rights(spec: dict[str, Any], home: str, own_users: bool) -> list[str]:
    """Become nobody in particular, for good; return what was given up."""
    done = []
    for capability in range(64):
        namespaces.control(namespaces.PR_CAPBSET_DROP, capability)
    uid = spec["uid"]
    if os.geteuid() == 0 and not own_users:
        os.setgroups([])
        if _may_read(uid, spec["needs"]):
            os.chown(home, uid, uid)
            os.setresgid(uid, uid, uid)
            os.setresuid(uid, uid, uid)
            done.append("user")
    if namespaces.control(namespaces.PR_SET_NO_NEW_PRIVS, 1):
        done.append("privileges")
    namespaces.control(namespaces.PR_SET_PDEATHSIG, int(signal.SIGKILL))
    return done


def _start(
    spec: dict[str, Any], files: dict[str, dict[str, bytes]], own_users: bool, active: list[str]
) -> NoReturn:
    """Become the child."""
    os.setsid()
    inside = "root" in active
    box = "/box" if inside else spec["box"]
    home = "/home" if inside else f"{box}/home"
    for place in (box, home):
        Path(place).mkdir(exist_ok=True)
    for place, kind in ((box, "programs"), (home, "files")):
        for name, data in files[kind].items():
            target = Path(place, name)
            target.write_bytes(data)
            target.chmod(0o444)
    Path(home).chmod(0o755)
    uid = spec["uid"] if os.geteuid() == 0 else os.getuid()
    release = tuple(int(part) for part in os.uname().release.split("-")[0].split(".")[:2] if part.isdigit())
    fresh = inside and own_users and release >= (5, 14)  # there, a user namespace counts for itself
    _set_limits(
        spec["limits"], spec["limits"]["processes"] + (3 if fresh else spec["threads"].get(str(uid), 0))
    )
    spec["needs"] = [*spec["needs"], f"{box}/child.py"]
    active = [*active, *_give_up_rights(spec, home, own_users)]
    if os.getuid() != 0:  # root's processes are not counted
        active.append("limits")
    if not inside and "user" not in active:  # then it may kill its launcher
        active = [name for name in active if name != "processes"]
    os.chdir(home)
    environment = {
        "HOME": home,
        "TMPDIR": home,
        "PATH": "/usr/bin:/bin",
        "LANG": "C.UTF-8",
        "TZ": "UTC",
        "USER": "student",
        "MPLBACKEND": "Agg",
        "PYTHONHASHSEED": "0",
        "OMP_NUM_THREADS": "1",
        "OPENBLAS_NUM_THREADS": "1",
        "MKL_NUM_THREADS": "1",
        "SANDBOX": json.dumps(active),
    }
    words = [spec["python"], "-P", "-s", "-S", "-B", f"{box}/child.py", str(spec["results"]), *spec["sites"]]
    os.execve(spec["python"], words, environment)


def _clear(child: int, deadline: float) -> None:
    """Kill every descendant: orphans become our children, as we are their reaper."""
    me = os.getpid()
    with contextlib.suppress(ProcessLookupError):
        if os.waitid(os.P_PID, child, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None:
            os.kill(child, signal.SIGKILL)
    while time.monotonic() < deadline:
        with contextlib.suppress(OSError):
            for pid in Path(f"/proc/{me}/task/{me}/children").read_text().split():
                os.kill(int(pid), signal.SIGKILL)
        try:
            if os.waitpid(-1, os.WNOHANG)[0] == 0:
                time.sleep(0.001)
        except ChildProcessError:
            return


def _wait(child: int) -> int:
    """Wait for a process, and bury the others that end; return how it ended, as a shell says it."""
    while True:
        found, status = os.wait()
        if found == child:
            code = os.waitstatus_to_exitcode(status)
            return code if code >= 0 else 128 - code


def _watch(child: int) -> int:
    """Wait until the child ends, or SIGTERM comes, or the sandbox is gone: then our standard input closes.

    Signals do no more than write into a pipe, so that none can come between this and clearing up.
    """
    read, write = os.pipe()
    os.set_blocking(write, False)
    signal.set_wakeup_fd(write, warn_on_full_buffer=False)
    for number in (signal.SIGTERM, signal.SIGCHLD):
        signal.signal(number, lambda signum, frame: None)
    poll = select.poll()
    poll.register(0, 0)
    poll.register(read, select.POLLIN)
    while True:
        ended = os.waitid(os.P_PID, child, os.WEXITED | os.WNOHANG | os.WNOWAIT)
        if ended is not None:
            return ended.si_status + (0 if ended.si_code == os.CLD_EXITED else 128)
        ready = [descriptor for descriptor, _ in poll.poll()]
        if 0 in ready or signal.SIGTERM in os.read(read, 512):
            return FAILED


def _fail(error: Exception) -> NoReturn:
    os.write(2, f"{type(error).__name__}: {error}\n".encode())
    os._exit(FAILED)


def _inside(spec: dict[str, Any], files: dict[str, dict[str, bytes]], own_users: bool) -> NoReturn:
    """Be the first process of the namespaces: when it ends, all of them end."""
    namespaces.control(namespaces.PR_SET_PDEATHSIG, int(signal.SIGKILL))
    try:
        active = ["processes", "network", "root"] + (["proc"] if namespaces.new_root(spec) else [])
        child = os.fork()
        if child == 0:
            _start(spec, files, own_users, active)
    except Exception as error:
        _fail(error)
    os._exit(_wait(child))


def _main() -> None:
    spec = json.loads(sys.argv[1])
    os.umask(0o022)
    os.set_inheritable(spec["results"], True)
    files = {
        kind: {name: Path(path).read_bytes() for name, path in spec[kind].items()}
        for kind in ("programs", "files")
    }
    spec["given"] = sum(len(data) + 4096 for data in files["files"].values())
    spec["threads"] = {str(uid): _threads(uid) for uid in {os.getuid(), spec["uid"]}}
    reaper = namespaces.control(namespaces.PR_SET_CHILD_SUBREAPER, 1)
    try:
        own_users = namespaces.unshare() if spec["namespaces"] else False
        child = os.fork()
        if child == 0 and spec["namespaces"]:
            _inside(spec, files, own_users)
        if child == 0:
            _start(spec, files, False, ["processes"] if reaper else [])
    except Exception as error:
        _fail(error)
    for descriptor in (1, 2, spec["results"]):
        os.close(descriptor)
    code = _watch(child)
    _clear(child, time.monotonic() + 2)
    os._exit(code)


if __name__ == "__main__":
    _main()
