#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The command line. Needs nothing but Python, so that it can be asked before anything is installed."""

import argparse
import os
import sys

TASKS = {
    "binary": "Binary Gridworld: Sutton's maze of 46 cells, 11 distractors and 6 more",
    "lake": "FrozenLake-v1, not slippery, 6 distractors",
    "slippery": "FrozenLake-v1, slippery, 6 distractors",
    "taxi": "Taxi-v3, 6 distractors",
    "cartpole": "CartPole-v1",
    "far": "a maze of 20 x 20 cells with one far reward and no other, 6 distractors",
    "nothing": "nothing to learn: random bits, random rewards; ten runs a seed",
    "wander": "random rewards on a walk, whose places foretell each other; ten runs a seed",
    "changing": "binary, but half-way the walls change",
}
LEARNERS = {
    "rlvc": "rlvc",
    "q": "Q-learning told the state",
    "fqi": "fitted Q iteration, extra trees",
    "dqn": "DQN",
}


def _names(known):
    def parse(text):
        names = text.split(",")
        for name in names:
            if name not in known:
                raise argparse.ArgumentTypeError(f"{name!r} is none of {', '.join(known)}")
        return list(dict.fromkeys(names))

    return parse


def _count(text):
    try:
        value = int(text)
    except ValueError:
        value = 0
    if value < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is no whole number from 1 on")
    return value


def parse(arguments=None):
    """The options, as a namespace."""
    listed = "\n".join(
        f"  {name:9} {text}" for table in (TASKS, LEARNERS) for name, text in table.items()
    )
    parser = argparse.ArgumentParser(
        prog="tools/yardstick",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Learns every task from many seeds, with one configuration for all, and prints a\n"
        "table: return, interactions, leaves, seconds, bytes, and whether each bar is met. It\n"
        "installs what it needs (tools/setup yardstick), but for the peers (tools/setup peers).",
        epilog=f"Tasks and learners:\n{listed}\n\n"
        "Ctrl-C, or SIGTERM, ends it early and prints what is there. Exit status: 0, or\n"
        "1 if a run failed, or 130 if ended early. A missed bar is no failure.",
    )  # fmt: skip
    parser.add_argument("--seeds", type=_count, default=20, metavar="N",
                        help="runs of rlvc on each task (20)")
    parser.add_argument("--peer-seeds", type=_count, default=3, metavar="N",
                        help="runs of each other learner on each task (3)")
    parser.add_argument("--tasks", type=_names(TASKS), default=list(TASKS), metavar="A,B",
                        help="which tasks (all)")
    parser.add_argument("--learners", type=_names(LEARNERS), default=list(LEARNERS), metavar="A,B",
                        help="which learners (all); fqi and dqn take an hour")
    parser.add_argument("--jobs", type=_count, default=os.cpu_count(), metavar="N",
                        help="runs at a time (as many as there are processors)")
    parser.add_argument("--json", metavar="FILE", help="write every run to a file")
    return parser.parse_args(arguments)  # fmt: skip


if __name__ == "__main__":
    parse()
    sys.exit()
