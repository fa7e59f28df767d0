#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks what the core's sources may say: which floors they include (core/DESIGN.md), which
headers of C, that they know no double, and that each names its licence."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]

# The floor of each file of core/src, by the name without .c or .h. A file includes lower floors and
# its own header.
FLOORS = {
    "snapshot": 9,
    "policy": 8, "prune": 8, "resume": 8,
    "agent": 7, "export": 7, "learn": 7, "print": 7,
    "config": 6, "state": 6,
    "model": 5, "seek": 5, "succession": 5,
    "export_descriptors": 4, "export_thresholds": 4, "samples": 4, "solver": 4, "split": 4,
    "aliasing": 3, "compact": 3, "explore": 3, "export_tree": 3, "incremental": 3,
    "cutpoint": 3, "predecessors": 3, "spread": 3,
    "fisher": 2, "ranks": 2, "returns": 2, "tree": 2, "values": 2,
    "chi2": 1, "fewest": 1, "gate": 1, "log": 1, "replay": 1, "score": 1, "slots": 1, "sort": 1,
    "text": 1,
    "arena": 0, "bytes": 0, "crc": 0, "mean": 0, "ones": 0, "real": 0, "rng": 0, "solvers": 0,
    "status": 0,
    "assert": -1,
}
# Who may use which headers of C. They are those of a freestanding compiler, and memcpy's.
C_HEADERS = {"stddef.h", "stdint.h", "float.h", "limits.h", "string.h"}
C_HEADERS_OF = {"core/src/assert.h": {"assert.h"}}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^">]+)[>"]', re.MULTILINE)
COMMENT_OR_STRING = re.compile(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"', re.DOTALL)
# The type, or a constant of it: one that does not end in f.
DOUBLE = re.compile(r"\bdouble\b|(?<![\w.])(?:0[xX][\da-fA-F.]+[pP][+-]?\d+|\d+[eE][+-]?\d+|"
                    r"(?:\d+\.\d*|\.\d+)(?:[eE][+-]?\d+)?)(?![\w.])")


def faults(path):
    name = path.relative_to(ROOT).as_posix()
    text = path.read_text(encoding="utf-8")
    inside = name.startswith("core/src/")
    if not text.startswith("/* SPDX-License-Identifier: MIT */\n"):
        yield f"{name}:1: does not begin with its licence"
    if inside and path.stem not in FLOORS:
        yield f"{name}: has no floor yet: add it to FLOORS in tools/check/sources.py"
        return
    for match in INCLUDE.finditer(text):
        bracket, header = match.groups()
        where = f"{name}:{text.count(chr(10), 0, match.start(2)) + 1}"
        if bracket == "<":
            if header not in C_HEADERS | C_HEADERS_OF.get(name, set()):
                yield f"{where}: includes <{header}>"
        elif header.startswith("rlvc/"):
            if not (ROOT / "core/include" / header).exists():
                yield f'{where}: includes "{header}", which is no public header'
        elif not inside:
            yield f'{where}: includes "{header}", but may only see the public headers'
        elif header[:-2] not in FLOORS:
            yield f'{where}: includes "{header}", which has no floor'
        elif header != f"{path.stem}.h" and FLOORS[header[:-2]] >= FLOORS[path.stem]:
            yield (f'{where}: floor {FLOORS[path.stem]} includes "{header}" '
                   f"of floor {FLOORS[header[:-2]]}")
    code = COMMENT_OR_STRING.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text)
    for match in DOUBLE.finditer(code):
        yield f"{name}:{code.count(chr(10), 0, match.start()) + 1}: a double: {match.group()}"


def main():
    files = sorted(path for folder in ("include", "src", "domains")
                   for path in (ROOT / "core" / folder).rglob("*.[ch]"))
    found = [fault for path in files for fault in faults(path)]
    stale = sorted(set(FLOORS) - {path.stem for path in files if path.parent.name == "src"})
    found += [f"tools/check/sources.py: FLOORS names {stem}, which is no file" for stem in stale]
    for fault in found:
        print(fault, file=sys.stderr)
    print(f"{len(files)} files of the core looked at, {len(found)} faults")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
