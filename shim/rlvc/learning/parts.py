# SPDX-License-Identifier: MIT
"""The parts of a space, compiled once: each turns its part of an observation into bits or floats."""

from __future__ import annotations

import dataclasses
import math
import operator
import struct
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..checks import listed, one_of, shown, whole
from ..errors import PerceptError, SpaceError

Array = npt.NDArray[Any]
_TABLE_MAX = 4096  # percepts of a Discrete that are kept ready
_SPELLED_MAX = 4  # values of a Discrete that its tests list
_KINDS = ("number", "numbers", "flags", "reals", "word")
_FLOAT = struct.Struct("=f")
_PLAIN_MAX = 1e14  # magnitude of a number that needs no clipping
_SQUARE_MAX = 0.9 * _native.THRESHOLDS_NUMBER_MAX**2


def width_of(count: int) -> int:
    """Return the number of bits of a number in [0, count)."""
    return max(1, int(count - 1).bit_length())


def prefix(path: Sequence[Any]) -> str:
    """Return the path of a part as text."""
    return ".".join(str(key) for key in path)


@dataclasses.dataclass
class Part:
    """A space that has no parts.

    Attributes
    ----------
    kind : {"number", "numbers", "flags", "reals", "word"}
        Discrete, MultiDiscrete, MultiBinary, Box, or a word of a list.
    path : tuple
        The keys that lead to it in an observation.
    shape : tuple of int
        Of its arrays.
    starts, counts : tuple of int
        The least number of each element, and how many numbers there are.
    words : tuple of str
    """

    kind: str
    path: tuple[Any, ...]
    shape: tuple[int, ...]
    starts: tuple[int, ...] = ()
    counts: tuple[int, ...] = ()
    words: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        self._check()
        self.size = 1 if self.kind == "word" else math.prod(self.shape)
        self.widths = [width_of(count) for count in self.counts]
        self.width = {"word": len(self.words), "flags": self.size, "reals": self.size}.get(
            self.kind, sum(self.widths)
        )
        self.offsets = np.cumsum([0, *self.widths]).tolist()
        self.index_of = {word: i for i, word in enumerate(self.words)}
        self._ready = self.table(True)

    def _check(self) -> None:
        """Make the fields tuples. Raises SpaceError if one is not as the class says."""
        one_of("kind", self.kind, _KINDS, SpaceError)
        self.path = tuple(listed("path", self.path, "keys", SpaceError))
        self.shape = self._wholes("shape", 0, 2**31 - 1)
        self.starts = self._wholes("starts", -(2**63), 2**63 - 1)
        self.counts = self._wholes("counts", 1, 2**63 - 1)
        self.words = tuple(str(word) for word in listed("words", self.words, "words", SpaceError))
        ranges = {"number": 1, "numbers": math.prod(self.shape)}.get(self.kind, 0)
        counts = 1 if self.kind == "word" else ranges
        if (len(self.starts), len(self.counts)) != (ranges, counts):
            raise SpaceError(f"{self.kind}: {len(self.counts)} counts, expected {counts}")
        if any(start + count > 2**63 for start, count in zip(self.starts, self.counts, strict=False)):
            raise SpaceError(f"{prefix(self.path) or 'space'}: a number beyond 2**63")

    def _wholes(self, field: str, least: int, most: int) -> tuple[int, ...]:
        numbers = listed(field, getattr(self, field), "int", SpaceError)
        name = f"{prefix(self.path)}: {field}" if self.path else field
        return tuple(whole(name, number, least, most, SpaceError) for number in numbers)

    def to_dict(self) -> dict[str, Any]:
        """Return the fields, for JSON."""
        return dataclasses.asdict(self)

    @classmethod
    def from_dict(cls, fields: dict[str, Any]) -> Part:
        """Make a part of its fields."""
        return cls(**fields)

    # -------------------------------------------------------------- names

    def described(self, given: Sequence[str | None]) -> Iterator[tuple[str, list[str]]]:
        """Yield each element's name, and the names of its bits or components.

        Parameters
        ----------
        given : sequence of str or None
            Names by the caller.
        """
        label = prefix(self.path)
        default = {"number": "number", "flags": "bit"}.get(self.kind, "x")
        for i in range(self.size):
            if given[i] is not None:
                name = str(given[i])
            elif self.size == 1 and self.kind != "flags":
                name = label or default
            elif self.kind == "flags" and not label:
                name = f"bit {i}"
            else:
                name = f"{label or default}[{i}]"
            yield name, self._columns_of(name, i)

    def _columns_of(self, name: str, index: int) -> list[str]:
        if self.kind in ("reals", "flags"):
            return [name]
        if self.kind == "word":
            return [f'{name} = "{word}"' for word in self.words]
        first, count = self.starts[index], self.counts[index]
        if count > _SPELLED_MAX:
            return [f"{name} bit {bit}" for bit in range(self.widths[index])]
        columns = []
        for bit in range(self.widths[index]):
            values = [str(first + v) for v in range(count) if v >> bit & 1]
            columns.append(
                f"{name} = {values[0]}"
                if len(values) == 1
                else f"{name} in {{{', '.join(values)}}}"
            )
        return columns

    # -------------------------------------------------------------- one observation

    def of(self, observation: Any) -> Any:
        """Its part of an observation, or of a batch of them."""
        try:
            for key in self.path:
                observation = observation[key]
        except Exception:  # also of a class of the caller
            raise PerceptError(f"an observation without {prefix(self.path)!r}") from None
        return observation

    def _wrong(self, value: Any) -> PerceptError:
        where = prefix(self.path) or "observation"
        if self.kind == "word":
            known = ", ".join(self.words)
            return PerceptError(f"{where}: {shown(value)} is none of the words {known:.200}")
        return PerceptError(f"{where}: {shown(value)} is not an element of the observation space")

    def _array(self, value: Any) -> Array:
        """The value as an array of the right shape."""
        try:
            array = np.asarray(value)
            if np.ma.is_masked(value):
                raise TypeError
            if self.size == 1 and array.size == 1:
                array = array.reshape(self.shape)
        except Exception:
            raise self._wrong(value) from None
        if array.shape != self.shape:
            raise self._wrong(value)
        return array

    def _numbers(self, value: Any) -> list[int]:
        """The numbers of a Discrete or MultiDiscrete, from 0 on."""
        try:
            listed = [operator.index(value)]
            if self.kind == "numbers" and self.size != 1:
                raise TypeError
        except Exception:
            array = self._array(value)
            if array.dtype.kind not in "biu":
                raise self._wrong(value) from None
            listed = array.ravel().tolist()
        numbers = list(map(operator.sub, map(int, listed), self.starts))
        if not all(0 <= number < count for number, count in zip(numbers, self.counts, strict=True)):
            raise self._wrong(value)
        return numbers

    def code(self, observation: Any) -> int:
        """Its bits of an observation, the first one lowest."""
        value = self.of(observation)
        if self.kind == "flags":
            array = self._array(value)
            if not ((array == 0) | (array == 1)).all():
                raise self._wrong(value)
            packed = np.packbits(array.ravel().astype(np.bool_), bitorder="little")
            return int.from_bytes(packed.tobytes(), "little")
        if self.kind == "word":
            return 1 << self._word(value)
        code = 0
        for number, offset in zip(self._numbers(value), self.offsets, strict=False):
            code |= number << offset
        return code

    def _word(self, value: Any) -> int:
        index = self.index_of.get(str(value))
        if index is None:
            raise self._wrong(value)
        return index

    def record(self, observation: Any) -> bytes:
        """Its components of an observation, as float32."""
        if self.kind == "reals":
            return self._reals(self.of(observation))
        code = self.code(observation)
        if self._ready is not None:
            return self._ready[code]
        return np.array([code >> i & 1 for i in range(self.width)], np.float32).tobytes()

    def _reals(self, value: Any) -> bytes:
        if type(value) is np.ndarray and value.ndim == 1 and value.shape == self.shape:
            if value.dtype != np.float32 and value.dtype.kind in "iu":
                value = value.astype(np.float32)
            if value.dtype == np.float32 and value.dot(value) <= _SQUARE_MAX:
                return bytes(value.tobytes())  # the square is NaN or large if an element is
        elif self.shape == () and isinstance(value, float | int | np.floating | np.integer):
            number = float(value)
            if abs(number) < _PLAIN_MAX:
                return _FLOAT.pack(number)
        array = self._array(value)
        return self.columns(array[None]).astype(np.float32).tobytes()

    def table(self, real: bool) -> list[bytes] | None:
        """Its records for each number, if it is a small Discrete; None if it is not."""
        if self.kind != "number" or self.counts[0] > _TABLE_MAX:
            return None
        columns = self.columns(np.arange(self.counts[0]) + self.starts[0])
        if real:
            return [row.tobytes() for row in columns.astype(np.float32)]
        return [row.tobytes() for row in np.packbits(columns, axis=1, bitorder="little")]

    # -------------------------------------------------------------- batches

    def columns(self, batch: Any) -> Array:
        """The columns of a batch: [n, width], bool or float64."""
        if self.kind == "word":
            indices = np.array([self._word(value) for value in batch])
            return np.asarray(indices[:, None] == np.arange(self.width))
        if np.ma.is_masked(batch):
            raise self._wrong(batch)
        batch = np.asarray(batch)
        count = len(batch)
        if self.kind == "flags":
            if not ((batch == 0) | (batch == 1)).all():
                raise self._wrong(batch)
            return np.asarray(batch.reshape(count, self.size), np.bool_)
        if self.kind == "reals":
            return self._clipped(batch.reshape(count, self.size))
        if batch.dtype.kind not in "biu":
            raise PerceptError(f"{prefix(self.path) or 'observation'}: {batch.dtype}: no integers")
        numbers = (batch.astype(np.int64) - np.reshape(self.starts, self.shape)).reshape(count, -1)
        if (numbers < 0).any() or (numbers >= self.counts).any():
            raise PerceptError(
                f"{prefix(self.path) or 'observation'}: a number outside the observation space"
            )
        index = np.repeat(np.arange(len(self.widths)), self.widths)
        shift = np.concatenate([np.arange(width) for width in self.widths])
        return np.asarray(numbers[:, index] >> shift & 1).astype(np.bool_)

    def _clipped(self, rows: Array) -> Array:
        try:
            if rows.dtype.kind not in "biufO":
                raise TypeError
            rows = rows.astype(np.float64)
        except (OverflowError, TypeError, ValueError):
            raise self._wrong(rows) from None
        bad = np.flatnonzero(np.isnan(rows).any(axis=0))
        if len(bad):
            names = [name for name, _ in self.described([None] * self.size)]
            raise PerceptError(f"{names[bad[0]]} is NaN: give a number instead")
        return rows.clip(-_native.THRESHOLDS_NUMBER_MAX, _native.THRESHOLDS_NUMBER_MAX)


