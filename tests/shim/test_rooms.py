# SPDX-License-Identifier: MIT
"""A room of the package imports only rooms before it; rlvc/__init__.py lists them in order."""

import ast
import re

from conftest import ROOT

PACKAGE = ROOT / "shim/rlvc"
DOORS = {"__init__", "__main__", "_version"}  # of the package: the first two see every room


def listed():
    text = (PACKAGE / "__init__.py").read_text(encoding="utf-8")
    return re.findall(r"^#     (\w+) +\S", text, re.MULTILINE)


def imported(path):
    """The rooms that a file imports from, with their lines."""
    depth = len(path.relative_to(PACKAGE).parts)
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names = [name.name for name in node.names]
            assert not any(name.split(".")[0] == "rlvc" for name in names), f"{path}:{node.lineno}"
        if isinstance(node, ast.ImportFrom) and node.level == depth:
            names = [node.module] if node.module else [name.name for name in node.names]
            yield from ((name.split(".")[0], node.lineno) for name in names)


def test_rooms_import_only_rooms_before_them():
    rooms = listed()
    present = {path.stem for path in PACKAGE.iterdir() if (path / "__init__.py").exists()}
    assert set(rooms) == present | {path.stem for path in PACKAGE.glob("*.py")} - DOORS
    for path in sorted(PACKAGE.rglob("*.py")):
        room = path.relative_to(PACKAGE).parts[0].removesuffix(".py")
        if room in DOORS:
            continue
        for other, line in imported(path):
            before = other == "_version" or rooms.index(other) < rooms.index(room)
            assert before, f"{path}:{line}: {room} imports {other}"
