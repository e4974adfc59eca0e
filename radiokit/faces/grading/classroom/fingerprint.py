"""Fingerprints: digests of all that a grade depends on, so that it is known whether it is still the grade."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from functools import lru_cache
from importlib.metadata import version
from pathlib import Path

import radiokit
from radiokit.faces.grading.isolation.limits import Limits

__all__ = ["code_digest", "fingerprint", "secret_digest"]

ROUNDS = 200_000
"""Rounds of PBKDF2: results may be shown to students, who must not find a short secret by trying."""


@lru_cache(maxsize=1)
def code_digest() -> str:
    """Return the digest of radiokit's version and sources.

    >>> len(code_digest())
    64
    """
    digest = hashlib.sha256(version("radiokit").encode())
    for root in map(Path, radiokit.__path__):
        for path in sorted(root.rglob("*.py")):
            content = path.read_bytes()
            digest.update(f"\n{path.relative_to(root).as_posix()} {len(content)}\n".encode())
            digest.update(content)
    return digest.hexdigest()


def secret_digest(secret: str) -> str:
    """Return a digest of a secret that is slow to find the secret from; empty where there is none."""
    if not secret:
        return ""
    return hashlib.pbkdf2_hmac("sha256", secret.encode(), b"radiokit grading", ROUNDS).hex()


def fingerprint(
    content: bytes,
    *,
    suffix: str,
    source: str,
    key: str,
    student: str,
    secret: str,
    language: str,
    limits: Limits | None,
    code: str,
) -> str:
    """Return the digest of what a grade depends on; ``secret`` is its digest, ``code`` radiokit's."""
    parts = {
        "content": hashlib.sha256(content).hexdigest(),
        "source": hashlib.sha256(source.encode()).hexdigest(),
        "limits": None if limits is None else dataclasses.asdict(limits),
        **{"suffix": suffix, "key": key, "student": student, "language": language},
        **{"secret": secret, "code": code},
    }
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()
