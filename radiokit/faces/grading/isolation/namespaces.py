"""Namespaces: what Linux can keep from a process: other processes, the network, the rest of the disk.

It is run by the launcher, before anything that is not trusted, and imports little, as all that it imports is
waited for.
"""

from __future__ import annotations

import ctypes
import os

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

__all__ = ["control", "fix_addresses", "new_root", "unshare"]

NEWNS = 0x00020000
NEWUTS = 0x04000000
NEWIPC = 0x08000000
NEWUSER = 0x10000000
NEWPID = 0x20000000
NEWNET = 0x40000000
MS_NOSUID, MS_NODEV, MS_BIND, MS_REC, MS_PRIVATE = 2, 4, 4096, 16384, 1 << 18
MNT_DETACH = 2
AT_FDCWD, AT_RECURSIVE, SYS_MOUNT_SETATTR = -100, 0x8000, 442
ATTR_RDONLY, ATTR_NOSUID = 1, 2
ADDR_NO_RANDOMIZE = 0x0040000
PR_SET_PDEATHSIG, PR_CAPBSET_DROP, PR_SET_CHILD_SUBREAPER, PR_SET_NO_NEW_PRIVS = 1, 24, 36, 38

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


def control(option: int, value: int) -> bool:
    """Set a property of this process by ``prctl``; return whether that is known here."""
    return _try("prctl", option, value, 0, 0, 0)


def _mount(source: str, target: str, kind: str, flags: int, options: str = "") -> None:
    _call("mount", source.encode(), target.encode(), kind.encode(), ctypes.c_ulong(flags), options.encode())


def unshare() -> bool:
    """Enter namespaces of our own; return whether the user namespace is one of them."""
    flags = NEWNS | NEWUTS | NEWIPC | NEWPID | NEWNET
    uid, gid = os.geteuid(), os.getegid()
    if uid == 0 and _try("unshare", flags):
        return False
    _call("unshare", flags | NEWUSER)
    try:
        _write("/proc/self/setgroups", "deny")
    except OSError:
        pass
    _write("/proc/self/uid_map", f"{uid} {uid} 1")
    _write("/proc/self/gid_map", f"{gid} {gid} 1")
    return True


def _write(path: str, text: str) -> None:
    with open(path, "w", encoding="ascii") as file:
        file.write(text)


def fix_addresses() -> None:
    """Give programs that are started from here the same addresses each time, and so sets the same order."""
    if hasattr(_libc, "personality"):
        _libc.personality(ADDR_NO_RANDOMIZE)


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


def new_root(spec: dict[str, Any]) -> bool:
    """Make the box the root: of the old one only what is visible, to read; return whether /proc is there."""
    box = spec["box"]
    _mount("none", "/", "none", MS_REC | MS_PRIVATE)
    size = (
        f"size={spec['limits']['disk_bytes'] + spec['given']},nr_inodes={spec['limits']['inodes']},mode=755"
    )
    _mount("tmpfs", box, "tmpfs", MS_NOSUID | MS_NODEV, size)
    for path in spec["visible"]:
        target = box + path
        if os.path.islink(path) and os.path.dirname(path) == "/":
            os.symlink(os.readlink(path), target)
            continue
        if not os.path.exists(path) or os.path.lexists(target):
            continue
        os.makedirs(target if os.path.isdir(path) else os.path.dirname(target), exist_ok=True)
        if not os.path.isdir(path):
            os.close(os.open(target, os.O_CREAT | os.O_WRONLY))
        _mount(path, target, "none", MS_BIND | MS_REC)
        _read_only(target)
    for path in spec["hidden"]:
        if os.path.isdir(box + path):
            _mount("tmpfs", box + path, "tmpfs", MS_NOSUID | MS_NODEV, "size=4k,mode=555")
    for path in ("/proc", "/home", "/tmp", "/dev/shm"):
        os.makedirs(box + path, exist_ok=True)
    for path in ("/tmp", "/dev/shm"):
        os.chmod(box + path, 0o1777)
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
