#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that each C++ file of run_gridworld compiles by itself, as in a user's build. The tests build all of them as
one file (RLVC_UNITY), where a missing include is not noticed."""

import concurrent.futures
import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
TOOL = ROOT / "tools/run_gridworld"
OPENCV = pathlib.Path("/usr/include/opencv4")
SKIPPED = 77


def compiles(source):
    include = [f"-I{ROOT / folder}" for folder in ("core/include", "vision/include", "examples", "examples/gridworld")]
    return subprocess.run(["c++", "-std=c++17", "-fsyntax-only", *include, "-isystem", OPENCV, source],
                          check=False).returncode == 0


def main():
    if not shutil.which("c++") or not OPENCV.exists():
        print("skipped: there is no C++ compiler or no OpenCV")
        return SKIPPED
    sources = sorted(TOOL.rglob("*.cc"))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        failed = [source for source, fine in zip(sources, pool.map(compiles, sources)) if not fine]
    for source in failed:
        print(f"{source.relative_to(ROOT)} does not compile by itself")
    print(f"{len(sources)} files, {len(failed)} failed")
    return len(failed) > 0


if __name__ == "__main__":
    sys.exit(main())
