"""Limits: what a sandbox allows, and the names of the protections that may hold in it."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

from radiokit.facts.errors import ParameterError

__all__ = ["PROTECTIONS", "Limits"]

PROTECTIONS = {
    "limits": "processor time, memory, processes, open files and file sizes are limited",
    "memory": "the memory of all its processes together is limited",
    "processes": "no process outlives the sandbox",
    "privileges": "no program can raise its rights",
    "user": "it runs as a user who owns nothing",
    "calls": "what a program of numbers does not need of the system's kernel is refused",
    "network": "there is no network",
    "files": "of the file system only Python and the submission can be read, only its folder be written",
    "root": "of the file system only Python and the submission are there, the rest of the disk is not",
    "proc": "other processes cannot be seen",
}
"""What can be active, by name. Linux has them all where it grants namespaces; elsewhere some are missing."""


@dataclass(frozen=True, kw_only=True)
class Limits:
    """What the code in a sandbox may use; all positive integers but wall times.

    Parameters
    ----------
    seconds : float
        Wall time of one call [s], above 0.
    load_seconds : float
        Wall time of loading the submission, each time that it must be loaded [s], above 0.
    cpu_seconds : int
        Processor time of one child over all its calls [s].
    memory_bytes : int
        Address space of each process; and, where that can be watched, memory of all of them together.
    processes : int
        Processes and threads at a time.
    open_files : int
        Open files of each process; at least 64.
    file_bytes : int
        Size of each file.
    disk_bytes : int
        Size of all files that it writes, where the file system is the sandbox's own.
    inodes : int
        Number of files, likewise; at least 1024.
    printed_bytes : int
        What it may print in one call, before it is stopped.
    answer_bytes : int
        Size of one answer.

    Raises
    ------
    ParameterError
        When a limit is not such a number.

    >>> Limits(processes=0)
    Traceback (most recent call last):
        ...
    radiokit.facts.errors.ParameterError: processes = 0 is not allowed: it must be an integer of at least 1
    """

    seconds: float = 10.0
    load_seconds: float = 20.0
    cpu_seconds: int = 3600
    memory_bytes: int = 1 << 31
    processes: int = 16
    open_files: int = 128
    file_bytes: int = 1 << 24
    disk_bytes: int = 1 << 25
    inodes: int = 4096
    printed_bytes: int = 1 << 20
    answer_bytes: int = 1 << 28

    def __post_init__(self) -> None:
        least = {"open_files": 64, "inodes": 1024}
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if field.name.endswith("seconds") and field.name != "cpu_seconds":
                if not (isinstance(value, int | float) and 0 < value < float("inf")):
                    raise ParameterError(field.name, value, "a finite number above 0")
            elif type(value) is not int or value < least.get(field.name, 1):
                raise ParameterError(field.name, value, f"an integer of at least {least.get(field.name, 1)}")
