# SPDX-License-Identifier: MIT
"""The planner: learns a small tree on real numbers, by searching in a learnt model of the world."""

from __future__ import annotations

import ctypes

import numpy as np
import numpy.typing as npt

from .. import _native
from ..checks import whole
from ..domains.domain import Percept
from ..domains.thresholds import Thresholds
from ..errors import PerceptError
from .learner import Learner
from .planned_policy import PlannedPolicy
from .planner_config import PlannerConfig, to_native
from .results import PlannerStatistics, Progress

_act_at = _native.call.rlvc_planner_act_at
_predict = _native.call.rlvc_predict
_byref = ctypes.byref


class Planner(Learner[Thresholds, PlannerConfig]):
    """Learns a small decision tree on real numbers from rewards alone.

    It fits a model of what each action changes, searches in that model for a small tree of tests
    x[i] > c that earns much, and lets the tree act for an episode. The real returns decide between
    the trees that were tried. It maximises the sum of the rewards of an episode, without a discount.

    Parameters
    ----------
    domain : Thresholds or int
        The percepts; an int is the number of components, [1, 64].
    config : PlannerConfig or int
        How to learn; an int is the number of actions, with the defaults for the rest.
    **changes
        Fields of the config to change.

    Raises
    ------
    ConfigError
        A field of the config is out of range, or the domain is not one of real numbers.
    BlockError
        There is not enough memory.

    Notes
    -----
    Use a planner from one thread at a time, as an :class:`rlvc.Agent`. A percept is float32
    [components], each element in [-1e9, 1e9]. Source: ``core/include/rlvc/planner.h``.

    Examples
    --------
    >>> import numpy as np
    >>> planner = Planner(1, 2, random=32)
    >>> random, x = np.random.default_rng(1), np.zeros(1, np.float32)
    >>> for _ in range(200):
    ...     planner.begin(x)
    ...     action = planner.act()
    ...     x, reward = random.random(1, np.float32), float((x[0] > 0.5) == action)
    ...     planner.observe(action, reward, x, terminated=True)
    ...     _ = planner.learn()
    >>> planner.statistics.episodes
    200
    """

    _noun = "planner"

    _size = "rlvc_planner_ample_size"
    _slice = 1 << 22
    _end_is_seen = True
    _config_type = PlannerConfig

    @staticmethod
    def _domain_of(domain: Thresholds | int) -> Thresholds:
        if isinstance(domain, Thresholds):
            return domain
        return Thresholds(whole("domain", domain, 1, _native.PLANNER_COMPONENTS_MAX))

    _to_native = staticmethod(to_native)

    def _fail(self, status: int, index: int | None = None) -> None:
        if status == _native.E_PERCEPT:
            where = "" if index is None else f"percept {index}: "
            raise PerceptError(f"{where}an element is beyond {_native.PLANNER_NUMBER_MAX:g}")
        super()._fail(status, index)

    # -------------------------------------------------------------- acting and observing

    def act(self) -> int:
        """Choose an action for the current percept, by the policy that acts in this episode.

        Returns
        -------
        int

        Raises
        ------
        OrderError
            There is no current percept: call :meth:`begin` first.
        """
        return self._act().action

    def act_at(self, percept: Percept) -> int:
        """Choose an action for any percept, by the policy that acts in the next episode.

        For episodes in several environments at once. Each is observed when it has ended, by
        :meth:`begin` and :meth:`observe`, before the next step of learning.

        Parameters
        ----------
        percept : bytes or ndarray of float32, [components]

        Returns
        -------
        int

        Raises
        ------
        PerceptError
            The percept has the wrong size, dtype or shape, or an element out of range.
        """
        self._check(_act_at(self._handle, self._pack(percept), _byref(self._action)))
        return self._action.value

    def predict(self, percept: Percept) -> int | npt.NDArray[np.uint32]:
        """Return the action of the learnt policy at a percept, or at each percept of an array.

        Parameters
        ----------
        percept : bytes, or ndarray of float32, [components] or [n, components]
            One percept, or n percepts.

        Returns
        -------
        int or ndarray of uint32, [n]
            0 while nothing is learnt.

        Raises
        ------
        PerceptError
            A percept has the wrong size, dtype or shape, or an element out of range, or the array
            is not C-contiguous.
        """
        if self._is_one(percept):
            answer = _byref(self._action)
            self._check(_predict(self._handle, self._pack(percept), None, answer))
            return self._action.value
        packed = self._pack_many(percept)
        actions, done = np.empty(len(packed), np.uint32), ctypes.c_size_t()
        status = self._long(
            "rlvc_shim_predict",
            packed.ctypes.data,
            self._native_domain.percept_bytes,
            len(packed),
            None,
            actions.ctypes.data,
            _byref(done),
        )
        self._check(status, done.value)
        return actions

    # -------------------------------------------------------------- learning

    def learn(self, budget: int | None = None) -> Progress:
        """Do a learning step, if an episode ended since the last: chooses the next episode's policy.

        Parameters
        ----------
        budget : int or None
            Maximum work of this call, in multiplications of floats, [``budget_min``, 2**32 - 1]; call
            again until the result is ``done``. None: do the whole step. Ctrl-C interrupts it.

        Returns
        -------
        Progress
            Its ``rounds`` and ``splits`` are 0.

        Raises
        ------
        RangeError
            ``budget`` is out of range.

        Notes
        -----
        What is learnt does not depend on the budgets. After Ctrl-C the next call continues where
        this one stopped. Other threads run meanwhile: the interpreter's lock is released.
        """
        return self._learn(budget)

    @property
    def statistics(self) -> PlannerStatistics:
        """Statistics of the planner."""
        native = _native.PlannerStatistics()
        self._check(_native.call.rlvc_planner_stats(self._handle, _byref(native)))
        return PlannerStatistics.of(native)

    # -------------------------------------------------------------- deploying

    def policy(self) -> PlannedPolicy:
        """Make a policy of what was learnt: to print, export, save, and act without the planner.

        Returns
        -------
        PlannedPolicy
            It is independent of the planner.
        """
        native, nodes = _native.PlannerTest(), []
        for index in range(2 * self.statistics.leaves - 1):
            self._check(_native.call.rlvc_planner_node(self._handle, index, _byref(native)))
            nodes.append((native.cutpoint, native.component, native.child, native.action))
        return PlannedPolicy(self._domain, self._config.actions, nodes)

    def __repr__(self) -> str:
        """Describe the planner."""
        if self._handle is None:
            return "<rlvc.Planner, closed>" if self._address is None else "<rlvc.Planner, in use>"
        s = self.statistics
        return f"<rlvc.Planner of {s.leaves} leaves after {s.interactions} interactions>"
