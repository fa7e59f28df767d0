#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes two files of the core, rlvc.c and rlvc.h, for whoever would rather add a file than a build system.

The sources follow one another in the order of their rooms. What is private to a source (functions, variables, types,
constants of an enum) gets its file's name before its own, and its macros end with it, so that no two meet."""

import argparse
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
CORE = ROOT / "core"
sys.path.insert(0, str(ROOT / "tools/check"))
from sources import ROOMS  # noqa: E402

INCLUDE = re.compile(r'^#include "([^"]+)"\n', re.MULTILINE)
TOKEN = re.compile(r'(?P<quiet>/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\')'
                   r"|(?P<member>(?:\.|->)\s*[A-Za-z_]\w*)|(?P<word>[A-Za-z_]\w*)|(?P<other>[{};])", re.DOTALL)
COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
DEFINE = re.compile(r"^#define (\w+)", re.MULTILINE)
# What a source declares for itself, of text whose lines within braces are indented: it stands at their beginning.
OWN = (
    re.compile(r"^static [^;{}()=\[]*?(\w+)(?=\(|\[| =|;)", re.MULTILINE),
    re.compile(r"^typedef [^;{}()]*?(\w+);", re.MULTILINE),
    re.compile(r"^typedef [\w ]+\(\*(\w+)\)", re.MULTILINE),
    re.compile(r"^\} (\w+);", re.MULTILINE),
    re.compile(r"^(?:typedef )?(?:struct|union|enum) (\w+) \{", re.MULTILINE),
)
ENUM = re.compile(r"^(?:typedef )?enum \w*\s*\{(.*?)\}", re.MULTILINE | re.DOTALL)


def own_names(text):
    text = COMMENT.sub("", text)
    names = {name for pattern in OWN for name in pattern.findall(text)}
    for body in ENUM.findall(text):
        names |= {part.split("=")[0].strip() for part in body.split(",") if part.strip()}
    return {name for name in names if not name.startswith(("rlvc_", "RLVC_"))}


def renamed(text, stem):
    """The source with its own names made unlike those of other sources. Members of structs keep theirs."""
    names = own_names(text)
    in_struct = []  # for each open brace: is it a struct's?
    struct_next = False

    def one(match):
        nonlocal struct_next
        if match["other"]:
            if match["other"] == "{":
                in_struct.append(struct_next)
            elif match["other"] == "}" and in_struct:
                in_struct.pop()
            struct_next = False
        elif match["word"]:
            word = match["word"]
            struct_next = struct_next or word in ("struct", "union")
            if word in ("enum",) or text[match.end():match.end() + 1] == "(":
                struct_next = False
            is_member = in_struct and in_struct[-1] and text[match.end():match.end() + 1] in ";,[:"
            before = text[match.start() - 1]
            if word in names and not (is_member and before != "["):
                return f"{stem}_{word}"
        return match[0]

    return TOKEN.sub(one, text)


def without_licence(text):
    return text.removeprefix("/* SPDX-License-Identifier: MIT */\n")


def header():
    """All public headers, each once, after those that it includes."""
    done, parts = set(), []

    def add(path):
        if path in done:
            return
        done.add(path)
        text = path.read_text(encoding="utf-8")
        for name in INCLUDE.findall(text):
            add(CORE / "include" / name)
        parts.append(without_licence(INCLUDE.sub("", text)))

    add(CORE / "include/rlvc/rlvc.h")
    for path in sorted((CORE / "include/rlvc").glob("*.h")):
        if path.name != "float_rules.h":  # for sources alone
            add(path)
    return "".join(parts)


def expanded(path, done):
    """A private file, with the private headers that no file before it has included."""

    def one(match):
        if match[1].startswith("rlvc/"):
            return ""
        included = (path.parent / match[1]).resolve()
        if included in done:
            return ""
        done.add(included)
        return without_licence(expanded(included, done))

    return INCLUDE.sub(one, path.read_text(encoding="utf-8"))


def source():
    done = set()
    parts = [without_licence((CORE / "include/rlvc/float_rules.h").read_text(encoding="utf-8")),
             '#include "rlvc.h"\n\n']
    files = [path for room in ROOMS for path in sorted((CORE / "src" / room).glob("*.c"))]
    for path in files + sorted((CORE / "domains").glob("*.c")):
        # Headers are expanded after renaming: their names are everyone's.
        text = renamed(path.read_text(encoding="utf-8"), path.stem)
        headers = []
        for name in INCLUDE.findall(text):
            included = (path.parent / name).resolve()
            if not name.startswith("rlvc/") and included not in done:
                done.add(included)
                headers.append(without_licence(expanded(included, done)))
        parts.append(f"\n/* ================ {path.relative_to(CORE)} ================ */\n\n")
        parts += headers
        parts.append(without_licence(INCLUDE.sub("", text)))
        parts += [f"#undef {name}\n" for name in DEFINE.findall(text)]
    return "".join(parts)


def write(folder):
    """Makes the two files in a folder."""
    version = re.search(r'RLVC_VERSION "(.*)"', (CORE / "include/rlvc/rlvc.h").read_text(encoding="utf-8"))[1]
    title = (f"/* SPDX-License-Identifier: MIT */\n/* rlvc {version}, made of its sources by tools/packages/amalgamate.py: "
             "change those. */\n")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "rlvc.h").write_text(title + header(), encoding="utf-8")
    (folder / "rlvc.c").write_text(title + source(), encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=pathlib.Path, help="where the two files go")
    write(parser.parse_args().folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
