# SPDX-License-Identifier: MIT
"""Mazes: classes and policy (figures 3 and 4), values, and the objects in the cells."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from ..objects import Objects
from .drawing import (
    ARROWS,
    BLUE,
    EXIT,
    GREY,
    WALL,
    Source,
    axes_of,
    circle,
    need,
    pictures_of,
    reports,
    save,
    show,
)


def write(axes: Any, x: float, y: float, text: str, size: float, colour: str = "black") -> None:
    """Write in the middle of the cell (x, y)."""
    axes.text(
        x + 0.5, y + 0.5, text, ha="center", va="center", fontsize=size, color=colour, zorder=5
    )


def arrow(axes: Any, x: float, y: float, move: tuple[int, int], size: float) -> None:
    """Draw an arrow in the cell (x, y)."""
    dx, dy = 0.32 * move[0], 0.32 * move[1]
    axes.annotate(
        "",
        xy=(x + 0.5 + dx, y + 0.5 + dy),
        xytext=(x + 0.5 - dx, y + 0.5 - dy),
        arrowprops={
            "arrowstyle": "-|>",
            "color": BLUE,
            "linewidth": 1.6 * size,
            "mutation_scale": 12 * size,
            "shrinkA": 0,
            "shrinkB": 0,
        },
    )


def board(axes: Any, rows: list[str], title: str) -> None:
    """Draw walls, exits and a frame."""
    width, height = len(rows[0]), len(rows)
    axes.set_title(title, fontsize=12, loc="left")
    axes.set_xlim(0, width)
    axes.set_ylim(height, 0)
    axes.set_aspect("equal")
    axes.set_xticks([])
    axes.set_yticks([])
    for y, row in enumerate(rows):
        for x, sign in enumerate(row):
            if sign != ".":
                colour = WALL if sign == "#" else EXIT
                axes.add_patch(Rectangle((x, y), 1, 1, color=colour, linewidth=0))
            if sign == "*":
                write(axes, x, y, "exit", _fit(width, 9))
    for spine in axes.spines.values():
        spine.set_linewidth(1.5)


def _free(rows: list[str], cells: list[list[Any]]) -> Iterator[tuple[int, int, Any]]:
    """Yield x, y and the value of each free cell."""
    for y, row in enumerate(cells):
        for x, value in enumerate(row):
            if rows[y][x] == ".":
                yield x, y, value


def _fit(width: int, size: float) -> float:
    """Return a font size that fits into a cell of a maze of this width."""
    return max(2.0, min(size, size * 12 / max(width, 1)))


def _borders(axes: Any, cells: Any) -> None:
    """Draw lines between neighbouring cells of different classes."""
    height, width = len(cells), len(cells[0])
    for y in range(height):
        for x in range(width):
            if x + 1 < width and cells[y][x] != cells[y][x + 1]:
                axes.plot([x + 1, x + 1], [y, y + 1], color=GREY, linewidth=0.8)
            if y + 1 < height and cells[y][x] != cells[y + 1][x]:
                axes.plot([x, x + 1], [y + 1, y + 1], color=GREY, linewidth=0.8)


def _grid(axes: Any, rows: list[str]) -> None:
    width, height = len(rows[0]), len(rows)
    if width <= 20:
        for x in range(1, width):
            axes.axvline(x, color="#d0d0d0", linewidth=0.5, zorder=0)
        for y in range(1, height):
            axes.axhline(y, color="#d0d0d0", linewidth=0.5, zorder=0)


def _pale(fraction: float) -> tuple[float, float, float]:
    """Return a light colour of the cividis map, on which black text is legible."""
    red, green, blue, _ = mpl.colormaps["cividis"](0.35 + 0.65 * fraction)
    return tuple(0.45 + 0.55 * part for part in (red, green, blue))  # type: ignore[return-value]


def _classes(axes: Any, report: dict[str, Any]) -> None:
    rows, cells = report["maze"], report["cell_classes"]
    board(axes, rows, f"Classes ({report['classes']})")
    highest = max([1, *(c for row in cells for c in row if c is not None)])
    for x, y, class_id in _free(rows, cells):
        if class_id is not None:
            colour = _pale(class_id / highest)
            axes.add_patch(Rectangle((x, y), 1, 1, color=colour, linewidth=0))
        write(axes, x, y, "?" if class_id is None else str(class_id), _fit(len(rows[0]), 10))
    _borders(axes, cells)


def _policy(axes: Any, report: dict[str, Any]) -> None:
    rows = report["maze"]
    width = len(rows[0])
    board(axes, rows, "Policy")
    for x, y, action in _free(rows, report["cell_actions"]):
        if action not in ARROWS:
            write(axes, x, y, "?", _fit(width, 10))
            continue
        arrow(axes, x, y, ARROWS[action], _fit(width, 1.0))
    _grid(axes, rows)


def _two_boards(rows: list[str], least: float, cell: float, most: float) -> tuple[Any, Any, Any]:
    """A figure with two mazes side by side, each `cell` inches a cell, within the limits."""
    width, height = len(rows[0]), len(rows)
    side = min(most, max(least, cell * width))
    figure = Figure(figsize=(2 * side + 0.4, side * height / width + 0.6), layout="constrained")
    return (figure, *figure.subplots(1, 2))


def maze(source: Source, file: str | Path | None = None) -> Figure:
    """Draw a maze twice: with the class of each cell, and with the learnt actions (figures 3 and 4).

    Needs ``maze``, ``classes``, ``cell_classes`` and ``cell_actions``.
    """
    report = need(reports(source)[0], "maze", "cell_classes", "cell_actions", "classes")
    figure, left, right = _two_boards(report["maze"], 4.0, 0.62, 7.0)
    _classes(left, report)
    _policy(right, report)
    return save(figure, file)


def values(source: Source, file: str | Path | None = None, ax: Any = None) -> Figure:
    """Draw the value of each cell of a maze as a heat map, in units of return.

    Needs ``maze``, ``cell_classes`` and ``tree``.
    """
    report = need(reports(source)[0], "maze", "cell_classes", "tree")
    rows = report["maze"]
    worth = {node["class"]: node["value"] for node in report["tree"]["nodes"] if "class" in node}
    table = np.array(
        [[math.nan if c is None else worth[c] for c in row] for row in report["cell_classes"]]
    )
    side = min(9.0, max(5.0, 0.75 * len(rows[0])))
    figure, axes = axes_of(ax, side + 1.2, side * len(rows) / len(rows[0]) + 0.6)
    board(axes, rows, "Value of each cell")
    extent = (0, len(rows[0]), len(rows), 0)
    shown = axes.imshow(np.ma.masked_invalid(table), cmap="cividis", extent=extent, zorder=0)
    if len(rows[0]) <= 20:
        middle = (np.nanmin(table) + np.nanmax(table)) / 2 if np.isfinite(table).any() else 0.0
        for (y, x), value in np.ndenumerate(table):
            if not math.isnan(value):
                colour = "black" if value > middle else "white"
                write(axes, x, y, f"{value:.3g}", 9, colour)
    figure.colorbar(shown, ax=axes, label="value (units of return)", shrink=0.9)
    return save(figure, file)


def tiles(source: Source, file: str | Path | None = None, objects: Objects | None = None) -> Figure:
    """Draw the Tiled Gridworld twice: its objects and interest points, and its classes (figure 4).

    Needs ``maze``, ``classes``, ``cell`` and ``objects``.
    """
    report = need(reports(source)[0], "maze", "cell", "objects", "classes")
    found = pictures_of(report, objects)
    rows = report["maze"]
    width, height = len(rows[0]), len(rows)
    figure, left, right = _two_boards(rows, 4.0, 1.15, 11.0)
    board(left, rows, "Objects and their interest points")
    for cell in report["cell"]:
        x, y, told = cell["x"], cell["y"], report["objects"][cell["object"]]
        scale = show(left, found.view(cell["object"], told["angle"]), x + 0.03, y + 0.03, 0.94)
        for point in told["points"]:
            place = (x + 0.03 + scale * (point[0] + 0.5), y + 0.03 + scale * (point[1] + 0.5))
            circle(left, *place, 0.035, 0.6 * min(1.15, 11.0 / width))
    left.set_xlim(0, width)
    left.set_ylim(height, 0)
    _classes(right, report)
    return save(figure, file)
