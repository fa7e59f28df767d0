#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that the C and C++ of the project are as clang-format leaves them (.clang-format); with --write,
formats what is not."""

import argparse
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ("core", "examples", "shim", "tests", "tools", "vision")
VERSION = "14."  # Debian 12's: another one formats a little differently
SKIPPED = 77


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="format the files")
    arguments = parser.parse_args()
    program = shutil.which("clang-format-14") or shutil.which("clang-format")
    version = program and subprocess.run([program, "--version"], check=True, stdout=subprocess.PIPE,
                                         text=True).stdout
    if not version or f"version {VERSION}" not in version:
        print(f"skipped: there is no clang-format {VERSION}x")
        return SKIPPED
    files = sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*")
                   if path.suffix in (".c", ".h", ".cc"))
    options = ["-i"] if arguments.write else ["--dry-run", "-Werror"]
    done = subprocess.run([program, "--style=file", *options, *files], check=False)
    if done.returncode:
        print("run tools/check/format.py --write", file=sys.stderr)
    print(f"{len(files)} files")
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())
