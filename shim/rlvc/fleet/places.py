# SPDX-License-Identifier: MIT
"""Files of a fleet: paths on this machine, or addresses that Arrow or fsspec know."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ..checks import shown
from ..errors import LogError
from ..files import checked_name
from . import layout


def filesystem_of(path: str) -> tuple[Any, str]:
    """Return Arrow's file system for a path or address, and the path within it.

    Parameters
    ----------
    path : str
    """
    pa = layout.arrow()
    checked_name("source", path, LogError)
    if any("\ud800" <= sign <= "\udfff" for sign in path):
        raise LogError(f"source: {shown(path)}: Arrow knows no name that is not UTF-8")
    if "://" not in path:
        return pa.fs.LocalFileSystem(), path
    try:
        filesystem, within = pa.fs.FileSystem.from_uri(path)
        return filesystem, within
    except pa.ArrowInvalid:
        pass
    except OSError as error:
        raise LogError(f"{path}: cannot be reached: {error}") from error
    try:
        import fsspec
    except ImportError:
        raise ImportError(
            f"{path}: this kind of address needs fsspec: pip install fsspec"
        ) from None
    try:
        found, within = fsspec.core.url_to_fs(path)
    except (ImportError, OSError, ValueError) as error:
        raise LogError(f"{path}: cannot be reached: {error}") from error
    return pa.fs.PyFileSystem(pa.fs.FSSpecHandler(found)), within


def files_below(path: str, *endings: tuple[str, ...]) -> list[str]:
    """Return a file, or those below a folder, in order of their names, each once.

    Parameters
    ----------
    path : str
    *endings : tuple of str
        Of a folder's files. The first of these that some file has is taken.

    Raises
    ------
    LogError
        There is none.
    """
    pa = layout.arrow()
    filesystem, within = filesystem_of(path)
    try:
        info = filesystem.get_file_info(within)
        if info.type == pa.fs.FileType.File:
            return [path]
        if info.type != pa.fs.FileType.Directory:
            raise LogError(f"{path}: no such file or folder")
        local = isinstance(filesystem, pa.fs.LocalFileSystem)
        names = _below(within) if local else _below_address(filesystem, within)
    except UnicodeError:
        raise LogError(f"{path}: Arrow knows no name that is not UTF-8, as of a file in it") from None
    except (OSError, pa.ArrowException) as error:
        raise LogError(f"{path}: cannot be listed: {error}") from error
    kept: list[str] = []
    for some in endings:
        kept = kept or [name for name in sorted(names) if Path(name).suffix in some]
    if local:  # a file that links lead to counts once
        kept = sorted({os.path.realpath(name): name for name in reversed(kept)}.values())
    scheme = path.partition("://")[0] + "://" if "://" in path else ""
    if not kept:
        *most, last = (ending for some in endings for ending in some)
        either = f"{', '.join(most)} or {last}" if most else last
        raise LogError(f"{path}: holds no file that ends in {either}")
    return [scheme + name for name in kept]


def _below(folder: str) -> list[str]:
    """Return the files below a folder of this machine, where links may lead back.

    A name that is not UTF-8 raises UnicodeError.
    """

    def refuse(error: OSError) -> None:
        raise error

    around = Path(os.path.realpath(folder))
    known = {str(around)}
    files: list[str] = []
    for where, folders, names in os.walk(folder, onerror=refuse, followlinks=True):
        files += filter(os.path.isfile, (os.path.join(where, name) for name in names))
        inner = {name: os.path.realpath(os.path.join(where, name)) for name in sorted(folders)}
        folders.clear()
        for name, real in inner.items():
            if real not in known and not around.is_relative_to(real):
                known.add(real)
                folders.append(name)
    for name in files:
        name.encode()  # raises UnicodeError where Arrow could not open the file
    return files


def _below_address(filesystem: Any, within: str) -> list[str]:
    fs = layout.arrow().fs
    below = filesystem.get_file_info(fs.FileSelector(within, recursive=True))
    return [entry.path for entry in below if entry.type == fs.FileType.File]


@contextlib.contextmanager
def reading(where: str, what: str = "") -> Iterator[None]:
    """Turn what Arrow raises of a damaged file into one error: it has no single kind of its own.

    Parameters
    ----------
    where : str
        What is read, for the error.
    what : str
        As what it is read.
    """
    try:
        yield
    except LogError:
        raise
    except Exception as error:
        raise LogError(f"{where}: cannot be read{what}: {' '.join(str(error).split())}") from error


def parquet(path: str) -> Any:
    """Open a Parquet file.

    Parameters
    ----------
    path : str
    """
    pa = layout.arrow()
    filesystem, within = filesystem_of(path)
    with reading(path, " as Parquet"):
        file = pa.parquet.ParquetFile(within, filesystem=filesystem, memory_map=False)
        names = file.schema_arrow.names
    if len(set(names)) != len(names):
        raise LogError(f"{path}: two columns have the same name (present: {', '.join(names)})")
    return file
