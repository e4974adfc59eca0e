"""The launcher: the program that puts the child behind its walls, and clears up behind it.

It is started as ``python -I -B -S launcher.pyc SPEC``, SPEC being JSON, beside the compiled programs of its
box. It unshares what Linux can unshare, builds a root that holds Python and the submission alone, sets
limits, gives up its rights, has calls refused and starts the child. It waits for the child, and looks after
the memory of all; then it kills every descendant and removes the box. SIGTERM, or the end of who started it,
makes it do so at once. It imports nothing that the submission wrote, and little of the standard library, as
each start waits for that.

Bubblewrap is not used: it asks for the same namespaces, and is refused where we are, unless it is installed
with root's rights or excepted by the system's own policy.
"""

from __future__ import annotations

import json
import marshal
import os
import select
import signal
import sys
import time

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Any, NoReturn

__all__: list[str] = []

PARTS = ("descendants", "landlock", "namespaces", "rights", "seccomp")
DEVICES = ("/dev/null", "/dev/zero", "/dev/full", "/dev/random", "/dev/urandom")
SPARE = 4
"""How many processes more than allowed are seen as too many: where the kernel counts, there are none."""
FAILED = 97
"""Exit code when the walls that were asked for cannot be built here."""
TOO_MUCH, TOO_MANY = -signal.SIGUSR1, -signal.SIGUSR2
"""How the launcher ends where the child's processes use too much memory, or are too many."""


def _beside(name: str) -> Any:
    """Import a compiled file of the box, which is on no path."""
    module = type(sys)(name)
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), f"{name}.pyc"), "rb") as file:
        exec(marshal.loads(file.read()[16:]), module.__dict__)
    return module


def _start(
    spec: dict[str, Any], files: dict[str, dict[str, bytes]], own_users: bool, active: list[str]
) -> NoReturn:
    """Become the child; ``active`` are the protections that hold so far."""
    os.setsid()
    inside = "root" in active
    box = "/box" if inside else spec["box"]
    home = "/home" if inside else f"{box}/home"
    for place, kind in ((box, "programs"), (home, "files")):
        os.makedirs(place, exist_ok=True)
        for name, data in files[kind].items():
            target = os.path.join(place, name)
            with open(target, "wb") as file:
                file.write(data)
            os.chmod(target, 0o444)
    os.chmod(home, 0o755)
    uid = spec["uid"] if os.geteuid() == 0 else os.getuid()
    release = tuple(int(part) for part in os.uname().release.split("-")[0].split(".")[:2] if part.isdigit())
    fresh = inside and own_users and release >= (5, 14)  # there, a user namespace counts for itself
    counted = 3 if fresh else spec["threads"][uid]
    rights.limit(spec["limits"], spec["limits"]["processes"] + counted)
    if not inside and os.geteuid() == 0:  # what was handed in is to be read by its own user alone
        os.chown(box, -1, uid)
        os.chmod(box, 0o710)
    for capability in range(64):
        namespaces.control(namespaces.PR_CAPBSET_DROP, capability)
    if not own_users and rights.become(spec["uid"], [*spec["needs"], f"{box}/child.pyc"], home):
        active.append("user")
    namespaces.control(namespaces.PR_SET_PDEATHSIG, int(signal.SIGKILL))
    os.chdir(home)
    namespaces.fix_addresses()
    if rights.processes_are_counted():
        active.append("limits")
    held = []
    if namespaces.control(namespaces.PR_SET_NO_NEW_PRIVS, 1):
        readable = [*spec["visible"], box, "/proc" if inside else "/proc/self"]
        writable = [home, *DEVICES, *(("/tmp", "/dev/shm") if inside else ())]
        held = ["privileges", *landlock.restrict(readable, writable, spec["hidden"]), *seccomp.install()]
    if not (inside or "user" in active or "signals" in held):  # then it may kill its launcher
        active = [name for name in active if name not in ("processes", "memory")]
    active += held
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
    words = [spec["python"], "-P", "-s", "-S", "-B", f"{box}/child.pyc", str(spec["results"]), *spec["sites"]]
    os.execve(spec["python"], words, environment)


def _wait(child: int) -> int:
    """Wait for a process, and bury the others that end; return how it ended, as a shell says it."""
    while True:
        found, status = os.wait()
        if found == child:
            code = os.waitstatus_to_exitcode(status)
            return code if code >= 0 else 128 - code


def _watch(child: int, excess: Callable[[], int] | None) -> tuple[int, bool]:
    """Wait until the child ends, or SIGTERM comes, or the sandbox is gone: then our standard input closes.

    Signals do no more than write into a pipe, so that none can come between this and clearing up. Where
    processes are watched, ``excess`` says what of them is too much, or 0. Returned are the exit code, and
    whether the child has ended.
    """
    read, write = os.pipe()
    os.set_blocking(write, False)
    signal.set_wakeup_fd(write, warn_on_full_buffer=False)
    for number in (signal.SIGTERM, signal.SIGCHLD):
        signal.signal(number, lambda signum, frame: None)
    poll = select.poll()
    poll.register(0, 0)
    poll.register(read, select.POLLIN)
    period = None if excess is None else 1000 * descendants.PERIOD
    looked = 0.0
    while True:
        descendants.bury(child)
        code = descendants.ended(child)
        if code is not None:
            return code, True
        ready = [descriptor for descriptor, _ in poll.poll(period)]
        if 0 in ready or (read in ready and signal.SIGTERM in os.read(read, 512)):
            return FAILED, False
        if excess is not None and time.monotonic() - looked >= descendants.PERIOD:
            looked = time.monotonic()
            if code := excess():
                return code, False


