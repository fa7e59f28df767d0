# SPDX-License-Identifier: MIT
"""An Arduino library: the core in src/, which Arduino compiles all of, with an example that senses a pin. Arduino's own
builder builds the example (C++) with the library (C), without an option of ours; what it made of the library then
learns the row of cells on a simulated processor of 16 KiB, which no board of Arduino's own has."""

import shutil

import packing

RECIPE = packing.HERE / "arduino"
BOARD = ("-fqbn", "arduino:avr:uno", "-prefs=build.mcu=atmega1284p", "-prefs=upload.maximum_size=131072",
         "-prefs=upload.maximum_data_size=16384")
HARDWARE = "/usr/share/arduino/hardware"
FIELDS = ("name", "version", "author", "maintainer", "sentence", "paragraph", "category", "url", "architectures")
# Debian's core for these boards is newer than Debian's compiler for them.
CORE_NEEDS = "-prefs=compiler.cpp.extra_flags=-DDECIMAL_DIG=__DECIMAL_DIG__"


def pack(folder):
    library = folder / "rlvc"
    shutil.copytree(RECIPE, library)
    source = library / "src"
    source.mkdir()
    shutil.copy(packing.ROOT / "LICENSE", library)
    shutil.copytree(packing.ROOT / "core/include/rlvc", source / "rlvc")
    # By a header that lies in src/ itself a sketch's library is found.
    (source / "rlvc.h").write_text('/* SPDX-License-Identifier: MIT */\n#include "rlvc/rlvc.h"\n', encoding="utf-8")
    shutil.copytree(packing.ROOT / "core/src", source / "core")
    shutil.copytree(packing.ROOT / "core/domains", source / "domains")
    return packing.pack_zip(library, folder / f"rlvc-arduino-{packing.VERSION}.zip")


def build(libraries, sketch, folder, *board):
    """What Arduino's builder makes of a sketch: the objects of the libraries."""
    made = folder / f"build-{sketch.stem}"
    made.mkdir()
    packing.run(packing.tool("arduino-builder"), "-compile", "-hardware", "/usr/share/arduino-builder", "-hardware",
                HARDWARE, "-tools", HARDWARE, "-libraries", libraries, *board, "-build-path", made,
                "-prefs=runtime.tools.avr-gcc.path=/usr", CORE_NEEDS, sketch)
    return (made / "libraries").rglob("*.o")


def check(archive, folder):
    simavr = packing.tool("simavr")
    library = packing.unpack(archive, folder / "unpacked").rename(folder / "rlvc")
    libraries = folder / "libraries"
    libraries.mkdir()
    library = library.rename(libraries / "rlvc")
    lines = (library / "library.properties").read_text(encoding="utf-8").splitlines()
    fields = dict(line.split("=", 1) for line in lines)
    lacking = [name for name in FIELDS if not fields.get(name)]
    if lacking:
        raise packing.Failed(f"library.properties lacks {lacking}")
    objects = build(libraries, library / "examples/Sensor/Sensor.ino", folder, *BOARD)
    packing.run("avr-gcc", "-mmcu=atmega1284p", "-std=gnu11", "-Os", "-flto", "-fuse-linker-plugin", "-Wl,--gc-sections",
                f"-I{library}/src", packing.ROW, packing.ROOT / "tests/targets/avr.c", *objects, "-o", folder / "row.elf")
    packing.expect_row(packing.run_simulated(simavr, "atmega1284p", folder / "row.elf"), folder)
    return "built by arduino-builder with an example, learnt on a simulated ATmega1284P"
