# SPDX-License-Identifier: MIT
"""What the scripts of the packages share: the version, copies of sources, commands, and the row of cells that each
package must learn."""

import gzip
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
HERE = ROOT / "tools/packages"
VERSION = re.search(r'RLVC_VERSION "(.*)"', (ROOT / "core/include/rlvc/rlvc.h").read_text(encoding="utf-8"))[1]
ROW = ROOT / "tests/targets/row.c"
EMULATED_M3 = ("qemu-system-arm", "-M", "mps2-an385", "-nographic", "-monitor", "none", "-serial", "none", "-chardev",
               "stdio,id=s0", "-semihosting-config", "enable=on,target=native,chardev=s0", "-kernel")
# Whether what a package's own build makes is optimised, and comes with symbols, as a release needs it.
optimised = True
SUMMARY = "Reinforcement learning of classes: a small decision tree, learnt from rewards in fixed memory"


class Skip(Exception):
    """A package cannot be tried here; says why."""


class Failed(Exception):
    """A package is not what it should be; says how."""


def run(*command, cwd=None, env=None):
    """What a command prints; it must succeed."""
    done = subprocess.run([str(part) for part in command], cwd=cwd, env=env, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    if done.returncode != 0:
        said = (done.stdout + done.stderr).decode(errors="replace")
        raise Failed(f"{' '.join(str(part) for part in command)}: exit status {done.returncode}\n{said[-3000:]}")
    return done.stdout.replace(b"\r", b"")


def tool(name):
    """Where a program is: beside the Python that runs this, or on the PATH. Skip if it is nowhere."""
    beside = pathlib.Path(sys.executable).parent / name
    found = str(beside) if beside.exists() else shutil.which(name)
    if not found:
        raise Skip(f"there is no {name}")
    return found


# ---------------------------------------------------------------------------------------- sources

def core_files():
    return sorted((*(ROOT / "core/src").rglob("*.[ch]"), *(ROOT / "core/domains").glob("*.[ch]")))


def copy_core(folder):
    """Lays the core out in a folder as it is in the project: include, src, domains; and the licence."""
    for name in ("include", "src", "domains"):
        shutil.copytree(ROOT / "core" / name, folder / name)
    shutil.copy(ROOT / "LICENSE", folder)


def copy_project(folder):
    """What a source archive of a release holds: all that is under version control."""
    names = run("git", "-C", ROOT, "ls-files", "-z").decode().split("\0")
    for name in filter(None, names):
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, folder / name)


# ---------------------------------------------------------------------------------------- archives

def pack_zip(folder, archive, within=None):
    """A zip of a folder, which lies at `within` (its own name if that is None); of the same bytes whenever it is packed."""
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as packed:
        for path in sorted(folder.rglob("*")):
            inside = pathlib.PurePath(folder.name if within is None else within, path.relative_to(folder))
            entry = zipfile.ZipInfo.from_file(path, inside)
            entry.date_time, entry.compress_type = (1980, 1, 1, 0, 0, 0), zipfile.ZIP_DEFLATED
            packed.writestr(entry, b"" if path.is_dir() else path.read_bytes())
    return archive


def pack_tar(folder, archive, within=None):
    """Likewise a tar."""

    def anonymous(entry):
        entry.uid = entry.gid = entry.mtime = 0
        entry.uname = entry.gname = ""
        return entry

    with (open(archive, "wb") as file, gzip.GzipFile("", "wb", fileobj=file, mtime=0) as compressed,
          tarfile.open(fileobj=compressed, mode="w") as packed):
        packed.add(folder, folder.name if within is None else within, filter=anonymous)
    return archive


def unpack(archive, folder):
    """The one folder that an archive holds, or `folder` if it holds more."""
    folder.mkdir(parents=True)
    if archive.suffix in (".zip", ".pack"):
        with zipfile.ZipFile(archive) as packed:
            packed.extractall(folder)
    else:
        run("tar", "--extract", "--file", archive, "--directory", folder)
    inside = list(folder.iterdir())
    return inside[0] if len(inside) == 1 and inside[0].is_dir() else folder


# ---------------------------------------------------------------------------------------- the row of cells

_expected = []


def expected_row(folder):
    """What tests/targets/row.c prints that is built with the project's sources."""
    if not _expected:
        program = folder / "expected-row"
        run("cc", "-O0", f"-I{ROOT}/core/include", ROW, *(path for path in core_files() if path.suffix == ".c"), "-o",
            program)
        _expected.append(run(program))
    return _expected[0]


def expect_row(output, folder):
    """Fails if a program that was built from a package prints another tree."""
    if output[output.find(b"{"):] != expected_row(folder):
        raise Failed(f"learns another tree:\n{output.decode(errors='replace')[:600]}")


def run_simulated(simavr, processor, image):
    """What an image prints on a simulated AVR: simavr shows it on stderr, in colours and with a dot at each end."""
    done = subprocess.run([simavr, "-m", processor, "-f", "16000000", str(image)], stdin=subprocess.DEVNULL,
                          stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, check=True, timeout=120)
    text = re.sub(rb"\x1b\[[\d;]*m", b"", done.stderr)
    return re.sub(rb"\.\n", b"\n", text)
