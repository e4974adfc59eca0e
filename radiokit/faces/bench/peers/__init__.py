"""Peers: the same albedos by other means. A peer that cannot run says why, and how it could."""

from __future__ import annotations

from radiokit.faces.bench.peers.peer import Peer

__all__ = ["Peer", "all_peers"]


def all_peers() -> tuple[Peer, ...]:
    """Return every peer, available or not."""
    from radiokit.faces.bench.peers.compiled import Compiled
    from radiokit.faces.bench.peers.mitsuba import Mitsuba, MitsubaRender
    from radiokit.faces.bench.peers.numpy_arrays import NumpyArrays
    from radiokit.faces.bench.peers.scipy_rules import Cubature, Dblquad

    return (NumpyArrays(), Compiled(), Mitsuba(), MitsubaRender(), Dblquad(), Cubature())
