#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Learns mazes that are drawn at random, with the defaults of run_gridworld.

    tools/bench/mazes.py build/release/tools/run_gridworld/run_gridworld [KIND...]
        [--discount G] [--interactions N]

Kinds: `rooms15` and `rooms30` (22 % of the cells are walls, the exit is at the centre), `corridors15`
and `corridors31` (perfect mazes: one way from each cell to the exit in a corner). A line is a maze:
after how many interactions every cell is optimal ("-": never), the cells that are optimal in the end,
the same of the compact policy, classes, leaves of that policy and of the smallest optimal tree, the
value before and after compaction, and seconds. Maze and learner have the same seed: 1, 2, 3, ...

An episode ends at the exit. So a cell behind it, with no other way to the rest, is seen only if an
episode begins there: of each such part of a maze, in order of size, it is told how many of its cells
are optimal, and of the rest how many moves the nearest one is away from the exit. The first line of a
kind says in how many mazes every part would be seen, in the mean, by one who knew them and always
went straight to the exit, and by one who did so with a quarter of the interactions.
"""

import argparse
import json
import math
import random
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

KINDS = {  # side, mazes, interactions
    "rooms15": (15, 10, 5000),
    "rooms30": (30, 5, 30000),
    "corridors15": (15, 10, 10000),
    "corridors31": (31, 10, 60000),
}
WALLS = 0.22
WAYS = ((0, -1), (1, 0), (0, 1), (-1, 0))


def reached_from(start, free):
    """The free cells that have a way to `start`."""
    seen, front = {start}, [start]
    while front:
        x, y = front.pop()
        for cell in ((x + dx, y + dy) for dx, dy in WAYS):
            if cell in free and cell not in seen:
                seen.add(cell)
                front.append(cell)
    return seen


def rooms(side, draw):
    """Cells that are walls with a probability; those without a way to the exit become walls."""
    exit_cell = (side // 2, side // 2)
    free = {(x, y) for y in range(side) for x in range(side) if draw.random() >= WALLS}
    return reached_from(exit_cell, free | {exit_cell}), exit_cell


def corridors(side, draw):
    """A perfect maze, by depth first search: crossings are the cells with even x and y."""
    free, way = {(0, 0)}, [(0, 0)]
    while way:
        x, y = way[-1]
        ways = [
            (dx, dy)
            for dx, dy in WAYS
            if {x + 2 * dx, y + 2 * dy} <= set(range(side)) and (x + 2 * dx, y + 2 * dy) not in free
        ]
        if ways:
            dx, dy = draw.choice(ways)
            free |= {(x + dx, y + dy), (x + 2 * dx, y + 2 * dy)}
            way.append((x + 2 * dx, y + 2 * dy))
        else:
            way.pop()
    return free, (side - 1, side - 1)


def distances(free, exit_cell):
    """Moves to the exit from each cell."""
    moves, front = {exit_cell: 0}, [exit_cell]
    for x, y in front:
        for cell in ((x + dx, y + dy) for dx, dy in WAYS):
            if cell in free and cell not in moves:
                moves[cell] = moves[x, y] + 1
                front.append(cell)
    return moves


def parts_of(free, exit_cell):
    """The cells but the exit, in parts that have a way to each other without it; the largest first."""
    parts, left = [], set(free) - {exit_cell}
    while left:
        parts.append(reached_from(min(left), left))
        left -= parts[-1]
    return sorted(parts, key=len, reverse=True)


def chance_of_all(free, exit_cell, interactions):
    """The probability that an episode begins in each part, if all go straight to the exit.

    As if the parts were drawn independently, and each episode took the mean number of moves.
    """
    moves = distances(free, exit_cell)
    cells = len(moves) - 1
    episodes = interactions * cells / sum(moves.values())
    parts = parts_of(free, exit_cell)
    return math.prod(1 - (1 - len(part) / cells) ** episodes for part in parts)


def describe_parts(run, free, exit_cell):
    """How many cells of each part are optimal, and how near to the exit one is that is not."""
    moves = distances(free, exit_cell)
    ways = dict(zip(("up", "right", "down", "left", None), (*WAYS, (0, 0)), strict=True))

    def is_right(x, y):
        dx, dy = ways[run["cell_actions"][y][x]]
        return moves.get((x + dx, y + dy)) == moves[x, y] - 1

    wrong = {cell for cell in moves if cell != exit_cell and not is_right(*cell)}
    parts = parts_of(free, exit_cell)
    counts = ", ".join(f"{len(part - wrong)} of {len(part)}" for part in parts)
    nearest = min((moves[cell] for cell in wrong & parts[0]), default=None)
    return counts if nearest is None else f"{counts}, wrong {nearest} moves away"


def text_of(side, free, exit_cell):
    def mark(cell):
        return "*" if cell == exit_cell else "." if cell in free else "#"

    return "".join("".join(mark((x, y)) for x in range(side)) + "\n" for y in range(side))


def learn(program, maze, interactions, seed, discount, folder):
    """What run_gridworld reports of a maze."""
    path, report = Path(folder) / "maze.txt", Path(folder) / "report.json"
    path.write_text(maze, encoding="ascii")
    command = [program, "binary", "--maze", path, "--interactions", interactions, "--seed", seed]
    command += ["--discount", discount]
    subprocess.run([*map(str, command), "--json", report], check=True, stdout=subprocess.DEVNULL)
    return json.loads(report.read_bytes())


def compare(program, kind, discount, interactions, folder):
    side, mazes, usual = KINDS[kind]
    interactions = interactions or usual
    draw_maze = rooms if kind.startswith("rooms") else corridors
    drawn = [draw_maze(side, random.Random(seed)) for seed in range(1, mazes + 1)]
    seen = [sum(chance_of_all(*one, n) for one in drawn) for n in (interactions, interactions / 4)]
    print(
        f"{kind}: {side} x {side}, {interactions:,} interactions, discount {discount:g};",
        f"straight to the exit every part is seen in {seen[0]:.2f} of {mazes}, or {seen[1]:.2f}",
    )
    runs = []
    for seed, (free, exit_cell) in enumerate(drawn, 1):
        maze = text_of(side, free, exit_cell)
        run = learn(program, maze, interactions, seed, discount, folder)
        runs.append(run)
        print(
            f"  {seed:2}  {run['interactions_to_optimal'] or '-':>6}",
            f"{run['optimal_cells']} of {run['cells']}  compact {run['policy_optimal_cells']}",
            f"parts {describe_parts(run, free, exit_cell)}",
            f"classes {run['classes']}  leaves {run['policy_leaves']} of {run['fewest_leaves']}",
            f"value {run['value_before']:.6g} {run['value_after']:.6g}  {run['seconds']:.2f} s",
            sep="  ",
            flush=True,
        )
    solved = [run["interactions_to_optimal"] for run in runs if run["interactions_to_optimal"]]
    kept = sum(run["policy_optimal_cells"] >= run["optimal_cells"] for run in runs)
    median = f", median {statistics.median(solved):,.0f}" if solved else ""
    seconds = statistics.median(run["seconds"] for run in runs)
    print(
        f"  optimal everywhere in {len(solved)} of {mazes}{median};",
        f"the compact policy is as good in {kept} of {mazes}; {seconds:.2f} s in the median",
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("kinds", nargs="*", metavar="KIND", help=", ".join(KINDS))
    parser.add_argument("--discount", type=float, default=0.9, metavar="G")
    parser.add_argument("--interactions", type=int, metavar="N", help="default: the kind's")
    arguments = parser.parse_args()
    if unknown := set(arguments.kinds) - set(KINDS):
        sys.exit(f"no such kind: {', '.join(unknown)}")
    with tempfile.TemporaryDirectory() as folder:
        for kind in arguments.kinds or KINDS:
            compare(arguments.program, kind, arguments.discount, arguments.interactions, folder)


if __name__ == "__main__":
    main()
