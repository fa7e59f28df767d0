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
element of the Box is a component, and each bit of the other parts is a component 0 or 1. A log's
column of words has one bit for each word.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..checks import array, listed, pickled, shown, told, whole
from ..domains.bits import Bits
from ..domains.domain import Domain
from ..domains.thresholds import Thresholds
from ..errors import ConfigError, PerceptError, SpaceError
from ..words import explain
from .parts import Part, parts_of

__all__ = ["Columns", "Encoder", "Flags", "Named", "Number", "Numbers", "Word", "explain"]


class _Space:
    """A space of a log: an error tells it by what it was made with."""

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(map(repr, vars(self).values()))})"


class Numbers(_Space):
    """A space of arrays of numbers, encoded like a Box; for logs, without Gymnasium.

    Parameters
    ----------
    shape : tuple of int
    """

    def __init__(self, shape: tuple[int, ...]) -> None:
        self.shape = shape


class Flags(_Space):
    """A space of arrays of truth values, encoded like a MultiBinary; for logs, without Gymnasium.

    Parameters
    ----------
    shape : tuple of int
    """

    def __init__(self, shape: tuple[int, ...]) -> None:
        self.shape = shape


class Number(_Space):
    """A space of numbers from 0 on, encoded like a Discrete; for logs, without Gymnasium.

    Parameters
    ----------
    count : int
    """

    def __init__(self, count: int) -> None:
        self.count = count


class Word(_Space):
    """A space of words, one bit for each; for logs, without Gymnasium.

    Parameters
    ----------
    words : sequence of str
    """

    def __init__(self, words: Sequence[str]) -> None:
        self.words = [str(word) for word in listed("words", words, "words", SpaceError)]


class Named(_Space):
    """A space of dicts of other spaces, encoded like a Dict; for logs, without Gymnasium.

    Parameters
    ----------
    spaces : dict
        For each name a space.
    """

    def __init__(self, spaces: Mapping[str, Any]) -> None:
        self.spaces = dict(_members("spaces", spaces))


class Columns(_Space):
    """A space of tables: a number or a word in each column; for logs, without Gymnasium.

    An observation is a dict or a row of a table by the names of the columns, or a sequence.

    Parameters
    ----------
    columns : dict
        For each name None, or the words that are in the column.
    """

    def __init__(self, columns: Mapping[str, Sequence[str] | None]) -> None:
        self.columns = {
            str(name): None if words is None else Word(words).words
            for name, words in _members("columns", columns)
        }


def _members(name: str, given: Any) -> list[tuple[Any, Any]]:
    """Return the keys and values of a dict."""
    if not isinstance(given, Mapping):
        raise SpaceError(f"{name}: {shown(given)} is not a dict")
    return list(given.items())


def _parts(space: Any, path: tuple[Any, ...] = ()) -> list[Part]:
    if isinstance(space, Numbers):
        return [Part("reals", path, space.shape)]
    if isinstance(space, Flags):
        return [Part("flags", path, space.shape)]
    if isinstance(space, Number):
        return [Part("number", path, (), (0,), (space.count,))]
    if isinstance(space, Word):
        return [Part("word", path, (), counts=(len(space.words),), words=tuple(space.words))]
    if isinstance(space, Columns):
        named = {
            name: Numbers(()) if words is None else Word(words)
            for name, words in space.columns.items()
        }
        return _parts(Named(named), path)
    if isinstance(space, Named):
        inner = space.spaces.items()
        return [part for name, sub in inner for part in _parts(sub, (*path, name))]
    return parts_of(space, path)


