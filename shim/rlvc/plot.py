# SPDX-License-Identifier: MIT
"""Pictures that explain what was learnt.

Each function draws from a report (a dict, or the file that ``run_gridworld --json`` or
:mod:`rlvc.report` wrote), a :class:`~rlvc.Run` or an :class:`~rlvc.Agent`, as far as it has what is to
be drawn, and saves to a PNG or an SVG if it is given a file's name.

The colours are those of the cividis map and of Okabe and Ito's palette, which the colour-blind can
tell apart; nothing is said by colour alone.
"""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from . import report as _report
from .agent import Agent
from .errors import RunError
from .learning import Run

try:
    import matplotlib as mpl
    from matplotlib.figure import Figure
    from matplotlib.patches import Rectangle
except ImportError:
    raise ImportError("rlvc.plot needs Matplotlib: pip install 'rlvc[plot]'") from None

if TYPE_CHECKING:
    import graphviz

Source: TypeAlias = "dict[str, Any] | str | Path | Run | Agent"

_BLUE, _ORANGE, _GREEN, _GREY = "#0072B2", "#D55E00", "#009E73", "#4d4d4d"
_WALL, _EXIT, _PAPER = "#3a3a3a", "#E69F00", "#ffffff"
_ARROWS = {"up": (0, -1), "right": (1, 0), "down": (0, 1), "left": (-1, 0)}


def _runs(source: Source) -> list[dict[str, Any]]:
    """The runs that a source has, as reports."""
    if isinstance(source, str | Path):
        source = _report.read(source)
    if isinstance(source, Run):
        source = _report.make(source)
    elif isinstance(source, Agent):
        source = {"tree": source.tree}
    runs = source.get("runs", [source])
    if not runs:
        raise RunError("the report has no run")
    return [{**source, **run} for run in runs]


def _need(report: dict[str, Any], *members: str) -> dict[str, Any]:
    for member in members:
        if member not in report:
            raise RunError(f"cannot be drawn: there is no {member} in it")
    return report


def _save(figure: Figure, file: str | Path | None) -> Figure:
    if file is not None:
        _check_name(file)
        # No date and fixed names within, so that the same run makes the same file.
        with mpl.rc_context({"svg.hashsalt": "rlvc", "svg.fonttype": "path"}):
            metadata = {"Date": None} if str(file).lower().endswith(".svg") else {}
            figure.savefig(file, dpi=150, bbox_inches="tight", facecolor=_PAPER, metadata=metadata)
    return figure


def _check_name(file: str | Path) -> None:
    if Path(file).suffix.lower() not in (".png", ".svg"):
        raise RunError(f"{file}: a picture is a .png or a .svg")


def _explained(name: str, report: dict[str, Any]) -> str:
    """A test's name, in words if the report has them."""
    names = report.get("names") or []
    match = re.fullmatch(r"bit (\d+)", name)
    if match and int(match[1]) < len(names):
        return str(names[int(match[1])])
    percept = report.get("percept")
    if match and percept:
        for axis in ("x", "y"):
            if int(match[1]) in percept[f"{axis}_bits"]:
                place = percept[f"{axis}_bits"].index(int(match[1]))
                return f"{name}: {axis} has {2**place}"
        return f"{name}: noise"
    return name


# ------------------------------------------------------------------ mazes


def _board(axes: Any, rows: list[str], title: str) -> None:
    """Walls, exits, and a frame."""
    width, height = len(rows[0]), len(rows)
    axes.set_title(title, fontsize=12, loc="left")
    axes.set_xlim(0, width)
    axes.set_ylim(height, 0)
    axes.set_aspect("equal")
    axes.set_xticks([])
    axes.set_yticks([])
    for y, row in enumerate(rows):
        for x, sign in enumerate(row):
            if sign == "#":
                axes.add_patch(Rectangle((x, y), 1, 1, color=_WALL, linewidth=0))
            elif sign == "*":
                axes.add_patch(Rectangle((x, y), 1, 1, color=_EXIT, linewidth=0))
                axes.text(
                    x + 0.5, y + 0.5, "exit", ha="center", va="center", fontsize=_fit(width, 9)
                )
    for spine in axes.spines.values():
        spine.set_linewidth(1.5)


