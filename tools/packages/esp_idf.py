# SPDX-License-Identifier: MIT
"""An ESP-IDF component, whose manifest lies at its root: packed by Espressif's own tool, and built as its build system
builds a component for an ESP32-C3 (a RISC-V processor; its options, and a stand-in for its one command). Learns on an
emulated processor of that kind."""

import shutil

import packing

RECIPE = packing.HERE / "esp_idf"
PROJECT = """cmake_minimum_required(VERSION 3.16)
project(stand_in C)
macro(idf_component_register)
    cmake_parse_arguments(idf "" "" "SRCS;INCLUDE_DIRS" ${{ARGN}})
    set(COMPONENT_LIB __idf_rlvc)
    add_library(${{COMPONENT_LIB}} STATIC ${{idf_SRCS}})
    target_include_directories(${{COMPONENT_LIB}} PUBLIC ${{idf_INCLUDE_DIRS}})
    target_compile_options(${{COMPONENT_LIB}} PRIVATE -std=gnu17 -Os -ffunction-sections -fdata-sections -Wall -Wextra
                           -Werror=all -Wno-unused-parameter -Wno-sign-compare -Wno-enum-conversion)
endmacro()
add_subdirectory({component} rlvc)
add_executable(row {row})
target_link_libraries(row PRIVATE __idf_rlvc)
target_link_options(row PRIVATE -Wl,--defsym=__ram_size=0x10000)
"""
EMULATOR = ("qemu-system-riscv32", "-M", "virt", "-bios", "none", "-nographic", "-monitor", "none", "-serial", "none",
            "-chardev", "stdio,id=s0", "-semihosting-config", "enable=on,target=native,chardev=s0", "-kernel")


def pack(folder):
    component = folder / "rlvc"
    shutil.copytree(RECIPE, component)
    packing.copy_core(component)
    shutil.copy(packing.ROOT / "README.md", component)
    packing.run(packing.tool("compote"), "component", "pack", "--name", "rlvc", "--project-dir", component,
                "--dest-dir", folder / "packed")
    (archive,) = (folder / "packed").glob("*.tgz")
    return archive


def check(archive, folder):
    packing.tool(EMULATOR[0])
    packing.tool("riscv64-unknown-elf-gcc")
    component = packing.unpack(archive, folder / "elsewhere")
    place = folder / "project"
    place.mkdir()
    text = PROJECT.format(component=component, row=packing.ROW)
    (place / "CMakeLists.txt").write_text(text, encoding="utf-8")
    toolchain = packing.ROOT / "cmake/toolchains/rv32imac.cmake"
    packing.run("cmake", "-G", "Ninja", "-S", place, "-B", place / "build", f"-DCMAKE_TOOLCHAIN_FILE={toolchain}")
    packing.run("cmake", "--build", place / "build")
    packing.expect_row(packing.run(*EMULATOR, place / "build/row.elf"), folder)
    return "packed by compote; built by its CMakeLists.txt, learnt on an emulated rv32imac (ESP-IDF itself cannot be had)"
