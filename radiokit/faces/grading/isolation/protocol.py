"""Protocol: the messages between a sandbox and the child in it: JSON and raw numbers, never pickles.

A message is ``RKG1``, the length of its header, the length of its body, the header, the body. The header is
a JSON object whose ``arrays`` gives the type and shape of each array in the body. No length is believed
before it is compared with a limit. This file is also run beside the child, so it imports NumPy alone.
"""

from __future__ import annotations

import json
import math
import re
import struct
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["HEADER_LIMIT", "Array", "Assembler", "MalformedError", "pack", "plain_text"]

MAGIC = b"RKG1"
PREFIX = struct.Struct("<4sIQ")
HEADER_LIMIT = 1 << 16
TYPES = {"<f8": 8, "<f4": 4, "<c16": 16, "<i8": 8, "|b1": 1}
COMMAND = re.compile(r"^::|##(?=\w*\[)")
ARRAYS = 8
DIMENSIONS = 4

Array = npt.NDArray[Any]


class MalformedError(ValueError):
    """Bytes that are no message, or one above its limits."""


def plain_text(text: object, limit: int = 300) -> str:
    r"""Return a text of unknown origin as one printable line of at most ``limit`` characters.

    None is a command where logs are read for commands, as GitHub's and Azure's runners do: no line begins
    with two colons, and none has ``##[`` or ``##vso[``.

    >>> plain_text("a\x1b[31m\n b"), plain_text("::add-mask::1"), plain_text("x ##[error]y")
    ('a?[31m b', ': :add-mask::1', 'x # #[error]y')
    """
    words = " ".join(str(text)[: 4 * limit].split())
    line = "".join(letter if letter.isprintable() else "?" for letter in words)
    line = COMMAND.sub(lambda found: f"{found[0][0]} {found[0][0]}", line)
    return line if len(line) <= limit else line[: limit - 1] + "…"


def pack(header: dict[str, Any], arrays: Sequence[Array] = ()) -> bytes:
    """Return a message; the arrays' types must be among those that are carried.

    Raises
    ------
    MalformedError
        When an array is of another type, or the header is too long.
    """
    described, parts = [], []
    for array in arrays:
        kind = array.dtype.newbyteorder("<").str
        if kind not in TYPES:
            raise MalformedError(f"arrays of {array.dtype} are not carried")
        described.append([kind, list(array.shape)])
        parts.append(np.ascontiguousarray(array, dtype=kind).tobytes())
    head = json.dumps({**header, "arrays": described}, ensure_ascii=False).encode(errors="backslashreplace")
    if len(head) > HEADER_LIMIT:
        raise MalformedError(f"a header of {len(head)} bytes is too long")
    body = b"".join(parts)
    return PREFIX.pack(MAGIC, len(head), len(body)) + head + body


class Assembler:
    """Builds one message from pieces, and refuses it as soon as it cannot be one.

    ``wanted`` is how many bytes may be given to ``feed`` next; 0 when the message is whole.

    >>> whole = Assembler(limit=1000)
    >>> data = pack({"id": 3}, [np.array([1.0, 2.0])])
    >>> while whole.wanted:
    ...     step, data = data[: whole.wanted], data[whole.wanted :]
    ...     whole.feed(step)
    >>> whole.message()
    ({'id': 3}, [array([1., 2.])])
    """

    def __init__(self, limit: int) -> None:
        self._limit = limit
        self._data = bytearray()
        self._head = self._body = 0
        self._total = PREFIX.size

    @property
    def wanted(self) -> int:
        """How many bytes are still missing, as far as is known."""
        return self._total - len(self._data)

    def feed(self, data: bytes) -> None:
        """Take the next bytes, at most ``wanted``."""
        if len(data) > self.wanted:
            raise MalformedError("more bytes than were asked for")
        self._data += data
        if len(self._data) == PREFIX.size and not self._head:
            magic, self._head, self._body = PREFIX.unpack(self._data)
            if magic != MAGIC:
                raise MalformedError("what came is no message")
            if not 0 < self._head <= HEADER_LIMIT:
                raise MalformedError(f"a header of {self._head} bytes is claimed")
            if self._body > self._limit:
                raise MalformedError(f"{self._body} bytes are claimed, of {self._limit} allowed")
            self._total += self._head + self._body

    def message(self) -> tuple[dict[str, Any], list[Array]]:
        """Return the header without ``arrays``, and the arrays."""
        if self.wanted:
            raise MalformedError("the message is not whole")
        start = PREFIX.size + self._head
        try:
            header = json.loads(self._data[PREFIX.size : start].decode())
        except (ValueError, RecursionError):
            raise MalformedError("the header is no JSON") from None
        if not isinstance(header, dict):
            raise MalformedError("the header is no object")
        described = header.pop("arrays", None)
        if not isinstance(described, list) or len(described) > ARRAYS:
            raise MalformedError(f"the header lists no arrays, or more than {ARRAYS}")
        sizes = [_size(each) for each in described]
        if sum(sizes) != self._body:
            raise MalformedError(f"arrays of {sum(sizes)} bytes are claimed, {self._body} came")
        arrays = []
        for (kind, shape), size in zip(described, sizes, strict=True):
            part = self._data[start : start + size]
            flat = np.frombuffer(part, "u1") != 0 if kind == "|b1" else np.frombuffer(part, kind)
            arrays.append(flat.reshape(shape))
            start += size
        return header, arrays


def _size(described: Any) -> int:
    """Return how many bytes an array takes, as it is described by a stranger."""
    if not isinstance(described, list) or len(described) != 2:
        raise MalformedError("an array is not described by its type and shape")
    kind, shape = described
    if not isinstance(kind, str) or kind not in TYPES:
        raise MalformedError("an array is of a type that is not carried")
    if not isinstance(shape, list) or len(shape) > DIMENSIONS:
        raise MalformedError(f"an array has no shape, or more than {DIMENSIONS} dimensions")
    if not all(type(length) is int and 0 <= length < 1 << 40 for length in shape):
        raise MalformedError("an array's shape is not of lengths")
    if 0 in shape and math.prod(length or 1 for length in shape) >= 1 << 40:  # of which NumPy makes no array
        raise MalformedError("an empty array's shape is too large")
    return TYPES[kind] * math.prod(shape)
