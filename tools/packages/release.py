#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Adds to a folder with the archives of a release what is published beside them: the notes, from CHANGELOG.md; a bill
of materials; the digests. With --tag, which starts a release, everything must be of that version, and the changelog must
give its date. .github/workflows/release.yml calls it; the archives are those of check.py --pack, and the wheels."""

import argparse
import hashlib
import pathlib
import re
import subprocess
import sys

import packing
import sbom

NOTES, DIGESTS = "NOTES.md", "SHA256SUMS"


def section():
    """What the changelog says of this version: its date, and its text."""
    text = (packing.ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    found = re.search(rf"^## \[{re.escape(packing.VERSION)}\] - (\S+)\n(.*?)(?=^## |\Z)", text, re.MULTILINE | re.DOTALL)
    if not found:
        raise packing.Failed(f"CHANGELOG.md has no section of {packing.VERSION}")
    return found[1], found[2].strip() + "\n"


def check_tag(tag, date):
    if tag != f"v{packing.VERSION}":
        raise packing.Failed(f"the tag {tag} is not that of {packing.VERSION}")
    if not re.fullmatch(r"\d{4}-\d{2}-\d{2}", date):
        raise packing.Failed(f"CHANGELOG.md gives {packing.VERSION} no date but '{date}'")
    if subprocess.run([sys.executable, "-B", packing.ROOT / "tools/check/version.py"], check=False).returncode:
        raise packing.Failed("the versions differ")


def write(folder, tag):
    bill = f"rlvc-{packing.VERSION}.cdx.json"
    archives = sorted(path for path in folder.iterdir() if path.name not in (NOTES, DIGESTS, bill))
    strange = [path.name for path in archives if packing.VERSION not in path.name]
    if strange or not archives:
        raise packing.Failed(f"not archives of {packing.VERSION}: {strange}")
    date, notes = section()
    if tag:
        check_tag(tag, date)
    (folder / NOTES).write_text(notes, encoding="utf-8")
    (folder / bill).write_text(sbom.make(archives), encoding="utf-8")
    lines = [f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n" for path in (*archives, folder / bill)]
    (folder / DIGESTS).write_text("".join(lines), encoding="utf-8")
    return f"{len(archives)} archives, notes, a bill of materials, digests"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=pathlib.Path, help="where the archives are")
    parser.add_argument("--tag", help="of the commit, such as v1.2.3")
    arguments = parser.parse_args()
    try:
        print(f"release {packing.VERSION}: {write(arguments.folder, arguments.tag)}")
    except packing.Failed as fault:
        print(f"release: {fault}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
