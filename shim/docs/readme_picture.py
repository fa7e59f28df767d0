#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the picture of README.md: the maze with the learnt actions, and the minimal policy beside it.

readme_picture.py FILE.svg
"""

import json
import sys

import matplotlib as mpl
from matplotlib.figure import Figure

import rlvc
import rlvc.envs

BLUE, ORANGE, YELLOW, DARK, GREY = "#0072B2", "#E69F00", "#fbf3d9", "#3a3a3a", "#9a9a9a"
ARROWS = "↑→↓←"


def draw_maze(axes, env, policy):
    """Each free cell with the arrow of its action; the 11 noise bits of its percept are 0."""
    axes.set_aspect("equal")
    axes.set_xlim(-0.03, env.maze.width + 0.03)
    axes.set_ylim(env.maze.height + 0.03, -0.03)
    axes.axis("off")
    for y, row in enumerate(env.maze.rows):
        for x, what in enumerate(row):
            colour = {"#": DARK, "*": ORANGE}.get(what, "white")
            axes.add_patch(mpl.patches.Rectangle((x, y), 1, 1, fc=colour, ec=GREY, lw=0.7))
            text = "exit" if what == "*" else ARROWS[policy.act(percept(x, y))] if what == "." else ""
            size, shade = (9, "black") if what == "*" else (15, BLUE)
            axes.text(x + 0.5, y + 0.52, text, ha="center", va="center", size=size, color=shade)
    cells = sum(row.count(".") for row in env.maze.rows)
    axes.set_title(f"{cells} cells seen as 18 bits, 11 of them noise", size=10)


def percept(x, y):
    """The percept of a cell: x in bits 0 to 3, y in bits 15 to 17."""
    return (x | y << 15).to_bytes(3, "little")


def layout(nodes):
    """Where each node stands: {number: (column, depth)}, leaves in columns of their own."""
    by_number = {node["node"]: node for node in nodes}
    places, leaves = {}, 0

    def place(number, depth):
        nonlocal leaves
        node = by_number[number]
        if "test" in node:
            sides = [place(node[side], depth + 1) for side in ("absent", "present")]
            column = sum(sides) / 2
        else:
            column, leaves = leaves, leaves + 1
        places[number] = column, depth
        return column

    place(nodes[0]["node"], 0)
    return places


def draw_tree(axes, nodes):
    """The policy's tree from the root at the top: tests as boxes, actions as arrows."""
    places = layout(nodes)
    for node in nodes:
        x, depth = places[node["node"]]
        if "test" not in node:
            axes.text(x, -depth, ARROWS[node["action"]], ha="center", va="center", size=14, color=BLUE,
                      bbox={"boxstyle": "round,pad=0.25", "fc": YELLOW, "ec": GREY, "lw": 0.7})  # fmt: skip
            continue
        for side, style in (("absent", (0, (3, 2))), ("present", "-")):
            below_x, below = places[node[side]]
            axes.plot([x, below_x], [-depth, -below], color=GREY, lw=1.2, ls=style, zorder=0)
        axes.text(x, -depth, node["test"], ha="center", va="center", size=9,
                  bbox={"boxstyle": "square,pad=0.3", "fc": "white", "ec": BLUE, "lw": 1.2})  # fmt: skip
    columns, depths = zip(*places.values(), strict=True)
    axes.set_xlim(min(columns) - 0.6, max(columns) + 0.6)
    axes.set_ylim(-max(depths) - 0.5, 0.45)
    axes.axis("off")
    leaves = sum("test" not in node for node in nodes)
    axes.set_title(f"its minimal policy: {leaves} leaves (dashed: the bit is 0, solid: 1)", size=10)


def main(file):
    env = rlvc.envs.BinaryGridworld()
    run = rlvc.learn(env, 2500, seed=1, discount=0.9)
    policy = run.agent.compact()
    figure = Figure(figsize=(9.6, 3.3), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=[1, 1.15])
    draw_maze(left, env, policy)
    draw_tree(right, json.loads(policy.print("json"))["nodes"])
    with mpl.rc_context({"svg.hashsalt": "rlvc"}):
        figure.savefig(file, metadata={"Date": None} if file.endswith(".svg") else None)


if __name__ == "__main__":
    main(*sys.argv[1:])
