#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that each C++ file compiles by itself, as in a user's build. The tests build a library or a program as one file
(RLVC_UNITY), where a missing include is not noticed. A large header of another project, where a file includes it, is read
as clang has precompiled it. Needs clang and OpenCV."""

import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCES = ("tools/run_gridworld/**/*.cc", "vision/src/*.cc", "examples/gridworld/objects/*.cc", "examples/*.cc")
FOLDERS = [ROOT / folder for folder in ("core/include", "vision/include", "examples", "examples/gridworld")]
OPENCV = pathlib.Path("/usr/include/opencv4")
# Those that take longest to read, the longest first: a file takes one that is precompiled.
PRECOMPILED = ("CLI/CLI.hpp", "nlohmann/json.hpp", "opencv2/core.hpp")
INCLUDE = re.compile(r'^#include [<"]([^>"]+)[>"]', re.MULTILINE)
COMPILE = ("clang++", "-std=c++17", "-mavx2", *(f"-I{folder}" for folder in FOLDERS), "-isystem", OPENCV)
SKIPPED = 77


def included(path, found):
    """Adds to the names of found all headers that a file includes, also through headers of ours."""
    for name in INCLUDE.findall(path.read_text(encoding="utf-8")):
        if name not in found:
            found.add(name)
            ours = next((folder / name for folder in (path.parent, *FOLDERS) if (folder / name).is_file()), None)
            if ours:
                included(ours, found)
    return found


def precompile(header, folder):
    output = folder / header.replace("/", "_")
    subprocess.run([*COMPILE, "-x", "c++-header", "-", "-o", output], input=f"#include <{header}>\n", text=True, check=True)
    return output


def compiles(source, precompiled):
    headers = included(source, set())
    ready = next((["-include-pch", precompiled[name].result()] for name in PRECOMPILED if name in headers), [])
    return subprocess.run([*COMPILE, *ready, "-fsyntax-only", source], check=False).returncode == 0


def main():
    if not shutil.which("clang++") or not OPENCV.exists():
        print("skipped: there is no clang or no OpenCV")
        return SKIPPED
    sources = sorted(path for pattern in SOURCES for path in ROOT.glob(pattern))
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        precompiled = {header: pool.submit(precompile, header, pathlib.Path(folder)) for header in PRECOMPILED}
        verdicts = list(pool.map(lambda source: compiles(source, precompiled), sources))
    failed = [source for source, fine in zip(sources, verdicts) if not fine]
    for source in failed:
        print(f"{source.relative_to(ROOT)} does not compile by itself")
    print(f"{len(sources)} files, {len(failed)} failed")
    return len(failed) > 0


if __name__ == "__main__":
    sys.exit(main())
