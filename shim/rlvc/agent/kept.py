# SPDX-License-Identifier: MIT
"""What the files of this package look like.

A line ``rlvc KIND VERSION``, a line of JSON, bytes, and the CRC-32 of all these in 4 bytes, lowest
first. Version 1 of an agent has no CRC-32, and is read, too.
"""

from __future__ import annotations

import contextlib
import json
import re
import zlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ..checks import listed, named, shown
from ..errors import ConfigError, SnapshotError, StoreError
from ..files import open_file, read, replace, tidy

# The newest version of each kind.
VERSIONS = {"agent": 2, "planner": 1, "policy": 1, "run": 1}
_WITHOUT_CRC = {"agent": 1}


def pack(kind: str, head: dict[str, Any], body: bytes = b"") -> bytes:
    """Return the content of a file.

    Parameters
    ----------
    kind : str
    head : dict
    body : bytes

    Returns
    -------
    bytes
    """
    text = json.dumps(head, default=lambda number: number.item())  # numpy's numbers
    content = b"rlvc %b %d\n%b\n%b" % (kind.encode(), VERSIONS[kind], text.encode(), body)
    return content + zlib.crc32(content).to_bytes(4, "little")


def unpack(kind: str, content: bytes) -> tuple[dict[str, Any], bytes]:
    """Return the head and the body of a file's content.

    Parameters
    ----------
    kind : str
    content : bytes

    Returns
    -------
    dict, bytes

    Raises
    ------
    SnapshotError
        It is of another kind or version, or is corrupt.
    """
    start = rb"rlvc %b (\d{1,9})\n" % kind.encode()
    first = re.match(start, content) if isinstance(content, bytes) else None
    if first is None:
        raise SnapshotError(f"not the file of {'an' if kind == 'agent' else 'a'} {kind}")
    version, newest = int(first[1]), VERSIONS[kind]
    if not 1 <= version <= newest:
        raise SnapshotError(f"version {version}; this package reads versions 1 to {newest}")
    if version != _WITHOUT_CRC.get(kind):
        content, checksum = content[:-4], content[-4:]
        if zlib.crc32(content) != int.from_bytes(checksum, "little"):
            raise SnapshotError("damaged: the checksum is wrong")
    line, _, body = content[first.end() :].partition(b"\n")
    try:
        head = json.loads(line)
    except (RecursionError, ValueError) as error:
        raise SnapshotError(f"damaged: the header is not valid ({error})") from error
    if not isinstance(head, dict):
        raise SnapshotError("damaged: the header is not valid")
    return head, body


def read_content(file: str | Path) -> bytes:
    """Return the content of a file; StoreError if it cannot be read."""
    try:
        tidy(file)
        return read(file)
    except OSError as error:
        raise StoreError(f"{named(file)}: cannot be read: {error.strerror}") from error


def write_named(file: str | Path, kind: str, names: Sequence[str], head: dict[str, Any],
                body: bytes = b"") -> None:  # fmt: skip
    """Write a file with the names of bits or components. A failure leaves the old file.

    Parameters
    ----------
    file : str or Path
    kind : str
    names : sequence of str
    head : dict
    body : bytes
    """
    known = listed("names", names, "str")
    if not all(isinstance(name, str) for name in known):
        raise ConfigError(f"names: {shown(names)} is not a list of str")
    replace(file, pack(kind, head | {"names": known}, body))


def is_kind(file: str | Path, kind: str) -> bool:
    """Whether a file can be read and begins as one of a kind."""
    first = b"rlvc %b " % kind.encode()
    with contextlib.suppress(OSError), open_file(file) as opened:
        return opened.read(len(first)) == first
    return False
