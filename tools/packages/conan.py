# SPDX-License-Identifier: MIT
"""Conan 2: the recipe at the root of the source archive, taken through `conan create` with its test."""

import os
import shutil

import packing

RECIPE = packing.HERE / "conan"


def pack(folder):
    made = folder / f"rlvc-conan-{packing.VERSION}"
    packing.copy_project(made)
    shutil.copytree(RECIPE, made, dirs_exist_ok=True)
    shutil.copy(packing.ROW, made / "test_package")
    return packing.pack_tar(made, folder / f"{made.name}.tar.gz")


def check(archive, folder):
    conan = packing.tool("conan")
    env = {**os.environ, "CONAN_HOME": str(folder / "home")}
    source = packing.unpack(archive, folder / "elsewhere")
    packing.run(conan, "profile", "detect", env=env)
    for shared in ("False", "True"):
        # Conan writes what its test prints to stderr.
        output = packing.run("sh", "-c", 'exec "$@" 2>&1', "sh", conan, "create", source, "--no-remote", "-s",
                             "build_type=Debug", "-o", f"rlvc/*:shared={shared}", env=env)  # Debug: compiled sooner
        if packing.expected_row(folder) not in output:
            raise packing.Failed(f"shared={shared} learns another tree")
    return "created and tested by conan, static and shared"
