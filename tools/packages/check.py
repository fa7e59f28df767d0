#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Packs the library for each system that packages it, unpacks that elsewhere, builds a program with it as the system
does, and has it learn the row of cells (tests/targets/row.c): the tree must be that of the project's own sources. What
cannot be had is skipped by name. With --pack, keeps the archives, which are what a release publishes."""

import argparse
import importlib
import pathlib
import shutil
import sys
import tempfile

import packing

PACKAGES = ("amalgamation", "cmake", "platformio", "arduino", "esp_idf", "zephyr", "cmsis_pack", "vcpkg", "conan",
            "debian", "windows", "wheels")


def try_package(name, archives):
    """A line that says how it went, and whether it passed; None: it was skipped."""
    package = importlib.import_module(name)
    with tempfile.TemporaryDirectory() as made, tempfile.TemporaryDirectory() as elsewhere:
        try:
            archive = package.pack(pathlib.Path(made))
            if archives:
                shutil.copy(archive, archives)
            said = package.check(archive, pathlib.Path(elsewhere))
        except packing.Skip as reason:
            return f"{name}: skipped: {reason}", None
        except packing.Failed as fault:
            return f"{name}: FAILED: {fault}", False
        return f"{name}: {archive.name}: {said}", True


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("package", nargs="*", help=f"of {', '.join(PACKAGES)}; default: all")
    parser.add_argument("--pack", type=pathlib.Path, metavar="FOLDER", help="where the archives go")
    parser.add_argument("--unoptimised", action="store_true", help="compile sooner what is not for a release")
    arguments = parser.parse_args()
    packing.optimised = not arguments.unoptimised
    for name in arguments.package:
        if name not in PACKAGES:
            parser.error(f"no such package: {name}")
    if arguments.pack:
        arguments.pack.mkdir(parents=True, exist_ok=True)
    count = {True: 0, False: 0, None: 0}
    for name in arguments.package or PACKAGES:
        line, passed = try_package(name, arguments.pack)
        print(line, flush=True)
        count[passed] += 1
    print(f"packages: {count[True]} passed, {count[False]} failed, {count[None]} skipped")
    return count[False] > 0


if __name__ == "__main__":
    sys.exit(main())
