# SPDX-License-Identifier: MIT
"""The library for 64-bit Windows, static and as a DLL: cross-built by mingw, used through the DLL under Wine."""

import os
import pathlib
import shutil

import packing

WINE = "/usr/lib/wine/wine64"  # where Debian keeps it


def pack(folder):
    compiler = packing.tool("x86_64-w64-mingw32-gcc")
    kind = "MinSizeRel" if packing.optimised else "Debug"
    made, build = folder / f"rlvc-windows-x86_64-{packing.VERSION}", folder / "build"
    packing.run("cmake", "-G", "Ninja", "-S", packing.ROOT, "-B", build, "-DCMAKE_SYSTEM_NAME=Windows",
                f"-DCMAKE_C_COMPILER={compiler}", f"-DCMAKE_BUILD_TYPE={kind}", "-DRLVC_VISION=OFF",
                "-DRLVC_TOOLS=OFF", "-DRLVC_EXAMPLES=OFF", f"-DCMAKE_INSTALL_PREFIX={made}")
    packing.run("cmake", "--build", build, "--target", "install")
    shutil.copy(packing.ROOT / "LICENSE", made)
    return packing.pack_zip(made, folder / f"{made.name}.zip")


def check(archive, folder):
    if not pathlib.Path(WINE).exists():
        raise packing.Skip("there is no wine64")
    place = packing.unpack(archive, folder / "elsewhere")
    program = place / "bin/row.exe"  # beside the DLL, which is found there
    packing.run("x86_64-w64-mingw32-gcc", "-O1", "-DRLVC_DLL", f"-I{place}/include", packing.ROW, f"-L{place}/lib",
                "-lrlvc", "-o", program)
    env = {**os.environ, "WINEPREFIX": str(folder / "wine"), "WINEDEBUG": "-all"}
    packing.expect_row(packing.run(WINE, program, env=env), folder)
    return "cross-built by mingw, learnt through the DLL under Wine"
