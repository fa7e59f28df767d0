# SPDX-License-Identifier: MIT
"""What all figures share: their source, colours, and how they are saved."""

from __future__ import annotations

import io
import re
from pathlib import Path
from typing import Any, TypeAlias

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from .. import files
from .. import objects as _objects
from .. import report as _report
from ..agent.agent import Agent
from ..agent.planner import Planner
from ..agent.policy import Policy
from ..checks import named, shown
from ..errors import RunError
from ..words import explain

Source: TypeAlias = "dict[str, Any] | str | Path | Agent | Planner | Policy | Any"

BLUE, ORANGE, GREY = "#0072B2", "#D55E00", "#4d4d4d"
WALL, EXIT, PAPER = "#3a3a3a", "#E69F00", "#ffffff"
ARROWS = {"up": (0, -1), "right": (1, 0), "down": (0, 1), "left": (-1, 0)}


def reports(source: Source) -> list[dict[str, Any]]:
    """Return the runs of a source as reports."""
    if isinstance(source, str | Path):
        source = _report.read(source)
    if isinstance(source, Agent | Planner | Policy):
        source = {"tree": source.tree}
    elif hasattr(source, "learner"):
        source = _report.make(source)
    if not isinstance(source, dict):
        raise RunError(f"a report, a file, a run or an agent is drawn, not {type(source).__name__}")
    runs = source.get("runs", [source])
    if not isinstance(runs, list) or not runs or not all(isinstance(run, dict) for run in runs):
        raise RunError("the report has no run")
    return [_with_tables({**source, **run}) for run in runs]


def run_of(source: Source, kind: str) -> Any:
    """Return a source that is a run: some figures ask it how it acts, which no report can tell."""
    if not hasattr(source, "learner"):
        raise RunError(
            f"{kind}: drawn of an rlvc.Run, or of its file, and not of a report or a tree"
        )
    return source


def axes_of(ax: Any, width: float, height: float) -> tuple[Figure, Any]:
    """Return the axes to draw into with their figure, or new ones of this size in inches."""
    if ax is not None:
        if not isinstance(ax, Axes):
            raise RunError(f"ax: {shown(ax)} is not an Axes of Matplotlib")
        return ax.figure, ax  # type: ignore[return-value]  # a part of a figure draws as well
    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, figure.subplots()


def _with_tables(report: dict[str, Any]) -> dict[str, Any]:
    """Add tables of classes and actions to a report that lists cells (Tiled Gridworld)."""
    if "cell" not in report:
        return report
    classes, actions = ([[None] * len(row) for row in report["maze"]] for _ in range(2))
    for cell in report["cell"]:
        found = cell["classes"]
        classes[cell["y"]][cell["x"]] = found[0] if len(found) == 1 else None
        actions[cell["y"]][cell["x"]] = cell["action"]
    return {"cell_classes": classes, "cell_actions": actions, **report}


def pictures_of(report: dict[str, Any], objects: _objects.Objects | None) -> _objects.Objects:
    """Return the given pictures, or those that the report names.

    Raises
    ------
    RunError
        The report does not name its pictures.
    """
    if objects is not None:
        return objects
    options = need(report, "objects", "options")["options"]
    angles = [*options["poses"], *options.get("test_poses", [])]
    return _objects.find(options["images"], angles, wanted=len(report["objects"]))


def circle(axes: Any, x: float, y: float, radius: float, width: float) -> None:
    """Draw a circle that is visible on light and on dark."""
    for colour, line in ((PAPER, 2.2 * width), (ORANGE, width)):
        axes.add_patch(Circle((x, y), radius, fill=False, color=colour, linewidth=line, zorder=4))


def connect(axes: Any, points: list[tuple[float, float]], radius: float, width: float) -> None:
    """Draw a line between two circles, if there are two: from rim to rim, visible on any ground."""
    if len(points) < 2:
        return
    (x, y), (u, v) = points
    length = max(float(np.hypot(u - x, v - y)), 1e-9)
    along, across = radius * (u - x) / length, radius * (v - y) / length
    if length > 2 * radius:
        for colour, line in ((PAPER, 2.2 * width), (ORANGE, width)):
            xs, ys = (x + along, u - along), (y + across, v - across)
            axes.add_line(Line2D(xs, ys, color=colour, linewidth=line, zorder=4))


def show(axes: Any, picture: npt.NDArray[np.uint8], x: float, y: float, side: float) -> float:
    """Draw a picture with its upper left corner at (x, y); return the size of a pixel."""
    height, width = picture.shape[:2]
    scale: float = side / max(height, width)
    extent = (x, x + width * scale, y + height * scale, y)
    axes.imshow(picture, extent=extent, zorder=2, interpolation="antialiased")
    return scale


def tidy(axes: Any, grid: str = "both") -> None:
    """Draw a light grid and no frame above and to the right."""
    axes.grid(axis=grid, color="#e0e0e0", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def need(report: dict[str, Any], *members: str) -> dict[str, Any]:
    """Return the report if it has these members."""
    for member in members:
        if member not in report:
            maker = "run_gridworld binary" if member == "history" else "run_gridworld"
            raise RunError(
                f"the report has no {member}: one by rlvc.report.make(run, env) or {maker} --json has"
            )
    return report


def save(figure: Figure, file: str | Path | None) -> Figure:
    """Save a figure if a file is named."""
    if file is not None:
        check_name(file)
        # No date and fixed identifiers: the same run makes the same file.
        with mpl.rc_context({"svg.hashsalt": "rlvc", "svg.fonttype": "path"}):
            form = Path(file).suffix.lower()[1:]
            metadata = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(form, {})
            drawn = io.BytesIO()
            figure.savefig(
                drawn, format=form, dpi=150, bbox_inches="tight", facecolor=PAPER, metadata=metadata
            )
        files.replace(file, drawn.getvalue())
    return figure


def check_name(file: str | Path) -> None:
    """Raise RunError unless the file is a .png, a .svg or a .pdf."""
    if not isinstance(file, str | Path) or Path(file).suffix.lower() not in (".png", ".svg", ".pdf"):
        raise RunError(f"{named(file)}: the file must be a .png, a .svg or a .pdf")


def explained(name: str, report: dict[str, Any]) -> str:
    """Return the name of a test, in words if the report has them."""
    names = report.get("names") or []
    match = re.fullmatch(r"bit (\d+)", name)
    if match and int(match[1]) < len(names):
        return str(names[int(match[1])])
    percept = report.get("percept")
    if match and percept:
        for axis in ("x", "y"):
            if int(match[1]) in percept[f"{axis}_bits"]:
                place = percept[f"{axis}_bits"].index(int(match[1]))
                return f"{name}: {2**place} of {axis}"
        return f"{name}: distractor"
    return explain(name, names, report.get("flags") or [])
