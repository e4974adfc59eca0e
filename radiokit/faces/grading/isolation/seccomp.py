"""Seccomp: the kernel's calls that a program of numbers does not need are refused, sockets among them.

A filter of classic BPF, which its processes inherit and cannot take off. What it refuses fails with EPERM; so
does every call of another architecture or of x32. It is run by the launcher, last before the child. Numbers
are those of Linux for x86_64 and aarch64; elsewhere there is no filter.

See seccomp(2) of the Linux man-pages, and the kernel's userspace-api/seccomp_filter.
"""

from __future__ import annotations

import ctypes
import os
import struct
import sys

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["install", "program"]

ARCHITECTURES = {"x86_64": 0xC000003E, "aarch64": 0xC00000B7}

REFUSED = {
    # others' processes
    "ptrace": (101, 117),
    "process_vm_readv": (310, 270),
    "process_vm_writev": (311, 271),
    "process_madvise": (440, 440),
    "kcmp": (312, 272),
    "pidfd_getfd": (438, 438),
    "setpriority": (141, 140),
    "ioprio_set": (251, 30),
    "sched_setparam": (142, 118),
    "sched_setscheduler": (144, 119),
    "sched_setaffinity": (203, 122),
    "sched_setattr": (314, 274),
    # namespaces and mounts
    "unshare": (272, 97),
    "setns": (308, 268),
    "mount": (165, 40),
    "umount2": (166, 39),
    "pivot_root": (155, 41),
    "chroot": (161, 51),
    "open_tree": (428, 428),
    "move_mount": (429, 429),
    "fsopen": (430, 430),
    "fsconfig": (431, 431),
    "fsmount": (432, 432),
    "fspick": (433, 433),
    "mount_setattr": (442, 442),
    "name_to_handle_at": (303, 264),
    "open_by_handle_at": (304, 265),
    "fanotify_init": (300, 262),
    "fanotify_mark": (301, 263),
    "quotactl": (179, 60),
    "quotactl_fd": (443, 443),
    # parts of the kernel in which most of its holes were found
    "bpf": (321, 280),
    "perf_event_open": (298, 241),
    "userfaultfd": (323, 282),
    "io_uring_setup": (425, 425),
    "io_uring_enter": (426, 426),
    "io_uring_register": (427, 427),
    "add_key": (248, 217),
    "request_key": (249, 218),
    "keyctl": (250, 219),
    # the machine
    "kexec_load": (246, 104),
    "kexec_file_load": (320, 294),
    "init_module": (175, 105),
    "finit_module": (313, 273),
    "delete_module": (176, 106),
    "reboot": (169, 142),
    "swapon": (167, 224),
    "swapoff": (168, 225),
    "acct": (163, 89),
    "syslog": (103, 116),
    "vhangup": (153, 58),
    "sethostname": (170, 161),
    "setdomainname": (171, 162),
    "settimeofday": (164, 170),
    "adjtimex": (159, 171),
    "clock_settime": (227, 112),
    "clock_adjtime": (305, 266),
    "personality": (135, 92),
    "modify_ldt": (154, None),
    "iopl": (172, None),
    "ioperm": (173, None),
    # memory that belongs to no process, so that none is seen to use it
    "memfd_create": (319, 279),
    "memfd_secret": (447, 447),
    "shmget": (29, 194),
    "shmat": (30, 196),
    "shmctl": (31, 195),
    "semget": (64, 190),
    "semctl": (66, 191),
    "semop": (65, 193),
    "semtimedop": (220, 192),
    "msgget": (68, 186),
    "msgctl": (71, 187),
    "msgsnd": (69, 189),
    "msgrcv": (70, 188),
    "mq_open": (240, 180),
    # the network, and servers of this machine; pairs are judged below
    "socket": (41, 198),
}
"""What is refused: its number on x86_64 and on aarch64."""

