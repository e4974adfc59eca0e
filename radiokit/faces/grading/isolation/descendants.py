"""Descendants: the processes below another, the memory and the time that they take together, and their end.

It is run by the launcher, and imports little, as all that it imports is waited for. Memory is looked at as
often as ``PERIOD`` says. A control group would bound it at once, but one may be made only where the grader's
own group is delegated to it and emptied, which no login session and no container does by itself.
"""

from __future__ import annotations

import math
import os
import signal
import time

__all__ = ["PERIOD", "bury", "clear", "ended", "slow", "tree", "used", "watchable"]

PERIOD = 0.05
"""How long nobody looks [s]."""
FREE = 2
"""How many tasks may run at once as fast as others'."""
SESSION, NICE = 3, 16
"""Their places in ``stat``, behind the name."""
STEP, MOST = 1.25, 19
"""How much less a task weighs for each step that it is nicer, and how nice one can be."""


def _read(proc: int, path: str) -> str:
    descriptor = os.open(path, os.O_RDONLY, dir_fd=proc)
    try:
        return os.read(descriptor, 1 << 16).decode()
    finally:
        os.close(descriptor)


def _children(proc: int, pid: int) -> list[int]:
    found: list[int] = []
    tasks = os.open(f"{pid}/task", os.O_RDONLY, dir_fd=proc)
    try:
        for task in os.listdir(tasks):
            found += map(int, _read(tasks, f"{task}/children").split())
    finally:
        os.close(tasks)
    return found


def tree(proc: int, pid: int) -> list[int]:
    """Return a process and its descendants, as /proc, open as ``proc``, shows them."""
    found = [pid]
    for each in found:
        try:
            found += [child for child in _children(proc, each) if child not in found]
        except OSError:
            continue
    return found


def _amount(proc: int, path: str, names: tuple[str, ...]) -> int | None:
    """Return the sum of lines such as ``VmRSS: 12 kB`` in bytes; None where the file cannot be read."""
    try:
        lines = [line.split() for line in _read(proc, path).splitlines()]
    except OSError:
        return None
    return 1024 * sum(int(words[1]) for words in lines if len(words) > 1 and words[0] in names)


def used(proc: int, pids: list[int], enough: int) -> int:
    """Return how many bytes processes use together, with what they share counted once where that is told.

    Sums up to ``enough`` may count what is shared more than once: that is faster.
    """
    amounts = {pid: _amount(proc, f"{pid}/status", ("VmRSS:", "VmSwap:")) or 0 for pid in pids}
    if sum(amounts.values()) > enough:
        for pid in pids:
            shared = _amount(proc, f"{pid}/smaps_rollup", ("Pss:", "SwapPss:"))
            amounts[pid] = amounts[pid] if shared is None else shared
    return sum(amounts.values())


def _tasks(proc: int, pid: int) -> list[tuple[int, list[str]]]:
    """Return the tasks of a process with what ``stat`` tells of each behind its name, its state first."""
    try:
        tasks = os.open(f"{pid}/task", os.O_RDONLY, dir_fd=proc)
    except OSError:
        return []
    found = []
    for task in os.listdir(tasks):
        try:
            found.append((int(task), _read(tasks, f"{task}/stat").rpartition(")")[2].split()))
        except OSError:
            continue
    os.close(tasks)
    return found


def slow(proc: int, pids: list[int]) -> None:
    """Let all that runs at once weigh little more than ``FREE`` tasks, as others' processes run beside it.

    The first of all is let be, for it lasts and mostly waits. Where the kernel weighs sessions (autogroups),
    those beside the first one's are slowed as well.
    """
    tasks = [(pid, task, told) for pid in pids for task, told in _tasks(proc, pid)]
    busy = sum(told[0] == "R" for _, _, told in tasks)
    if busy <= FREE:
        return
    nice = min(MOST, os.getpriority(os.PRIO_PROCESS, 0) + math.ceil(math.log(busy / FREE, STEP)))
    for pid, task, told in tasks:
        if task == pids[0]:
            continue
        try:
            if int(told[NICE]) < nice:
                os.setpriority(os.PRIO_PROCESS, task, nice)
            if task == pid and told[SESSION] != tasks[0][2][SESSION]:
                group = f"{pid}/autogroup"  # /autogroup-7 nice 0
                if int(_read(proc, group).split()[-1]) < nice:
                    _write(proc, group, str(nice))
        except OSError:
            continue


def _write(proc: int, path: str, text: str) -> None:
    descriptor = os.open(path, os.O_WRONLY, dir_fd=proc)
    try:
        os.write(descriptor, text.encode())
    finally:
        os.close(descriptor)


def watchable(proc: int) -> bool:
    """Return whether memory can be watched here."""
    try:
        _children(proc, os.getpid())
        return used(proc, [os.getpid()], 1 << 62) > 0
    except (OSError, ValueError):
        return False


def bury(child: int) -> None:
    """Bury what has ended of our children but one: orphans, if we reap them."""
    while hasattr(os, "waitid"):
        state = os.waitid(os.P_ALL, 0, os.WEXITED | os.WNOHANG | os.WNOWAIT)
        if state is None or state.si_pid == child:
            return
        os.waitpid(state.si_pid, 0)


def ended(child: int) -> int | None:
    """Return how a child ended, as a shell says it, or None; where it can be, it is left to be buried."""
    if hasattr(os, "waitid"):
        state = os.waitid(os.P_PID, child, os.WEXITED | os.WNOHANG | os.WNOWAIT)
        return None if state is None else state.si_status + (0 if state.si_code == os.CLD_EXITED else 128)
    found, status = os.waitpid(child, os.WNOHANG)  # macOS
    code = os.waitstatus_to_exitcode(status)
    return None if not found else code if code >= 0 else 128 - code


def clear(proc: int, child: int, seconds: float) -> None:
    """Kill a child, unless it is 0, and every descendant: orphans become our children, if we reap them.

    Time in which we have no turn is not counted.
    """
    me, now = os.getpid(), time.monotonic()
    if child:
        os.kill(child, signal.SIGKILL)
    while seconds > 0:
        before, now = now, time.monotonic()
        seconds -= min(now - before, PERIOD)
        try:
            for pid in _children(proc, me):
                os.kill(pid, signal.SIGKILL)
        except OSError:
            pass
        try:
            if os.waitpid(-1, os.WNOHANG)[0] == 0:
                time.sleep(0.001)
        except ChildProcessError:
            return
