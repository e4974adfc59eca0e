"""Diagram: error against time, radiokit's methods and its peers, into one picture."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from radiokit.faces.bench.peers import all_peers
from radiokit.faces.bench.timing import interleave
from radiokit.faces.plots.work_precision import Line, draw_work_precision
from radiokit.worlds.cases.catalogue import case

__all__ = ["draw", "peer_lines"]

SAMPLES = tuple(4**k for k in range(3, 10))
TOLERANCES = (1e-2, 1e-4, 1e-6, 1e-8, 1e-10)
SEEDS = 5


def draw(path: Path, *, seed: int = 0) -> Path:
    """Draw the work-precision diagram of the furnaces with the peers that are there."""
    return draw_work_precision(path, seed=seed, more=peer_lines)


def peer_lines(name: str, seed: int = 0) -> list[Line]:
    """Measure every peer that is there on a furnace case of GGX, at rising cost."""
    scene: Any = case(name).scene
    alpha, theta = scene.f.alpha, round(math.degrees(math.atan2(scene.wo[0], scene.wo[2])), 9)
    lines = []
    for peer in all_peers():
        if peer.absent() is not None:
            continue
        sizes = SAMPLES if peer.rival == "mc" else TOLERANCES
        truth = peer.truth(alpha, theta)
        calls = [
            lambda repeat, size=size, peer=peer: peer.answer(alpha, theta, size, seed + repeat)
            for size in sizes
        ]
        timings = interleave(calls, SEEDS if peer.rival == "mc" else 1)
        error = [
            float(np.sqrt(np.mean([(each.value / truth - 1) ** 2 for each in timing.results])))
            for timing in timings
        ]
        evaluations = [timing.results[0].evaluations for timing in timings]
        lines.append(Line(peer.name, [min(timing.seconds) for timing in timings], evaluations, error))
    return lines