def _fit(width: int, size: float) -> float:
    """A size of type that fits into a cell of a maze of that width."""
    return max(2.0, min(size, size * 12 / max(width, 1)))


def _borders(axes: Any, cells: Any) -> None:
    """Lines between neighbours of different classes."""
    height, width = len(cells), len(cells[0])
    for y in range(height):
        for x in range(width):
            if x + 1 < width and cells[y][x] != cells[y][x + 1]:
                axes.plot([x + 1, x + 1], [y, y + 1], color=_GREY, linewidth=0.8)
            if y + 1 < height and cells[y][x] != cells[y + 1][x]:
                axes.plot([x, x + 1], [y + 1, y + 1], color=_GREY, linewidth=0.8)


def _pale(fraction: float) -> tuple[float, float, float]:
    """A light colour of the cividis map, dark type is legible on it."""
    red, green, blue, _ = mpl.colormaps["cividis"](0.35 + 0.65 * fraction)
    return tuple(0.45 + 0.55 * part for part in (red, green, blue))  # type: ignore[return-value]


def _classes(axes: Any, report: dict[str, Any]) -> None:
    rows, cells = report["maze"], report["cell_classes"]
    _board(axes, rows, f"Classes ({report['classes']})")
    highest = max([1, *(c for row in cells for c in row if c is not None)])
    for y, row in enumerate(cells):
        for x, class_id in enumerate(row):
            if rows[y][x] != ".":
                continue
            if class_id is not None:
                axes.add_patch(
                    Rectangle((x, y), 1, 1, color=_pale(class_id / highest), linewidth=0)
                )
            text = "?" if class_id is None else str(class_id)
            axes.text(x + 0.5, y + 0.5, text, ha="center", va="center", fontsize=_fit(len(row), 10))
    _borders(axes, cells)


def _policy(axes: Any, report: dict[str, Any]) -> None:
    rows, cells = report["maze"], report["cell_actions"]
    _board(axes, rows, "Policy")
    for y, row in enumerate(cells):
        for x, action in enumerate(row):
            if rows[y][x] != ".":
                continue
            if action not in _ARROWS:
                axes.text(
                    x + 0.5, y + 0.5, "?", ha="center", va="center", fontsize=_fit(len(row), 10)
                )
                continue
            dx, dy = _ARROWS[action]
            axes.annotate(
                "",
                xy=(x + 0.5 + 0.32 * dx, y + 0.5 + 0.32 * dy),
                xytext=(x + 0.5 - 0.32 * dx, y + 0.5 - 0.32 * dy),
                arrowprops={
                    "arrowstyle": "-|>",
                    "color": _BLUE,
                    "linewidth": _fit(len(row), 1.6),
                    "mutation_scale": _fit(len(row), 12),
                    "shrinkA": 0,
                    "shrinkB": 0,
                },
            )
    width, height = len(rows[0]), len(rows)
    if width <= 20:
        for x in range(1, width):
            axes.axvline(x, color="#d0d0d0", linewidth=0.5, zorder=0)
        for y in range(1, height):
            axes.axhline(y, color="#d0d0d0", linewidth=0.5, zorder=0)


