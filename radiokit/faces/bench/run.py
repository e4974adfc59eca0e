"""Run: the whole bench, one call at a time, for nothing else may run beside what is timed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from typing import Any

import numpy as np

from radiokit.bsdfs.ggx import GGX
from radiokit.contracts.albedo import albedo
from radiokit.faces.bench.machine import whole_machine
from radiokit.faces.bench.methods import METHODS, SAMPLED, Method
from radiokit.faces.bench.peers import Peer, all_peers
from radiokit.faces.bench.rows import Row, row
from radiokit.faces.bench.slopes import Slope, fit
from radiokit.faces.bench.starts import Start, starts
from radiokit.faces.bench.tasks import Task, ggx_albedo, tasks, towards
from radiokit.faces.bench.timing import interleave, standard_work
from radiokit.facts.errors import ParameterError
from radiokit.facts.jsonable import jsonable

__all__ = ["Bench", "Ratio", "bench", "measure", "measure_peers"]

HEADLINES = ((0.3, 60.0), (1.0, 60.0), (0.05, 60.0), (0.05, 89.0), (0.001, 60.0))
"""Widths and angles at which radiokit is put beside its peers."""

SAMPLES, QUICK_SAMPLES = 1 << 20, 1 << 16
MANY_SAMPLES, QUICK_MANY_SAMPLES = 1 << 24, 1 << 18
"""For the throughput, where no start of threads counts."""
RTOL = 1e-6
PAUSE = 0.03


@dataclass(frozen=True)
class Ratio:
    """radiokit beside one peer on one task, at equal samples or at an equal tolerance.

    ``speed`` is how many times faster radiokit is (the ratio of throughputs for equal samples).
    ``efficiency`` is the ratio of 1/(standard error² · seconds), for radiokit's random points, and
    ``qmc_efficiency`` for its lattices; None for a peer that does not sample.
    """

    task: str
    peer: str
    rival: str
    size: float
    speed: float
    noise: float
    efficiency: float | None
    qmc_efficiency: float | None
    error: float
    peer_error: float

    def to_json(self) -> dict[str, Any]:
        """Return the ratio as JSON-ready data."""
        return {name: jsonable(value) for name, value in asdict(self).items()}


@dataclass(frozen=True)
class Bench:
    """What a run measured, on which machine. Ratios hold where seconds do not."""

    settings: dict[str, Any]
    machine: dict[str, str]
    ratios: tuple[Ratio, ...]
    peers: tuple[Row, ...]
    throughput: tuple[Row, ...]
    """radiokit's Monte Carlo and its peers on one albedo, at 2²⁴ samples."""
    throughput_ratios: tuple[Ratio, ...]
    absent: dict[str, str]
    notes: dict[str, str]
    rows: tuple[Row, ...]
    truths: dict[str, str]
    slopes: tuple[Slope, ...]
    starts: tuple[Start, ...]

    @property
    def dishonest(self) -> tuple[Row, ...]:
        """The rows of radiokit whose errors are larger than they claim."""
        return tuple(each for each in self.rows if not each.honest)

    def to_json(self) -> dict[str, Any]:
        """Return the run as JSON-ready data, which ``compare`` reads."""
        parts = ("ratios", "peers", "throughput", "throughput_ratios", "rows", "slopes", "starts")
        return {
            "format": 1,
            "settings": self.settings,
            "machine": self.machine,
            "absent": self.absent,
            "notes": self.notes,
            "truths": self.truths,
            **{name: [each.to_json() for each in getattr(self, name)] for name in parts},
        }


