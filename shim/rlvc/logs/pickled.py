# SPDX-License-Identifier: MIT
"""Pickles of numbers, texts, lists, dicts and numpy arrays, read without running what is in them.

A pickle may name any function, which Python's own reader calls. Here only stand-ins are called, for
what numpy writes; a pickle that names anything else is refused. Of a stand-in it gets a copy, as it may
also set attributes.

Two things of a few bytes would take all memory: a place in the reader's table of what comes again, for
which Python's reader in C makes a table of that length and the one in Python does not; and lists of
lists that come again, whose elements are counted.
"""

from __future__ import annotations

import collections
import functools
import io
import math
import pickle
import re
from pathlib import Path
from typing import IO, Any

import numpy as np
import numpy.typing as npt

from ..errors import LogError

Array = npt.NDArray[Any]
_REPEATED_MAX = 1 << 26
_DTYPE = re.compile(r"[biufSU]\d+|O8?")
_SAVED_BY = {
    "pandas": "pass pandas.read_pickle(path)",
    "stable_baselines3": "pass model.replay_buffer after model.load_replay_buffer(path)",
    "torch": "pass what torch.load(path) returns, as arrays",
}


class _Dtype:
    """Stands for numpy.dtype."""

    def __init__(self, code: str, *_: Any) -> None:
        self.code, self.order = str(code), "<"

    def __setstate__(self, state: Any) -> None:
        self.order = str(state[1])

    def made(self) -> np.dtype[Any]:
        if not _DTYPE.fullmatch(self.code):
            raise ValueError(f"an array of {self.code:.20}")
        plain = self.order if self.order in "<>" else "="
        return np.dtype("O") if self.code[0] == "O" else np.dtype(plain + self.code)


class _Ndarray:
    """Stands for numpy.ndarray."""

    state: Any = None

    def __init__(self, *state: Any) -> None:
        if state:
            self.state = state

    def __setstate__(self, state: Any) -> None:
        self.state = state[-4:]

    def made(self, finished: Any) -> Array:
        shape, dtype, fortran, data = self.state
        kind = dtype.made()
        if any(not isinstance(n, int) or n < 0 for n in shape):
            raise ValueError("an array of a wrong shape")
        if kind.hasobject:
            array = np.empty(len(data), object)
            array[:] = [finished(element) for element in data]
        else:
            array = np.frombuffer(_bytes(data), kind)
        if len(array) != math.prod(shape):
            raise ValueError("an array of a wrong size")
        return array.reshape(shape, order="F" if fortran else "C")


def _bytes(data: Any) -> bytes:
    if not isinstance(data, bytes | bytearray):
        raise ValueError("an array without its bytes")
    return bytes(data)


def _reconstruct(*_: Any) -> _Ndarray:
    return _Ndarray()


def _from_buffer(data: Any, dtype: Any, shape: Any, order: str, *_: Any) -> _Ndarray:
    return _Ndarray(shape, dtype, order == "F", data)


def _scalar(dtype: Any, data: Any = b"") -> Any:
    kind = dtype.made()
    return data if kind.hasobject else np.frombuffer(_bytes(data), kind)[0]


def _encode(text: str, encoding: str = "latin1") -> bytes:
    return text.encode("latin1")  # of old protocols, which have no bytes


_STAND_INS: dict[tuple[str, str], Any] = {
    ("numpy", "dtype"): _Dtype,
    ("numpy", "ndarray"): _Ndarray,
    ("_codecs", "encode"): _encode,
    ("collections", "OrderedDict"): collections.OrderedDict,
    ("collections", "deque"): collections.deque,
}
for _room in ("numpy.core", "numpy._core"):
    _STAND_INS |= {
        (f"{_room}.multiarray", "_reconstruct"): _reconstruct,
        (f"{_room}.multiarray", "scalar"): _scalar,
        (f"{_room}.numeric", "_frombuffer"): _from_buffer,
    }


class _Reader(pickle._Unpickler):
    def find_class(self, module: str, name: str) -> Any:
        found = _STAND_INS.get((module, name))
        if found is None:
            known = next((m for m in _SAVED_BY if module.split(".")[0] == m), "")
            hint = _SAVED_BY.get(known, "load it yourself if you trust it, and pass what it holds")
            raise LogError(f"holds {module}.{name}, which is not taken from a file: {hint}")
        return functools.partial(found)


class _Finished:
    """The structure with arrays in place of the stand-ins.

    Parameters
    ----------
    most : int
        How many elements it may have, where what comes again counts each time.
    """

    def __init__(self, most: int) -> None:
        self._most = most
        self._done: dict[int, tuple[Any, int]] = {}  # what was made of an object, and its elements

    def of(self, found: Any) -> Any:
        """What is made of an object."""
        return self._with_count(found)[0]

    def _with_count(self, found: Any) -> tuple[Any, int]:
        if id(found) not in self._done:
            made, count = self._made(found)
            if count > self._most:
                raise LogError(f"holds lists that come again, with over {self._most} elements in all")
            self._done[id(found)] = made, count
        return self._done[id(found)]

    def _made(self, found: Any) -> tuple[Any, int]:
        if isinstance(found, _Ndarray):
            counts = [0]

            def element(value: Any) -> Any:
                part, count = self._with_count(value)
                counts.append(count)
                return part

            array = found.made(element)
            return array, max(array.size, sum(counts))
        if isinstance(found, dict):
            parts = {key: self._with_count(value) for key, value in found.items()}
            return {key: part for key, (part, _) in parts.items()}, sum(n for _, n in parts.values())
        if isinstance(found, list | tuple | collections.deque):
            each = [self._with_count(value) for value in found]
            return [part for part, _ in each], sum(n for _, n in each)
        return found, 1


def unpickled(file: IO[bytes], where: str | Path) -> Any:
    """Read what is pickled in a file.

    Parameters
    ----------
    file : binary file
    where : str or Path
        For errors.

    Returns
    -------
    object
        Numbers, texts, lists, dicts and arrays.

    Raises
    ------
    LogError
        It is damaged, or holds something else.
    """
    try:
        content = file.read()
        found = _Reader(io.BytesIO(content)).load()
        return _Finished(max(len(content), _REPEATED_MAX)).of(found)
    except LogError as error:
        raise LogError(f"{where}: {error}") from None
    except Exception as error:  # a damaged pickle raises whatever it likes
        raise LogError(f"{where}: cannot be read as a pickle: {error}") from error


def array_of(file: IO[bytes], where: str | Path) -> Any:
    """Read an array in the format NPY: an ndarray, or the object that is the only one in it.

    As :func:`unpickled`, whose arguments and errors it has; those of numpy are not caught.
    """
    from numpy.lib import format as npy

    content = file.read()
    start = io.BytesIO(content)
    version = npy.read_magic(start)
    read_head = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
    _, _, dtype = read_head(start)
    if not dtype.hasobject:
        return np.load(io.BytesIO(content), allow_pickle=False)
    found = unpickled(start, where)
    return found.item() if isinstance(found, np.ndarray) and found.ndim == 0 else found
