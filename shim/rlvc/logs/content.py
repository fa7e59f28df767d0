# SPDX-License-Identifier: MIT
"""What is in a log's file: unpacked if it is compressed, and as text in the encodings in use."""

from __future__ import annotations

import bz2
import gzip
import io
import lzma
import zipfile
from pathlib import Path
from typing import IO, Any

from ..checks import named
from ..errors import LogError
from ..files import open_file
from .log import counted

SUFFIXES = (".csv", ".tsv", ".tab", ".txt", ".dat", ".json", ".jsonl", ".ndjson")
"""Of files with a log as text."""
_MOST = 1 << 32  # bytes of an unpacked file: more may be an attack
_PACKED: tuple[tuple[bytes, Any], ...] = (
    (b"\x1f\x8b", gzip.open),
    (b"BZh", bz2.open),
    (b"\xfd7zXZ\x00", lzma.open),
)
_ZIP = b"PK\x03\x04"
_ENCODINGS = ((b"\xef\xbb\xbf", "utf-8-sig"), (b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16"))


def content_of(path: str | Path) -> bytes:
    """Read a file: unpacked, if it is compressed by gzip, bzip2 or xz, or the only one of a ZIP.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    bytes

    Raises
    ------
    LogError
        It cannot be read or unpacked.
    """
    try:
        with open_file(path) as file:
            start = file.read(6)
            file.seek(0)
            opener = next((opened for mark, opened in _PACKED if start.startswith(mark)), None)
            if opener is not None:
                with opener(file, "rb") as inside:
                    return _whole(inside, path)
            if start.startswith(_ZIP):
                with zipfile.ZipFile(file) as archive:
                    name = only_log_in(archive)
                    if name is not None:
                        with archive.open(name) as inside:
                            return _whole(inside, path)
            file.seek(0)
            return file.read()
    except OSError as error:
        raise LogError(f"{named(path)}: cannot be read: {error.strerror or error}") from error
    except LogError:
        raise
    except Exception as error:  # of zlib, lzma and zipfile
        raise LogError(f"{path}: cannot be unpacked: {error}") from error


def is_packed(start: bytes) -> bool:
    """Whether a file that begins so is compressed, or a ZIP."""
    return start.startswith((*(mark for mark, _ in _PACKED), _ZIP))


def is_wide(start: bytes) -> bool:
    """Whether a text begins like UTF-16 without a mark."""
    return start[1:4:2] == b"\0\0" and start[:1] >= b" "


def _whole(file: IO[bytes], path: str | Path) -> bytes:
    content = file.read(_MOST + 1)
    if len(content) > _MOST:
        raise LogError(f"{path}: unpacked it has more than 4 GiB: divide it")
    return content


def only_log_in(archive: zipfile.ZipFile) -> str | None:
    """Of a ZIP with one log in it the name of that; None of an NPZ and of others."""
    found = [
        name
        for name in archive.namelist()
        if name.lower().endswith(SUFFIXES) and not name.startswith("__MACOSX")
    ]
    return found[0] if len(found) == 1 else None


def why_no_arrays(names: list[str]) -> str:
    """Say what a ZIP with files of these names is, if it has no arrays; else nothing."""
    if any(name.startswith("xl/") for name in names):
        return "is of Excel: pass what pandas.read_excel returns"
    if any(name.endswith("/data.pkl") for name in names):
        return "is of PyTorch: pass what torch.load returns, as arrays"
    if not names or any(not name.endswith(".npy") for name in names):
        return f"a ZIP of {len(names)} files, and not one log: unpack it, and pass one of them"
    return ""


def text_of(path: str | Path, notes: list[str], lost: list[str]) -> str:
    """Read a text: UTF-8, UTF-16, or what Windows and Excel call ANSI.

    Parameters
    ----------
    path : str or Path
    notes : list of str
        Takes a line about the encoding, if it had to be guessed.
    lost : list of str
        Takes a line about bytes 0, which are left out: a logger without power leaves them behind.

    Returns
    -------
    str
    """
    content = content_of(path)
    encoding = next((name for mark, name in _ENCODINGS if content.startswith(mark)), "")
    if not encoding and is_wide(content):
        encoding = "utf-16-le"
    try:
        text = content.decode(encoding or "utf-8")
    except UnicodeDecodeError as error:
        if encoding or b"\0" in content:
            raise LogError(f"{path}: cannot be read as text: {error}") from None
        text = content.decode("cp1252", errors="replace")
        notes.append("not UTF-8: read as Windows-1252")
    text = text.lstrip("\ufeff")
    count = text.count("\0")
    if count:
        line = text.count("\n", 0, text.index("\0")) + 1
        lost.append(f"{counted(count, 'byte')} 0, which is no text, and left out, first line {line}")
        text = text.replace("\0", "")
    ended = text.rstrip()
    return ended[:-1] if ended.endswith("\x1a") else text  # an old end of file


def as_file(path: str | Path) -> IO[bytes]:
    """What is in a file, to read from."""
    return io.BytesIO(content_of(path))
