#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that builds of run_gridworld by different compilers learn the same, bit for bit: all that
their reports say must be equal, but for times and bytes of memory."""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

COMMANDS = [
    ["--criterion", "residual"],
    ["--criterion", "residual", "--slip", "0.1"],
    ["--criterion", "returns", "--interactions", "10000"],
    ["--score", "ranks"],
]
OWN = {"seconds", "memory_bytes"}  # of a report; counts of 32 bits take less memory


def without_times(value):
    if isinstance(value, dict):
        return {key: without_times(item) for key, item in value.items() if key not in OWN}
    if isinstance(value, list):
        return [without_times(item) for item in value]
    return value


def report(program, options, folder):
    path = pathlib.Path(folder) / "report.json"
    subprocess.run([program, "binary", *options, "--json", str(path)], check=True,
                   stdout=subprocess.DEVNULL)
    # Numbers stay text: two that are printed alike are alike, two that are not are not.
    return without_times(json.loads(path.read_text(encoding="utf-8"), parse_float=str))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", nargs="+")
    parser.add_argument("--seeds", type=int, default=5, help="default: %(default)s")
    arguments = parser.parse_args()
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        for command in COMMANDS:
            for seed in range(1, arguments.seeds + 1):
                options = [*command, "--seed", str(seed)]
                first, *others = (report(program, options, folder)
                                  for program in arguments.program)
                for program, other in zip(arguments.program[1:], others):
                    if other != first:
                        failed += 1
                        print(f"{program} and {arguments.program[0]} differ: binary "
                              f"{' '.join(options)}", file=sys.stderr)
    print(f"{len(COMMANDS) * arguments.seeds} runs by {len(arguments.program)} programs, "
          f"{failed} differences")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