SOCKETPAIR, PRLIMIT, CLONE, CLONE3 = (53, 199), (302, 261), (56, 220), 435
AF_UNIX = 1
NEW_NAMESPACES = 0x7E020080  # CLONE_NEWNS, NEWCGROUP, NEWUTS, NEWIPC, NEWUSER, NEWPID, NEWNET, NEWTIME
X32 = 0x40000000
EPERM, ENOSYS = 1, 38
PR_SET_SECCOMP, SECCOMP_MODE_FILTER = 22, 2
ALLOW, ERRNO = 0x7FFF0000, 0x00050000
LOAD, EQUAL, AT_LEAST, ANY_BIT, RETURN = 0x20, 0x15, 0x35, 0x45, 0x06
NUMBER, ARCHITECTURE, FIRST = 0, 4, 16  # places in what the filter is shown; the argument's lower half


def program(machine: str) -> bytes:
    """Return the filter for a machine as instructions of 8 bytes, empty where there is none.

    >>> len(program("x86_64")) // 8 < 128
    True
    >>> program("riscv64")
    b''
    """
    if machine not in ARCHITECTURES:
        return b""
    column = list(ARCHITECTURES).index(machine)
    numbers = [pair[column] for pair in REFUSED.values()]
    # (code, value, where to go if true, and if false); names are ends, "" is the next
    steps: list[tuple[int, int, str, str]] = [
        (LOAD, ARCHITECTURE, "", ""),
        (EQUAL, ARCHITECTURES[machine], "", "refuse"),
        (LOAD, NUMBER, "", ""),
        (AT_LEAST, X32, "refuse", ""),
        *((EQUAL, number, "refuse", "") for number in numbers if number is not None),
        (EQUAL, CLONE3, "unknown", ""),  # its flags are out of sight; the C library then uses clone
        (EQUAL, SOCKETPAIR[column], "pair", ""),
        (EQUAL, PRLIMIT[column], "limit", ""),
        (EQUAL, CLONE[column], "clone", "allow"),
    ]
    ends = {
        "pair": [(LOAD, FIRST, "", ""), (EQUAL, AF_UNIX, "allow", "refuse")],
        "limit": [(LOAD, FIRST, "", ""), (EQUAL, 0, "allow", "refuse")],
        "clone": [(LOAD, FIRST, "", ""), (ANY_BIT, NEW_NAMESPACES, "refuse", "allow")],
        "allow": [(RETURN, ALLOW, "", "")],
        "refuse": [(RETURN, ERRNO | EPERM, "", "")],
        "unknown": [(RETURN, ERRNO | ENOSYS, "", "")],
    }
    places = {}
    for name, tail in ends.items():
        places[name] = len(steps)
        steps += tail
    return b"".join(
        struct.pack("<HBBI", code, *(places[to] - at - 1 if to else 0 for to in (yes, no)), value)
        for at, (code, value, yes, no) in enumerate(steps)
    )


class _Program(ctypes.Structure):
    _fields_ = (("count", ctypes.c_ushort), ("steps", ctypes.c_char_p))


def install() -> list[str]:
    """Put the filter on this process, which must have given up new rights; return what is seen to hold."""
    steps = program(os.uname().machine) if sys.maxsize > 1 << 32 and sys.byteorder == "little" else b""
    libc = ctypes.CDLL(None, use_errno=True)
    if not steps or not hasattr(libc, "prctl"):
        return []
    filter_ = _Program(len(steps) // 8, steps)
    libc.prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, ctypes.byref(filter_), 0, 0)
    tried = {"calls": ("unshare", 0), "network": ("socket", 2, 1, 0)}
    return [name for name, (call, *given) in tried.items() if _is_refused(libc, str(call), given)]


def _is_refused(libc: ctypes.CDLL, call: str, given: Sequence[object]) -> bool:
    found = getattr(libc, call)(*given)
    return bool(found == -1 and ctypes.get_errno() == EPERM)
