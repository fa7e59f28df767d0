# SPDX-License-Identifier: MIT
"""The world as the learner sees it (section 5): percepts, features, detector and refining oracle."""

from __future__ import annotations

import abc
from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from .. import _native
from ..errors import ConfigError, PerceptError
from .callbacks import Callbacks, Guard

Percept: TypeAlias = "bytes | npt.NDArray[Any]"


class Domain(abc.ABC):
    """A world of one's own: the kind of percepts and features, and three methods.

    Parameters
    ----------
    percept_dtype : dtype
        Of a percept's elements.
    percept_shape : tuple of int
        Of a percept; () for a single element.
    feature_dtype : dtype
        Of a feature: a number, or a structured type.
    features_max : int
        How many candidates there can be for one class, or 0 if that is not known; it only sizes
        memory.

    Notes
    -----
    A domain must not use the agent that calls it, and must give the same answer for the same
    arguments. An exception that one of its methods raises comes out of the agent's call that led to
    it. Besides the three methods, a domain may have

    - ``detect(percepts, features)``, with percepts [n, *percept_shape] and features [m]: a boolean
      array [n, m], to save calls of ``exhibits``;
    - ``oracle(percepts, below)``, with percepts [n, *percept_shape] by ascending target: the feature
      that best explains the partition into percepts[:below] and percepts[below:], and among how many
      it chose; or None. It replaces the search over ``candidates``.

    Source: ``core/include/rlvc/domain.h``.
    """

    detect: Callable[[Any, Any], Any] | None = None
    oracle: Callable[[Any, int], Any] | None = None

    def __init__(
        self,
        percept_dtype: npt.DTypeLike,
        percept_shape: tuple[int, ...] = (),
        feature_dtype: npt.DTypeLike = np.int32,
        features_max: int = 0,
    ) -> None:
        self.percept_dtype = np.dtype(percept_dtype)
        self.percept_shape = tuple(percept_shape)
        self.feature_dtype = np.dtype(feature_dtype)
        self.features_max = features_max
        if self.percept_dtype.hasobject or self.feature_dtype.hasobject:
            raise ConfigError(
                "a percept and a feature are values: no Python objects in their dtype"
            )
        self.percept_bytes = self.percept_dtype.itemsize * int(
            np.prod(self.percept_shape, dtype=int)
        )
        self.feature_bytes = self.feature_dtype.itemsize
        if not 1 <= self.percept_bytes <= 2**20:
            raise ConfigError(f"a percept has {self.percept_bytes} bytes, not 1 to 2^20")
        if not 1 <= self.feature_bytes <= 2**16:
            raise ConfigError(f"a feature has {self.feature_bytes} bytes, not 1 to 2^16")

    @abc.abstractmethod
    def exhibits(self, percept: npt.NDArray[Any], feature: Any) -> bool:
        """Whether a percept exhibits a feature.

        Parameters
        ----------
        percept : ndarray, percept_shape
            Read-only.
        feature : scalar of feature_dtype

        Returns
        -------
        bool
        """

    @abc.abstractmethod
    def candidates(self, percepts: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """List the features among which a class's split is searched (section 4.2.3).

        Parameters
        ----------
        percepts : ndarray, [n, *percept_shape]
            Those of the class and an action, by ascending target.

        Returns
        -------
        ndarray, [features], of feature_dtype
            The earlier of two that score alike wins.
        """

    @abc.abstractmethod
    def name(self, feature: Any) -> str:
        """Name a feature, in at most 63 bytes without quote, backslash or control character.

        Parameters
        ----------
        feature : scalar of feature_dtype

        Returns
        -------
        str
        """

    def pack(self, percept: Percept) -> bytes:
        """Give the record of a percept.

        Parameters
        ----------
        percept : bytes of percept_bytes, or ndarray of percept_dtype and percept_shape

        Returns
        -------
        bytes

        Raises
        ------
        PerceptError
            It is of another size, dtype or shape.
        """
        if isinstance(percept, bytes):
            if len(percept) != self.percept_bytes:
                raise PerceptError(f"a percept of {len(percept)} bytes, not {self.percept_bytes}")
            return percept
        if not isinstance(percept, np.ndarray | np.generic):
            raise PerceptError(f"a percept is bytes or an array, not {type(percept).__name__}")
        if percept.dtype != self.percept_dtype or percept.shape != self.percept_shape:
            raise PerceptError(
                f"a percept of {percept.dtype}{list(percept.shape)}, not "
                f"{self.percept_dtype}{list(self.percept_shape)}"
            )
        return percept.tobytes()

    def pack_many(self, percepts: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Check an array of percepts.

        Parameters
        ----------
        percepts : ndarray, [n, *percept_shape], of percept_dtype, C-contiguous

        Returns
        -------
        ndarray
            Itself, or another one whose memory holds the n records.

        Raises
        ------
        PerceptError
            It is of another dtype or shape, or not C-contiguous.
        """
        if not isinstance(percepts, np.ndarray):
            raise PerceptError(f"percepts are an array, not {type(percepts).__name__}")
        if percepts.dtype != self.percept_dtype or percepts.shape[1:] != self.percept_shape:
            raise PerceptError(
                f"percepts of {percepts.dtype}{list(percepts.shape)}, not "
                f"{self.percept_dtype}{['n', *self.percept_shape]}"
            )
        if not percepts.flags.c_contiguous:
            raise PerceptError(
                "percepts are not C-contiguous: numpy.ascontiguousarray makes them so"
            )
        return percepts

    def is_one(self, percept: Any) -> bool:
        """Whether this is one percept rather than an array of them."""
        return isinstance(percept, bytes) or np.ndim(percept) == len(self.percept_shape)

    def feature(self, record: bytes) -> Any:
        """Give the feature whose record this is."""
        return np.frombuffer(record, self.feature_dtype)[0]

    def native(self, guard: Guard) -> _native.Domain:
        """Make the C struct, which keeps its callbacks alive.

        Parameters
        ----------
        guard : Guard
            Gets what the callbacks raise.

        Returns
        -------
        rlvc_domain
        """
        if not isinstance(self.features_max, int) or not 0 <= self.features_max < 2**32:
            raise ConfigError(f"features_max: {self.features_max!r} is out of range")
        return Callbacks(self, guard).native()
