# SPDX-License-Identifier: MIT
"""The Debian packages librlvc and librlvc-dev: built by dpkg-buildpackage, accepted by lintian, unpacked elsewhere, and
used by pkg-config from there."""

import os
import shutil

import packing

RECIPE = packing.HERE / "debian"
CHANGELOG = """rlvc ({version}-1) unstable; urgency=medium

  * Release {version}; CHANGELOG.md says what changed.

 -- The rlvc contributors <rlvc@example.org>  Thu, 01 Jan 2026 00:00:00 +0000
"""
# New packages close a bug that asks for them, which only an upload to Debian has; the date is fixed for the archive to be.
SUPPRESSED = "initial-upload-closes-no-bugs,no-symbols-control-file"


def pack(folder):
    """The source and the binary packages, in one archive."""
    for program in ("dpkg-buildpackage", "dh", "lintian"):
        packing.tool(program)
    source = folder / "build" / f"rlvc-{packing.VERSION}"
    packing.copy_project(source)
    packing.pack_tar(source, folder / "build" / f"rlvc_{packing.VERSION}.orig.tar.gz")
    shutil.copytree(RECIPE, source / "debian")
    (source / "debian/changelog").write_text(CHANGELOG.format(version=packing.VERSION), encoding="utf-8")
    options = {} if packing.optimised else {"DEB_BUILD_OPTIONS": "noopt noautodbgsym"}
    packing.run("dpkg-buildpackage", "--no-sign", cwd=source, env={**os.environ, **options})
    made = folder / f"rlvc-debian-{packing.VERSION}"
    made.mkdir()
    for path in (folder / "build").iterdir():
        if path.is_file():
            shutil.copy(path, made)
    return packing.pack_tar(made, folder / f"{made.name}.tar.gz")


def check(archive, folder):
    place = packing.unpack(archive, folder / "elsewhere")
    (changes,) = place.glob("*.changes")
    packing.run("lintian", "--fail-on", "error,warning", "--suppress-tags", SUPPRESSED, "--allow-root", changes)
    root = folder / "root"
    for package in place.glob("librlvc*.deb"):
        if "dbgsym" not in package.name:
            packing.run("dpkg-deb", "--extract", package, root)
    (found,) = root.glob("usr/lib/*/pkgconfig")
    flags = packing.run("pkg-config", "--cflags", "--libs", "rlvc",
                        env={**os.environ, "PKG_CONFIG_PATH": str(found)}).decode().split()
    packing.run("cc", packing.ROW, *flags, "-o", folder / "row")
    packing.expect_row(packing.run(folder / "row", env={**os.environ, "LD_LIBRARY_PATH": str(found.parent)}), folder)
    return "built by dpkg-buildpackage, clean to lintian, used from where it was unpacked"
