#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The same bits by the sources alone. Builds the programs of tests/targets from the two files that
tools/packages/amalgamate.py makes, by many compilers for many processors, each with the options that its users' build
systems give and none of ours, and compares what is learnt with the first of them, byte for byte. Snapshots and logs
go from one byte order to the other and back. Options under which floats would differ must be refused. A target whose
compiler or emulator is missing is skipped by name (tools/setup targets installs all)."""

import argparse
import concurrent.futures
import dataclasses
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = ROOT / "tests/targets"


@dataclasses.dataclass
class Target:
    name: str
    compiler: str
    options: str = "-O2"
    run: str = ""  # the command that runs a program, up to its name
    link: str = ""
    programs: tuple = ("row", "reals")
    beside: tuple = ()  # sources that a program needs there
    orders: bool = False  # exchanges snapshots and logs with the first target
    packaged: bool = False  # a package of tools/packages is built and run for it with these options, too


BARE = ("--crt0=semihost --oslib=semihost -Wl,--gc-sections -Wl,--defsym=__flash={flash} "
        "-Wl,--defsym=__flash_size=0x200000 -Wl,--defsym=__ram={ram} -Wl,--defsym=__ram_size=0x400000")
QEMU = (" -nographic -monitor none -serial none -chardev stdio,id=s0 "
        "-semihosting-config enable=on,target=native,chardev=s0 -kernel")
# Arduino's options for a C file.
ARDUINO = "-std=gnu11 -Os -w -ffunction-sections -fdata-sections"

TARGETS = (
    Target("x86-64, gcc", "gcc", orders=True),
    Target("x86-64 with FMA, gcc", "gcc", "-O2 -march=haswell", "qemu-x86_64 -cpu max"),
    Target("x86-64, gcc 11", "gcc-11", "-O0"),
    Target("x86-64 with FMA, clang", "clang", "-O1 -march=haswell", "qemu-x86_64 -cpu max"),
    Target("x86-64, clang 19", "clang-19", "-Os"),
    Target("x86-64, tcc", "tcc", ""),
    Target("32-bit x86", "i686-linux-gnu-gcc", "-O1 -msse2 -mfpmath=sse", "qemu-i386", "-static", orders=True),
    Target("aarch64", "aarch64-linux-gnu-gcc", "-O1", "qemu-aarch64", "-static"),
    Target("PowerPC, big-endian", "powerpc-linux-gnu-gcc", "-O1", "qemu-ppc", "-static", orders=True),
    Target("AVR, int of 16 bits", "avr-gcc", ARDUINO + " -mmcu=atmega1284p", "simavr -m atmega1284p -f 16000000",
           "-Wl,--gc-sections", programs=("row",), beside=("avr.c",), packaged=True),
    Target("Cortex-M4F", "arm-none-eabi-gcc",
           ARDUINO + " -mthumb -mcpu=cortex-m4 -mfloat-abi=hard -mfpu=fpv4-sp-d16 --specs=picolibc.specs",
           "qemu-system-arm -M mps2-an386" + QEMU, BARE.format(flash="0", ram="0x20000000")),
    Target("Cortex-M3", "arm-none-eabi-gcc", "-std=c99 -Os -mthumb -mcpu=cortex-m3 --specs=picolibc.specs",
           "qemu-system-arm -M mps2-an385" + QEMU, BARE.format(flash="0", ram="0x20000000"), programs=("row",),
           packaged=True),
    Target("RISC-V of 32 bits", "riscv64-unknown-elf-gcc",
           "-std=gnu17 -Os -march=rv32imac -mabi=ilp32 --specs=picolibc.specs",
           "qemu-system-riscv32 -M virt -bios none" + QEMU, BARE.format(flash="0x80000000", ram="0x80200000"),
           programs=("row",), packaged=True),
    Target("Windows", "x86_64-w64-mingw32-gcc", "-O1", "/usr/lib/wine/wine64", orders=True),
    Target("RISC-V of 64 bits", "riscv64-unknown-elf-gcc",
           "-O1 -march=rv64imafdc -mabi=lp64d -mcmodel=medany --specs=picolibc.specs",
           "qemu-system-riscv64 -M virt -bios none" + QEMU, BARE.format(flash="0x80000000", ram="0x80200000")),
)
REFUSED = (("gcc", "-O2 -ffast-math"), ("gcc", "-Ofast"), ("gcc", "-O2 -funsafe-math-optimizations"),
           ("clang", "-O2 -ffast-math"), ("gcc-11", "-O2 -ffinite-math-only"), ("i686-linux-gnu-gcc", "-O2"),
           ("avr-gcc", "-mmcu=atmega1284p -ffast-math"))


class Failed(Exception):
    pass


def run(command):
    """What it writes to stdout and to stderr."""
    done = subprocess.run([str(part) for part in command], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, timeout=900, check=False)
    if done.returncode != 0:
        raise Failed(f"{' '.join(str(part) for part in command)}: exit status {done.returncode}\n"
                     f"{done.stderr.decode(errors='replace')[-2000:]}")
    return done.stdout.replace(b"\r", b""), done.stderr


def identity(compiler):
    """What the compiler says that it is, and of which version: another processor's is the same compiler."""
    said = run([compiler, "-v" if compiler == "tcc" else "--version"])[0].decode().splitlines()[0]
    family = "clang" if "clang" in said else "tcc" if "tcc" in said else "gcc"
    return f"{family} {re.search(r'[0-9]+', said.split(')')[-1] if family == 'gcc' else said)[0]}"