class Encoder:
    """Turns observations into percepts of bits, or of real numbers if the space contains a Box.

    Parameters
    ----------
    space : gymnasium.Space, or one of the spaces of logs in this module
        Discrete, MultiDiscrete, MultiBinary, Box, or a Dict or Tuple of these.
    thresholds : int
        Maximum number of cutpoints for each component of real numbers; 0: no limit.
    names : sequence of str or None
        A name for each number of an observation, in order: each element of a Box, each Discrete, and
        so on. None: made from the space.

    Attributes
    ----------
    domain : Domain
        Domain of the percepts: :class:`rlvc.Bits` or :class:`rlvc.Thresholds`.
    names : list of str
        Name of each bit or component.
    flags : list of bool
        Whether each is 0 or 1.
    elements : list of (str, list of int)
        The numbers of an observation: the name of each, and its bits or components.

    Raises
    ------
    SpaceError
        The space cannot be encoded, or needs more than 1024 bits or components.
    ConfigError
        The number of names is not that of the space.

    Notes
    -----
    Elements beyond +-1e15, also infinite ones, are clipped to it.
    """

    domain: Domain

    def __init__(
        self, space: Any, thresholds: int = 15, names: Sequence[str] | None = None
    ) -> None:
        parts = _parts(space)
        numbers = sum(part.size for part in parts)
        if names is not None:
            words = [] if isinstance(names, str) else listed("names", names, "names")
            if len(words) != numbers:
                raise ConfigError(
                    f"names: {shown(names)}: give a list of {numbers} names for {space!s:.80}"
                )
            names = [str(word) for word in words]
            if not all(name.strip() for name in names):
                raise ConfigError(f"names: {shown(names)}: a name is empty")
        self._settle(parts, thresholds, names)

    def _settle(
        self, parts: list[Part], thresholds: int, names: Sequence[str | None] | None
    ) -> None:
        size, real = sum(part.width for part in parts), any(part.kind == "reals" for part in parts)
        if not 1 <= size <= (_native.THRESHOLDS_COMPONENTS_MAX if real else _native.BITS_MAX):
            kind = "components" if real else "bits"
            raise SpaceError(
                f"the space needs {size} {kind}, and a percept has 1 to {_native.BITS_MAX}: pass an "
                "encoder, for pictures an rlvc.vision.Eye"
            )
        cutpoints = whole("thresholds", thresholds, 0, _native.THRESHOLDS_CUTPOINTS_MAX)
        self.domain = Thresholds(size, cutpoints) if real else Bits(size)
        given = [None] * sum(part.size for part in parts) if names is None else list(names)
        self._parts, self._thresholds, self._given = parts, cutpoints, given
        self.names: list[str] = []
        self.flags: list[bool] = []
        self.elements: list[tuple[str, list[int]]] = []
        at = 0
        for part in parts:
            for element, columns in part.described(given[at : at + part.size]):
                first = len(self.names)
                self.names += columns
                self.elements.append((element, list(range(first, len(self.names)))))
            self.flags += [part.kind != "reals"] * (len(self.names) - len(self.flags))
            at += part.size
        self._bytes = self.domain.percept_bytes
        # Of one Discrete every percept is known beforehand.
        self._table = parts[0].table(real) if len(parts) == 1 and parts[0].path == () else None
        self._first = parts[0].starts[0] if self._table else 0
        flat = np.frombuffer(
            b"".join(self._table or [bytes(self._bytes)]), self.domain.percept_dtype
        )
        self._rows = flat.reshape(-1, *self.domain.percept_shape)
        table = all(
            len(p.path) == 1 and p.kind in ("reals", "word") and p.shape == () for p in parts
        )
        self._columns = [str(part.path[0]) for part in parts] if table else []
        shifts = np.cumsum([0, *(part.width for part in parts)]).tolist()
        self._shifted = list(zip(parts, shifts[:-1], strict=True))

    def fits(self, space: Any) -> bool:
        """Whether it encodes the observations of a space as it was made to.

        Parameters
        ----------
        space : gymnasium.Space, or one of the spaces of logs in this module

        Returns
        -------
        bool
            An encoder of a table takes rows of any space, and looks at each as it comes: True.

        Raises
        ------
        SpaceError
            A part of the space cannot be encoded.
        """
        return bool(self._columns) or _parts(space) == self._parts

    def to_json(self) -> str:
        """Return what the encoder was made of, as JSON; :meth:`from_json` makes it again."""
        made_of = {
            "parts": [part.to_dict() for part in self._parts],
            "thresholds": self._thresholds,
            "names": self._given,
        }
        return json.dumps(made_of)

    @classmethod
    def from_json(cls, text: str) -> Encoder:
        """Make an encoder of the text of :meth:`to_json`.

        Parameters
        ----------
        text : str

        Returns
        -------
        Encoder

        Raises
        ------
        SpaceError
            The text is not one of :meth:`to_json`.
        """
        encoder = cls.__new__(cls)
        try:
            made_of = json.loads(text)
            parts = [Part.from_dict(part) for part in made_of["parts"]]
            names = [None if name is None else str(name) for name in made_of["names"]]
            if len(names) != sum(part.size for part in parts):
                raise SpaceError(f"{len(names)} names")
            encoder._settle(parts, made_of["thresholds"], names)
        except Exception as error:  # members of any kind
            raise SpaceError(f"not the text of an encoder's to_json(): {told(error)}") from error
        return encoder

    def __getstate__(self) -> dict[str, Any]:
        """Pickle what it was made of."""
        return {"made_of": self.to_json()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Make it again."""
        (text,) = pickled(state, "made_of")
        self.__dict__ |= Encoder.from_json(text).__dict__

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
        if self._table is not None:
            try:
                index = observation.__index__() - self._first
                if index >= 0:
                    record: bytes = self._table[index]
                    return record
            except Exception:
                pass  # the way below says what is wrong, or takes an array of one
        if self._columns:
            observation = self._by_name(observation)
        if isinstance(self.domain, Bits):
            code = 0
            for part, shift in self._shifted:
                code |= part.code(observation) << shift
            return bytes(code.to_bytes(self._bytes, "little"))
        if len(self._parts) == 1:
            return self._parts[0].record(observation)
        return b"".join([part.record(observation) for part in self._parts])

    def _by_name(self, observation: Any) -> Any:
        """Give a row of a table the names of its columns."""
        if not self._columns or hasattr(observation, "keys"):
            return observation
        try:
            row = list(observation)
        except TypeError:
            row = [observation]
        if len(row) != len(self._columns):
            raise PerceptError(
                f"observation: {shown(observation)} has {len(row)} elements, expected "
                f"{', '.join(self._columns)}"
            )
        return dict(zip(self._columns, row, strict=True))

    def is_batch(self, observation: Any) -> bool:
        """Whether this is a batch of observations, and not one.

        Parameters
        ----------
        observation : element of the space, or arrays of n of them

        Returns
        -------
        bool
        """
        part = self._parts[0]
        try:
            if self._columns and not hasattr(observation, "keys"):
                return np.ndim(observation[0]) > 0  # rows of a table
            value = part.of(observation)
            return np.ndim(value) > len(part.shape) and (part.size > 1 or np.shape(value) != (1,))
        except Exception:  # to encode it says what is wrong
            return False

    def encode_many(self, observations: Any) -> npt.NDArray[Any]:
        """Encode a batch as vector environments return it: arrays [n, ...], in dicts or tuples.

        Parameters
        ----------
        observations : batch of n elements of the space

        Returns
        -------
        ndarray, [n, *percept_shape] of the domain
        """
        if self._table is not None:
            indices = array("observations", observations, PerceptError)
            if indices.dtype.kind in "iu" and indices.ndim == 1 and len(indices):
                indices = indices - self._first
                if indices.min() >= 0 and indices.max() < len(self._rows):
                    return np.asarray(self._rows[indices])
        try:
            if self._columns and not hasattr(observations, "keys"):
                rows = zip(*(self._by_name(row).values() for row in observations), strict=True)
                observations = dict(zip(self._columns, rows, strict=True))
            columns = [part.columns(part.of(observations)) for part in self._parts]
            joined = columns[0] if len(columns) == 1 else np.concatenate(columns, axis=1)
        except PerceptError:
            raise
        except Exception as error:
            raise PerceptError(f"a batch that is not of the space: {told(error)}") from error
        if isinstance(self.domain, Bits):
            packed = np.packbits(joined.astype(np.bool_), axis=1, bitorder="little")
            return np.ascontiguousarray(packed)
        return np.ascontiguousarray(joined, np.float32)

    def values(self, percept: Any) -> list[float]:
        """Return the bits or components of a percept.

        Parameters
        ----------
        percept : bytes or ndarray

        Returns
        -------
        list of float
        """
        if isinstance(self.domain, Bits):
            raw = np.frombuffer(self.domain.pack(percept), np.uint8)
            bits = np.unpackbits(raw, bitorder="little")[: self.domain.bits]
            return [float(bit) for bit in bits]
        return [float(value) for value in np.frombuffer(self.domain.pack(percept), np.float32)]

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
        return explain(text, self.names, self.flags)
