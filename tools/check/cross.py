# SPDX-License-Identifier: MIT
"""The compilers for small machines: how each compiles the core as one file, links a program with what it uses of
that and nothing else, and how many bytes the program then takes."""

import collections
import re
import shutil
import subprocess

from committed import ROOT

Target = collections.namedtuple("Target", "compiler options")

ARM = ("arm-none-eabi-gcc", "--specs=picolibc.specs", "-mthumb")
RISCV = ("riscv64-unknown-elf-gcc", "--specs=picolibc.specs", "-mcmodel=medany")
FREESTANDING = ROOT / "examples/playground/freestanding"
TARGETS = {
    "AVR": Target("avr-gcc", ("-mmcu=atmega1284p",)),
    "M0": Target(ARM[0], (*ARM[1:], "-mcpu=cortex-m0")),
    "M3": Target(ARM[0], (*ARM[1:], "-mcpu=cortex-m3")),
    "M4F": Target(ARM[0], (*ARM[1:], "-mcpu=cortex-m4", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16")),
    "M7": Target(ARM[0], (*ARM[1:], "-mcpu=cortex-m7", "-mfloat-abi=hard", "-mfpu=fpv5-sp-d16")),
    "rv32imac": Target(RISCV[0], (*RISCV[1:], "-march=rv32imac", "-mabi=ilp32")),
    "rv64imac": Target(RISCV[0], (*RISCV[1:], "-march=rv64imac", "-mabi=lp64")),
    "wasm32": Target("clang", ("--target=wasm32", "-mbulk-memory", f"-I{FREESTANDING}")),
}
NEEDS = {"clang": ("clang", "wasm-ld")}  # beside itself, where that is not all
FLAGS = ("-std=c99", "-ffp-contract=off", "-ffunction-sections", "-fdata-sections", f"-I{ROOT}/core/include")
BARE = ("--crt0=minimal", "-Wl,--defsym=__flash=0x80000000", "-Wl,--defsym=__flash_size=0x200000",
        "-Wl,--defsym=__ram=0x80200000", "-Wl,--defsym=__ram_size=0x40000")  # nothing but what a program needs
ROOMY = ("-Wl,--defsym=__DATA_REGION_LENGTH__=0xfe00",)  # as if it had the memory, to tell what that is
IN_FLASH = ("text", "init", "rodata", "srodata", "data", "sdata")
IN_RAM = ("data", "bss", "sdata", "sbss")


def run(*command):
    return subprocess.run([str(part) for part in command], check=True, stdout=subprocess.PIPE,
                          text=True).stdout


def missing(compiler):
    """What is not installed of a compiler."""
    return [program for program in NEEDS.get(compiler, (compiler,)) if not shutil.which(program)]


def named(compiler):
    """A compiler that is installed, with its version."""
    return f"{compiler} {run(compiler, '-dumpversion').strip()}"


def compile_c(target, source, output, *options):
    run(TARGETS[target].compiler, *TARGETS[target].options, *FLAGS, *options, "-c", source, "-o", output)


def sections(target, file):
    """The bytes of each kind of section: text, rodata, data, bss and so on."""
    sizes = collections.Counter()
    for line in run(TARGETS[target].compiler.removesuffix("gcc") + "size", "-A", "-d", file).splitlines():
        match = re.match(r"\.([a-z]+)\S*\s+(\d+)\s", line)
        if match:
            sizes[match[1]] += int(match[2])
    return sizes


def link(target, text, keep, parts, image):
    """Links a program with what it needs of the parts: what it calls, and the functions `keep`. Its (flash, RAM)."""
    compiler, options = TARGETS[target]
    source = image.with_suffix(".c")
    source.write_text(text, encoding="utf-8")
    command = [compiler, *options, *FLAGS, "-Os", source, *parts, "-Wl,--gc-sections", "-o", image]
    if target == "wasm32":
        return link_wasm(command, keep, image.with_suffix(".map"))
    bare = ROOMY if target == "AVR" else BARE
    run(*command, *bare, *(f"-Wl,--require-defined={name}" for name in keep))
    sizes = sections(target, image)
    return sum(sizes[kind] for kind in IN_FLASH), sum(sizes[kind] for kind in IN_RAM)


def link_wasm(command, keep, listing):
    """The same by clang: code and data; of a module everything that is no code lies in its memory."""
    run(*command, "-nostdlib", FREESTANDING / "string.c", "-Wl,--no-entry", f"-Wl,-Map={listing}",
        *(f"-Wl,--export={name}" for name in ("main", *keep)))
    sizes = collections.Counter()
    for line in listing.read_text(encoding="utf-8").splitlines():
        match = re.match(r"\s*\S+\s+[0-9a-f]+\s+([0-9a-f]+) (CODE|\.rodata|\.data|\.bss)$", line)
        if match:
            sizes[match[2]] += int(match[1], 16)
    return (sizes["CODE"] + sizes[".rodata"] + sizes[".data"],
            sizes[".rodata"] + sizes[".data"] + sizes[".bss"])
