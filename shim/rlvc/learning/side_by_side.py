# SPDX-License-Identifier: MIT
"""Learning by a planner from a vector of environments, whose episodes go on side by side.

All environments follow one policy. When each has ended an episode that it began by that policy, the
planner learns, and all follow the next one. Episodes that are under way then began by the policy before:
what comes of them is observed, but their returns count for neither.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from .. import _native
from ..agent.planner import Planner
from .interact import Interaction
from .masks import best_allowed
from .run import Run


class Track:
    """An episode under way in one environment."""

    def __init__(self, first: Any, counts: bool) -> None:
        self.first = first
        self.counts = counts  # its return is that of the policy
        self.steps: list[tuple[int, float, Any, int]] = []  # action, reward, s' and how it ended

    @property
    def last(self) -> Any:
        """The percept that was seen last."""
        return self.steps[-1][2] if self.steps else self.first

    def observe(self, planner: Planner) -> None:
        """Give the planner all of the episode; of one that does not count, not its end."""
        if not self.steps:
            return
        planner.begin(self.first)
        for action, reward, percept, end in self.steps:
            ends = end if self.counts else 0
            if not self.counts and end == _native.TERMINATED:
                continue
            planner.observe(
                action, reward, percept, ends == _native.TERMINATED, ends == _native.TRUNCATED
            )


def episodes(run: Run, learner: Interaction) -> Iterator[None]:
    """Interact and learn; yield after each learning step.

    Parameters
    ----------
    run : Run
        Of a planner.
    learner : Interaction
        Of a vector.
    """
    planner, stream = run.planner, learner.stream
    tracks = [Track(run.percept(seen), True) for seen in stream.split(stream.current)]
    waiting = set(range(stream.count))
    while learner.done < learner.interactions:
        actions, resetting = _actions(run, learner, tracks), np.flatnonzero(stream.dead)
        live, reached, rewards, ends = learner.step_all(actions)
        listed = reached if isinstance(reached, list) else stream.split(reached)
        for j, i in enumerate(live.tolist()):
            percept = run.percept(listed[i])
            run.seen.add(percept.tobytes())
            tracks[i].steps.append((int(actions[i]), float(rewards[j]), percept, int(ends[j])))
        seen = stream.split(stream.current)
        for i in resetting.tolist():
            tracks[i].first = run.percept(seen[i])
        _renew(run, learner, tracks, waiting)
        if not waiting:
            waiting |= set(range(stream.count))
            for i, track in enumerate(tracks):
                track.observe(planner)
                tracks[i] = Track(track.last, not track.steps)
            planner.learn()
            yield


def _actions(run: Run, learner: Interaction, tracks: list[Track]) -> Any:
    """The action of each environment."""
    masks, actions = learner.stream.masks, np.zeros(len(tracks), np.int64)
    for i in np.flatnonzero(~learner.stream.dead).tolist():
        actions[i] = run.planner.act_at(tracks[i].last)
        if masks is not None:
            actions[i] = best_allowed(run, b"", int(actions[i]), masks[i])
    return actions


def _renew(run: Run, learner: Interaction, tracks: list[Track], waiting: set[int]) -> None:
    """Observe the episodes that have ended or reached the horizon, and begin the next ones."""
    stream, horizon = learner.stream, run.planner.config.horizon
    seen = stream.split(stream.current)
    for i, track in enumerate(tracks):
        over = bool(track.steps) and track.steps[-1][3] != 0
        if not over and len(track.steps) < horizon:
            continue
        track.observe(run.planner)
        if track.counts:
            waiting.discard(i)
        tracks[i] = Track(track.last if not over or stream.dead[i] else run.percept(seen[i]), True)
