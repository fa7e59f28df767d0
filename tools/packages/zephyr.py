# SPDX-License-Identifier: MIT
"""A Zephyr module: zephyr/module.yml where west looks for it, and a sample. A west workspace takes it in, Kconfig reads
its options, and its CMakeLists.txt and its sample are built (with stand-ins for Zephyr's commands). Learns on an emulated
Cortex-M3."""

import os
import re
import shutil

import packing

RECIPE = packing.HERE / "zephyr"
MANIFEST = """manifest:
  projects:
    - name: rlvc
      url: file://{module}
      revision: main
"""
# What Zephyr's build defines before it reads a module and an application.
STAND_IN = """cmake_minimum_required(VERSION 3.20)
project(stand_in C)
set(CONFIG_RLVC y)
macro(zephyr_library_named name)
    set(ZEPHYR_CURRENT_LIBRARY ${{name}})
    add_library(${{name}} STATIC)
endmacro()
macro(zephyr_library_sources)
    target_sources(${{ZEPHYR_CURRENT_LIBRARY}} PRIVATE ${{ARGN}})
endmacro()
macro(zephyr_include_directories)
    include_directories(${{ARGN}})
endmacro()
macro(zephyr_library_compile_definitions_ifdef feature)
    if(${{feature}})
        target_compile_definitions(${{ZEPHYR_CURRENT_LIBRARY}} PRIVATE ${{ARGN}})
    endif()
endmacro()
add_compile_options(-std=c99 -O1 -ffunction-sections -fdata-sections -Wall)
add_subdirectory({module}/{cmake} rlvc)
get_directory_property(include DIRECTORY {module}/{cmake} INCLUDE_DIRECTORIES)
include_directories(${{include}})
add_executable(app)
target_link_libraries(app PRIVATE rlvc)
target_link_options(app PRIVATE -Wl,--defsym=__ram_size=0x10000)
add_subdirectory({module}/{sample} sample)
"""


def pack(folder):
    module = folder / "rlvc"
    shutil.copytree(RECIPE, module)
    packing.copy_core(module)
    (module / "samples/row/src").mkdir(exist_ok=True)
    shutil.copy(packing.ROW, module / "samples/row/src/main.c")
    return packing.pack_tar(module, folder / f"rlvc-zephyr-{packing.VERSION}.tar.gz")


def in_a_workspace(module, folder):
    """Where west puts the module that a manifest names."""
    west = packing.tool("west")
    env = {**os.environ, "GIT_AUTHOR_NAME": "rlvc", "GIT_AUTHOR_EMAIL": "rlvc@example.org",
           "GIT_COMMITTER_NAME": "rlvc", "GIT_COMMITTER_EMAIL": "rlvc@example.org"}
    for command in (("init", "--quiet", "--initial-branch=main"), ("add", "--all"), ("commit", "--quiet", "-m", "rlvc")):
        packing.run("git", "-C", module, *command, env=env)
    manifest = folder / "workspace" / "manifest"
    manifest.mkdir(parents=True)
    (manifest / "west.yml").write_text(MANIFEST.format(module=module), encoding="utf-8")
    packing.run(west, "init", "--local", manifest, cwd=folder / "workspace")
    packing.run(west, "update", cwd=folder / "workspace")
    listed = packing.run(west, "list", "--format", "{abspath}", "rlvc", cwd=folder / "workspace").decode().strip()
    return packing.pathlib.Path(listed)


def read_options(file):
    """Kconfig's own reading: RLVC_ASSERTS can be chosen once RLVC is."""
    try:
        import kconfiglib
    except ImportError:
        raise packing.Skip("there is no kconfiglib") from None
    options = kconfiglib.Kconfig(str(file), warn=False)
    options.syms["RLVC"].set_value("y")
    options.syms["RLVC_ASSERTS"].set_value("y")
    if options.syms["RLVC_ASSERTS"].str_value != "y":
        raise packing.Failed("CONFIG_RLVC_ASSERTS cannot be set")


def check(archive, folder):
    packing.tool(packing.EMULATED_M3[0])
    packing.tool("arm-none-eabi-gcc")
    module = in_a_workspace(packing.unpack(archive, folder / "elsewhere"), folder)
    said = dict(re.findall(r"^ *(?:- )?(\w+): *(\S+)$", (module / "zephyr/module.yml").read_text(encoding="utf-8"),
                           re.MULTILINE))
    read_options(module / said["kconfig"])
    place = folder / "project"
    (place / "cmake").mkdir(parents=True)
    text = STAND_IN.format(module=module, cmake=said["cmake"], sample="samples/row")
    (place / "CMakeLists.txt").write_text(text, encoding="utf-8")
    (place / "cmake/ZephyrConfig.cmake").write_text("", encoding="utf-8")
    toolchain = packing.ROOT / "cmake/toolchains/cortex-m3.cmake"
    packing.run("cmake", "-G", "Ninja", "-S", place, "-B", place / "build", f"-DCMAKE_TOOLCHAIN_FILE={toolchain}",
                f"-DZephyr_DIR={place / 'cmake'}")
    packing.run("cmake", "--build", place / "build")
    packing.expect_row(packing.run(*packing.EMULATED_M3, place / "build/app.elf"), folder)
    return "found by west, its options read by Kconfig, its sample learnt on an emulated Cortex-M3 (Zephyr cannot be had)"
