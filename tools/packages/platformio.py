# SPDX-License-Identifier: MIT
"""PlatformIO: `pio pkg pack`, then what its builder does with the manifest that was packed: the sources of srcDir that
srcFilter names, by build.flags. Its platforms come from a registry of its own. The sketch of the tutorial "my own sensor"
is compiled as its src/main.cpp, by the flags and with the headers of an Arduino board."""

import json
import os
import shutil

import packing


ARDUINO = "/usr/share/arduino/hardware/arduino/avr"
BOARD = ("-mmcu=atmega1284p", "-std=gnu++11", "-fpermissive", "-fno-exceptions", "-fno-threadsafe-statics", "-Os",
         "-DF_CPU=16000000L", "-DPLATFORMIO=60100", "-DARDUINO=10808", f"-I{ARDUINO}/cores/arduino",
         f"-I{ARDUINO}/variants/standard")


def sources_of(library, build):
    """What a library's srcFilter takes of its srcDir, as PlatformIO reads it: +<glob>."""
    root = library / build["srcDir"]
    return [path for rule in build["srcFilter"] for path in sorted(root.glob(rule.removeprefix("+<").removesuffix(">")))]


def compile_sketch(includes, flags, folder):
    """As the tutorial says: the sketch with these two lines in place of its own include."""
    tutorial = (packing.ROOT / "shim/docs/tutorials/sensor.md").read_text(encoding="utf-8")
    lines = "#include <Arduino.h>\n#include <rlvc/rlvc.h>\n"
    if lines not in tutorial:
        raise packing.Failed("the tutorial gives other lines for PlatformIO than are tried here")
    sketch = (packing.HERE / "arduino/examples/Sensor/Sensor.ino").read_text(encoding="utf-8")
    (folder / "main.cpp").write_text(sketch.replace("#include <rlvc.h>\n", lines), encoding="utf-8")
    packing.run(packing.tool("avr-g++"), *BOARD, *flags, includes, "-c", folder / "main.cpp", "-o", folder / "main.o")


def pack(folder):
    pio = os.environ.get("RLVC_PIO") or packing.tool("pio")
    place = folder / "rlvc"
    packing.copy_project(place)
    archive = folder / f"rlvc-platformio-{packing.VERSION}.tar.gz"
    try:
        packing.run(pio, "pkg", "pack", place, "--output", archive)
    except packing.Failed as fault:
        if "Could not load SPDX licenses" not in str(fault):  # it fetches their list
            raise
        manifest = json.loads((place / "library.json").read_text(encoding="utf-8"))
        without = {key: value for key, value in manifest.items() if key != "license"}
        (place / "library.json").write_text(json.dumps(without), encoding="utf-8")
        packing.run(pio, "pkg", "pack", place, "--output", archive)
        shutil.rmtree(place)
        repacked = packing.unpack(archive, place)
        (repacked / "library.json").write_text(json.dumps(manifest, indent=4) + "\n", encoding="utf-8")
        packing.pack_tar(repacked, archive, within=".")
    return archive


def check(archive, folder):
    library = packing.unpack(archive, folder / "elsewhere")
    manifest = json.loads((library / "library.json").read_text(encoding="utf-8"))
    build = manifest["build"]
    sources = sources_of(library, build)
    if len(sources) != sum(path.suffix == ".c" for path in packing.core_files()):
        raise packing.Failed(f"{len(sources)} sources are packed")
    includes = f"-I{library / build['includeDir']}"
    packing.run("cc", "-std=gnu11", "-O0", *build["flags"], includes, packing.ROW, *sources, "-o", folder / "row")
    packing.expect_row(packing.run(folder / "row"), folder)
    compile_sketch(includes, build["flags"], folder)
    return ("packed by PlatformIO; built for this machine by its manifest, the tutorial's sketch for an Arduino board "
            "(its platforms cannot be had)")
