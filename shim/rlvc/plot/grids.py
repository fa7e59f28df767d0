# SPDX-License-Identifier: MIT
"""The policy on the maps of Gymnasium's FrozenLake, CliffWalking and Taxi."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from ..errors import RunError
from .drawing import ARROWS, EXIT, GREY, WALL, Source, axes_of, run_of, save
from .mazes import arrow, write

_UP, _RIGHT, _DOWN, _LEFT = (ARROWS[name] for name in ("up", "right", "down", "left"))
_PASSENGER = "#cfe3f1"
_GAP = 1.3  # cells between the boards of Taxi


class _Map(NamedTuple):
    height: int
    width: int
    signs: dict[tuple[int, int], str]  # of cells (x, y): start, goal, hole, cliff
    moves: list[tuple[int, int]]  # of each action


def grid(source: Source, file: str | Path | None = None, env: Any = None, ax: Any = None) -> Figure:
    """Draw the action in each cell of FrozenLake, CliffWalking or Taxi.

    Needs a run that learnt there, and the environment ``env``, whose map is drawn. Taxi has one small
    board for each place of the passenger and each destination: axes of the caller should be at least 8
    inches wide.
    """
    run = run_of(source, "grid")
    world = getattr(env, "unwrapped", env)
    kind = type(world).__name__
    if kind not in ("FrozenLakeEnv", "CliffWalkingEnv", "TaxiEnv"):
        raise RunError(f"env: {kind}: give a FrozenLake, CliffWalking or Taxi")
    states = int(world.observation_space.n)
    bits = getattr(run.encoder, "names", [])
    if len(getattr(run.encoder, "elements", [])) != 1 or len(bits) != (states - 1).bit_length():
        raise RunError(f"env: the run does not observe the number of one of {states} states")
    chosen = run.indices(run.percepts(np.arange(states)))  # as without masks
    actions = run.actions.of_many(chosen).tolist()
    if kind == "TaxiEnv":
        figure, axes = axes_of(ax, 8.4, 9.8)
        _taxi(axes, world, actions)
    else:
        found = _lake(world) if kind == "FrozenLakeEnv" else _cliff(world)
        side = min(0.75, 9 / found.width)
        figure, axes = axes_of(ax, side * found.width + 0.4, side * found.height + 0.6)
        _one(axes, found, actions, side)
    axes.set_aspect("equal")
    axes.set_axis_off()
    return save(figure, file)


def _lake(world: Any) -> _Map:
    words = {b"S": "start", b"G": "goal", b"H": "hole"}
    letters = np.asarray(world.desc)
    signs = {(x, y): words[sign] for (y, x), sign in np.ndenumerate(letters) if sign in words}
    return _Map(len(letters), len(letters[0]), signs, [_LEFT, _DOWN, _RIGHT, _UP])


def _cliff(world: Any) -> _Map:
    height, width = world.shape
    signs = {(int(x), int(y)): "cliff" for y, x in np.argwhere(world._cliff)}
    signs |= {(0, height - 1): "start", (width - 1, height - 1): "goal"}
    return _Map(height, width, signs, [_UP, _RIGHT, _DOWN, _LEFT])


def _one(axes: Any, found: _Map, actions: list[int], side: float) -> None:
    """Draw a map with one arrow in each cell. `side` is that of a cell in inches."""
    size = side / 0.75
    colours = {"goal": EXIT, "hole": WALL, "cliff": WALL}
    for y in range(found.height):
        for x in range(found.width):
            sign = found.signs.get((x, y), "")
            _cell(axes, x, y, colours.get(sign, "none"))
            if sign in colours:
                write(axes, x, y, sign, 10 * size, "black" if sign == "goal" else "white")
                continue
            arrow(axes, x, y, found.moves[actions[y * found.width + x]], 1.2 * size)
            if sign:
                axes.text(x + 0.06, y + 0.06, sign, fontsize=8 * size, va="top", color="black")
    axes.set_title("Policy", fontsize=12, loc="left")
    axes.set_xlim(-0.02, found.width + 0.02)
    axes.set_ylim(found.height + 0.02, -0.02)


def _cell(axes: Any, x: float, y: float, colour: str) -> None:
    place: dict[str, Any] = {
        "facecolor": colour,
        "edgecolor": "#b0b0b0",
        "linewidth": 0.6,
        "zorder": 0,
    }
    axes.add_patch(Rectangle((x, y), 1, 1, **place))


def _taxi(axes: Any, world: Any, actions: list[int]) -> None:
    """Draw a board for each place of the passenger, downwards, and each destination."""
    step = 5 + _GAP
    letters = ["R", "G", "Y", "B"]
    for target, letter in enumerate(letters):
        axes.text(target * step + 2.5, -0.4, f"to {letter}", ha="center", va="bottom", fontsize=10)
    for place, letter in enumerate([*letters, "taxi"]):
        text = "passenger\nin the taxi" if letter == "taxi" else f"passenger\nat {letter}"
        axes.text(-0.4, place * step + 2.5, text, ha="right", va="center", fontsize=10)
        for target in range(4):
            at = (target * step, place * step)
            if place == target:
                write(axes, at[0] + 2, at[1] + 2, "there already", 9, GREY)
            else:
                _ride(axes, world, actions, (place, target), at)
    axes.set_title(
        "Policy. Pale: the passenger; framed: the destination; P: pick up, D: drop off",
        fontsize=11, loc="left", pad=10,
    )  # fmt: skip
    axes.set_xlim(-3.2, 4 * step - _GAP + 0.1)
    axes.set_ylim(5 * step - _GAP + 0.1, -1.3)


def _ride(
    axes: Any, world: Any, actions: list[int], ride: tuple[int, int], at: tuple[float, float]
) -> None:
    """Draw the board of a passenger's place and a destination, with its corner `at`."""
    moves = [_DOWN, _UP, _RIGHT, _LEFT]
    places = [(column, row) for row, column in world.locs]
    left, top = at
    for state_row in range(5):
        for column in range(5):
            x, y = left + column, top + state_row
            here = ride[0] < 4 and places[ride[0]] == (column, state_row)
            _cell(axes, x, y, _PASSENGER if here else "none")
            action = actions[world.encode(state_row, column, *ride)]
            if action < 4:
                arrow(axes, x, y, moves[action], 0.5)
            else:
                write(axes, x, y, "PD"[action - 4], 8)
            if world.desc[1 + state_row, 2 * column + 2] == b"|":
                wide = 2.4 if column < 4 else 1.2
                axes.plot([x + 1, x + 1], [y, y + 1], color=WALL, linewidth=wide, zorder=4)
    x, y = places[ride[1]]
    frame: dict[str, Any] = {
        "facecolor": "none",
        "edgecolor": "#D55E00",
        "linewidth": 1.8,
        "zorder": 3,
    }
    axes.add_patch(Rectangle((left + x + 0.06, top + y + 0.06), 0.88, 0.88, **frame))
    axes.add_patch(Rectangle(at, 5, 5, facecolor="none", edgecolor=WALL, linewidth=1.2, zorder=4))
