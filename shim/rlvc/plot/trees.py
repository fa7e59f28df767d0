# SPDX-License-Identifier: MIT
"""The tree: its tests as text (:func:`tree`), or as pictures (:func:`features`, figure 5)."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from matplotlib.figure import Figure

from .. import files
from ..errors import RunError
from ..objects import Objects
from .drawing import (
    ARROWS,
    BLUE,
    GREY,
    Source,
    check_name,
    circle,
    connect,
    explained,
    need,
    pictures_of,
    reports,
    save,
    show,
)

if TYPE_CHECKING:
    import graphviz


def _action(report: dict[str, Any], action: int) -> str:
    if "actions" in report:
        return str(report["actions"][action])
    compass = report.get("cell_actions") is not None
    return list(ARROWS)[action] if compass and action < 4 else f"action {action}"


def tree(source: Source, file: str | Path | None = None) -> graphviz.Digraph:
    """Draw the tree: a box for each test, a rounded box for each class with its action and value.

    The leaves of a planner or a policy are no classes: their boxes have the action alone.

    Needs ``tree``. Saving it needs the program ``dot`` of Graphviz; without it this raises
    :class:`~rlvc.errors.RunError`.
    """
    try:
        import graphviz
    except ImportError:
        raise ImportError("rlvc.plot.tree needs graphviz: pip install 'rlvc[plot]'") from None
    report = need(reports(source)[0], "tree")
    nodes = report["tree"]["nodes"]
    graph = graphviz.Digraph(
        graph_attr={"rankdir": "LR", "nodesep": "0.12", "ranksep": "0.35", "bgcolor": "white"},
        node_attr={
            "fontname": "Helvetica",
            "fontsize": "11",
            "shape": "box",
            "margin": "0.12,0.05",
        },
        edge_attr={"fontname": "Helvetica", "fontsize": "10", "color": GREY, "arrowsize": "0.6"},
    )
    for node in nodes:
        name = str(node["node"])
        if "test" in node:
            graph.node(name, f"{explained(node['test'], report)}?", color=BLUE, penwidth="1.4")
            graph.edge(name, str(node["absent"]), label="no", style="dashed")
            graph.edge(name, str(node["present"]), label="yes")
        else:
            label = _action(report, node["action"])
            if "value" in node:  # a class; a leaf of a planner or a policy has an action alone
                label = f"class {node['class']}\n{label}, value {node['value']:.3g}"
            graph.node(name, label, style="rounded,filled", fillcolor="#fbf3d9", color=GREY)
    if file is not None:
        check_name(file)
        try:
            picture = graph.pipe(format=Path(file).suffix.lower()[1:])
        except graphviz.ExecutableNotFound:
            raise RunError(
                "saving a tree needs the program dot: on Debian, apt-get install graphviz"
            ) from None
        files.replace(file, picture)
    return graph


_LABEL = 0.8  # inches: width of a class's label


class _Place(NamedTuple):
    node: dict[str, Any]
    column: int
    row: int


def _places(nodes: list[dict[str, Any]]) -> list[_Place]:
    """Lay a tree out: percepts without the feature go down, those with it go right.

    Each leaf ends a row. A test begins a row, or is in the row of the test above it.
    """
    by_number = {node["node"]: node for node in nodes}
    places, row = [], 0
    waiting = [(nodes[0], 0)]
    while waiting:
        node, column = waiting.pop()
        places.append(_Place(node, column, row))
        if "test" in node:
            waiting.append((by_number[node["absent"]], column))
            waiting.append((by_number[node["present"]], column + 1))
        else:
            row += 1
    return places


class _Drawing:
    """The drawing of a tree of pictures. Lengths are in inches from the upper left corner."""

    def __init__(self, report: dict[str, Any], objects: Objects) -> None:
        self.report, self.objects = report, objects
        self.places = _places(report["tree"]["nodes"])
        rows = 1 + max(place.row for place in self.places)
        self.side = 0.95 if rows <= 16 else 0.75
        self.across, self.down = self.side + 0.6, self.side + 0.26
        self.tests = {test["name"]: test for test in report["tests"]}
        self.members: dict[int, list[int]] = {}
        for cell in report["cell"]:
            for class_id in cell["classes"]:
                self.members.setdefault(class_id, []).append(cell["object"])
        ends = [
            self.left(place)
            + _LABEL
            + 0.1
            + (0.6 * self.side + 0.05) * len(self._shown(place.node))
            for place in self.places
            if "class" in place.node
        ]
        self.figure = Figure(figsize=(max(ends) + 0.1, rows * self.down + 0.55))
        self.axes = self.figure.add_axes((0, 0, 1, 1))
        self.axes.set_axis_off()
        width, height = self.figure.get_size_inches()
        self.axes.text(
            0.15, 0.3, "Tests: the circled feature is looked for", fontsize=12, va="center"
        )
        for place in self.places:
            self.test(place) if "test" in place.node else self.leaf(place)
        self.axes.set_xlim(0, width)
        self.axes.set_ylim(height, 0)

    def left(self, place: _Place) -> float:
        return 0.15 + place.column * self.across

    def top(self, place: _Place) -> float:
        return 0.5 + place.row * self.down

    def _shown(self, node: dict[str, Any]) -> list[int]:
        return self.members.get(node["class"], [])[:6]

    def test(self, place: _Place) -> None:
        """Draw a test: the picture with its points circled, and the arrows to its children."""
        x, y, side = self.left(place), self.top(place), self.side
        test = self.tests[place.node["test"]]
        if test["object"] is None:
            self.axes.text(x, y + side / 2, place.node["test"], fontsize=7, va="center")
        else:
            picture = self.objects.view(test["object"], test["angle"])
            scale = show(self.axes, picture, x, y, side)
            bag = test.get("bag")
            points = bag["points"] if bag else [p for p in (test, test.get("second")) if p]
            radius, width = (0.06 * side, 1.0) if bag else (0.11 * side, 1.8)
            at = [(x + scale * (p["x"] + 0.5), y + scale * (p["y"] + 0.5)) for p in points]
            if not bag:
                connect(self.axes, at, radius, width)
            for place_of in at:
                circle(self.axes, *place_of, radius, width)
        middle = y + side / 2
        self.arrow((x + side, middle), (x + self.across, middle), "-")
        self.axes.text(x + side + 0.12, middle - 0.04, "yes", fontsize=8, va="bottom")
        below = next(p for p in self.places if p.node["node"] == place.node["absent"])
        gap = 0.0 if "test" in below.node else side / 2 - 0.24
        self.arrow((x + side / 2, y + side), (x + side / 2, self.top(below) + gap), "--")
        self.axes.text(x + side / 2 + 0.05, y + side + 0.14, "no", fontsize=8, va="center")

    def arrow(self, start: tuple[float, float], end: tuple[float, float], style: str) -> None:
        arrow = {"arrowstyle": "-|>", "linestyle": style, "color": GREY, "shrinkA": 0, "shrinkB": 0}
        self.axes.annotate("", xy=end, xytext=start, arrowprops=arrow, zorder=1)

    def leaf(self, place: _Place) -> None:
        """Draw a class: its number, its action and its objects."""
        x, y, node = self.left(place), self.top(place), place.node
        label = f"class {node['class']}\n{_action(self.report, node['action'])}"
        frame = {"boxstyle": "round,pad=0.3", "facecolor": "#fbf3d9", "edgecolor": GREY}
        middle = y + self.side / 2
        self.axes.text(x + 0.1, middle, label, fontsize=9, va="center", bbox=frame, zorder=3)
        small = 0.6 * self.side
        for i, number in enumerate(self._shown(node)):
            angle = self.report["objects"][number]["angle"]
            at = x + _LABEL + i * (small + 0.05)
            show(self.axes, self.objects.view(number, angle), at, middle - small / 2, small)


def features(
    source: Source, file: str | Path | None = None, objects: Objects | None = None
) -> Figure:
    """Draw the tree of an agent on pictures: each test is a picture with its point circled (figure 5).

    A pair is two circles and a line. A bag is shown in the picture that has most of it; a small
    circle is around each point that is like one of its vectors.

    Pictures without the feature go down, those with it go right. Beside each class are up to six of
    its objects. Needs ``tree``, ``tests``, ``cell`` and ``objects``.
    """
    report = need(reports(source)[0], "tests", "tree", "cell", "objects")
    return save(_Drawing(report, pictures_of(report, objects)).figure, file)
