"""Landlock: what Linux keeps from a process that asks for it: files, signals; it needs no namespaces.

A process gives up what is not allowed to it and to what it starts, for good. It is run by the launcher, just
before the child, and imports little, as all that it imports is waited for.

See landlock(7) of the Linux man-pages, and the kernel's userspace-api/landlock.
"""

from __future__ import annotations

import ctypes
import os
import stat
import struct

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

__all__ = ["allowed", "restrict"]

CREATE, ADD, RESTRICT = 444, 445, 446  # the calls' numbers, on every architecture
ONLY_VERSION, BENEATH = 1, 1
EXECUTE, WRITE_FILE, READ_FILE, READ_DIR, TRUNCATE, IOCTL_DEV = 1, 2, 4, 8, 1 << 14, 1 << 15
DEVICES = 1 << 6 | 1 << 11  # to make them
ON_FILES = EXECUTE | WRITE_FILE | READ_FILE | TRUNCATE | IOCTL_DEV
READ = EXECUTE | READ_FILE | READ_DIR
SINCE = {1: 13, 2: 14, 3: 15, 5: 16}
"""How many kinds of access to files are known, by the first version that knows them."""
TCP, SCOPES = 3, 3  # bind and connect; abstract sockets and signals
SINCE_TCP, SINCE_SCOPES = 4, 6


def allowed(path: str, hidden: Sequence[str]) -> Iterator[tuple[str, int]]:
    """Yield what must be allowed so that a path can be read, but none of those hidden beneath it."""
    inside = [each for each in hidden if f"{each}/".startswith(f"{path}/")]
    if not inside:
        yield path, READ
    elif path not in inside:
        yield path, READ_DIR
        for name in os.listdir(path):
            yield from allowed(f"{path}/{name}", inside)


def restrict(readable: Sequence[str], writable: Sequence[str], hidden: Sequence[str]) -> list[str]:
    """Keep this process to some of the file system, and from others; return what of that is seen to hold."""
    libc = ctypes.CDLL(None, use_errno=True)
    if os.uname().sysname != "Linux":
        return []
    version = libc.syscall(ctypes.c_long(CREATE), None, ctypes.c_size_t(0), ONLY_VERSION)
    if version < 1:
        return []
    known = (1 << max(count for first, count in SINCE.items() if version >= first)) - 1
    asked = [known] + [TCP] * (version >= SINCE_TCP) + [SCOPES] * (version >= SINCE_SCOPES)
    wanted = struct.pack(f"={len(asked)}Q", *asked)
    ruleset = libc.syscall(ctypes.c_long(CREATE), wanted, ctypes.c_size_t(len(wanted)), 0)
    if ruleset < 0:
        return []
    rules = [rule for path in readable if os.path.exists(path) for rule in allowed(path, hidden)]
    rules += [(path, known & ~DEVICES) for path in writable if os.path.exists(path)]
    for path, access in rules:
        try:
            descriptor = os.open(path, os.O_PATH)
        except OSError:
            continue
        kinds = access if stat.S_ISDIR(os.fstat(descriptor).st_mode) else access & ON_FILES
        rule = struct.pack("=Qi", kinds & known, descriptor)
        libc.syscall(ctypes.c_long(ADD), ruleset, BENEATH, rule, 0)
        os.close(descriptor)
    libc.syscall(ctypes.c_long(RESTRICT), ruleset, 0)
    os.close(ruleset)
    return [name for name, holds in (("files", _no_files()), ("signals", _no_signals())) if holds]


def _no_files() -> bool:
    try:
        os.listdir("/")
    except PermissionError:
        return True
    return False


def _no_signals() -> bool:
    try:
        os.kill(os.getppid(), 0)
    except PermissionError:
        return True
    return False
