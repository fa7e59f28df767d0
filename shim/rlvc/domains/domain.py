# SPDX-License-Identifier: MIT
"""The domain (section 5): percepts, features, feature detector and refining oracle."""

from __future__ import annotations

import abc
from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from .. import _native
from ..checks import array, shown, whole
from ..errors import ConfigError, DomainError, PerceptError
from .callbacks import Callbacks, Guard

Percept: TypeAlias = "bytes | npt.NDArray[Any]"

_SIZES = {"percept_dtype", "percept_shape", "percept_bytes", "feature_dtype", "feature_bytes"}


class Domain(abc.ABC):
    """Base class of user-defined domains: the types of percepts and features, and three methods.

    Parameters
    ----------
    percept_dtype : dtype
        Type of a percept's elements.
    percept_shape : tuple of int
        Shape of a percept; () for a single element.
    feature_dtype : dtype
        Type of a feature: a number, or a structured type.
    features_max : int
        The largest number of candidates for one class; 0: unknown. It only affects the size of the
        agent's memory.

    Notes
    -----
    The methods must not use the agent that calls them, and must return the same result for the same
    arguments. If one raises, the agent's method that called it raises the same exception. What they
    and ``pack`` return is checked. Types and sizes cannot be changed later. Four more methods are
    optional:

    - ``detect(percepts, features)`` replaces calls of ``exhibits``. It takes percepts
      [n, *percept_shape] and features [m], and returns bool [n, m].
    - ``oracle(percepts, below)`` replaces the search over ``candidates``. It takes percepts
      [n, *percept_shape], sorted by ascending target, and returns the feature that best explains
      the partition into percepts[:below] and percepts[below:], and the number of features it
      compared; or None if no feature does.
    - ``check_percept(percept)`` and ``check_feature(feature)`` return whether the values of a
      percept, and of a feature of a tree, are valid. Percepts are checked where an agent gets them,
      and both where a snapshot is loaded: its bytes may come from anywhere. Without these methods
      the others must be right for any values.

    Source: ``core/include/rlvc/domain.h``.
    """

    detect: Callable[[Any, Any], Any] | None = None
    oracle: Callable[[Any, int], Any] | None = None
    check_percept: Callable[[Any], bool] | None = None
    check_feature: Callable[[Any], bool] | None = None

    def __init__(
        self,
        percept_dtype: npt.DTypeLike,
        percept_shape: tuple[int, ...] = (),
        feature_dtype: npt.DTypeLike = np.int32,
        features_max: int = 0,
    ) -> None:
        try:
            self.percept_dtype = np.dtype(percept_dtype)
            self.feature_dtype = np.dtype(feature_dtype)
            shape = tuple(percept_shape)
        except (TypeError, ValueError) as error:
            raise ConfigError(f"the dtypes and the shape are numpy's: {error}") from None
        self.percept_shape = tuple(whole("percept_shape", size, 0, 2**20) for size in shape)
        self.features_max = whole("features_max", features_max, 0, 2**32 - 1)
        if self.percept_dtype.hasobject or self.feature_dtype.hasobject:
            raise ConfigError("the dtypes of percepts and features must not contain Python objects")
        self.percept_bytes = self.percept_dtype.itemsize * int(
            np.prod(self.percept_shape, dtype=int)
        )
        self.feature_bytes = self.feature_dtype.itemsize
        if not 1 <= self.percept_bytes <= 2**20:
            raise ConfigError(f"a percept has {self.percept_bytes} bytes, allowed are [1, 2**20]")
        if not 1 <= self.feature_bytes <= 2**16:
            raise ConfigError(f"a feature has {self.feature_bytes} bytes, allowed are [1, 2**16]")

    def __setattr__(self, name: str, value: Any) -> None:
        """Set an attribute, but keep the types and sizes that agents rely on."""
        if name in _SIZES and name in self.__dict__:
            raise DomainError(f"{name}: the types and sizes of a domain cannot be changed")
        super().__setattr__(name, value)

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
        """List the features among which the split of a class is searched (section 4.2.3).

        Parameters
        ----------
        percepts : ndarray, [n, *percept_shape]
            The percepts of the class and one action, by ascending target.

        Returns
        -------
        ndarray, [features], of feature_dtype
            If two features have the same score, the earlier one is chosen.
        """

    @abc.abstractmethod
    def name(self, feature: Any) -> str:
        """Return the name of a feature: at most 63 bytes, no quote, backslash or control character.

        Parameters
        ----------
        feature : scalar of feature_dtype

        Returns
        -------
        str
        """

    def pack(self, percept: Percept) -> bytes:
        """Return a percept as bytes.

        Parameters
        ----------
        percept : bytes of percept_bytes, or ndarray of percept_dtype and percept_shape

        Returns
        -------
        bytes

        Raises
        ------
        PerceptError
            The percept has the wrong size, dtype or shape.
        """
        if isinstance(percept, bytes):
            if len(percept) != self.percept_bytes:
                raise PerceptError(
                    f"a percept has {len(percept)} bytes, expected {self.percept_bytes}"
                )
            return percept
        if not isinstance(percept, np.ndarray | np.generic):
            raise PerceptError(f"a percept must be bytes or an array, not {type(percept).__name__}")
        if percept.dtype != self.percept_dtype or percept.shape != self.percept_shape:
            raise PerceptError(
                f"a percept is {percept.dtype}{list(percept.shape)}, expected "
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
            The same array, or a packed copy.

        Raises
        ------
        PerceptError
            The array has the wrong dtype or shape, or is not C-contiguous.
        """
        if not isinstance(percepts, np.ndarray):
            raise PerceptError(f"percepts must be an array, not {type(percepts).__name__}")
        if percepts.dtype != self.percept_dtype or percepts.shape[1:] != self.percept_shape:
            raise PerceptError(
                f"percepts are {percepts.dtype}{list(percepts.shape)}, expected "
                f"{self.percept_dtype}{['n', *self.percept_shape]}"
            )
        if not percepts.flags.c_contiguous:
            raise PerceptError("percepts are not C-contiguous: use numpy.ascontiguousarray")
        return percepts

    def check_many(self, packed: npt.NDArray[Any]) -> None:  # noqa: B027 - any value may be valid
        """Raise :class:`~rlvc.errors.PerceptError` if a percept of an array has an invalid value."""

    def is_one(self, percept: Any) -> bool:
        """Whether this is a single percept, not an array of percepts."""
        return isinstance(percept, bytes) or array(
            "percept", percept, PerceptError
        ).ndim == len(self.percept_shape)

    def feature(self, record: bytes) -> Any:
        """Return the feature with these bytes."""
        if not isinstance(record, bytes) or len(record) != self.feature_dtype.itemsize:
            raise DomainError(f"{shown(record)} is not {self.feature_dtype.itemsize} bytes")
        return np.frombuffer(record, self.feature_dtype)[0]

    def native(self, guard: Guard) -> _native.Domain:
        """Make the C struct, which keeps its callbacks alive.

        Parameters
        ----------
        guard : Guard
            Receives the exceptions of the callbacks.

        Returns
        -------
        rlvc_domain
        """
        return Callbacks(self, guard).native()
