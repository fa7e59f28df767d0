#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The command line. Needs only Python's own modules: --help works before anything is installed."""

import argparse
import os
import sys

TASKS = {
    "binary": "Binary Gridworld: Sutton's maze of 46 cells, 11 distractors and 6 more",
    "lake": "FrozenLake-v1, not slippery, 6 distractors",
    "slippery": "FrozenLake-v1, slippery, 6 distractors",
    "large": "FrozenLake-v1, 8 x 8 cells, slippery, 6 distractors",
    "taxi": "Taxi, 6 distractors",
    "cab": "Taxi as Gymnasium gives it: one number for the whole situation",
    "cartpole": "CartPole-v1",
    "noise": "CartPole-v1, 4 more components that are noise",
    "sensors": "CartPole-v1, sensors with an error of 2 %",
    "car": "MountainCar-v0",
    "acrobot": "Acrobot-v1",
    "pendulum": "Pendulum-v1 with 3 torques",
    "lander": "LunarLander-v3",
    "catch": "a ball to catch: rewards of 1 and -1 at the end, else none",
    "grid": "MiniGrid-Empty-5x5-v0, all of it seen",
    "far": "a maze of 20 x 20 cells with a single, distant reward, 6 distractors",
    "nothing": "nothing to learn: random bits, random rewards; ten runs a seed",
    "wander": "a random walk with random rewards: bits predict the next bits only; ten runs a seed",
    "changing": "binary, but the walls change half-way",
}
LEARNERS = {
    "rlvc": "rlvc",
    "fqi-rlvc": "fitted Q iteration, rlvc's tree",
    "rmax": "R-max, sees the state",
    "vi": "value iteration, sees the state",
    "q": "Q-learning, sees the state",
    "q-raw": "Q-learning on the raw bits",
    "q-tree": "Pyeatt and Howe's Q-tree",
    "fqi": "fitted Q iteration, extra trees",
    "cem": "linear policy by the cross-entropy method",
    "dqn": "DQN",
    "ppo": "PPO",
}


def _names(known):
    def parse(text):
        names = text.split(",")
        for name in names:
            if name not in known:
                raise argparse.ArgumentTypeError(f"{name!r} is not one of {', '.join(known)}")
        return list(dict.fromkeys(names))

    return parse


def _count(text):
    try:
        value = int(text)
    except ValueError:
        value = 0
    if value < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number of at least 1")
    return value


def parse(arguments=None):
    """The options, as a namespace."""
    tasks, learners = (
        "\n".join(f"  {name:9} {text}" for name, text in table.items())
        for table in (TASKS, LEARNERS)
    )
    parser = argparse.ArgumentParser(
        prog="tools/yardstick",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Learns every task with many seeds and one configuration, and prints a table:\n"
        "return, interactions, leaves, seconds and bytes. Below it stands whether rlvc meets each\n"
        "bar. Installs what rlvc needs (tools/setup yardstick); fqi, dqn and ppo need more\n"
        "(tools/setup peers).",
        epilog=f"Tasks:\n{tasks}\n\n"
        "Learners (rlvc sees bits with distractors among them; a learner that sees the state\n"
        f"does not have to find the useful bits):\n{learners}\n\n"
        "Ctrl-C or SIGTERM ends the run early and prints the runs that are done. Exit status: 0;\n"
        "1 if a run failed; 130 if ended early. A missed bar does not change it.",
    )  # fmt: skip
    parser.add_argument("--seeds", type=_count, default=20, metavar="N",
                        help="runs of rlvc on each task (default 20)")
    parser.add_argument("--peer-seeds", type=_count, default=3, metavar="N",
                        help="runs of each other learner on each task (default 3)")
    parser.add_argument("--tasks", type=_names(TASKS), default=list(TASKS), metavar="A,B",
                        help="which tasks (default all)")
    parser.add_argument("--learners", type=_names(LEARNERS), default=list(LEARNERS), metavar="A,B",
                        help="which learners (default all; fqi, dqn and ppo take hours)")
    parser.add_argument("--jobs", type=_count, default=os.cpu_count(), metavar="N",
                        help="runs at the same time (default: the number of processors)")
    parser.add_argument("--json", metavar="FILE", help="write the figures of every run to a file")
    return parser.parse_args(arguments)  # fmt: skip


if __name__ == "__main__":
    parse()
    sys.exit()