def maze(source: Source, file: str | Path | None = None) -> Figure:
    """Draw a maze with the classes that the tree tells apart and the learnt policy (figures 3, 4).

    Parameters
    ----------
    source : dict, path, Run or Agent
        With ``maze``, ``cell_classes`` and ``cell_actions``.
    file : str, Path or None
        A PNG or an SVG.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    RunError
        The source has no maze, or the file is neither PNG nor SVG.
    """
    report = _need(_runs(source)[0], "maze", "cell_classes", "cell_actions", "classes")
    width, height = len(report["maze"][0]), len(report["maze"])
    side = min(7.0, max(4.0, 0.62 * width))
    figure = Figure(figsize=(2 * side + 0.4, side * height / width + 0.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    _classes(left, report)
    _policy(right, report)
    return _save(figure, file)


def values(source: Source, file: str | Path | None = None) -> Figure:
    """Draw the value of each cell of a maze as a heat map, in units of return.

    Parameters
    ----------
    source : dict, path, Run or Agent
        With ``maze``, ``cell_classes`` and ``tree``.
    file : str, Path or None
        A PNG or an SVG.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    RunError
        The source has no maze, or the file is neither PNG nor SVG.
    """
    report = _need(_runs(source)[0], "maze", "cell_classes", "tree")
    rows = report["maze"]
    worth = {node["class"]: node["value"] for node in report["tree"]["nodes"] if "class" in node}
    table = np.array(
        [[math.nan if c is None else worth[c] for c in row] for row in report["cell_classes"]]
    )
    side = min(9.0, max(5.0, 0.75 * len(rows[0])))
    figure = Figure(
        figsize=(side + 1.2, side * len(rows) / len(rows[0]) + 0.6), layout="constrained"
    )
    axes = figure.subplots()
    _board(axes, rows, "Value of each cell")
    extent = (0, len(rows[0]), len(rows), 0)
    shown = axes.imshow(np.ma.masked_invalid(table), cmap="cividis", extent=extent, zorder=0)
    if len(rows[0]) <= 20:
        middle = (np.nanmin(table) + np.nanmax(table)) / 2 if np.isfinite(table).any() else 0.0
        for (y, x), value in np.ndenumerate(table):
            if not math.isnan(value):
                colour = "black" if value > middle else "white"
                axes.text(
                    x + 0.5,
                    y + 0.5,
                    f"{value:.3g}",
                    ha="center",
                    va="center",
                    fontsize=9,
                    color=colour,
                )
    figure.colorbar(shown, ax=axes, label="value, in units of return", shrink=0.9)
    return _save(figure, file)


# ------------------------------------------------------------------ over interactions


def learning_curve(source: Source, file: str | Path | None = None) -> Figure:
    """Draw classes, and optimal cells or the mean return, over interactions.

    Parameters
    ----------
    source : dict, path or Run
        With ``history``; all runs of a report are drawn.
    file : str, Path or None
        A PNG or an SVG.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    RunError
        The source has no history, or the file is neither PNG nor SVG.
    """
    runs = [_need(run, "history") for run in _runs(source)]
    if not runs[0]["history"]:
        raise RunError("cannot be drawn: no learning step in it")
    optimal = "optimal_cells" in runs[0]["history"][0]
    second = "optimal_cells" if optimal else "mean_return"
    figure = Figure(figsize=(7, 5), layout="constrained")
    upper, lower = figure.subplots(2, 1, sharex=True)
    for run in runs:
        points = [record["interactions"] for record in run["history"]]
        thin = 2.0 if len(runs) == 1 else 0.9
        upper.plot(
            points, [record["classes"] for record in run["history"]], color=_BLUE, linewidth=thin
        )
        known = [record for record in run["history"] if record[second] is not None]
        lower.plot(
            [record["interactions"] for record in known],
            [record[second] for record in known],
            color=_ORANGE,
            linewidth=thin,
            marker="o" if len(runs) == 1 else None,
            markersize=3.5,
        )
    upper.set_ylabel("classes")
    lower.set_ylabel("optimal cells" if optimal else "mean return of an episode")
    lower.set_xlabel("interactions")
    if optimal and "cells" in runs[0]:
        lower.axhline(runs[0]["cells"], color=_GREY, linewidth=0.9, linestyle=":")
        lower.annotate(
            f"all {runs[0]['cells']} cells",
            (1, runs[0]["cells"]),
            xycoords=("axes fraction", "data"),
            xytext=(0, 3),
            textcoords="offset points",
            ha="right",
            va="bottom",
            fontsize=9,
            color=_GREY,
        )
        lower.set_ylim(top=1.15 * runs[0]["cells"])
    for axes in (upper, lower):
        axes.grid(color="#e0e0e0", linewidth=0.6)
        axes.set_axisbelow(True)
        axes.spines[["top", "right"]].set_visible(False)
    title = "Learning" if len(runs) == 1 else f"Learning: {len(runs)} runs"
    upper.set_title(title, fontsize=12, loc="left")
    return _save(figure, file)


def splits(source: Source, file: str | Path | None = None) -> Figure:
    """Draw which feature was found at which step: a disc a split, the larger the surer.

    Parameters
    ----------
    source : dict, path, Run or Agent
        With ``tree``.
    file : str, Path or None
        A PNG or an SVG.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    RunError
        The source has no tree, or the file is neither PNG nor SVG.
    """
    report = _need(_runs(source)[0], "tree")
    found = [node for node in report["tree"]["nodes"] if "test" in node]
    if not found:
        raise RunError("cannot be drawn: the tree has a single class")
    found.sort(key=lambda node: node["split"])
    tests: dict[str, int] = {}
    for node in found:
        tests.setdefault(_explained(node["test"], report), len(tests))
    height = min(20.0, max(2.5, 0.3 * len(tests) + 1.2))
    figure = Figure(figsize=(7.5, height), layout="constrained")
    axes = figure.subplots()
    at: dict[tuple[int, int], int] = {}
    xs, ys, sizes = [], [], []
    for node in found:
        place = (node["step"], tests[_explained(node["test"], report)])
        at[place] = at.get(place, 0) + 1
        xs.append(place[0] + 0.14 * (at[place] - 1))
        ys.append(place[1])
        sizes.append(18 + 12 * math.log1p(-node["log_p"]))
    axes.scatter(xs, ys, s=sizes, color=_BLUE, alpha=0.75, edgecolors="white", linewidths=0.5)
    axes.set_yticks(range(len(tests)), list(tests), fontsize=9)
    axes.set_ylim(len(tests) - 0.4, -0.6)
    axes.set_xlabel("learning step k (several splits of a step stand side by side)")
    axes.set_title(f"{len(found)} splits, by feature", fontsize=12, loc="left")
    axes.grid(axis="y", color="#e0e0e0", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    return _save(figure, file)


# ------------------------------------------------------------------ the tree


def tree(source: Source, file: str | Path | None = None) -> graphviz.Digraph:
    """Draw the tree: tests as boxes, classes with their actions and values as rounded ones.

    Parameters
    ----------
    source : dict, path, Run or Agent
        With ``tree``.
    file : str, Path or None
        A PNG or an SVG; to make it needs Graphviz's program ``dot``.

    Returns
    -------
    graphviz.Digraph

    Raises
    ------
    RunError
        The source has no tree, the file is neither PNG nor SVG, or there is no ``dot``.
    """
    try:
        import graphviz
    except ImportError:
        raise ImportError("rlvc.plot.tree needs graphviz: pip install 'rlvc[plot]'") from None
    report = _need(_runs(source)[0], "tree")
    nodes = report["tree"]["nodes"]
    graph = graphviz.Digraph(
        graph_attr={"rankdir": "LR", "nodesep": "0.12", "ranksep": "0.35", "bgcolor": "white"},
        node_attr={
            "fontname": "Helvetica",
            "fontsize": "11",
            "shape": "box",
            "margin": "0.12,0.05",
        },
        edge_attr={"fontname": "Helvetica", "fontsize": "10", "color": _GREY, "arrowsize": "0.6"},
    )
    compass = report.get("cell_actions") is not None
    for node in nodes:
        name = str(node["node"])
        if "test" in node:
            graph.node(name, f"{_explained(node['test'], report)} ?", color=_BLUE, penwidth="1.4")
            graph.edge(name, str(node["absent"]), label="no", style="dashed")
            graph.edge(name, str(node["present"]), label="yes")
        else:
            action = node["action"]
            words = list(_ARROWS)[action] if compass and action < 4 else f"action {action}"
            label = f"class {node['class']}\n{words}, value {node['value']:.3g}"
            graph.node(name, label, style="rounded,filled", fillcolor="#fbf3d9", color=_GREY)
    if file is not None:
        _check_name(file)
        try:
            picture = graph.pipe(format=Path(file).suffix.lower()[1:])
        except graphviz.ExecutableNotFound:
            raise RunError(
                "a picture of a tree needs Graphviz: on Debian, apt-get install graphviz"
            ) from None
        Path(file).write_bytes(picture)
    return graph


KINDS = {
    "maze": maze,
    "values": values,
    "curve": learning_curve,
    "splits": splits,
    "tree": tree,
}
"""The functions by the names that the command ``python -m rlvc plot`` knows them by."""
