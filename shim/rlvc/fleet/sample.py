# SPDX-License-Identifier: MIT
"""A sample of the percepts of a fleet: those with the lowest hashes, so that no sharding changes it."""

from __future__ import annotations

import dataclasses

import numpy as np
import numpy.typing as npt

_ODD = np.uint64(0x9E3779B97F4A7C15)
_SHIFT = np.uint64(32)


def hashes(percepts: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint64]:
    """Return a hash of each percept's bytes.

    Parameters
    ----------
    percepts : ndarray of uint8, [n, bytes]
    """
    words = -(-percepts.shape[1] // 8)
    padded = np.zeros((len(percepts), 8 * words), np.uint8)
    padded[:, : percepts.shape[1]] = percepts
    made = np.zeros(len(percepts), np.uint64)
    for word in padded.view("<u8").T:
        made ^= word
        made *= _ODD
        made ^= made >> _SHIFT
    made *= _ODD
    return made


@dataclasses.dataclass(frozen=True)
class Sample:
    """Distinct percepts, by ascending hash.

    Attributes
    ----------
    percepts : ndarray of uint8, [at most room, bytes]
    room : int
        How many are kept.
    """

    percepts: npt.NDArray[np.uint8]
    room: int

    def __add__(self, other: Sample) -> Sample:
        """Return the sample of both."""
        return self.with_more(other.percepts)

    def with_more(self, percepts: npt.NDArray[np.uint8]) -> Sample:
        """Return the sample of these percepts as well.

        Parameters
        ----------
        percepts : ndarray of uint8, [n, bytes]
        """
        found, sample = hashes(percepts), self
        start, size = 0, 2 * self.room
        while start < len(found):  # the more are seen, the fewer of the rest are low enough
            some = slice(start, start + size)
            sample = sample._with(percepts[some], found[some])
            start, size = start + size, 2 * size
        return sample

    def _with(self, percepts: npt.NDArray[np.uint8], found: npt.NDArray[np.uint64]) -> Sample:
        if len(self.percepts) == self.room:
            low = found <= hashes(self.percepts[-1:])[0]
            percepts, found = percepts[low], found[low]
        if len(self.percepts):
            percepts = np.concatenate([self.percepts, percepts])
            found = np.concatenate([hashes(self.percepts), found])
        _, first = np.unique(found, return_index=True)
        return Sample(np.ascontiguousarray(percepts[first[: self.room]]), self.room)


def empty(size: int, room: int) -> Sample:
    """Return a sample of nothing.

    Parameters
    ----------
    size : int
        Bytes of a percept.
    room : int
    """
    return Sample(np.zeros((0, size), np.uint8), room)
