#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compares value iteration on the class-level model with Storm's and QuantEcon's, on one thread.

    solvers.py BUILD/tools/bench/bench_solve [--states N,N,...] [--repeats R]

Needs numpy, scipy, stormpy (below 2) and quantecon; of the last two, what is not installed is left out.
The processes are square grids with one exit, 22 % walls, cells that have a way to it, four actions, and
moves that slip to a side with probability 0.1 each; a move costs 1 and the discount is 0.99. Storm and
QuantEcon begin with 0, which is best for QuantEcon (with -100 it takes 1.0 to 4 times as long), and ours
with -100, which no value is below. All stop when a sweep changes no value by more than what leaves an
error of 0.01. To Storm the discount is an end that is reached with probability 0.01. Times are processor
times without building the model, medians of R, and as multiples of ours; the error is the largest, from
policy iteration in double.
"""

import argparse
import os
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np  # noqa: E402 - after the number of threads is set
from scipy import ndimage, sparse  # noqa: E402
from scipy.sparse import linalg  # noqa: E402

ACTIONS, DISCOUNT, TOLERANCE = 4, 0.99, 0.01
MOVES = ((0, -1), (1, 0), (0, 1), (-1, 0))
CHANGE = TOLERANCE * (1 - DISCOUNT) / DISCOUNT  # of the last sweep


class Grid:
    """A process: for each pair of state and action what follows, how often of ten, and the reward.

    ``matrix`` is sparse, [states * actions, states]: probabilities, without those of the exit.
    """

    def __init__(self, states, seed=1):
        side = round((states / 0.78) ** 0.5)
        rng = np.random.default_rng(seed)
        free = rng.random((side, side)) >= 0.22
        exit_cell = (side // 2, side // 2)
        free[exit_cell] = True
        near, _ = ndimage.label(free)
        free = near == near[exit_cell]
        number = np.full((side, side), -1)
        number[free] = np.arange(free.sum())
        self.states = int(free.sum())
        begins, nexts, counts = [0], [], []
        for y, x in zip(*np.nonzero(free), strict=True):
            reached = [self._reach(number, x, y, move, exit_cell) for move in MOVES]
            for action in range(ACTIONS):
                followed = {}
                for turn, count in ((0, 8), (1, 1), (3, 1)):
                    to = reached[(action + turn) % ACTIONS]
                    followed[to] = followed.get(to, 0) + count
                for to in sorted(followed):
                    nexts.append(to)
                    counts.append(followed[to])
                begins.append(len(nexts))
        self.begins = np.array(begins, np.uint32)
        self.nexts, self.counts = np.array(nexts, np.uint32), np.array(counts, np.uint32)
        self.rewards = np.full(self.states * ACTIONS, -1.0)
        rows = np.repeat(np.arange(self.states * ACTIONS), np.diff(self.begins))
        stays = self.nexts != 2**32 - 1
        self.matrix = sparse.csr_matrix(
            (self.counts[stays] / 10, (rows[stays], self.nexts[stays].astype(np.int64))),
            (self.states * ACTIONS, self.states),
        )

    @staticmethod
    def _reach(number, x, y, move, exit_cell):
        to_x, to_y = x + move[0], y + move[1]
        inside = 0 <= to_x < number.shape[1] and 0 <= to_y < number.shape[0]
        if not inside or number[to_y, to_x] < 0:
            return int(number[y, x])
        return 2**32 - 1 if (to_y, to_x) == exit_cell else int(number[to_y, to_x])

    def write(self, path):
        with path.open("wb") as file:
            np.array([self.states, ACTIONS, len(self.nexts)], "<u4").tofile(file)
            self.begins.astype("<u4").tofile(file)
            self.rewards.astype("<f4").tofile(file)
            np.stack([self.nexts, self.counts], 1).astype("<u4").tofile(file)

    def solve(self):
        """The values, by policy iteration in double."""
        policy = np.zeros(self.states, np.int64)
        while True:
            rows = np.arange(self.states) * ACTIONS + policy
            left = sparse.identity(self.states, format="csr") - DISCOUNT * self.matrix[rows]
            values = linalg.spsolve(left.tocsc(), self.rewards[rows])
            q = (self.rewards + DISCOUNT * (self.matrix @ values)).reshape(-1, ACTIONS)
            better = q.max(1) > q[np.arange(self.states), policy] + 1e-9
            if not better.any():
                return values
            policy[better] = q[better].argmax(1)


def timed(repeats, solve):
    """The median of seconds, and the last result."""
    seconds, result = [], None
    for _ in range(repeats):
        start = time.process_time()
        result = solve()
        seconds.append(time.process_time() - start)
    return statistics.median(seconds), result


def by_rlvc(program, grid, repeats):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "process"
        grid.write(path)
        least = grid.rewards.min() / (1 - DISCOUNT)
        command = [program, path, DISCOUNT, TOLERANCE, repeats, least]
        text = subprocess.run([*map(str, command)], check=True, capture_output=True, text=True).stdout
    first, *values = text.splitlines()
    seconds, sweeps = first.split()
    return float(seconds), np.array(values, float), int(sweeps)


def by_quantecon(grid, repeats):
    from quantecon.markov import DiscreteDP

    states = np.repeat(np.arange(grid.states), ACTIONS)
    # The exit is a state of its own, which stays and earns nothing.
    rest = 1 - np.asarray(grid.matrix.sum(1)).ravel()
    pairs = sparse.hstack([grid.matrix, sparse.csr_matrix(rest[:, None])])
    end = sparse.csr_matrix(([1.0], ([0], [grid.states])), (1, grid.states + 1))
    process = DiscreteDP(
        np.append(grid.rewards, 0.0), sparse.vstack([pairs, end]).tocsr(), DISCOUNT,
        np.append(states, grid.states), np.append(np.tile(np.arange(ACTIONS), grid.states), 0),
    )  # fmt: skip
    for method in ("value_iteration", "modified_policy_iteration"):
        options = {"method": method, "epsilon": 2 * TOLERANCE, "max_iter": 100000}
        first = np.zeros(grid.states + 1)
        process.solve(v_init=first, **options)  # compiles
        found = timed(repeats, lambda o=options, f=first: process.solve(v_init=f, **o))
        yield f"QuantEcon, {method.replace('_', ' ')}", found[0], np.array(found[1].v)[:-1]


def by_storm(grid, repeats):
    import stormpy

    end = grid.states
    builder = stormpy.SparseMatrixBuilder(0, 0, 0, False, True, 0)
    for pair in range(grid.states * ACTIONS):
        if pair % ACTIONS == 0:
            builder.new_row_group(pair)
        row = grid.matrix[pair] * DISCOUNT
        for to, chance in sorted(zip(row.indices.tolist(), row.data.tolist(), strict=True)):
            builder.add_next_value(pair, to, chance)
        builder.add_next_value(pair, end, 1 - float(row.data.sum()))
    builder.new_row_group(grid.states * ACTIONS)
    builder.add_next_value(grid.states * ACTIONS, end, 1.0)
    labels = stormpy.storage.StateLabeling(grid.states + 1)
    labels.add_label("end")
    labels.add_label_to_state("end", end)
    costs = [1.0] * (grid.states * ACTIONS) + [0.0]
    parts = stormpy.SparseModelComponents(
        transition_matrix=builder.build(), state_labeling=labels,
        reward_models={"cost": stormpy.SparseRewardModel(optional_state_action_reward_vector=costs)},
    )  # fmt: skip
    model = stormpy.storage.SparseMdp(parts)
    formula = stormpy.parse_properties('R{"cost"}min=? [F "end"]')[0]
    environment = stormpy.Environment()
    solver = environment.solver_environment.minmax_solver_environment
    solver.method = stormpy.MinMaxMethod.value_iteration
    solver.precision = stormpy.Rational(CHANGE)
    found = timed(repeats, lambda: stormpy.model_checking(model, formula, environment=environment))
    yield "Storm, value iteration", found[0], -np.array(found[1].get_values())[:-1]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("--states", default="1000,10000,60000")
    parser.add_argument("--repeats", type=int, default=5)
    arguments = parser.parse_args()
    for states in map(int, arguments.states.split(",")):
        grid = Grid(states)
        exact = grid.solve()
        print(f"{grid.states:,} states, {len(grid.nexts):,} transitions")
        ours, values, sweeps = by_rlvc(arguments.program, grid, arguments.repeats)

        def show(name, seconds, values, of=ours, exact=exact):
            error = np.abs(values - exact).max()
            times = f"{seconds:9.4f} s  {seconds / of:6.2f} times"
            print(f"  {name:38} {times}  error {error:.1e}", flush=True)

        show(f"rlvc, {sweeps} sweeps", ours, values)
        for solve in (by_quantecon, by_storm):
            try:
                for row in solve(grid, arguments.repeats):
                    show(*row)
            except ImportError as error:
                print(f"  not measured: {error}")


if __name__ == "__main__":
    main()
