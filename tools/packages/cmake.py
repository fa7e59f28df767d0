# SPDX-License-Identifier: MIT
"""The source archive, by CMake and by pkg-config: installed and found, fetched as a part of another project (one that
builds in unity), and by the oldest CMake that it asks for."""

import os
import shutil

import packing

PROJECT = """cmake_minimum_required(VERSION 3.16)
project(consumer C)
{use}
add_executable(row {row})
target_link_libraries(row PRIVATE {target})
"""
FIND = "find_package(rlvc REQUIRED CONFIG)"
FETCH = """include(FetchContent)
FetchContent_Declare(rlvc URL {archive} URL_HASH SHA256={hash})
FetchContent_MakeAvailable(rlvc)"""


def pack(folder):
    made = folder / f"rlvc-{packing.VERSION}"
    packing.copy_project(made)
    return packing.pack_tar(made, folder / f"rlvc-source-{packing.VERSION}.tar.gz")


def consume(folder, name, cmake, use, target, *options):
    """Configures, builds and runs a project that uses the library so."""
    place = folder / name
    place.mkdir()
    text = PROJECT.format(use=use, row=packing.ROW, target=target)
    (place / "CMakeLists.txt").write_text(text, encoding="utf-8")
    packing.run(cmake, "-G", "Ninja", "-S", place, "-B", place / "build", *options)
    packing.run(cmake, "--build", place / "build")
    packing.expect_row(packing.run(place / "build/row"), folder)


def install(folder, name, cmake, source):
    """Installs the library alone, and moves it: an installed tree may be anywhere."""
    prefix, build = folder / f"{name}-there", folder / f"{name}-build"
    packing.run(cmake, "-G", "Ninja", "-S", source, "-B", build, "-DRLVC_VISION=OFF", "-DRLVC_TOOLS=OFF",
                "-DRLVC_EXAMPLES=OFF", f"-DCMAKE_INSTALL_PREFIX={prefix}")
    packing.run(cmake, "--build", build, "--target", "install")
    return prefix.rename(folder / f"{name}-prefix")


def by_pkg_config(prefix, folder):
    """By hand and shared, without ldconfig or LD_LIBRARY_PATH; and static."""
    (library,) = prefix.glob("lib*/**/pkgconfig")
    env = {**os.environ, "PKG_CONFIG_PATH": str(library)}
    flags = packing.run("pkg-config", "--cflags", "--libs", "rlvc", env=env).decode().split()
    packing.run("cc", packing.ROW, *flags, "-o", folder / "by-hand")
    packing.expect_row(packing.run(folder / "by-hand"), folder)


def check(archive, folder):
    source = packing.unpack(archive, folder / "elsewhere")
    cmake = packing.tool("cmake")
    digest = packing.run("sha256sum", archive).decode().split()[0]
    prefix = install(folder, "new", cmake, source)
    consume(folder, "shared", cmake, FIND, "rlvc::rlvc", f"-DCMAKE_PREFIX_PATH={prefix}")
    consume(folder, "static", cmake, FIND, "rlvc::rlvc_static", f"-DCMAKE_PREFIX_PATH={prefix}")
    # What is fetched is added as a directory is, here to a project that builds in unity.
    consume(folder, "fetched", cmake, FETCH.format(archive=archive, hash=digest), "rlvc::rlvc", "-DCMAKE_UNITY_BUILD=ON")
    by_pkg_config(prefix, folder)
    ways = "find_package, FetchContent in unity, pkg-config without ldconfig"
    oldest = os.environ.get("RLVC_OLD_CMAKE") or shutil.which("cmake-3.16")
    if not oldest:
        return f"{ways}; not by CMake 3.16 (RLVC_OLD_CMAKE names none)"
    consume(folder, "old", oldest, f"add_subdirectory({source} rlvc)", "rlvc::rlvc")
    consume(folder, "old-found", oldest, FIND, "rlvc::rlvc",
            f"-DCMAKE_PREFIX_PATH={install(folder, 'old', oldest, source)}")
    return f"{ways}; also by CMake 3.16"