def bench(
    *,
    quick: bool = False,
    seed: int = 0,
    repeats: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Bench:
    """Measure every method on every task, fresh starts, and the peers.

    Parameters
    ----------
    quick : bool
        Four tasks, small sizes and one headline: for continuous integration.
    seed : int
        At least 0. Seeds of the Monte Carlo methods derive from it.
    repeats : int, optional
        Repetitions, at least 3, whose medians count: 3 if quick and 7 otherwise.
    progress : callable, optional
        Called with the number of finished steps and the number of all.

    Raises
    ------
    ParameterError
        When ``seed`` or ``repeats`` is out of range.
    """
    count = (3 if quick else 7) if repeats is None else repeats
    for name, number, least in (("seed", seed, 0), ("repeats", count, 3)):
        if isinstance(number, bool) or not isinstance(number, int) or number < least:
            raise ParameterError(name, number, f"an integer, at least {least}")
    chosen, headlines = tasks(quick), HEADLINES[:1] if quick else HEADLINES
    total = len(chosen) + len(headlines) + 2
    steps = iter(range(1, total + 1))

    def done() -> None:
        if progress is not None:
            progress(next(steps), total)

    peers = all_peers()
    absent = {peer.name: reason for peer in peers if (reason := peer.absent()) is not None}
    present = [peer for peer in peers if peer.name not in absent]
    ratios: list[Ratio] = []
    beside: list[Row] = []
    samples = QUICK_SAMPLES if quick else SAMPLES
    for alpha, theta in headlines:
        found, compared = measure_peers(alpha, theta, present, samples=samples, seed=seed, repeats=count)
        beside += found
        ratios += compared
        done()
    many = QUICK_MANY_SAMPLES if quick else MANY_SAMPLES
    quickest, throughput = measure_peers(
        *HEADLINES[0],
        [peer for peer in present if peer.rival == "mc" and peer.most >= many],
        methods=("mc",),
        samples=many,
        seed=seed,
        repeats=count if quick else 2 * count + 1,
    )
    done()
    rows: list[Row] = []
    for task in chosen:
        rows += measure(task, METHODS, quick=quick, seed=seed, repeats=count)
        done()
    begun = starts(("quadrature", *SAMPLED), samples=samples, repeats=1 if quick else 3)
    done()
    return Bench(
        settings={
            "quick": quick,
            "seed": seed,
            "repeats": count,
            "samples": samples,
            "throughput_samples": many,
            "rtol": RTOL,
        },
        machine=whole_machine(),
        ratios=tuple(ratios),
        peers=tuple(beside),
        throughput=tuple(quickest),
        throughput_ratios=tuple(throughput),
        absent=absent,
        notes={peer.name: peer.note for peer in present if peer.note},
        rows=tuple(rows),
        truths={task.name: task.truth for task in chosen},
        slopes=tuple(fit(rows, broad={task.name for task in chosen if task.broad}, repeats=count)),
        starts=tuple(begun),
    )


def _seeds(seed: int, task: str, repeats: int) -> list[int]:
    """Return a seed for each repetition, of the task's own."""
    state = np.random.SeedSequence([seed, *task.encode()]).generate_state(repeats, dtype=np.uint64)
    return [int(each) >> 1 for each in state]


def measure(
    task: Task, methods: Sequence[Method], *, quick: bool = False, seed: int = 0, repeats: int = 7
) -> list[Row]:
    """Return a row for each method and size on one task; all of them take turns."""
    seeds = _seeds(seed, task.name, repeats)
    todo = [(method, size) for method in methods for size in (method.quick if quick else method.sizes)]

    def call(method: Method, size: float, repeat: int) -> Any:
        return method.answer(task.f, task.wo, size, seeds[repeat])

    calls: list[Callable[[int], Any]] = [standard_work]
    calls += [partial(call, method, size) for method, size in todo]
    unit, *timings = interleave(calls, repeats)
    return [
        row(task.name, method.name, size, task.exact, timing, unit)
        for (method, size), timing in zip(todo, timings, strict=True)
    ]


def measure_peers(
    alpha: float,
    theta_deg: float,
    peers: Sequence[Peer],
    *,
    methods: Sequence[str] = (*SAMPLED, "quadrature"),
    samples: int = QUICK_SAMPLES,
    seed: int = 0,
    repeats: int = 7,
) -> tuple[list[Row], list[Ratio]]:
    """Return the rows of radiokit and its peers on one albedo of GGX, taking turns, and their ratios.

    ``methods`` are radiokit's that run; each peer's rival must be among them.
    """
    name = f"ggx-{alpha:g}-at-{theta_deg:g}deg"
    f, wo, exact = GGX(alpha=alpha), towards(theta_deg), ggx_albedo(alpha, theta_deg)[0]
    seeds = _seeds(seed, name, repeats)
    sizes: dict[str, float] = dict.fromkeys(SAMPLED, samples) | {"quadrature": RTOL}

    def ours(method: Any, repeat: int) -> Any:
        if method == "quadrature":
            return albedo(f, wo, rtol=RTOL)
        return albedo(f, wo, method=method, samples=samples, rng=seeds[repeat])

    def theirs(peer: Peer, repeat: int) -> Any:
        return peer.answer(alpha, theta_deg, sizes[peer.rival], seeds[repeat])

    calls: list[Callable[[int], Any]] = [standard_work, *(partial(ours, method) for method in methods)]
    calls += [partial(theirs, peer) for peer in peers]
    unit, *timings = interleave(calls, repeats, pause=PAUSE)
    parties = [(method, sizes[method], exact) for method in methods]
    parties += [(peer.name, sizes[peer.rival], peer.truth(alpha, theta_deg)) for peer in peers]
    rows = [
        row(name, party, size, truth, timing, unit)
        for (party, size, truth), timing in zip(parties, timings, strict=True)
    ]
    by_name = {each.method: each for each in rows}
    return rows, [_ratio(by_name[peer.name], by_name, peer.rival) for peer in peers]


def _ratio(peer: Row, by_name: dict[str, Row], rival: str) -> Ratio:
    ours = by_name[rival]

    def efficiency(mine: Row | None) -> float | None:
        if mine is None or peer.kind != "statistical" or not (mine.claimed_error and peer.claimed_error):
            return None
        return (peer.claimed_error / mine.claimed_error) ** 2 * peer.seconds / mine.seconds

    return Ratio(
        task=peer.task,
        peer=peer.method,
        rival=rival,
        size=peer.size,
        speed=peer.seconds / ours.seconds,
        noise=float(np.hypot(peer.noise, ours.noise)),
        efficiency=efficiency(ours),
        qmc_efficiency=efficiency(by_name.get("qmc")),
        error=ours.true_error / abs(ours.exact),
        peer_error=peer.true_error / abs(peer.exact),
    )
