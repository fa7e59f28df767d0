# SPDX-License-Identifier: MIT
"""Reports: a run as JSON, which ``rlvc.plot`` draws.

``run_gridworld --json`` writes reports, too; ``tools/run_gridworld/REPORT.md`` describes their
members. A report of :func:`make` has the kind ``"rlvc learn"`` and the members ``method``
(``"classes"``, or ``"planner"``: then ``classes`` counts leaves), ``seed``, ``interactions``,
``classes``, ``depth``, ``last_split_step``, ``memory_bytes``, ``history`` (with ``mean_return`` in
place of ``optimal_cells``), ``names`` (of the bits or components), ``flags`` (which of them are 0 or
1), ``actions`` (their names, unless they are plain numbers), ``tree``, and ``warning``: why nothing
was learnt, empty if something was. Of a planner or a compact policy it has neither ``depth`` nor
``last_split_step``, and its tree has no values.
The Binary Gridworld adds ``maze``, ``cells``, ``cell_classes`` and ``cell_actions``. The Tiled
Gridworld with an :class:`rlvc.vision.Eye` adds ``maze``, ``cells``, ``cell``, ``objects`` and
``tests``: of a bag, ``object`` and ``angle`` are those of the picture that has most of it.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from . import files
from .agent.agent import Agent
from .checks import named
from .domains.bags import Bags
from .errors import RunError

VERSION = 1
_DRAWS = 8  # percepts of a cell with other distractors, which must all have the same class


def _cells(run: Any, env: Any) -> dict[str, Any]:
    from .envs import ACTIONS, BinaryGridworld

    world = getattr(env, "unwrapped", env)
    if not isinstance(world, BinaryGridworld):
        return {}
    maze = world.maze
    draws = [
        run.agent.predict(maze.percepts(world.distractors, seed=seed)) for seed in range(_DRAWS)
    ]
    free = np.array([list(row) for row in maze.rows]).ravel() == "."

    def agreed(answers: Any, names: Any) -> list[list[Any]]:
        table = np.stack(answers)
        same = (table == table[0]).all(axis=0) & free
        flat = [names(int(v)) if ok else None for v, ok in zip(table[0], same, strict=True)]
        return [flat[y * maze.width : (y + 1) * maze.width] for y in range(maze.height)]

    return {
        "maze": maze.rows,
        "cells": int(free.sum()),
        "cell_classes": agreed([draw.class_id for draw in draws], int),
        "cell_actions": agreed([draw.action for draw in draws], ACTIONS.__getitem__),
    }


def _seen(run: Any, env: Any) -> dict[str, Any]:
    """The objects in the cells of the Tiled Gridworld, and the places of the tests' features."""
    from .envs import ACTIONS, TiledGridworld

    world = getattr(env, "unwrapped", env)
    look = getattr(run.encoder, "look", None)
    if not isinstance(world, TiledGridworld) or look is None:
        return {}
    maze, objects = world.maze, world.objects
    sights = [[look(view) for view in views] for views in objects.pictures]
    places: dict[bytes, dict[str, Any]] = {}
    for number, views in enumerate(sights):
        for angle, sight in zip(objects.angles, views, strict=True):
            for vector, (x, y, _) in zip(sight.vectors, sight.points.tolist(), strict=True):
                place = {"object": number, "angle": angle, "x": x, "y": y}
                places.setdefault(vector.tobytes(), place)
    cells = []
    for cell, number in enumerate(world.object_of.tolist()):
        if number >= 0:
            answers = [run.agent.predict(sight.percept) for sight in sights[number]]
            actions = {answer.action for answer in answers}
            cells.append({
                "x": cell % maze.width,
                "y": cell // maze.width,
                "object": number,
                "classes": sorted({answer.class_id for answer in answers}),
                "action": ACTIONS[actions.pop()] if len(actions) == 1 else None,
            })  # fmt: skip
    tests = []
    for split in run.agent.splits:
        test = {"name": split.name, "class": split.class_id, "step": split.step}
        if isinstance(run.agent.domain, Bags):
            test |= _bag_of(split.feature, run.agent.domain, sights, objects.angles)
        else:
            test |= _places_of(split.feature, places)
        tests.append(test)
    listed = [
        {"name": name, "angle": objects.angles[0], "points": views[0].points.tolist()}
        for name, views in zip(objects.names, sights, strict=True)
    ]
    where = {"images": objects.folder or None, "poses": objects.angles}
    return {
        **({} if objects.folder is None else {"options": where}),
        "maze": maze.rows,
        "cells": len(cells),
        "cell": cells,
        "objects": listed,
        "tests": tests,
    }


