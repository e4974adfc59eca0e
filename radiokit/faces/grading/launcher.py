"""The launcher: the program that puts the child behind its walls, and clears up behind it.

It is started as ``python -I -B -S launcher.py SPEC``, SPEC being JSON. It unshares what Linux can unshare,
builds a root that holds Python and the submission alone, sets limits, gives up its rights and starts the
child. It waits for the child, then kills every descendant; SIGTERM makes it do so at once. It imports the
standard library alone, and nothing that the submission wrote.
"""

from __future__ import annotations

import contextlib
import ctypes
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

NEWNS, NEWUTS, NEWIPC, NEWUSER, NEWPID, NEWNET = (
    0x00020000,
    0x04000000,
    0x08000000,
    0x10000000,
    0x20000000,
    0x40000000,
)
MS_NOSUID, MS_NODEV, MS_BIND, MS_REC, MS_PRIVATE = 2, 4, 4096, 16384, 1 << 18
MNT_DETACH = 2
AT_FDCWD, AT_RECURSIVE, SYS_MOUNT_SETATTR = -100, 0x8000, 442
ATTR_RDONLY, ATTR_NOSUID = 1, 2
PR_SET_PDEATHSIG, PR_CAPBSET_DROP, PR_SET_CHILD_SUBREAPER, PR_SET_NO_NEW_PRIVS = 1, 24, 36, 38
FAILED = 97
"""Exit code when the walls that were asked for cannot be built here."""

_libc = ctypes.CDLL(None, use_errno=True)


def _call(name: str, *arguments: Any) -> None:
    """Call a function of the C library; OSError when it is missing or fails."""
    function = getattr(_libc, name, None)
    if function is None:
        raise OSError(f"no {name} here")
    if function(*arguments) != 0:
        code = ctypes.get_errno()
        raise OSError(code, f"{name}: {os.strerror(code)}")


def _try(name: str, *arguments: Any) -> bool:
    try:
        _call(name, *arguments)
    except OSError:
        return False
    return True


def _mount(source: str, target: str, kind: str, flags: int, options: str = "") -> None:
    _call("mount", source.encode(), target.encode(), kind.encode(), ctypes.c_ulong(flags), options.encode())


def _unshare() -> bool:
    """Enter namespaces of our own; return whether the user namespace is one of them."""
    flags = NEWNS | NEWUTS | NEWIPC | NEWPID | NEWNET
    uid, gid = os.geteuid(), os.getegid()
    if uid == 0 and _try("unshare", flags):
        return False
    _call("unshare", flags | NEWUSER)
    with contextlib.suppress(OSError):
        Path("/proc/self/setgroups").write_text("deny", encoding="ascii")
    Path("/proc/self/uid_map").write_text(f"{uid} {uid} 1", encoding="ascii")
    Path("/proc/self/gid_map").write_text(f"{gid} {gid} 1", encoding="ascii")
    return True


def _read_only(target: str) -> None:
    attributes = (ctypes.c_uint64 * 4)(ATTR_RDONLY | ATTR_NOSUID, 0, 0, 0)
    _call(
        "syscall",
        ctypes.c_long(SYS_MOUNT_SETATTR),
        ctypes.c_int(AT_FDCWD),
        ctypes.c_char_p(target.encode()),
        ctypes.c_uint(AT_RECURSIVE),
        attributes,
        ctypes.c_size_t(32),
    )


def _new_root(spec: dict[str, Any]) -> bool:
    """Make the box the root: of the old one only what is visible, to read; return whether /proc is there."""
    box = spec["box"]
    _mount("none", "/", "none", MS_REC | MS_PRIVATE)
    size = f"size={spec['limits']['disk_bytes']},nr_inodes={spec['limits']['inodes']},mode=755"
    _mount("tmpfs", box, "tmpfs", MS_NOSUID | MS_NODEV, size)
    for path in spec["visible"]:
        source, target = Path(path), Path(box + path)
        if source.is_symlink() and source.parent == Path("/"):
            target.symlink_to(source.readlink())
            continue
        if not source.exists() or target.exists():
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            target.mkdir()
        else:
            target.touch()
        _mount(path, str(target), "none", MS_BIND | MS_REC)
        _read_only(str(target))
    for path in spec["hidden"]:
        if Path(box + path).is_dir():
            _mount("tmpfs", box + path, "tmpfs", MS_NOSUID | MS_NODEV, "size=4k,mode=555")
    for path in ("/proc", "/home", "/tmp", "/dev/shm"):
        Path(box + path).mkdir(parents=True, exist_ok=True)
    for path in ("/tmp", "/dev/shm"):
        Path(box + path).chmod(0o1777)
    proc = True
    try:
        _mount("proc", f"{box}/proc", "proc", MS_NOSUID | MS_NODEV)
    except OSError:
        proc = False
    os.chdir(box)
    _call("pivot_root", b".", b".")
    _call("umount2", b".", MNT_DETACH)
    os.chdir("/")
    return proc


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
        _try("prctl", PR_CAPBSET_DROP, capability, 0, 0, 0)
    uid = spec["uid"]
    if os.geteuid() == 0 and not own_users:
        os.setgroups([])
        if _may_read(uid, spec["needs"]):
            os.chown(home, uid, uid)
            os.setresgid(uid, uid, uid)
            os.setresuid(uid, uid, uid)
            done.append("user")
    if _try("prctl", PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0):
        done.append("privileges")
    _try("prctl", PR_SET_PDEATHSIG, int(signal.SIGKILL), 0, 0, 0)
    return done


