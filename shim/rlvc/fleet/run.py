# SPDX-License-Identifier: MIT
"""What comes of a fleet's learning, and the bar that shows how far it is."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..agent.agent import Agent
from ..agent.results import CHOICE
from ..learning.run import Run


@dataclasses.dataclass(frozen=True)
class Report:
    """How a fleet's run came about.

    Attributes
    ----------
    passes, rounds : int
        Passes over the data, and rounds of the tree; of a planner steps of learning.
    interactions, bytes : int
        Of a pass.
    rows : int
        Of the last table of counts; of a planner the interactions of the sample.
    lost : int
        Interactions of a pass that were left out, as what came next is not in the log: in a LeRobot data
        set the last of episodes that are cut short.
    skipped : list of str
        Row groups that were left out, and why; empty unless that was asked for.
    """

    passes: int
    rounds: int
    interactions: int
    bytes: int
    rows: int
    lost: int
    skipped: list[str]


class FleetRun(Run):
    """A run of :func:`learn_from`.

    Attributes
    ----------
    report : Report
    sample : ndarray of uint8, [n, bytes]
        Distinct percepts, at most as many as the agent holds: what :meth:`compact` looks at. Of a
        planner there are none.
    """

    report: Report
    sample: npt.NDArray[np.uint8]

    def _seeing(self) -> Agent:
        """A copy of the agent that holds the sample, as interactions that end at once."""
        agent = Agent.restore(self.agent.domain, self.agent.config, self.agent.snapshot())
        count = len(self.sample)
        agent.observe_many(
            self.sample,
            np.zeros(count, CHOICE),
            np.zeros(count, np.float32),
            self.sample,
            np.full(count, _native.TERMINATED, np.uint8),
        )
        return agent

    @property
    def interactions(self) -> int:
        """Number that was learnt from."""
        return self.report.interactions


class Bar:
    """A progress bar over the interactions of a pass; nothing if none is wanted.

    Parameters
    ----------
    wanted : bool
    total : int
        Interactions; 0: unknown.
    """

    def __init__(self, wanted: bool, total: int) -> None:
        self._bar: Any = None
        if wanted:
            try:
                from tqdm import tqdm
            except ImportError:
                raise ImportError("a progress bar needs tqdm: pip install 'rlvc[fleet]'") from None
            self._bar = tqdm(total=total or None, unit=" interactions", unit_scale=True)

    def begin(self, number: int, **shown: int) -> None:
        """Begin a pass."""
        if self._bar is not None:
            self._bar.reset()
            self._bar.set_description(f"pass {number}")
            self._bar.set_postfix(**shown)

    def note(self, rows: int) -> None:
        """Go on by so many interactions."""
        if self._bar is not None:
            self._bar.update(rows)

    def close(self) -> None:
        """Leave it as it is."""
        if self._bar is not None:
            self._bar.close()
