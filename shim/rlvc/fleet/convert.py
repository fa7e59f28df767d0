# SPDX-License-Identifier: MIT
"""From any log to Parquet files of the layout, and back."""

from __future__ import annotations

import contextlib
import io
import os
import secrets
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ..checks import named, shown, whole
from ..counts.table import Columns
from ..errors import ConfigError, LogError, StoreError
from ..files import replace
from ..learning.encode import Encoder
from ..logs import read
from . import layout
from .logs import columns_of_log
from .places import filesystem_of
from .sources import blocks, opened

FILE_ROWS = 1 << 22  # interactions in a file, and what is left of the last one's episode


def _episodes(ends: npt.NDArray[np.uint8], rows: int) -> Iterator[slice]:
    """Cut a log into files: whole episodes, of at least so many interactions."""
    last = np.flatnonzero(ends != 0)
    start = 0
    while start < len(ends):
        index = np.searchsorted(last, start + rows - 1)
        stop = int(last[index]) + 1 if index < len(last) else len(ends)
        yield slice(start, stop)
        start = stop


def convert(
    log: Any,
    folder: str | Path,
    *,
    columns: Sequence[str] | None = None,
    actions: int | None = None,
    space: Any = None,
    encoder: Encoder | None = None,
    file_rows: int = FILE_ROWS,
    prefix: str = "part",
) -> list[str]:
    """Write a log as Parquet files of the layout (:mod:`rlvc.fleet.layout`).

    Parameters
    ----------
    log : dict of arrays, path of a file, Minari data set or its name
        What :func:`rlvc.learn_from` reads.
    folder : str or Path
        A folder, which is made, or an address such as ``s3://bucket/folder``.
    columns, actions, space, encoder
        As for :func:`rlvc.learn_from`. The percepts must come out as bits.
    file_rows : int
        Interactions in a file; its last episode is kept whole.
    prefix : str
        Beginning of the files' names.

    Returns
    -------
    list of str
        The files.

    Raises
    ------
    LogError
        The log is damaged, or its percepts are not bits.
    ConfigError
        An argument is out of range.
    StoreError
        The folder or a file in it cannot be written.

    Notes
    -----
    Each file is written as a whole or not at all, also if writing fails or is interrupted; those
    before it are there. A folder that was made is removed again if nothing came into it.
    """
    file_rows = whole("file_rows", file_rows, 1, 2**31)
    if not isinstance(folder, str | Path) or not str(folder):
        raise ConfigError(f"folder: {shown(folder)} is not the name of a folder")
    if not isinstance(prefix, str) or Path(prefix).name != prefix or "\0" in prefix:
        raise ConfigError(f"prefix: {shown(prefix)} cannot begin the name of a file")
    source = read(log, columns)
    all_of_it, bits, _ = columns_of_log(source, encoder, space)
    count = whole("actions", actions or source.known.count, 1, 255)
    pa = layout.arrow()
    try:
        return _written(all_of_it, source.exploited, (bits, count, file_rows), str(folder), prefix)
    except StoreError:  # it names the file
        raise
    except (OSError, pa.ArrowException) as error:
        raise StoreError(f"{folder}: cannot be written: {error}") from error


def _written(
    all_of_it: Columns,
    choices: npt.NDArray[np.bool_] | None,
    sizes: tuple[int, int, int],
    folder: str,
    prefix: str,
) -> list[str]:
    """Write the files; return their names."""
    bits, count, file_rows = sizes
    filesystem, within = filesystem_of(folder)
    names: list[str] = []
    with _folder(filesystem, within):
        for number, some in enumerate(_episodes(all_of_it.ends, file_rows)):
            exploited = None if choices is None else choices[some]
            name = f"{prefix}-{number:05d}.parquet"
            content = io.BytesIO()
            writer = layout.Writer(content, bits, count, exploited is not None)
            writer.write(_cut(all_of_it, some), exploited)
            writer.close()
            _put(filesystem, f"{within}/{name}", content.getvalue())
            names.append(f"{folder.rstrip('/')}/{name}")
    return names


@contextlib.contextmanager
def _folder(filesystem: Any, within: str) -> Iterator[None]:
    """Make a folder, and remove on failure what was made of it if it is still empty."""
    missing = []
    if isinstance(filesystem, layout.arrow().fs.LocalFileSystem):
        folders = [Path(within), *Path(within).parents]
        missing = [folder for folder in folders if not os.path.lexists(folder)]
    try:
        filesystem.create_dir(within, recursive=True)
        yield
    except BaseException:
        with contextlib.suppress(OSError):
            for folder in missing:
                folder.rmdir()
        raise


def _put(filesystem: Any, path: str, content: bytes) -> None:
    """Write a file so that it is there as a whole or not at all."""
    if isinstance(filesystem, layout.arrow().fs.LocalFileSystem):
        replace(path, content)
        return
    where, _, name = path.rpartition("/")
    temporary = f"{where}/.rlvc-{secrets.token_hex(8)}-{name}.new"
    try:
        with filesystem.open_output_stream(temporary) as stream:
            stream.write(content)
        filesystem.move(temporary, path)
    except BaseException:
        with contextlib.suppress(OSError):
            filesystem.delete_file(temporary)
        raise


def _cut(columns: Columns, some: slice) -> Columns:
    return Columns(
        columns.percepts[some],
        columns.next_percepts[some],
        columns.actions[some],
        columns.rewards[some],
        columns.ends[some],
        columns.keys[some],
    )


def export(source: str | Path | Sequence[str | Path], file: str | Path) -> int:
    """Write logs of the layout as one NPZ file, which :func:`rlvc.learn_from` reads.

    Parameters
    ----------
    source : str, Path or sequence of these
        As for :func:`rlvc.fleet.learn_from`.
    file : str or Path
        Ends in ``.npz``.

    Returns
    -------
    int
        The number of interactions. All of them are in memory at once.

    Raises
    ------
    LogError
        A file is broken.
    """
    if not str(file).endswith(".npz"):
        raise ConfigError(f"file: {named(file)} does not end in .npz")
    found = opened(source)
    parts = []
    for piece in found.pieces:
        for _, block in blocks(piece, found.bits):
            if isinstance(block, LogError):
                raise block
            parts.append(block)

    def whole_of(name: str) -> npt.NDArray[Any]:
        return np.concatenate([getattr(part, name) for part in parts])

    def bits_of(name: str) -> npt.NDArray[np.bool_]:
        packed = whole_of(name)
        return np.unpackbits(packed, axis=1, count=found.bits, bitorder="little").astype(np.bool_)

    ends = whole_of("ends")
    content = io.BytesIO()
    np.savez_compressed(
        content,
        observations=bits_of("percepts"),
        next_observations=bits_of("next_percepts"),
        actions=whole_of("actions"),
        rewards=whole_of("rewards"),
        terminated=ends == 1,
        truncated=ends == 2,
    )
    replace(file, content.getvalue())
    return len(ends)
