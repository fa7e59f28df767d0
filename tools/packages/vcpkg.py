# SPDX-License-Identifier: MIT
"""A port for vcpkg, whose portfile fetches the source archive of the same release. vcpkg itself comes from a server of
its own, so that its functions have stand-ins, as its documentation describes them: CMake runs the portfile for static
libraries, vcpkg's default on Linux, and a program finds the package that it leaves. Shared ones, of which the portfile
knows nothing, are asked for in the same way by Conan."""

import hashlib
import json
import shutil

import cmake
import packing

RECIPE = packing.HERE / "vcpkg"
# What vcpkg defines before it includes a portfile.
STAND_IN = """cmake_minimum_required(VERSION 3.19)
set(PORT rlvc)
set(VERSION {version})
set(CURRENT_PACKAGES_DIR {place}/packages)
function(succeed)
    execute_process(COMMAND ${{ARGV}} RESULT_VARIABLE status OUTPUT_QUIET)
    if(NOT status EQUAL 0)
        message(FATAL_ERROR "exit status ${{status}}: ${{ARGV}}")
    endif()
endfunction()
function(vcpkg_download_distfile result)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "FILENAME;SHA512" "URLS")
    file(SHA512 {downloads}/${{arg_FILENAME}} digest)
    if(NOT digest STREQUAL arg_SHA512)
        message(FATAL_ERROR "${{arg_FILENAME}} is not the archive that the port names")
    endif()
    set(${{result}} {downloads}/${{arg_FILENAME}} PARENT_SCOPE)
endfunction()
function(vcpkg_extract_source_archive result)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "ARCHIVE" "")
    file(ARCHIVE_EXTRACT INPUT ${{arg_ARCHIVE}} DESTINATION {place}/source)
    file(GLOB inside {place}/source/*)
    set(${{result}} ${{inside}} PARENT_SCOPE)
endfunction()
function(vcpkg_cmake_configure)
    cmake_parse_arguments(PARSE_ARGV 0 arg "" "SOURCE_PATH" "OPTIONS")
    succeed(${{CMAKE_COMMAND}} -G Ninja -S ${{arg_SOURCE_PATH}} -B {place}/build -DCMAKE_BUILD_TYPE=Debug
            -DCMAKE_INSTALL_PREFIX=${{CURRENT_PACKAGES_DIR}} -DCMAKE_INSTALL_LIBDIR=lib -DBUILD_SHARED_LIBS=OFF
            ${{arg_OPTIONS}})
endfunction()
function(vcpkg_cmake_install)
    succeed(${{CMAKE_COMMAND}} --build {place}/build --target install)
endfunction()
function(vcpkg_cmake_config_fixup)
    cmake_parse_arguments(PARSE_ARGV 0 arg "" "CONFIG_PATH" "")
    if(NOT EXISTS ${{CURRENT_PACKAGES_DIR}}/${{arg_CONFIG_PATH}}/rlvcConfig.cmake)
        message(FATAL_ERROR "no configuration in ${{arg_CONFIG_PATH}}")
    endif()
endfunction()
function(vcpkg_fixup_pkgconfig)
endfunction()
function(vcpkg_install_copyright)
    cmake_parse_arguments(PARSE_ARGV 0 arg "" "" "FILE_LIST")
    file(COPY ${{arg_FILE_LIST}} DESTINATION ${{CURRENT_PACKAGES_DIR}}/share/${{PORT}})
endfunction()
include({port}/portfile.cmake)
"""


def pack(folder):
    """The port, and beside it the archive that it fetches."""
    made = folder / f"rlvc-vcpkg-{packing.VERSION}"
    port = made / "ports/rlvc"
    shutil.copytree(RECIPE, port)
    archive = cmake.pack(made)
    shutil.rmtree(made / f"rlvc-{packing.VERSION}")
    text = (port / "portfile.cmake").read_text(encoding="utf-8")
    digest = hashlib.sha512(archive.read_bytes()).hexdigest()
    (port / "portfile.cmake").write_text(text.replace("@SHA512@", digest), encoding="utf-8")
    return packing.pack_zip(made, folder / f"{made.name}.zip")


def run_port(source, place):
    """What the port installs."""
    place.mkdir()
    manifest = json.loads((source / "ports/rlvc/vcpkg.json").read_text(encoding="utf-8"))
    text = STAND_IN.format(version=manifest["version"], place=place, downloads=source, port=source / "ports/rlvc")
    (place / "run.cmake").write_text(text, encoding="utf-8")
    packing.run(packing.tool("cmake"), "-P", place / "run.cmake")
    return place / "packages"


def check(archive, folder):
    source = packing.unpack(archive, folder / "elsewhere")
    packages = run_port(source, folder / "port")
    names = {path.name for path in packages.rglob("*")}
    if not {"LICENSE", "usage", "librlvc.a"} <= names or "librlvc.so" in names:
        raise packing.Failed(f"the port installs {sorted(names)}")
    cmake.consume(folder, "vcpkg", packing.tool("cmake"), cmake.FIND, "rlvc::rlvc", f"-DCMAKE_PREFIX_PATH={packages}")
    return "its portfile run by CMake, static, for debugging (vcpkg itself cannot be had)"
