"""Rights: what a process may use, and who it is; given up by the launcher before it becomes the child.

It imports little, as all that it imports is waited for.
"""

from __future__ import annotations

import os
import resource

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["become", "free_user", "limit", "processes_are_counted", "threads"]

USERS = range(61184, 65184)
"""Ids that are kept for users who come and go, as systemd does."""


def threads(uid: int) -> int:
    """Return how many threads a user already runs: they count towards his limit."""
    count = 0
    for pid in os.listdir("/proc") if os.path.isdir("/proc/self") else []:
        try:
            if pid.isdigit() and os.stat(f"/proc/{pid}").st_uid == uid:
                count += len(os.listdir(f"/proc/{pid}/task"))
        except OSError:
            continue
    return count


def free_user() -> int:
    """Return a user who runs nothing, so that two submissions neither count for nor reach each other."""
    first = os.getpid() % len(USERS)
    return next((uid for uid in (*USERS[first:], *USERS[:first]) if not threads(uid)), USERS[first])


def limit(limits: dict[str, int], processes: int) -> None:
    """Set the limits of this process and of what it starts, as far as they are known here."""
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
            try:
                resource.setrlimit(kind, (value, value))
            except (OSError, ValueError):  # macOS refuses RLIMIT_AS
                pass


def processes_are_counted() -> bool:
    """Return whether the limit of processes holds for this user: for some, as root, it does not."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NPROC)
    resource.setrlimit(resource.RLIMIT_NPROC, (0, hard))
    try:
        child = os.fork()
    except OSError:
        return True
    finally:
        resource.setrlimit(resource.RLIMIT_NPROC, (soft, hard))
    if child == 0:
        os._exit(0)
    os.waitpid(child, 0)
    return False


def become(uid: int, needs: Sequence[str], home: str) -> bool:
    """Let root become a user who owns but a home, if that user can read what is needed; return whether."""
    if os.geteuid() != 0 or not hasattr(os, "setresuid"):
        return False
    os.setgroups([])
    if not _may_read(uid, needs):
        return False
    os.chown(home, uid, uid)
    os.setresgid(uid, uid, uid)
    os.setresuid(uid, uid, uid)
    return True


def _may_read(uid: int, paths: Sequence[str]) -> bool:
    """Return whether another user could open these files."""
    os.setegid(uid)
    os.seteuid(uid)
    try:
        for path in paths:
            with open(path, "rb"):
                pass
        return True
    except OSError:
        return False
    finally:
        os.seteuid(0)
        os.setegid(0)
