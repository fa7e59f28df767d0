# SPDX-License-Identifier: MIT
"""Learning by a planner from a sample of a fleet's log of real numbers."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import _native
from ..agent.planner import Planner
from ..checks import whole
from ..domains.thresholds import Thresholds
from ..errors import ConfigError, LogError
from ..learning import planning
from ..learning.actions import Actions
from ..learning.run import Record
from .engines import Engine
from .episodes import Drawing, Rows
from .run import Bar, FleetRun, Report
from .sources import Source

SAMPLE = 4000  # interactions, unless something else is asked for


def refuse(asked: dict[str, Any]) -> None:
    """Raise ConfigError if something is asked for that goes with counts alone.

    Parameters
    ----------
    asked : dict
        Arguments; None: not asked for.
    """
    why = {
        "domain": "a planner's percepts are the numbers of the log",
        "reward_bits": "a planner learns from rewards as they are",
        "reward_grid": "a planner learns from rewards as they are",
        "checkpoint": "a planner's sample takes one pass",
    }
    for name, reason in why.items():
        if asked[name] is not None:
            raise ConfigError(f"{name}: {reason}: leave {name} out, or learn with method='classes'")


def drawing_of(source: Source, actions: int, sample: int | None, skip: bool) -> Drawing:
    """Return what is drawn from a log, or raise ConfigError if no planner learns from it.

    Parameters
    ----------
    source : Source
        Of real numbers.
    actions : int
    sample : int or None
        Interactions; None: 4000.
    skip : bool
        Whether files that are broken are left out.
    """
    names = tuple(source.encoder.names)
    why = planning.refusal(Thresholds(len(names)), actions)
    if why:
        raise ConfigError(f"method: {why}")
    most = _native.PLANNER_CAPACITY_MAX // 2
    room = whole("sample", SAMPLE if sample is None else sample, 64, most)
    return Drawing(names, actions, room, skip)


def planner_of(drawing: Drawing, seed: int, changes: dict[str, Any]) -> Planner:
    """Return a planner that has room for a sample.

    Parameters
    ----------
    drawing : Drawing
    seed : int
    changes : dict
        Fields of the config that the caller sets.
    """
    room = 2 * drawing.room  # percepts: each interaction may be an episode
    fields = {"sample": drawing.room, "capacity": room} | changes
    settings = planning.default_config(drawing.actions, drawing.room, seed, fields)
    if settings.capacity < room:
        raise ConfigError(f"capacity: {settings.capacity} is less than twice the sample, {room}")
    return Planner(Thresholds(len(drawing.names)), settings)


def learn(planner: Planner, source: Source, drawing: Drawing, engine: Engine, bar: Bar) -> FleetRun:
    """Draw a sample, and learn from it in one step.

    Parameters
    ----------
    planner : Planner
    source : Source
    drawing : Drawing
    engine : Engine
    bar : Bar
    """
    bar.begin(1)
    drawn, seen = engine.total(drawing, source.pieces, bar.note)
    episodes = drawn.chosen()
    if not episodes:
        raise LogError("the source holds no interaction")
    config = planner.config
    run = FleetRun(planner, source.encoder, config.seed, source.known or Actions(config.actions))
    for episode in episodes:
        _see(planner, episode)
        run.seen.add(episode["before"][0].tobytes())
    planner.learn()
    run.sample = np.zeros((0, planner.domain.percept_bytes), np.uint8)
    count = sum(len(episode) for episode in episodes)
    run.report = Report(1, 1, seen.rows, seen.bytes, count, seen.lost, seen.skipped)
    mean = float(np.mean([episode["reward"].sum(dtype=np.float64) for episode in episodes]))
    run.history.append(Record(1, count, run.leaves, 0, len(episodes), mean))
    return run


def _see(planner: Planner, episode: Rows) -> None:
    most = _native.PLANNER_NUMBER_MAX
    before, after = (episode[side].clip(-most, most) for side in ("before", "after"))
    planner.begin(before[0])
    last = len(episode) - 1
    for i, row in enumerate(episode):
        terminated = bool(row["end"] == _native.TERMINATED)
        cut = i == last and not terminated
        planner.observe(int(row["action"]), float(row["reward"]), after[i], terminated, cut)
