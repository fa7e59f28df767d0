# SPDX-License-Identifier: MIT
"""Encoders: from observations of Gymnasium's spaces to percepts.

==================  =====================================================================
space               bits
==================  =====================================================================
Discrete            the number minus ``start``, in binary, lowest bit first
MultiDiscrete       each number, as for Discrete
MultiBinary         the bits themselves
Dict, Tuple         the bits of all parts, in order
==================  =====================================================================

If the space contains a Box, percepts are vectors of real numbers (:class:`rlvc.Thresholds`): each
element of the Box is a component, and each bit of the other parts is a component 0 or 1.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..domains.bits import Bits
from ..domains.domain import Domain
from ..domains.thresholds import Thresholds
from ..errors import PerceptError, SpaceError

Columns = npt.NDArray[Any]


def _binary(starts: Any, widths: Sequence[int]) -> Callable[[Any], Columns]:
    """From numbers [n, d] to their bits [n, sum(widths)], lowest first."""
    index = np.repeat(np.arange(len(widths)), widths)
    shift = np.concatenate([np.arange(width) for width in widths])

    def columns(values: Any) -> Columns:
        numbers = (np.asarray(values, np.int64) - starts).reshape(-1, len(widths))
        bits: Columns = (numbers[:, index] >> shift & 1).astype(np.bool_)
        return bits

    return columns


def _width(count: int) -> int:
    return max(1, int(count - 1).bit_length())


class _Part:
    """A space that has no parts: its path in the observation, and its bits."""

    def __init__(
        self,
        path: tuple[Any, ...],
        names: list[str],
        columns: Callable[[Any], Columns],
        shape: tuple[int, ...],
        accepts: Callable[[Any], bool],
    ) -> None:
        self.path = path
        self.names = names
        self.columns = columns
        self.shape = shape
        self.single = all(size == 1 for size in shape)
        self.accepts = accepts

    def of(self, observation: Any) -> Any:
        """Its part of an observation, or of a batch of them."""
        try:
            for key in self.path:
                observation = observation[key]
        except (KeyError, IndexError, TypeError):
            raise PerceptError(f"an observation without {_prefix(self.path)!r}") from None
        return observation

    def encode(self, observation: Any) -> Columns:
        """The columns of one observation."""
        value = self.of(observation)
        try:
            array = np.asarray(value)
            if self.single and array.size == 1:
                array = array.reshape(self.shape)
            if self.accepts(array):
                columns: Columns = self.columns(array[None])[0]
                return columns
        except (OverflowError, TypeError, ValueError) as error:
            if isinstance(error, PerceptError):
                raise
        where = _prefix(self.path) or "observation"
        raise PerceptError(f"{where}: {value!r:.80} is not an element of the observation space")


def _prefix(path: tuple[Any, ...]) -> str:
    return ".".join(str(key) for key in path)


def _box_part(space: Any, path: tuple[Any, ...]) -> _Part:
    size = int(np.prod(space.shape, dtype=int))
    label = _prefix(path) or "x"
    names = [label] if size == 1 else [f"{label}[{i}]" for i in range(size)]

    def columns(batch: Any) -> Columns:
        rows = np.asarray(batch, np.float64).reshape(len(batch), -1)
        bad = np.flatnonzero(np.isnan(rows).any(axis=0))
        if len(bad):
            raise PerceptError(f"{names[bad[0]]} is NaN: give a number instead")
        return rows.clip(-_native.THRESHOLDS_NUMBER_MAX, _native.THRESHOLDS_NUMBER_MAX)

    return _Part(path, names, columns, space.shape, lambda value: value.shape == space.shape)


class Numbers:
    """A space of arrays of numbers, encoded like a Box; for logs, without Gymnasium.

    Parameters
    ----------
    shape : tuple of int
    """

    def __init__(self, shape: tuple[int, ...]) -> None:
        self.shape = shape


def _parts(space: Any, path: tuple[Any, ...]) -> list[_Part]:
    if isinstance(space, Numbers):
        return [_box_part(space, path)]
    from gymnasium import spaces

    label = _prefix(path)
    if isinstance(space, spaces.Dict):
        inner = [((*path, key), sub) for key, sub in space.spaces.items()]
        return [p for deeper, sub in inner for p in _parts(sub, deeper)]
    if isinstance(space, spaces.Tuple):
        return [p for i, sub in enumerate(space.spaces) for p in _parts(sub, (*path, i))]
    if isinstance(space, spaces.Discrete):
        width, start = _width(int(space.n)), int(space.start)
        names = [f"{label or 'number'} bit {bit}" for bit in range(width)]
        beyond = start + int(space.n)
        return [
            _Part(
                path,
                names,
                _binary(start, [width]),
                (),
                lambda v: v.dtype.kind in "biu" and start <= int(v) < beyond,
            )
        ]
    if isinstance(space, spaces.MultiDiscrete):
        counts, starts = np.ravel(space.nvec), np.ravel(space.start)
        widths = [_width(int(count)) for count in counts]
        names = [
            f"{label or 'x'}[{i}] bit {bit}"
            for i, width in enumerate(widths)
            for bit in range(width)
        ]

        return [
            _Part(
                path,
                names,
                _binary(starts, widths),
                space.shape,
                lambda v: v.dtype.kind in "biu" and bool(space.contains(v.astype(np.int64))),
            )
        ]
    if isinstance(space, spaces.MultiBinary):
        size = int(np.prod(space.shape))
        names = [f"{label}[{i}]" if label else f"bit {i}" for i in range(size)]
        return [
            _Part(
                path,
                names,
                lambda v: np.asarray(v).reshape(-1, size).astype(np.bool_),
                space.shape,
                lambda v: v.shape == space.shape and bool(((v == 0) | (v == 1)).all()),
            )
        ]
    if isinstance(space, spaces.Box):
        return [_box_part(space, path)]
    raise SpaceError(f"{label + ': ' if label else ''}cannot encode {space}")


def _has_reals(space: Any) -> bool:
    """Whether a space contains a Box."""
    if isinstance(space, Numbers):
        return True
    from gymnasium import spaces

    if isinstance(space, spaces.Dict):
        return any(_has_reals(sub) for sub in space.spaces.values())
    if isinstance(space, spaces.Tuple):
        return any(_has_reals(sub) for sub in space.spaces)
    return isinstance(space, spaces.Box)


class Encoder:
    """Turns observations into percepts of bits, or of real numbers if the space contains a Box.

    Parameters
    ----------
    space : gymnasium.Space or Numbers
        Discrete, MultiDiscrete, MultiBinary, Box, or a Dict or Tuple of these.
    thresholds : int
        Maximum number of cutpoints for each component of real numbers; 0: no limit.

    Attributes
    ----------
    domain : Domain
        Domain of the percepts: :class:`rlvc.Bits` or :class:`rlvc.Thresholds`.
    names : list of str
        Name of each bit or component.

    Raises
    ------
    SpaceError
        The space cannot be encoded, or needs more than 1024 bits or components.

    Notes
    -----
    Elements beyond +-1e15, also infinite ones, are clipped to it.
    """

    domain: Domain

    def __init__(self, space: Any, thresholds: int = 15) -> None:
        self._made_of = (space, thresholds)
        self._parts = _parts(space, ())
        self.names = [name for part in self._parts for name in part.names]
        size, real = len(self.names), _has_reals(space)
        if size > (_native.THRESHOLDS_COMPONENTS_MAX if real else _native.BITS_MAX):
            raise SpaceError(
                f"{space} needs {size} {'components' if real else 'bits'}, and a percept has at most "
                f"{_native.BITS_MAX}: pass an encoder, for pictures an rlvc.vision.Eye"
            )
        self.domain = Thresholds(size, thresholds) if real else Bits(size)

    def __getstate__(self) -> dict[str, Any]:
        """Pickle what it was made of, and the names."""
        return {"made_of": self._made_of, "names": self.names}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Make it again."""
        Encoder.__init__(self, *state["made_of"])
        self.names = state["names"]

    def encode(self, observation: Any) -> bytes:
        """Encode one observation.

        Parameters
        ----------
        observation : element of the space

        Returns
        -------
        bytes, [ceil(bits / 8)]

        Raises
        ------
        PerceptError
            It is not an element of the space, or contains NaN.
        """
        columns = [part.encode(observation) for part in self._parts]
        return bytes(self._packed(np.concatenate(columns)[None])[0].tobytes())

    def encode_many(self, observations: Any) -> npt.NDArray[Any]:
        """Encode a batch as vector environments return it: arrays [n, ...], in dicts or tuples.

        Parameters
        ----------
        observations : batch of n elements of the space

        Returns
        -------
        ndarray, [n, *percept_shape] of the domain
        """
        try:
            columns = [part.columns(np.asarray(part.of(observations))) for part in self._parts]
        except (OverflowError, TypeError, ValueError) as error:
            if isinstance(error, PerceptError):
                raise
            raise PerceptError(f"a batch that is not of the space: {error}") from error
        return self._packed(np.concatenate(columns, axis=1))

    def _packed(self, columns: Columns) -> npt.NDArray[Any]:
        if isinstance(self.domain, Bits):
            return np.packbits(columns, axis=1, bitorder="little")
        return columns.astype(np.float32)

    def explain(self, text: str) -> str:
        """Replace ``bit N`` and ``x[N]`` by the name of the bit or component.

        Parameters
        ----------
        text : str
            A result of :meth:`rlvc.Agent.print`.

        Returns
        -------
        str
        """
        return explain(text, self.names)


def explain(text: str, names: Sequence[str]) -> str:
    """Replace ``bit N`` and ``x[N]`` in a text by the name number N.

    Parameters
    ----------
    text : str
    names : sequence of str

    Returns
    -------
    str
    """

    def name(match: re.Match[str]) -> str:
        index = int(match[1] or match[2])
        return names[index] if index < len(names) else match[0]

    return re.sub(r"\bbit (\d+)\b|\bx\[(\d+)\]", name, text)
