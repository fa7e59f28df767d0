#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that every place that carries the version carries the same one."""

import argparse
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]

# File, and a pattern whose groups, joined by dots, are the version.
PLACES = [
    ("CMakeLists.txt", r"^project\(rlvc VERSION (\S+)"),
    ("core/include/rlvc/rlvc.h", r'^#define RLVC_VERSION "(.*)"'),
    ("core/include/rlvc/rlvc.h",
     r"^#define RLVC_VERSION_MAJOR (\d+)\n#define RLVC_VERSION_MINOR (\d+)\n"
     r"#define RLVC_VERSION_PATCH (\d+)$"),
    ("shim/rlvc/_version.py", r'^__version__ = "(.*)"$'),
    ("CHANGELOG.md", r"^## \[(\d[^\]]*)\]"),
    ("library.json", r'^    "version": "(.*)"'),
    ("tools/packages/arduino/library.properties", r"^version=(.*)"),
    ("tools/packages/vcpkg/vcpkg.json", r'^  "version": "(.*)"'),
    ("tools/packages/esp_idf/idf_component.yml", r'^version: "(.*)"'),
]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--project", help="the version that CMake knows; default: not looked at")
    arguments = parser.parse_args()
    found = {"CMake": arguments.project} if arguments.project else {}
    for number, (name, pattern) in enumerate(PLACES):
        match = re.search(pattern, (ROOT / name).read_text(encoding="utf-8"), re.MULTILINE)
        found[f"{name} ({number})"] = ".".join(match.groups()) if match else "none"
    for place, version in found.items():
        print(f"{version}  {place}")
    if len(set(found.values())) != 1:
        print("the versions differ", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
