#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks what the core's sources may say: which rooms they include (core/DESIGN.md), which
headers of C, that they use no double, that each names its licence, and that floats are compiled by the rules."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCES = ROOT / "core/src"

# The rooms of core/src, from the ground up (core/DESIGN.md). A file includes headers of its own room and of
# the rooms before it, and any public header.
ROOMS = ("base", "stats", "tree", "samples", "split", "solve", "explore", "dynamics", "plan", "agent",
         "counts", "export", "policy", "store")
# The rooms of run_gridworld, by the same rule. Files beside them may include any.
TOOL = ROOT / "tools/run_gridworld"
TOOL_ROOMS = ("cli", "maze", "report", "tiled")
# Who may use which headers of C. They are those of a freestanding compiler, and memcpy's.
C_HEADERS = {"stddef.h", "stdint.h", "float.h", "limits.h", "string.h"}
C_HEADERS_OF = {"core/src/base/arena.h": {"sanitizer/asan_interface.h"},  # in tests' builds alone
                "core/src/base/assert.h": {"assert.h"}}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^">]+)[>"]', re.MULTILINE)
COMMENT_OR_STRING = re.compile(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"', re.DOTALL)
# The type, or a constant of it: one that does not end in f.
DOUBLE = re.compile(r"\bdouble\b|(?<![\w.])(?:0[xX][\da-fA-F.]+[pP][+-]?\d+|\d+[eE][+-]?\d+|"
                    r"(?:\d+\.\d*|\.\d+)(?:[eE][+-]?\d+)?)(?![\w.])")


def fault_of_include(path, room, bracket, header):
    """What is wrong with an #include in a file of a room of core/src (None: of a folder beside), or None."""
    if bracket == "<":
        if header not in C_HEADERS | C_HEADERS_OF.get(path.relative_to(ROOT).as_posix(), set()):
            return f"includes <{header}>"
        return None
    if header.startswith("rlvc/"):
        if not (ROOT / "core/include" / header).exists():
            return f'includes "{header}", which is no public header'
        return None
    if room is None:
        own = path.parent.name == "domains" and (path.parent / header).is_file()
        return None if own else f'includes "{header}", but may only include public headers'
    included = (path.parent / header).resolve()
    if not included.is_file():
        return f'includes "{header}", which does not exist'
    if included.parent.name not in ROOMS[:ROOMS.index(room) + 1]:
        return f'room {room} includes "{header}", which is not in a room before it'
    return None


def faults_of_tool(path):
    name, room = path.relative_to(ROOT).as_posix(), path.parent.name
    if room not in TOOL_ROOMS:
        yield f"{name}: lies in no room of run_gridworld: {', '.join(TOOL_ROOMS)}"
        return
    text = path.read_text(encoding="utf-8")
    for match in INCLUDE.finditer(text):
        header = (path.parent / match[2]).resolve()
        if (header.is_file() and TOOL in header.parents
                and header.parent.name not in TOOL_ROOMS[:TOOL_ROOMS.index(room) + 1]):
            yield (f"{name}:{text.count(chr(10), 0, match.start(2)) + 1}: room {room} includes "
                   f'"{match[2]}", which is not in a room before it')


def faults(path):
    name = path.relative_to(ROOT).as_posix()
    text = path.read_text(encoding="utf-8")
    room = path.parent.name if path.parent.parent == SOURCES else None
    if not text.startswith("/* SPDX-License-Identifier: MIT */\n"):
        yield f"{name}:1: does not begin with its licence"
    if SOURCES in path.parents and room not in ROOMS:
        yield f"{name}: lies in no room of core/src: {', '.join(ROOMS)}"
        return
    includes = list(INCLUDE.finditer(text))
    if path.suffix == ".c" and includes and includes[0][2] != "rlvc/float_rules.h":
        yield f"{name}: does not include rlvc/float_rules.h first"
    for match in includes:
        if fault := fault_of_include(path, room, *match.groups()):
            yield f"{name}:{text.count(chr(10), 0, match.start(2)) + 1}: {fault}"
    code = COMMENT_OR_STRING.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text)
    for match in DOUBLE.finditer(code):
        yield f"{name}:{code.count(chr(10), 0, match.start()) + 1}: a double: {match.group()}"


def main():
    files = sorted(path for folder in ("include", "src", "domains")
                   for path in (ROOT / "core" / folder).rglob("*.[ch]"))
    found = [fault for path in files for fault in faults(path)]
    tool = sorted(path for path in TOOL.glob("*/*") if path.suffix in (".cc", ".h"))
    found += [fault for path in tool for fault in faults_of_tool(path)]
    found += [f"core/src/{room}: listed in tools/check/sources.py, but holds no file" for room in ROOMS
              if not any(path.parent == SOURCES / room for path in files)]
    for fault in found:
        print(fault, file=sys.stderr)
    print(f"{len(files)} files of the core and {len(tool)} of run_gridworld looked at, {len(found)} faults")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
