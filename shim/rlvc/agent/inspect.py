# SPDX-License-Identifier: MIT
"""The queries of an agent: none changes it."""

from __future__ import annotations

import ctypes
import dataclasses
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..domains.bags import Bags
from ..domains.domain import Domain, Percept
from ..errors import ArrayError, ConfigError
from .batch import checked
from .config import Config
from .learner import Learner
from .results import SOLUTIONS, Prediction, Split, Statistics

_predict = _native.call.rlvc_predict
_byref = ctypes.byref


class Queries(Learner[Domain, Config]):
    """The queries of :class:`rlvc.Agent`."""

    def _make(self, *arguments: Any) -> None:
        """Make the agent, and the memory for results of C."""
        super()._make(*arguments)
        self._class = ctypes.c_uint32()
        self._answers = (_byref(self._class), _byref(self._action))

    def __repr__(self) -> str:
        """Describe the agent."""
        if self._handle is None:
            return "<rlvc.Agent, closed>" if self._address is None else "<rlvc.Agent, in use>"
        s = self.statistics
        return f"<rlvc.Agent of {s.classes} classes after {s.interactions} interactions>"

    def predict(
        self,
        percept: Percept,
        out: tuple[npt.NDArray[np.uint32] | None, npt.NDArray[np.uint32] | None] | None = None,
    ) -> Prediction:
        """Return the class and the greedy action of a percept, or of each percept of an array.

        Parameters
        ----------
        percept : bytes, or ndarray [*percept_shape] or [n, *percept_shape]
            One percept, or n percepts.
        out : pair of ndarray of uint32, [n], or None
            With n percepts: the arrays for the classes and the actions. Either may be None.

        Returns
        -------
        Prediction
            (class_id, action): ints, or arrays [n].

        Raises
        ------
        PerceptError
            A percept has the wrong size, dtype or shape, or the array is not C-contiguous.
        ArrayError
            ``out`` has the wrong dtype or shape, is not C-contiguous, or is read-only.
        """
        if not self._is_one(percept):
            return self._predict_many(percept, out)
        status = _predict(self._handle, self._pack(percept), *self._answers)
        if status:
            self._fail(status)
        return Prediction(self._class.value, self._action.value)

    def weigh(self, percept: Percept) -> Prediction:
        """Return the class of a percept by the weight of evidence, and its greedy action.

        Of a domain of bags (:class:`rlvc.Bags`), for places that differ from those of learning.
        Before clutter, partly covered, or from another side a thing may show less of its bag than is
        needed, so that :meth:`predict` goes astray. Here each class weighs as the product, over the
        bags of which its percepts have enough, of the score in parts of what is needed; a class
        that is told by what its percepts have not weighs 0.4 of that. The heaviest is the answer.
        Where nothing differs from learning, :meth:`predict` is right a little more often.

        Parameters
        ----------
        percept : bytes, or ndarray as the domain's ``pack`` takes it
            One percept.

        Returns
        -------
        Prediction
            (class_id, action).

        Raises
        ------
        ConfigError
            The domain is not of bags.
        PerceptError
            The percept has the wrong size, dtype or shape, or an element out of range.
        """
        domain = self._domain
        if not isinstance(domain, Bags):
            raise ConfigError("weigh: the agent's domain is not of bags (rlvc.Bags)")
        feature = np.empty(self._native_domain.feature_bytes // 4, np.uint32)  # aligned to 4
        weights = np.empty(self.classes, np.float32)
        status = _native.call.rlvc_bags_weigh(
            _byref(domain._made),
            self._handle,
            self._pack(percept),
            feature.ctypes.data,
            weights.ctypes.data,
            *self._answers,
        )
        if status:
            self._fail(status)
        return Prediction(self._class.value, self._action.value)

    def _predict_many(self, percepts: Any, out: Any) -> Prediction:
        packed = self._pack_many(percepts)
        count = len(packed)
        if out is None:
            out = (np.empty(count, np.uint32), np.empty(count, np.uint32))
        elif not isinstance(out, tuple) or len(out) != 2:
            raise ArrayError("out: must be a pair of arrays")
        pointers: list[int | None] = []
        for array in out:
            if array is not None and not checked(array, "out", "uint32", (count,)).flags.writeable:
                raise ArrayError("out: read-only")
            pointers.append(None if array is None else array.ctypes.data)
        done = ctypes.c_size_t()
        status = self._long(
            "rlvc_shim_predict",
            packed.ctypes.data,
            self._native_domain.percept_bytes,
            count,
            *pointers,
            _byref(done),
        )
        if status:
            self._fail(status, done.value)
        return Prediction(*out)

    @property
    def statistics(self) -> Statistics:
        """Statistics of the agent."""
        native = _native.Statistics()
        self._check(_native.call.rlvc_stats(self._handle, _byref(native)))
        numbers = [getattr(native, field.name) for field in dataclasses.fields(Statistics)]
        numbers[-1] = SOLUTIONS[native.solution]
        return Statistics(*numbers)

    @property
    def classes(self) -> int:
        """Number of classes: leaves of the tree."""
        return self.statistics.classes

    def _tables(self) -> tuple[npt.NDArray[Any], ...]:
        classes, actions = self.classes, self._config.actions
        tables: tuple[npt.NDArray[Any], ...] = (
            np.empty((classes, actions), np.float32),
            np.empty((classes, actions), np.uint32),
            np.empty(classes, np.float32),
            np.empty(classes, np.uint32),
        )
        pointers = (table.ctypes.data for table in tables)
        self._check(self._long("rlvc_shim_tables", classes, actions, *pointers))
        return tables

    @property
    def q(self) -> npt.NDArray[np.float32]:
        """Q(class, action) of the last solution, float32 [classes, actions], in units of return."""
        return self._tables()[0]

    @property
    def samples(self) -> npt.NDArray[np.uint32]:
        """Number of interactions behind each Q, uint32 [classes, actions]; 0: untried."""
        return self._tables()[1]

    @property
    def values(self) -> npt.NDArray[np.float32]:
        """V(class) of the last solution, float32 [classes], in units of return."""
        return self._tables()[2]

    @property
    def policy(self) -> npt.NDArray[np.uint32]:
        """The greedy action of each class, uint32 [classes]."""
        return self._tables()[3]

    @property
    def splits(self) -> list[Split]:
        """The splits of the tree, oldest first."""
        native = _native.Split()
        record = ctypes.create_string_buffer(self._native_domain.feature_bytes)
        splits = []
        for index in range(self.classes - 1):
            status = _native.call.rlvc_split_at(self._handle, index, _byref(native), record)
            self._check(status)
            feature = self._domain.feature(record.raw)
            action = native.action if native.action < self._config.actions else None
            splits.append(
                Split(
                    index,
                    native.class_id,
                    feature,
                    self._domain.name(feature),
                    native.step,
                    action,
                    native.samples,
                    native.action > self._config.actions,
                    native.log_tests,
                    native.score,
                    native.log_p,
                )
            )
        return splits

    def check(self) -> None:
        """Check every invariant of the agent's memory; ``core/SPEC.md`` lists them.

        Raises
        ------
        BlockError
            The memory is corrupt.
        """
        self._check(self._long("rlvc_agent_check"))
