# SPDX-License-Identifier: MIT
"""The core in two files, rlvc.c and rlvc.h (amalgamate.py)."""

import shutil

import amalgamate
import packing


def pack(folder):
    made = folder / f"rlvc-amalgamation-{packing.VERSION}"
    amalgamate.write(made)
    shutil.copy(packing.ROOT / "LICENSE", made)
    return packing.pack_zip(made, folder / f"{made.name}.zip")


def check(archive, folder):
    """The row of cells, and the program of the README as C++: both include the one header."""
    place = packing.unpack(archive, folder / "elsewhere")
    row = packing.ROW.read_text(encoding="utf-8").replace("<rlvc/rlvc.h>", '"rlvc.h"')
    (place / "row.c").write_text(row, encoding="utf-8")
    packing.run("cc", "-O1", "-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-c", "row.c", "rlvc.c", cwd=place)
    packing.run("cc", "row.o", "rlvc.o", "-o", "row", cwd=place)
    packing.expect_row(packing.run(place / "row"), folder)
    program = (packing.ROOT / "examples/01_learn.c").read_text(encoding="utf-8").replace("<rlvc/rlvc.h>", '"rlvc.h"')
    (place / "learn.cpp").write_text(program, encoding="utf-8")
    packing.run("c++", "-Wall", "-Wextra", "-Werror", "learn.cpp", "rlvc.o", "-o", "learn", cwd=place)
    packing.run(place / "learn")
    return "compiled as C99, its header as C++"
