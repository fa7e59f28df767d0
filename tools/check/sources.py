#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks what the core's sources may say: which floors they include (core/DESIGN.md), which
headers of C, that they know no double, and that each names its licence."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]

# The floor of each file of core/src, by the name without .c or .h. A file includes lower floors and
# its own header; the files of one group are one thing in several files, and may include each other.
FLOORS = {
    "assert": -1,
    "arena": 0, "mean": 0, "real": 0, "rng": 0, "status": 0, "version": 0,
    "chi2": 1, "domain": 1, "replay": 1, "samples": 1, "score": 1, "sort": 1,
    "cutpoint": 2, "returns": 2, "tree": 2,
    "search": 3, "solver": 3, "split": 3, "values": 3,
    "aliasing": 4,
    "agent": 5, "config": 5, "learn": 5, "print": 5,
}
GROUPS = []
# Who may use which headers of C. They are those of a freestanding compiler, and memcpy's.
C_HEADERS = {"stddef.h", "stdint.h", "float.h", "limits.h", "string.h"}
C_HEADERS_OF = {"core/src/assert.h": {"assert.h"}}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^">]+)[>"]', re.MULTILINE)
COMMENT_OR_STRING = re.compile(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"', re.DOTALL)


def may_include(source, header):
    """Whether a file of core/src may include another, both as names without an ending."""
    if source == header or any(source in group and header in group for group in GROUPS):
        return True
    return FLOORS[header] < FLOORS[source]


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
        elif pathlib.Path(header).stem not in FLOORS:
            yield f'{where}: includes "{header}", which has no floor'
        elif not may_include(path.stem, pathlib.Path(header).stem):
            stem = pathlib.Path(header).stem
            yield (f'{where}: floor {FLOORS[path.stem]} includes "{header}" '
                   f"of floor {FLOORS[stem]}")
    code = COMMENT_OR_STRING.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text)
    for match in re.finditer(r"\bdouble\b|\b\d+\.\d*(?![\dfF])(?:[eE][+-]?\d+)?(?![\dfFeE])", code):
        yield f"{name}:{code.count(chr(10), 0, match.start()) + 1}: a double: {match.group()}"


def main():
    files = sorted(path for folder in ("include", "src", "domains")
                   for path in (ROOT / "core" / folder).rglob("*.[ch]"))
    found = [fault for path in files for fault in faults(path)]
    stale = sorted(set(FLOORS) - {path.stem for path in files})
    found += [f"tools/check/sources.py: FLOORS names {stem}, which is no file" for stem in stale]
    for fault in found:
        print(fault, file=sys.stderr)
    print(f"{len(files)} files of the core looked at, {len(found)} faults")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
