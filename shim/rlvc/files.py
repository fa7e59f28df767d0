# SPDX-License-Identifier: MIT
"""Reads regular files only, and writes files atomically.

A new file is written without a name if the system supports that, and gets its name when all of it is
on the disk. An old file of that name is replaced in one step, by a process of its own: so a writer
that is killed, at whatever moment, leaves the old file or the new one, and nothing else.

Elsewhere (macOS; a file system without ``O_TMPFILE``, as NFS) the new file has a random name until it
is renamed. The writer holds a lock on it. If the writer is killed, the lock is released: the next
process that saves or loads an agent removes what it left. So it does what a power failure left, or a
kill of all processes of a machine, in the moment between naming a new file and replacing the old.

Where a system has no locks on files and no names relative to a folder (Windows), the new file has a
random name from the start, and a killed writer leaves it behind.
"""

from __future__ import annotations

import contextlib
import errno
import os
import secrets
import stat
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any, BinaryIO

from . import _native as native
from .checks import named, shown
from .errors import Error, StoreError

try:
    import fcntl
except ImportError:  # not a POSIX system
    fcntl = None  # type: ignore[assignment]

_KINDS: tuple[tuple[Callable[[int], bool], str], ...] = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISLNK, "a link"),
    (stat.S_ISFIFO, "a FIFO"),
    (stat.S_ISSOCK, "a socket"),
)
_FDS = "/proc/self/fd"  # where the system shows files without a name


def _need_file(mode: int) -> None:
    """Raise OSError unless the mode is that of a regular file."""
    if not stat.S_ISREG(mode):
        kind = next((kind for test, kind in _KINDS if test(mode)), "a device")
        raise OSError(errno.EINVAL, f"it is {kind}, not a file")


def name_of(path: str | Path) -> str:
    """Return the name of a file as the system has it.

    Parameters
    ----------
    path : str or Path

    Raises
    ------
    OSError
        It is no name.
    """
    try:
        name = os.fsdecode(path)
        os.fsencode(name)
    except Exception:  # of another type; of no character of the system's; of a class of the caller
        raise OSError(errno.EINVAL, "not the name of a file") from None
    if "\0" in name or not name:
        raise OSError(errno.EINVAL, "not the name of a file")
    return name


def checked_name(what: str, path: Any, error: type[Error]) -> str:
    """Return the name of a file that a caller gave.

    Parameters
    ----------
    what : str
        What the file is, for the error.
    path : str or Path
    error : type
        The exception to raise where it is no name.

    Returns
    -------
    str
    """
    try:
        return name_of(path)
    except OSError as cause:
        raise error(f"{what}: {shown(path)}: {cause.strerror}") from cause


def open_file(path: str | Path) -> BinaryIO:
    """Open a regular file to read.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    binary file

    Raises
    ------
    OSError
        It cannot be opened, or is not a regular file. It never waits for a FIFO.
    """
    name = name_of(path)
    _need_file(os.stat(name).st_mode)  # opening a device may have effects
    file: BinaryIO = _opened(name, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0))
    _need_file(os.fstat(file.fileno()).st_mode)
    return file


def read(path: str | Path) -> bytes:
    """Return the content of a regular file.

    Raises
    ------
    OSError
        As of :func:`open_file`, or it cannot be read.
    """
    with open_file(path) as file:
        return file.read()


def replace(path: str | Path, content: bytes) -> None:
    """Write a file atomically: even if the process is killed, the file is old or new as a whole.

    Parameters
    ----------
    path : str or Path
        If the file exists, the new one gets its permissions.
    content : bytes

    Raises
    ------
    StoreError
        It cannot be written, or is write-protected, a link, a folder, a FIFO or a device. The old
        file is still there.
    """
    try:
        if fcntl is None:
            _replace_by_name(name_of(path), content)
        else:
            _replace(path, content)
    except OSError as error:
        raise StoreError(f"{named(path)}: cannot be written: {error.strerror}") from error


def check_place(path: str | Path) -> None:
    """Raise what :func:`replace` would raise, so that it is known before there is something to write.

    Parameters
    ----------
    path : str or Path

    Raises
    ------
    StoreError
        A file could not be written there now.
    """
    try:
        name = name_of(path)
        folder = os.path.dirname(name) or "."
        if not stat.S_ISDIR(os.stat(folder).st_mode):
            raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR))
        if not os.access(folder, os.W_OK | os.X_OK):
            raise PermissionError(errno.EACCES, "its folder is write-protected")
        with contextlib.suppress(FileNotFoundError):
            _need_file(os.stat(name, follow_symlinks=False).st_mode)
            if not os.access(name, os.W_OK):
                raise PermissionError(errno.EACCES, "it is write-protected")
    except OSError as error:
        raise StoreError(f"{named(path)}: cannot be written: {error.strerror}") from error


