#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that functions and files stay small: no function of core, shim, tools or vision has more than 60 lines
of code, none in C and C++ a cyclomatic complexity above 12 (ruff's C901 looks at Python), and no file has more
than 800 lines. Needs lizard (PyPI)."""

import argparse
import pathlib
import sys

import lizard

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ("core", "shim", "tools", "vision")
SUFFIXES = (".c", ".h", ".cc", ".py")
LINES_MAX = 60
COMPLEXITY_MAX = 12
FILE_MAX = 800
# Flat: one case or comparison after the other, which splitting would only hide.
FLAT = {
    "vision/src/config.cc: rlvc_vision_status_text",
}
GENERATED = {"shim/rlvc/_native/bindings.py"}  # by tools/check/bindings.py


def oversized(path):
    """(entry, fault) of each function of a file that is too large, and how many functions it has."""
    name = path.relative_to(ROOT).as_posix()
    functions = lizard.analyze_file(str(path)).function_list
    found = []
    for function in functions:
        lines, complexity = function.nloc, function.cyclomatic_complexity
        if lines > LINES_MAX or (path.suffix != ".py" and complexity > COMPLEXITY_MAX):
            found.append((f"{name}: {function.name}",
                          f"{name}:{function.start_line}: {function.name} has {lines} lines and complexity "
                          f"{complexity}; the limits are {LINES_MAX} and {COMPLEXITY_MAX}"))
    return found, len(functions)


def main():
    argparse.ArgumentParser(description=__doc__).parse_args()
    files = sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*")
                   if path.suffix in SUFFIXES)
    faults, count, seen = [], 0, set()
    for path in files:
        name = path.relative_to(ROOT).as_posix()
        lines = len(path.read_text(encoding="utf-8").splitlines())
        if lines > FILE_MAX and name not in GENERATED:
            faults.append(f"{name}: {lines} lines, more than {FILE_MAX}")
        found, functions = oversized(path)
        count += functions
        seen |= {entry for entry, _ in found}
        faults += [fault for entry, fault in found if entry not in FLAT]
    faults += [f"{pathlib.Path(__file__).name} lists {entry}, which is small or gone"
               for entry in sorted(FLAT - seen)]
    for fault in faults:
        print(fault, file=sys.stderr)
    print(f"{count} functions in {len(files)} files, {len(faults)} faults")
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main())
