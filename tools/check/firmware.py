#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compares what the firmware example learnt, tree and values, with what run_gridworld learns by the same
settings: the one learns in slices between the ticks of a control loop, the other at one go."""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

# What both say, and must say alike.
SHARED = ["cells", "optimal_cells", "interactions", "interactions_to_optimal",
          "interactions_to_first_optimal", "classes", "depth", "last_split_step", "bits_used",
          "distractors_used", "cell_classes", "cell_actions", "tree"]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("run_gridworld")
    parser.add_argument("outputs", nargs="+", help="what the firmware printed")
    arguments = parser.parse_args()
    differences = 0
    for name in arguments.outputs:
        text = pathlib.Path(name).read_text(encoding="utf-8")
        firmware = json.loads(text[text.index("\n{") + 1:])
        with tempfile.TemporaryDirectory() as folder:
            report = pathlib.Path(folder) / "report.json"
            options = [f"--{key}={value}" for key, value in firmware["options"].items()]
            subprocess.run([arguments.run_gridworld, "binary", *options, "--json", str(report)],
                           stdout=subprocess.DEVNULL, check=True)
            whole = json.loads(report.read_text(encoding="utf-8"))
        for key in SHARED:
            if firmware[key] != whole[key]:
                differences += 1
                print(f"{name}: {key} differs from that of run_gridworld {' '.join(options)}",
                      file=sys.stderr)
        print(f"{name}: compared with run_gridworld by the {firmware['options']['criterion']} "
              "criterion")
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main())