def _places_of(feature: Any, places: dict[bytes, dict[str, Any]]) -> dict[str, Any]:
    """Where the vectors of a feature come from."""
    nowhere = dict.fromkeys(("object", "angle", "x", "y"))
    second = None
    if "scale" in feature.dtype.names and feature["scale"] > 0:
        found = places.get(feature["second"].tobytes())
        second = found and {"x": found["x"], "y": found["y"]}
    return {
        "radius": float(feature["radius"]),
        **places.get(feature["vector"].tobytes(), nowhere),
        "second": second,
        "bag": None,
    }


def _bag_of(feature: Any, domain: Bags, sights: Any, angles: Any) -> dict[str, Any]:
    """The picture that has most of a bag, and which points of it are like vectors of the bag."""
    wanted = feature["vectors"][: feature["count"]].astype(float)
    radius = domain.parameters[2]
    best: tuple[int, int, list[Any]] = 0, angles[0], []
    most = -1.0
    for number, views in enumerate(sights):
        for angle, sight in zip(angles, views, strict=True):
            vectors = sight.vectors.astype(float)
            if len(vectors) == 0:
                continue
            squares = ((wanted[:, None] - vectors) ** 2).sum(2)
            worth = np.maximum(radius**2 - squares.min(1), 0.0)
            if worth.sum() > most:
                points = sight.points[squares.argmin(1)[worth > 0]].tolist()
                most, best = worth.sum(), (number, angle, points)
    number, angle, points = best
    return {
        "radius": None,
        "object": number,
        "angle": angle,
        **dict.fromkeys(("x", "y", "second")),
        "bag": {
            "count": int(feature["count"]),
            "needed": float(feature["needed"]) / radius**2,
            "points": [{"x": x, "y": y} for x, y, _ in points],
        },
    }


def _tree_members(learner: Any) -> dict[str, Any]:
    """Members that the tree of an agent has, and that of a planner has not."""
    if not isinstance(learner, Agent):
        return {}
    statistics = learner.statistics
    return {"depth": statistics.depth, "last_split_step": statistics.last_split}


def _actions(run: Any) -> dict[str, Any]:
    """The names of the actions, unless they are the numbers of the tree."""
    if run.actions.plain():
        return {}
    return {"actions": [run.actions.name(index) for index in range(run.actions.count)]}


def make(run: Any, env: Any = None) -> dict[str, Any]:
    """Make the report of a run.

    Parameters
    ----------
    run : rlvc.Run
    env : gymnasium.Env or None
        The environment; a gridworld adds its maze with classes and actions.

    Returns
    -------
    dict
        Can be written as JSON.
    """
    history = [
        {
            "step": record.step,
            "interactions": record.interactions,
            "splits": record.splits,
            "classes": record.classes,
            "mean_return": None if math.isnan(record.mean_return) else record.mean_return,
        }
        for record in run.history
    ]
    return {
        "version": VERSION,
        "kind": "rlvc learn",
        "method": "classes" if isinstance(run.learner, Agent) else "planner",
        "seed": run.seed,
        "interactions": run.interactions,
        "classes": run.leaves,
        **_tree_members(run.acting),
        "memory_bytes": run.learner.memory_bytes,
        "warning": run.warning,
        **({} if env is None else {**_cells(run, env), **_seen(run, env)}),
        "names": getattr(run.encoder, "names", []),
        "flags": getattr(run.encoder, "flags", []),
        **_actions(run),
        "history": history,
        "tree": run.tree,
    }


def read(path: str | Path) -> dict[str, Any]:
    """Read a report from a file.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    dict

    Raises
    ------
    RunError
        It cannot be read, is not a report, or has another version.
    """
    try:
        report = json.loads(files.read(path).decode())
    except OSError as error:
        raise RunError(f"{named(path)}: cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise RunError(f"{path}: cannot be read: {error}") from error
    except json.JSONDecodeError as error:
        raise RunError(f"{path}: line {error.lineno}: is not JSON: {error.msg}") from error
    except (RecursionError, ValueError) as error:
        raise RunError(f"{path}: is no report of a run: {error}") from error
    if not isinstance(report, dict) or "version" not in report:
        raise RunError(f"{path}: is not the report of a run")
    if report["version"] != VERSION:
        raise RunError(f"{path}: has version {report['version']}, expected {VERSION}")
    return report