def missing(target):
    """The program that a target lacks on this machine, or None."""
    for program in (target.compiler, *target.run.split()[:1]):
        if not shutil.which(program):
            return program
    return None


def printed(target, program):
    """What a program prints. simavr shows it on stderr, each line in colours and with a dot at its end."""
    stdout, stderr = run([*target.run.split(), program])
    if not target.run.startswith("simavr"):
        return stdout
    text = re.sub(rb"\x1b\[[\d;]*m", b"", stderr)
    return re.sub(rb"\.\n", b"\n", text[text.find(b"{"):])


class Builds:
    def __init__(self, folder):
        self.folder = folder
        run([sys.executable, "-B", ROOT / "tools/packages/amalgamate.py", folder])

    def programs(self, target):
        """Builds a target's programs; those by name."""
        place = self.folder / re.sub(r"\W+", "-", target.name)
        place.mkdir()
        options = target.options.split()
        run([target.compiler, *options, "-c", self.folder / "rlvc.c", "-o", place / "rlvc.o"])
        beside = [PROGRAMS / name for name in target.beside]
        built = {}
        for name in (*target.programs, *(["orders"] if target.orders else [])):
            built[name] = place / f"{name}.exe"  # Windows wants the suffix
            run([target.compiler, *options, f"-I{ROOT}/core/include", PROGRAMS / f"{name}.c", *beside,
                 place / "rlvc.o", *target.link.split(), "-o", built[name]])
        return built


def try_target(target, builds):
    """What the programs print, by name, and where they are."""
    built = builds.programs(target)
    prints = {name: printed(target, built[name]) for name in target.programs}
    return prints, built


def exchange(first, other, folder):
    """Snapshots and logs of each of two (target, program) on the other: all must be the same."""
    wrote, read = [], []
    for writer, program in (first, other):
        place = folder / f"orders-{program.parent.name}"
        place.mkdir(exist_ok=True)
        wrote.append((place, run([*writer.run.split(), program, "write", place])[0]))
    for place, _ in wrote:
        for reader, program in (first, other):
            read.append(run([*reader.run.split(), program, "read", place])[0])
    for file in sorted(wrote[0][0].iterdir()):
        if file.read_bytes() != (wrote[1][0] / file.name).read_bytes():
            raise Failed(f"{file.name} differs")
    if wrote[0][1] != wrote[1][1] or len(set(read)) != 1:
        raise Failed("what is loaded or read learns another tree")
    trees = re.findall(rb"\{\"classes.*?\]\}\n", wrote[0][1], re.DOTALL)
    if re.findall(rb"\{\"classes.*?\]\}\n", read[0], re.DOTALL) != [tree for tree in trees for _ in range(2)]:
        raise Failed("what is loaded or read learns another tree than what was never saved")


def refusals():
    source = ROOT / "core/src/base/float_math.c"
    for compiler, options in REFUSED:
        if shutil.which(compiler):
            done = subprocess.run([compiler, *options.split(), f"-I{ROOT}/core/include", "-fsyntax-only", source],
                                  stderr=subprocess.PIPE, text=True, check=False)
            if done.returncode == 0 or '"rlvc: ' not in done.stderr:
                yield f"{compiler} {options}: not refused"


def compare(targets, results, folder):
    """Yields a line a target; raises nothing."""
    first = targets[0]
    prints, built = results[first.name].result()
    yield True, f"{first.name} ({first.compiler} {first.options}): the reference"
    for target in targets[1:]:
        title = f"{target.name} ({target.compiler} {target.options})"
        try:
            others, other_built = results[target.name].result()
            for name, output in others.items():
                if output != prints[name]:
                    raise Failed(f"{name} prints something else")
            if target.orders:
                exchange((first, built["orders"]), (target, other_built["orders"]), folder)
        except (Failed, subprocess.TimeoutExpired) as error:
            yield False, f"{title}: {error}"
        else:
            crossed = "; snapshots and logs cross" if target.orders else ""
            yield True, f"{title}: {' and '.join(others)} the same{crossed}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("target", nargs="*", help="part of the name of each to try; default: all")
    parser.add_argument("--beside-packages", action="store_true", help="leave out what the packages are tried on")
    arguments = parser.parse_args()
    wanted = arguments.target
    chosen = [t for t in TARGETS[1:] if not wanted or any(w.lower() in t.name.lower() for w in wanted)]
    if arguments.beside_packages:
        chosen = [t for t in chosen if not t.packaged]
    skipped = {t.name: missing(t) for t in chosen if missing(t)}
    targets = [TARGETS[0], *(t for t in chosen if t.name not in skipped)]
    passed = failed = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        os.environ.update(WINEPREFIX=str(folder / "wine"), WINEDEBUG="-all")
        builds = Builds(folder)
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            results = {target.name: pool.submit(try_target, target, builds) for target in targets}
            for good, line in compare(targets, results, folder):
                print(line, flush=True)
                passed, failed = passed + good, failed + (not good)
    for line in refusals():
        print(line)
        failed += 1
    for target, program in skipped.items():
        print(f"skipped: {target} (no {program})")
    compilers = sorted({identity(target.compiler) for target in targets})
    machines = {target.name.split(",")[0] for target in targets}
    print(f"{len(machines)} targets by {len(compilers)} compilers: {', '.join(compilers)}")
    print(f"alone: {passed} passed, {failed} failed, {len(skipped)} skipped")
    return bool(failed)


if __name__ == "__main__":
    sys.exit(main())
