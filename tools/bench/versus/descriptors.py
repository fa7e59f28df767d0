# SPDX-License-Identifier: MIT
"""Compares descriptors and rules on photographs: the table of the vision module's design page.

    RLVC_COIL100=DIR tools/bench/versus/descriptors.py PATH/TO/run_gridworld [--runs N]

Sutton's maze with an object in each cell, noise 3, light +-5 %, 4,500 interactions. Each row is learnt
twice: from poses 0 and +-20 degrees with +-10 held out, and from 0, +-10 and +-20 with +-30 held out. A
share is that of optimal decisions, the mean over the runs. Classes are the mean and the maximum. Seconds
are processor time of learning in one run. Prints Markdown."""

import argparse
import json
import os
import subprocess
import sys
import tempfile

ROWS = [
    ("sift-upright, 16 axes, margin rule (default)", []),
    ("sift-upright, 16 axes, fixed tau 5 %", ["--margin", "1", "--share", "0.05"]),
    ("sift-upright, 32 axes, margin rule", ["--axes", "32"]),
    ("sift, 16 axes, margin rule", ["--descriptor", "sift"]),
    ("sift-upright as it is, margin rule", ["--axes", "0"]),
    ("sqrt-invariants, margin rule", ["--descriptor", "sqrt-invariants", "--sigma", "3"]),
    ("invariants, fixed tau", ["--descriptor", "invariants", "--margin", "1", "--share", "0.2"]),
    ("orb, margin rule", ["--descriptor", "orb"]),
]
TASKS = [["--poses", "0,20,-20", "--test-poses", "10,-10"],
         ["--poses", "0,10,-10,20,-20", "--test-poses", "30,-30"]]


def learn(program, folder, runs, arguments):
    with tempfile.TemporaryDirectory() as made:
        report = os.path.join(made, "report.json")
        subprocess.run([program, "tiled", "--images", folder, "--noise", "3", "--light", "0.05",
                        "--runs", str(runs), "--json", report, *arguments], check=True,
                       stdout=subprocess.DEVNULL)
        with open(report) as file:
            return json.load(file)


def cells(report):
    classes = [run["classes"] for run in report["runs"]]
    seconds = sum(run["seconds"] for run in report["runs"]) / len(classes)
    return (f"{report['optimal_seen']:.4f} | {report['optimal_heldout']:.4f} | "
            f"{sum(classes) / len(classes):.0f} ({max(classes)}) | {seconds:.1f}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--runs", type=int, default=20, help="each with a seed of its own, from 1 on")
    options = parser.parse_args()
    folder = os.environ.get("RLVC_COIL100")
    if not folder:
        sys.exit("descriptors.py: RLVC_COIL100 must name a folder of COIL-100 pictures")
    print("| vectors, rule | seen | +-10 | classes | s | seen | +-30 | classes | s |")
    print("|---|---|---|---|---|---|---|---|---|")
    for name, arguments in ROWS:
        made = [cells(learn(options.program, folder, options.runs, [*arguments, *task]))
                for task in TASKS]
        print(f"| {name} | {' | '.join(made)} |", flush=True)


if __name__ == "__main__":
    main()