def _start(spec: dict[str, Any], files: dict[str, bytes], own_users: bool, active: list[str]) -> NoReturn:
    """Become the child."""
    os.setsid()
    inside = "root" in active
    box = "/box" if inside else spec["box"]
    home = "/home" if inside else f"{box}/home"
    Path(home).mkdir(parents=True, exist_ok=True)
    for name, data in files.items():
        target = Path(box if name in ("child.py", "protocol.py") else home, name)
        target.parent.mkdir(parents=True, exist_ok=True)
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
        "OMP_NUM_THREADS": "1",
        "OPENBLAS_NUM_THREADS": "1",
        "MKL_NUM_THREADS": "1",
        "SANDBOX": json.dumps(active),
    }
    words = [spec["python"], "-I", "-B", f"{box}/child.py", spec["site"], str(spec["results"])]
    os.execve(spec["python"], words, environment)


def _clear(child: int | None, deadline: float) -> None:
    """Kill every descendant: orphans become our children, as we are their reaper."""
    me = os.getpid()
    if child is not None:
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


def _wait(pid: int) -> int:
    """Wait for a child, reaping others; return how it ended, as a shell says it."""
    while True:
        found, status = os.wait()
        if found == pid:
            code = os.waitstatus_to_exitcode(status)
            return code if code >= 0 else 128 - code


def _watch() -> None:
    """Return when a child has ended; end when the sandbox has: then our standard input closes."""
    read, write = os.pipe()
    os.set_blocking(write, False)
    signal.set_wakeup_fd(write)
    signal.signal(signal.SIGCHLD, lambda signum, frame: None)
    with contextlib.suppress(ChildProcessError):
        if os.waitid(os.P_ALL, 0, os.WEXITED | os.WNOHANG | os.WNOWAIT):
            return
    poll = select.poll()
    poll.register(0, 0)
    poll.register(read, select.POLLIN)
    if any(descriptor == 0 for descriptor, _ in poll.poll()):
        raise SystemExit(FAILED)


def _stop(signum: int, frame: object) -> None:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    raise SystemExit(128 + signum)


def _fail(error: Exception) -> NoReturn:
    os.write(2, f"{type(error).__name__}: {error}\n".encode())
    os._exit(FAILED)


def _inside(spec: dict[str, Any], files: dict[str, bytes], own_users: bool) -> NoReturn:
    """Be the first process of the namespaces: when it ends, all of them end."""
    _try("prctl", PR_SET_PDEATHSIG, int(signal.SIGKILL), 0, 0, 0)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    try:
        active = ["processes", "network", "root"] + (["proc"] if _new_root(spec) else [])
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
    files = {name: Path(path).read_bytes() for name, path in spec["files"].items()}
    spec["threads"] = {str(uid): _threads(uid) for uid in {os.getuid(), spec["uid"]}}
    reaper = _try("prctl", PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    signal.signal(signal.SIGTERM, _stop)
    try:
        own_users = _unshare() if spec["namespaces"] else False
        child = os.fork()
        if child == 0 and spec["namespaces"]:
            _inside(spec, files, own_users)
        if child == 0:
            signal.signal(signal.SIGTERM, signal.SIG_DFL)
            _start(spec, files, False, ["processes"] if reaper else [])
    except Exception as error:
        _fail(error)
    for descriptor in (1, 2, spec["results"]):
        os.close(descriptor)
    code: int = FAILED
    left: int | None = child
    try:
        _watch()
        code, left = _wait(child), None
    finally:
        _clear(left, time.monotonic() + 2)
        os._exit(code)


if __name__ == "__main__":
    _main()