def parts_of(space: Any, path: tuple[Any, ...]) -> list[Part]:
    """Take a space of Gymnasium apart.

    Parameters
    ----------
    space : gymnasium.Space
    path : tuple
        The keys that lead to it.

    Returns
    -------
    list of Part

    Raises
    ------
    SpaceError
        A part of the space cannot be encoded.
    """
    from gymnasium import spaces

    if isinstance(space, spaces.Dict):
        inner = [((*path, key), sub) for key, sub in space.spaces.items()]
        return [part for deeper, sub in inner for part in parts_of(sub, deeper)]
    if isinstance(space, spaces.Tuple):
        inner = [((*path, i), sub) for i, sub in enumerate(space.spaces)]
        return [part for deeper, sub in inner for part in parts_of(sub, deeper)]
    if isinstance(space, spaces.Discrete):
        return [Part("number", path, (), (int(space.start),), (int(space.n),))]
    if isinstance(space, spaces.MultiDiscrete):
        starts = tuple(int(v) for v in np.ravel(space.start))
        counts = tuple(int(v) for v in np.ravel(space.nvec))
        return [Part("numbers", path, tuple(space.shape), starts, counts)]
    if isinstance(space, spaces.MultiBinary):
        return [Part("flags", path, tuple(space.shape))]
    if isinstance(space, spaces.Box):
        return [Part("reals", path, tuple(space.shape))]
    where = f"{prefix(path)}: " if path else ""
    raise SpaceError(f"{where}cannot encode {shown(space)}")
