# SPDX-License-Identifier: MIT
"""Logs in Minari data sets."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..errors import Error, LogError
from ..learning.actions import actions_of, indices_of
from ..learning.interact import ends_of
from .log import Log, checked


def from_minari(
    dataset: Any, bins: int | None = None, episodes: Sequence[int] | None = None
) -> Log:
    """Read a log from a Minari data set, with its spaces.

    Parameters
    ----------
    dataset : minari.MinariDataset or str
        A str is the name of a local data set. ``exploited`` is read from the infos, if it is there.
    bins : int or None
        If actions are a Box: into how many numbers each element is divided; the nearest is taken.
    episodes : sequence of int or None
        Which are read. None: all.
    """
    if isinstance(dataset, str):
        dataset = _loaded(dataset)
    name = str(dataset.spec.dataset_id)
    parts: dict[str, list[Any]] = {key: [] for key in ("before", "after", "a", "r", "e", "x")}
    for episode in dataset.iterate_episodes(episodes):
        where = f"{name}: episode {episode.id}"
        count = len(episode.actions)
        seen = _observations(episode.observations)
        if len(seen) != count + 1:
            raise LogError(f"{where}: {len(seen)} observations for {count} actions")
        if count == 0:
            continue
        ends = ends_of(episode.terminations, episode.truncations)
        if ends[-1] == 0:
            ends[-1] = 2
        early = np.flatnonzero(ends[:-1])
        if len(early):
            raise LogError(f"{where}: index {early[0]}: ends before its last interaction")
        parts["before"] += seen[:-1]
        parts["after"] += seen[1:]
        parts["a"].append(np.asarray(episode.actions))
        parts["r"].append(np.asarray(episode.rewards, np.float32))
        parts["e"].append(ends)
        infos = episode.infos or {}
        if "exploited" in infos:
            parts["x"].append(np.asarray(infos["exploited"], np.bool_)[-count:])
    if not parts["a"]:
        raise LogError(f"{name}: there is no interaction")
    actions, known = _actions(np.concatenate(parts["a"]), dataset.spec.action_space, bins, name)
    rewards, ends = np.concatenate(parts["r"]), np.concatenate(parts["e"])
    exploited = np.concatenate(parts["x"]) if parts["x"] else None
    if exploited is not None and len(exploited) != len(actions):
        raise LogError(
            f"{name}: infos: exploited: {len(exploited)} of them for {len(actions)} actions"
        )
    space = dataset.spec.observation_space
    notes = [f"observation: {space}"]
    before, after = parts["before"], parts["after"]
    return checked(Log(before, after, actions, rewards, ends, exploited, name, known, space, notes))


def _actions(values: Any, space: Any, bins: int | None, name: str) -> tuple[Any, Any]:
    try:
        known = actions_of(space, bins)
    except Error as error:
        raise LogError(f"{name}: actions: {error}") from None
    if bins is not None and known.table is not None:
        flat = known.table.reshape(known.count, -1).astype(np.float64)
        rows = values.reshape(len(values), -1).astype(np.float64)
        return np.abs(rows[:, None] - flat[None]).sum(axis=2).argmin(axis=1), known
    return indices_of(values, known, name), known


def _loaded(name: str) -> Any:
    try:
        import minari
    except ImportError:
        raise ImportError("Minari data sets need Minari: pip install 'rlvc[logs]'") from None
    try:
        return minari.load_dataset(name)
    except (OSError, ValueError, KeyError) as error:
        raise LogError(f"{name}: no such file, and no Minari data set: {error}") from error


def _observations(observations: Any) -> list[Any]:
    if isinstance(observations, dict):
        parts = {key: _observations(value) for key, value in observations.items()}
        count = len(next(iter(parts.values())))
        return [{key: value[i] for key, value in parts.items()} for i in range(count)]
    if isinstance(observations, tuple):
        return list(zip(*(_observations(value) for value in observations), strict=True))
    return list(observations)
