# SPDX-License-Identifier: MIT
"""Encoders: from the observations of Gymnasium's spaces to percepts of bits.

==================  =====================================================================
space               bits
==================  =====================================================================
Discrete            the number less ``start``, in binary, lowest bit first
MultiDiscrete       each number likewise
MultiBinary         as they are
Box                 for each element, one bit a threshold: whether it lies above (a thermometer);
                    the thresholds are quantiles of observations made before
Dict, Tuple         their parts, one after another
==================  =====================================================================
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _lib
from .errors import PerceptError, SpaceError

Columns = npt.NDArray[np.bool_]


def _binary(values: Any, starts: Any, widths: Sequence[int]) -> Columns:
    """Numbers [n, d] in binary, of so many bits each, lowest first: [n, sum(widths)]."""
    numbers = (np.asarray(values, np.int64) - starts).reshape(-1, len(widths))
    columns = [numbers[:, i] >> bit & 1 for i, width in enumerate(widths) for bit in range(width)]
    return np.stack(columns, axis=1).astype(np.bool_)


def _width(count: int) -> int:
    return max(1, int(count - 1).bit_length())


class _Part:
    """A space without parts of its own: where it lies in an observation, and its bits."""

    def __init__(
        self,
        path: tuple[Any, ...],
        names: list[str],
        columns: Callable[[Any], Columns],
        accepts: Callable[[Any], bool],
    ) -> None:
        self.path = path
        self.names = names
        self.columns = columns
        self.accepts = accepts

    def of(self, observation: Any) -> Any:
        for key in self.path:
            observation = observation[key]
        return observation


def _thresholds(values: npt.NDArray[Any], most: int) -> npt.NDArray[Any]:
    """At most so many numbers that part the values into parts of about the same size."""
    distinct = np.unique(values[np.isfinite(values)])
    middles = distinct[:-1] + np.diff(distinct) / 2
    if len(middles) <= most:
        return middles
    return np.unique(np.quantile(values, np.arange(1, most + 1) / (most + 1)))


def _prefix(path: tuple[Any, ...]) -> str:
    return ".".join(str(key) for key in path)


def _box_part(space: Any, path: tuple[Any, ...], samples: list[Any], most: int) -> _Part:
    values = np.asarray(samples, np.float64).reshape(len(samples), -1)
    elements: list[int] = []
    limits: list[float] = []
    names: list[str] = []
    scalar = values.shape[1] == 1
    for i in range(values.shape[1]):
        for limit in _thresholds(values[:, i], most):
            elements.append(i)
            limits.append(float(limit))
            where = (_prefix(path) or "x") + ("" if scalar else f"[{i}]")
            names.append(f"{where} > {limit:.4g}")
    chosen, above = np.array(elements, np.intp), np.array(limits)

    def columns(batch: Any) -> Columns:
        rows = np.asarray(batch, np.float64)
        rows = rows.reshape(len(rows), -1)
        if np.isnan(rows).any():
            raise PerceptError("an observation has a NaN in it")
        return np.asarray(rows[:, chosen] > above)

    return _Part(path, names, columns, lambda value: np.shape(value) == space.shape)


class Numbers:
    """Arrays of numbers of one shape, encoded as a Box is; for logs, where Gymnasium may be missing.

    Parameters
    ----------
    shape : tuple of int
    """

    def __init__(self, shape: tuple[int, ...]) -> None:
        self.shape = shape


def _parts(space: Any, path: tuple[Any, ...], samples: list[Any], most: int) -> list[_Part]:
    if isinstance(space, Numbers):
        return [_box_part(space, path, samples, most)]
    from gymnasium import spaces

    label = _prefix(path)
    if isinstance(space, spaces.Dict):
        inner = [((*path, key), sub) for key, sub in space.spaces.items()]
        return [
            p
            for deeper, sub in inner
            for p in _parts(sub, deeper, [s[deeper[-1]] for s in samples], most)
        ]
    if isinstance(space, spaces.Tuple):
        return [
            p
            for i, sub in enumerate(space.spaces)
            for p in _parts(sub, (*path, i), [s[i] for s in samples], most)
        ]
    if isinstance(space, spaces.Discrete):
        width, start = _width(int(space.n)), int(space.start)
        names = [f"{label or 'number'} bit {bit}" for bit in range(width)]
        return [_Part(path, names, lambda v: _binary(v, start, [width]), space.contains)]
    if isinstance(space, spaces.MultiDiscrete):
        counts, starts = np.ravel(space.nvec), np.ravel(space.start)
        widths = [_width(int(count)) for count in counts]
        names = [
            f"{label or 'x'}[{i}] bit {bit}"
            for i, width in enumerate(widths)
            for bit in range(width)
        ]

        def multi(values: Any) -> Columns:
            return _binary(np.asarray(values).reshape(-1, len(widths)), starts, widths)

        return [_Part(path, names, multi, space.contains)]
    if isinstance(space, spaces.MultiBinary):
        size = int(np.prod(space.shape))
        names = [f"{label or 'x'}[{i}]" for i in range(size)]
        return [
            _Part(
                path,
                names,
                lambda v: np.asarray(v).reshape(-1, size).astype(np.bool_),
                lambda value: np.shape(value) == space.shape,
            )
        ]
    if isinstance(space, spaces.Box):
        return [_box_part(space, path, samples, most)]
    raise SpaceError(f"{label + ': ' if label else ''}cannot encode {space}")


def needs_samples(space: Any) -> bool:
    """Whether a space has a Box in it, whose thresholds come from observations.

    Parameters
    ----------
    space : gymnasium.Space

    Returns
    -------
    bool
    """
    if isinstance(space, Numbers):
        return True
    from gymnasium import spaces

    if isinstance(space, spaces.Dict):
        return any(needs_samples(sub) for sub in space.spaces.values())
    if isinstance(space, spaces.Tuple):
        return any(needs_samples(sub) for sub in space.spaces)
    return isinstance(space, spaces.Box)


class Encoder:
    """Turns the observations of a space into percepts of bits.

    Parameters
    ----------
    space : gymnasium.Space or Numbers
        Discrete, MultiDiscrete, MultiBinary, Box, or a Dict or Tuple of such.
    samples : sequence of observations
        From which a Box gets its thresholds.
    thresholds : int
        At most so many for each element of a Box.

    Attributes
    ----------
    bits : int
        Of a percept.
    names : list of str
        What each bit says.
    real : bool
        Whether some of them are thresholds of real numbers.

    Raises
    ------
    SpaceError
        The space cannot be encoded, or would need more than 1024 bits.
    """

    def __init__(self, space: Any, samples: Sequence[Any] = (), thresholds: int = 15) -> None:
        if needs_samples(space) and len(samples) == 0:
            raise SpaceError("a Box gets its thresholds from observations: give some as samples")
        self.real = needs_samples(space)
        self._parts = _parts(space, (), list(samples), thresholds)
        self.names = [name for part in self._parts for name in part.names]
        if not self.names:
            self.names = ["nothing"]  # observations that never differ
        self.bits = len(self.names)
        if self.bits > _lib.BITS_MAX:
            raise SpaceError(
                f"{space} would need {self.bits} bits, and a percept has at most {_lib.BITS_MAX}: "
                "give an encoder of your own, or for pictures an rlvc.vision.Eye"
            )

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
            It is no element of the space, or has a NaN in it.
        """
        columns = []
        for part in self._parts:
            try:
                value = part.of(observation)
            except (KeyError, IndexError, TypeError):
                raise PerceptError(f"an observation without {_prefix(part.path)!r}") from None
            if not part.accepts(value):
                raise PerceptError(
                    f"{_prefix(part.path) or 'observation'}: {value!r:.80} is not of its space"
                )
            columns.append(part.columns(np.asarray(value)[None])[0])
        return bytes(self._packed(np.concatenate(columns)[None])[0])

    def encode_many(self, observations: Any) -> npt.NDArray[np.uint8]:
        """Encode a batch, as vector environments give it: arrays [n, ...], in dicts or tuples.

        Parameters
        ----------
        observations : batch of n elements of the space

        Returns
        -------
        ndarray of uint8, [n, ceil(bits / 8)]
        """
        columns = [part.columns(np.asarray(part.of(observations))) for part in self._parts]
        return self._packed(np.concatenate(columns, axis=1))

    def _packed(self, columns: Columns) -> npt.NDArray[np.uint8]:
        if columns.shape[1] == 0:
            columns = np.zeros((len(columns), 1), np.bool_)
        return np.packbits(columns, axis=1, bitorder="little")

    def explain(self, text: str) -> str:
        """Replace ``bit N`` by what the bit says.

        Parameters
        ----------
        text : str
            A tree that ``Agent.print`` gave.

        Returns
        -------
        str
        """
        return explain(text, self.names)


def explain(text: str, names: Sequence[str]) -> str:
    """Replace ``bit N`` in a text by the N-th name.

    Parameters
    ----------
    text : str
    names : sequence of str

    Returns
    -------
    str
    """
    return re.sub(r"\bbit (\d+)\b", lambda match: names[int(match[1])], text)
