#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that every row of core/PROMISES.md has a command, and that what the command names exists: a script of the
project, a stage of tools/test, a preset and a test of CMake, a fuzz target, a test of Python."""

import json
import pathlib
import re
import shlex
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "core/PROMISES.md"


def text_of(name):
    return (ROOT / name).read_text(encoding="utf-8")


def fault_of_script(words):
    if not (ROOT / words[0]).is_file():
        return f"no such file: {words[0]}"
    if words[0] == "tools/test":
        stages = re.search(r"^stages=\((.*)\)", text_of(words[0]), re.M)[1].split()
        return next((f"no such stage: {stage}" for stage in words[1:] if stage not in stages), "")
    if words[0] == "tools/fuzz":
        return next((f"no such target: {name}" for name in words[2:]
                     if not list((ROOT / "tests/fuzz").glob(f"fuzz_{name}.c*"))), "")
    if words[0] == "tools/targets":
        presets = {preset["name"] for preset in json.loads(text_of("CMakePresets.json"))["configurePresets"]}
        return next((f"no such preset: {name}" for name in words[1:] if name not in presets), "")
    return ""


def fault_of_ctest(words):
    if len(words) != 5 or words[1] != "--preset" or words[3] != "-R":
        return "expected: ctest --preset PRESET -R LABEL.NAME"
    presets = {preset["name"] for preset in json.loads(text_of("CMakePresets.json"))["testPresets"]}
    if words[2] not in presets:
        return f"no such preset: {words[2]}"
    label, _, name = words[4].partition(".")
    if label == "core" and (ROOT / f"tests/core/{name}.c").is_file():
        return ""
    lists = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "tests").rglob("CMakeLists.txt"))
    known = re.search(rf"rlvc_test\({label} {name}\b", lists) or (
        label == "checks" and re.search(rf"rlvc_check\({name}\b", lists))
    return "" if known else f"no such test: {words[4]}"


def fault_of_pytest(words):
    files = [word for word in words if word.endswith(".py")]
    if not files or not all((ROOT / file).is_file() for file in files):
        return f"no such file: {' '.join(files)}"
    if "-k" in words:
        name = words[words.index("-k") + 1]
        if not any(re.search(rf"def test_\w*{name}", text_of(file)) for file in files):
            return f"no test is called {name}"
    return ""


def fault_of(command):
    """What is wrong with a command; "" if nothing is."""
    words = [word for word in shlex.split(command) if not re.fullmatch(r"[A-Z_]+=\S+", word)]
    if words[0].startswith(("tools/", "tests/")):
        return fault_of_script(words)
    if words[0] == "ctest":
        return fault_of_ctest(words)
    if words[:3] == ["python", "-m", "pytest"]:
        return fault_of_pytest(words[3:])
    return "neither a script of the project, nor ctest, nor python -m pytest"


def main():
    faults, rows = [], 0
    for number, line in enumerate(PAGE.read_text(encoding="utf-8").splitlines(), 1):
        cells = [cell.strip() for cell in line.strip("|").split(" | ")]
        if not line.startswith("|") or line.startswith(("|--", "| promise |")):
            continue
        rows += 1
        command = re.fullmatch(r"`([^`]+)`", cells[2]) if len(cells) == 4 else None
        fault = fault_of(command[1]) if command else "expected: promise | checked by | `command` | figure"
        if fault or not cells[3]:
            faults.append(f"core/PROMISES.md:{number}: {fault or 'no figure'}")
    print(*faults, f"{rows} promises, {len(faults)} faults", sep="\n")
    return bool(faults) or rows == 0


if __name__ == "__main__":
    sys.exit(main())
