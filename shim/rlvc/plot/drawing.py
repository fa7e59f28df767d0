# SPDX-License-Identifier: MIT
"""What the pictures have in common: where they draw from, their colours, and how they are saved."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, TypeAlias

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from .. import objects as _objects
from .. import report as _report
from ..agent.agent import Agent
from ..errors import RunError
from ..learning.run import Run

Source: TypeAlias = "dict[str, Any] | str | Path | Run | Agent"

BLUE, ORANGE, GREY = "#0072B2", "#D55E00", "#4d4d4d"
WALL, EXIT, PAPER = "#3a3a3a", "#E69F00", "#ffffff"
ARROWS = {"up": (0, -1), "right": (1, 0), "down": (0, 1), "left": (-1, 0)}


def reports(source: Source) -> list[dict[str, Any]]:
    """Give the runs that a source has, as reports."""
    if isinstance(source, str | Path):
        source = _report.read(source)
    if isinstance(source, Run):
        source = _report.make(source)
    elif isinstance(source, Agent):
        source = {"tree": source.tree}
    runs = source.get("runs", [source])
    if not runs:
        raise RunError("the report has no run")
    return [_with_tables({**source, **run}) for run in runs]


def _with_tables(report: dict[str, Any]) -> dict[str, Any]:
    """Add the tables of a maze's cells to a report that lists them: that of the Tiled Gridworld."""
    if "cell" not in report:
        return report
    classes, actions = ([[None] * len(row) for row in report["maze"]] for _ in range(2))
    for cell in report["cell"]:
        found = cell["classes"]
        classes[cell["y"]][cell["x"]] = found[0] if len(found) == 1 else None
        actions[cell["y"]][cell["x"]] = cell["action"]
    return {"cell_classes": classes, "cell_actions": actions, **report}


def pictures_of(report: dict[str, Any], objects: _objects.Objects | None) -> _objects.Objects:
    """Give the pictures of a report's objects.

    Parameters
    ----------
    report : dict
    objects : Objects or None
        None: those of the folder that the report names, or rendered ones.

    Returns
    -------
    Objects

    Raises
    ------
    RunError
        The report does not say where its pictures are from.
    """
    if objects is not None:
        return objects
    options = need(report, "objects", "options")["options"]
    angles = [*options["poses"], *options.get("test_poses", [])]
    return _objects.find(options["images"], angles, wanted=len(report["objects"]))


def circle(axes: Any, x: float, y: float, radius: float, width: float) -> None:
    """Draw a circle that is seen on light and on dark."""
    for colour, line in ((PAPER, 2.2 * width), (ORANGE, width)):
        axes.add_patch(Circle((x, y), radius, fill=False, color=colour, linewidth=line, zorder=4))


def show(axes: Any, picture: npt.NDArray[np.uint8], x: float, y: float, side: float) -> float:
    """Draw a picture into a square with the upper left corner (x, y); give the side of a pixel."""
    height, width = picture.shape[:2]
    scale: float = side / max(height, width)
    extent = (x, x + width * scale, y + height * scale, y)
    axes.imshow(picture, extent=extent, zorder=2, interpolation="antialiased")
    return scale


def need(report: dict[str, Any], *members: str) -> dict[str, Any]:
    """Give the report, if it has these members."""
    for member in members:
        if member not in report:
            raise RunError(f"cannot be drawn: there is no {member} in it")
    return report


def save(figure: Figure, file: str | Path | None) -> Figure:
    """Save a figure, if a file is named."""
    if file is not None:
        check_name(file)
        # No date and fixed names within, so that the same run makes the same file.
        with mpl.rc_context({"svg.hashsalt": "rlvc", "svg.fonttype": "path"}):
            metadata = {"Date": None} if str(file).lower().endswith(".svg") else {}
            figure.savefig(file, dpi=150, bbox_inches="tight", facecolor=PAPER, metadata=metadata)
    return figure


def check_name(file: str | Path) -> None:
    """Refuse a file that is neither PNG nor SVG."""
    if Path(file).suffix.lower() not in (".png", ".svg"):
        raise RunError(f"{file}: a picture is a .png or a .svg")


def explained(name: str, report: dict[str, Any]) -> str:
    """Give a test's name, in words if the report has them."""
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