def _replace(path: str | Path, content: bytes) -> None:
    where, name = os.path.split(name_of(path))
    folder = os.open(where or ".", os.O_RDONLY | os.O_DIRECTORY)
    try:
        mode = None
        with contextlib.suppress(FileNotFoundError):
            mode = os.stat(name, dir_fd=folder, follow_symlinks=False).st_mode
            _need_file(mode)
            if not os.access(name, os.W_OK, dir_fd=folder):
                raise PermissionError(errno.EACCES, "it is write-protected")
        _tidy(folder, name)
        temporary = _beginning(name) + secrets.token_hex(8)
        try:
            with _create(folder, temporary) as file:
                file.write(content)
                file.flush()
                if mode is not None:
                    os.fchmod(file.fileno(), stat.S_IMODE(mode))
                os.fsync(file.fileno())
                _give_name(file, folder, temporary, name, new=mode is None)
        except BaseException:
            with contextlib.suppress(FileNotFoundError):
                os.unlink(temporary, dir_fd=folder)
            raise
        os.fsync(folder)
    finally:
        os.close(folder)


def _give_name(file: BinaryIO, folder: int, temporary: str, name: str, new: bool) -> None:
    """Give a file that is written its final name: at once if no file has it yet."""
    if os.fstat(file.fileno()).st_nlink == 0:
        here = f"{_FDS}/{file.fileno()}"
        if new:
            with contextlib.suppress(FileExistsError):  # another process was first
                os.link(here, name, dst_dir_fd=folder, follow_symlinks=True)
                return
        names = os.fsencode(temporary), os.fsencode(name)
        failed = native.long_call.rlvc_shim_give_name(file.fileno(), folder, *names)
        if failed:
            raise OSError(failed, os.strerror(failed))
        return
    os.rename(temporary, name, src_dir_fd=folder, dst_dir_fd=folder)


def _replace_by_name(name: str, content: bytes) -> None:
    """Write a file where the system has neither locks nor folders by number."""
    mode = None
    with contextlib.suppress(FileNotFoundError):
        mode = os.stat(name, follow_symlinks=False).st_mode
        _need_file(mode)
        if not os.access(name, os.W_OK):
            raise PermissionError(errno.EACCES, "it is write-protected")
    where, last = os.path.split(name)
    temporary = os.path.join(where, _beginning(last) + secrets.token_hex(8))
    try:
        with open(temporary, "xb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        if mode is not None:
            os.chmod(temporary, stat.S_IMODE(mode))
        os.replace(temporary, name)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(temporary)
        raise


def tidy(path: str | Path) -> None:
    """Remove what processes that were killed while they wrote a file left behind beside it."""
    if fcntl is None:
        return
    with contextlib.suppress(OSError):
        where, name = os.path.split(name_of(path))
        folder = os.open(where or ".", os.O_RDONLY | os.O_DIRECTORY)
        try:
            _tidy(folder, name)
        finally:
            os.close(folder)


def _beginning(name: str) -> str:
    """How the temporary names begin that belong to a file."""
    return f".rlvc-{zlib.crc32(os.fsencode(name)):08x}-"


def _opened(name: str, flags: int, folder: int | None = None) -> Any:
    """Open a file by its name in a folder; Python closes it when nobody needs it any more."""
    mode = "wb" if flags & os.O_WRONLY else "rb"

    def opener(_name: str, _flags: int) -> int:
        return os.open(name, flags | os.O_CLOEXEC, 0o666, dir_fd=folder)

    return open(name, mode, opener=opener)  # the caller closes it


def _create(folder: int, temporary: str) -> BinaryIO:
    """Make a new file and lock it: without a name if the system can name it later."""
    if hasattr(os, "O_TMPFILE") and os.path.exists(_FDS):
        with contextlib.suppress(OSError):
            file: BinaryIO = _opened(".", os.O_TMPFILE | os.O_WRONLY, folder)
            _lock(file, fcntl.LOCK_EX)
            return file
    while True:
        file = _opened(temporary, os.O_CREAT | os.O_EXCL | os.O_WRONLY, folder)
        _lock(file, fcntl.LOCK_EX)
        if (
            os.fstat(file.fileno()).st_nlink > 0
        ):  # else another process tidied it up before the lock
            return file
        file.close()


def _lock(file: BinaryIO, how: int) -> None:
    with contextlib.suppress(OSError):  # there are file systems without locks
        fcntl.flock(file, how)


def _tidy(folder: int, name: str) -> None:
    beginning = _beginning(name)
    for entry in os.listdir(folder):
        if not entry.startswith(beginning):
            continue
        flags = os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK
        # It may be gone, or its process at work.
        with contextlib.suppress(OSError), _opened(entry, flags, folder) as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            os.unlink(entry, dir_fd=folder)
