#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tries the core as a module of Zephyr, a component of ESP-IDF, an Arduino library and a PlatformIO
library. The first two are configured with stand-ins for what those systems define, and built; the third is
laid out and compiled; the last is packed by PlatformIO itself, if it is installed (else: skipped)."""

import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tarfile
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEAD = "cmake_minimum_required(VERSION 3.25)\nproject(stand_in C)\n"
ZEPHYR = HEAD + """
set(CONFIG_RLVC y)
set(CONFIG_RLVC_ASSERTS y)
macro(zephyr_library_named name)
    set(ZEPHYR_CURRENT_LIBRARY ${name})
    add_library(${name} STATIC)
endmacro()
macro(zephyr_library_sources)
    target_sources(${ZEPHYR_CURRENT_LIBRARY} PRIVATE ${ARGN})
endmacro()
macro(zephyr_include_directories)
    target_include_directories(${ZEPHYR_CURRENT_LIBRARY} PUBLIC ${ARGN})
endmacro()
macro(zephyr_compile_options)
    target_compile_options(${ZEPHYR_CURRENT_LIBRARY} PUBLIC ${ARGN})
endmacro()
macro(zephyr_library_compile_definitions_ifdef feature)
    if(${feature})
        target_compile_definitions(${ZEPHYR_CURRENT_LIBRARY} PRIVATE ${ARGN})
    endif()
endmacro()
"""
ESP_IDF = HEAD + """
macro(idf_component_register)
    cmake_parse_arguments(idf "" "" "SRCS;INCLUDE_DIRS" ${ARGN})
    set(COMPONENT_LIB rlvc)
    add_library(rlvc STATIC ${idf_SRCS})
    target_include_directories(rlvc PUBLIC ${idf_INCLUDE_DIRS})
endmacro()
"""
PROGRAM = '#include <rlvc/rlvc.h>\nint main(void) { return rlvc_version() == 0; }\n'


def run(*command):
    done = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(str(part) for part in command)}\n{done.stdout}")


def by_cmake(folder, stand_in, module):
    (folder / "CMakeLists.txt").write_text(
        f'{stand_in}add_subdirectory("{ROOT}/core/{module}" rlvc)\n'
        "add_executable(program program.c)\ntarget_link_libraries(program PRIVATE rlvc)\n",
        encoding="utf-8")
    (folder / "program.c").write_text(PROGRAM, encoding="utf-8")
    run("cmake", "-G", "Ninja", "-S", folder, "-B", folder / "build")
    run("cmake", "--build", folder / "build")
    run(folder / "build/program")


def zephyr(folder):
    text = (ROOT / "core/zephyr/module.yml").read_text(encoding="utf-8")
    for name in ("cmake: zephyr", "kconfig: zephyr/Kconfig"):
        if name not in text or not (ROOT / "core" / name.split(": ")[1]).exists():
            raise SystemExit(f"core/zephyr/module.yml: {name}")
    by_cmake(folder, ZEPHYR, "zephyr")


def esp_idf(folder):
    by_cmake(folder, ESP_IDF, "esp-idf")


def arduino(folder):
    library = folder / "rlvc"
    run(ROOT / "core/arduino/pack", library)
    lines = (library / "library.properties").read_text(encoding="utf-8").splitlines()
    fields = dict(line.split("=", 1) for line in lines)
    for name in ("name", "version", "author", "maintainer", "sentence", "paragraph", "category",
                 "url", "architectures"):
        if not fields.get(name):
            raise SystemExit(f"library.properties lacks {name}")
    (folder / "program.c").write_text(PROGRAM, encoding="utf-8")
    run("cc", f"-I{library}/src", folder / "program.c", *library.glob("src/**/*.c"), "-o",
        folder / "program")
    run(folder / "program")


def platformio(folder):
    pio = os.environ.get("RLVC_PIO") or shutil.which("pio")
    if not pio:
        return "skipped: there is no pio"
    library, packed_file = folder / "rlvc", folder / "rlvc.tar.gz"
    shutil.copytree(ROOT, library, ignore=shutil.ignore_patterns(".git", "build"))
    command = [pio, "pkg", "pack", str(library), "--output", str(packed_file)]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          check=False)
    note = ""
    if "Could not load SPDX licenses" in done.stdout: # it fetches their list
        note = ", but the licence could not be looked up"
        manifest = json.loads((library / "library.json").read_text(encoding="utf-8"))
        del manifest["license"]
        (library / "library.json").write_text(json.dumps(manifest), encoding="utf-8")
        run(*command)
    elif done.returncode != 0:
        raise SystemExit(done.stdout)
    with tarfile.open(packed_file) as packed:
        names = packed.getnames()
        manifest = json.load(packed.extractfile("library.json"))
    wanted = {str(path.relative_to(ROOT)) for path in (ROOT / "core").glob("**/*.[ch]")}
    if wanted - set(names):
        raise SystemExit(f"not packed: {sorted(wanted - set(names))}")
    return f"packed {manifest['name']} {manifest['version']}: {len(names)} files{note}"


def main():
    argparse.ArgumentParser(description=__doc__).parse_args()
    for check in (zephyr, esp_idf, arduino, platformio):
        with tempfile.TemporaryDirectory() as folder:
            print(f"{check.__name__}: {check(pathlib.Path(folder)) or 'built'}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