def _remove(parent: int, name: str) -> None:
    """Remove a folder; folders within folders are moved up first, so that no depth is too much."""
    try:
        top = os.open(name, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW, dir_fd=parent)
    except OSError:
        return
    moved = 0
    try:
        while entries := os.listdir(top):
            for entry in entries:
                if _unlinked(top, entry):
                    continue
                os.chmod(entry, 0o700, dir_fd=top)
                inner = os.open(entry, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW, dir_fd=top)
                for each in os.listdir(inner):
                    if not _unlinked(inner, each):
                        os.chmod(each, 0o700, dir_fd=inner)
                        moved += 1
                        os.rename(each, f"..{moved}", src_dir_fd=inner, dst_dir_fd=top)
                os.close(inner)
                os.rmdir(entry, dir_fd=top)
        os.rmdir(name, dir_fd=parent)
    except OSError:  # the sandbox tries again, if it still can
        pass


def _unlinked(folder: int, name: str) -> bool:
    try:
        os.unlink(name, dir_fd=folder)
    except OSError:
        return False
    return True


def _fail(error: Exception) -> NoReturn:
    os.write(2, f"{type(error).__name__}: {error}\n".encode())
    os._exit(FAILED)


def _inside(
    spec: dict[str, Any], files: dict[str, dict[str, bytes]], own_users: bool, active: list[str]
) -> NoReturn:
    """Be the first process of the namespaces: when it ends, all of them end."""
    namespaces.control(namespaces.PR_SET_PDEATHSIG, int(signal.SIGKILL))
    try:
        active = [*active, "processes", "network", "root"]
        active += ["proc"] if namespaces.new_root(spec) else []
        child = os.fork()
        if child == 0:
            _start(spec, files, own_users, active)
    except Exception as error:
        _fail(error)
    os._exit(_wait(child))


def _contents(path: str) -> bytes:
    with open(path, "rb") as file:
        return file.read()


def _main() -> None:
    spec = json.loads(sys.argv[1])
    os.umask(0o022)
    os.set_inheritable(spec["results"], True)
    files = {
        kind: {name: _contents(path) for name, path in spec[kind].items()} for kind in ("programs", "files")
    }
    spec["given"] = sum(len(data) + 4096 for data in files["files"].values())
    spec["uid"] = rights.free_user()
    spec["threads"] = {spec["uid"]: 0, os.getuid(): rights.threads(os.getuid())}
    folder = os.open(os.path.dirname(spec["box"]), os.O_RDONLY | os.O_DIRECTORY)
    proc = os.open("/proc", os.O_RDONLY | os.O_DIRECTORY) if os.path.isdir("/proc/self") else -1
    watched = descendants.watchable(proc)
    active = ["memory"] if watched else []
    reaper = namespaces.control(namespaces.PR_SET_CHILD_SUBREAPER, 1)
    try:
        own_users = namespaces.unshare() if spec["namespaces"] else False
        child = os.fork()
        if child == 0:
            for descriptor in (folder, proc):
                if descriptor >= 0:
                    os.close(descriptor)
        if child == 0 and spec["namespaces"]:
            _inside(spec, files, own_users, active)
        if child == 0:
            _start(spec, files, False, [*active, "processes"] if reaper else active)
    except Exception as error:
        _fail(error)
    for descriptor in (1, 2, spec["results"]):
        os.close(descriptor)
    me, limits = os.getpid(), spec["limits"]
    ours = 2 if spec["namespaces"] else 1  # the launcher, and the first process of the namespaces

    def excess() -> int:
        """Slow what runs beside itself; return what of it is too much, as is seen twice, or 0."""
        for _ in range(2):
            pids = descendants.tree(proc, me)[ours:]
            descendants.slow(proc, pids)
            many = len(pids) > limits["processes"] + SPARE
            if not many and descendants.used(proc, pids, limits["memory_bytes"]) <= limits["memory_bytes"]:
                return 0
        return TOO_MANY if many else TOO_MUCH

    code, ended = _watch(child, excess if watched else None)
    descendants.clear(proc, 0 if ended else child, 2.0)
    _remove(folder, os.path.basename(spec["box"]))
    if code < 0:  # no exit code of a child looks like it
        signal.signal(-code, signal.SIG_DFL)
        os.kill(me, -code)
    os._exit(code)


if __name__ == "__main__":
    descendants, landlock, namespaces, rights, seccomp = map(_beside, PARTS)
    _main()
