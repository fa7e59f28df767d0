#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Declares the C interface for Python: compares shim/rlvc/_native/bindings.py and shim/native/layout.c
with what the headers say, or writes them with --write.

Reads our own headers, which are regular: a struct is `typedef struct NAME {...} NAME;`, a function begins
with RLVC_API, a constant is a #define with a number. Anything else in a struct or a prototype is an error
here, so that nothing is left out."""

import argparse
import pathlib
import re
import sys
import textwrap

ROOT = pathlib.Path(__file__).resolve().parents[2]
BINDINGS = ROOT / "shim/rlvc/_native/bindings.py"
LAYOUT = ROOT / "shim/native/layout.c"
FOLDERS = [ROOT / folder for folder in
           ("core/include", "vision/include", "examples/gridworld", "shim/native")]
CORE = sorted((ROOT / "core/include/rlvc").glob("*.h"))
# The headers of each library of the package, by the name of its table of functions.
TABLES = {
    "CORE": [*CORE, ROOT / "examples/gridworld/gridworld.h", ROOT / "shim/native/shim.h"],
    "VISION": [ROOT / "vision/include/rlvc/vision.h"],
    "OBJECTS": [ROOT / "shim/native/objects.h"],
}
SCALARS = {
    "int": "c_int", "char": "c_char", "float": "c_float", "size_t": "c_size_t", "ptrdiff_t": "c_ssize_t",
    "int8_t": "c_int8", "uint8_t": "c_uint8", "uint16_t": "c_uint16", "int32_t": "c_int32",
    "uint32_t": "c_uint32", "uint64_t": "c_uint64", "rlvc_status": "c_int", "rlvc_vision_status": "c_int",
}

COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)
STRUCT = re.compile(r"^typedef struct (\w+) \{(.*?)^\} \1;", re.MULTILINE | re.DOTALL)
FUNCTION_TYPE = re.compile(r"^typedef (\w+) \(\*(\w+)\)\((.*?)\);", re.MULTILINE | re.DOTALL)
FUNCTION = re.compile(r"^RLVC_API\s+([\w\s*]+?[\s*])(\w+)\((.*?)\);", re.MULTILINE | re.DOTALL)
CALLBACK = re.compile(r"(\w+) \(\*(\w+)\)\((.*)\)", re.DOTALL)
DECLARATOR = re.compile(r"(\**)\s*(\w+)(?:\[(\w+)\])?")
DEFINE = re.compile(r"^#define RLVC_(\w+) (\S.*)$", re.MULTILINE)
ENUMERATOR = re.compile(r"^\s+RLVC_(\w+) = (-?\d+),?\s*$", re.MULTILINE)
NUMBER = re.compile(r"[\w\s.()+<-]+")


def python_name(name):
    """rlvc_policy_info becomes PolicyInfo."""
    return "".join(part.capitalize() for part in name.removeprefix("rlvc_").split("_"))


def parameters(text):
    """The parameters of a prototype, at commas outside of parentheses."""
    parts = [" ".join(part.split()) for part in re.split(r",(?![^()]*\))", text)]
    return [] if parts == ["void"] else parts


def folded(begin, parts, end, indent=""):
    """A call or a list: on one line, or on lines of its own where that is too long."""
    line = begin + ", ".join(parts) + end
    if len(indent + line) <= 100:
        return indent + line
    glued = ", ".join(part.replace(" ", "\0") for part in parts) + ","  # so that no part is broken
    inner = textwrap.indent(textwrap.fill(glued, 88).replace("\0", " "), indent + "    ")
    return f"{indent}{begin}\n{inner}\n{indent}{end}"


class Headers:
    """What the headers declare, in the order in which C sees it."""

    def __init__(self):
        self.seen = set()
        self.constants = {"UINT32_MAX": 2**32 - 1}
        self.types = []   # lines of Python
        self.structs = {}  # name in C: names of the fields
        self.known = {}   # name in C of a struct or a function type: name in Python
        self.functions = {name: {} for name in TABLES}

    def read(self, header, table):
        if header in self.seen:
            return
        self.seen.add(header)
        text = COMMENT.sub("", header.read_text(encoding="utf-8"))
        for name in INCLUDE.findall(text):
            found = [folder / name for folder in FOLDERS if (folder / name).exists()]
            self.read(found[0], table)
        text = text.replace("\\\n", " ")
        self.read_constants(text)
        declarations = [*STRUCT.finditer(text), *FUNCTION_TYPE.finditer(text)]
        for match in sorted(declarations, key=lambda match: match.start()):
            (self.struct if match.re is STRUCT else self.function_type)(match)
        for result, name, taken in FUNCTION.findall(text):
            pair = (self.result(result.strip()), [self.parameter(p) for p in parameters(taken)])
            self.functions[table][name] = pair

    def read_constants(self, text):
        for name, value in [*ENUMERATOR.findall(text), *DEFINE.findall(text)]:
            plain = re.sub(r"\(uint(?:32|64)_t\)|UINT32_C", "", value.replace("RLVC_", "")).strip()
            # What a compiler predefines is another number on another target.
            if not NUMBER.fullmatch(plain) or "__" in plain or name.startswith("VERSION"):
                continue
            plain = re.sub(r"\b(0x[\da-fA-F]+|\d+)u\b|\b(\d[\d.]*(?:e\d+)?)f\b", r"\1\2", plain)
            self.constants[name] = eval(plain, {}, self.constants)

    def scalar(self, name):
        if name in SCALARS:
            return f"c.{SCALARS[name]}"
        return self.known[name]  # a KeyError here: teach this script the type

    def callback(self, name, result, taken):
        kinds = [self.scalar(result), *(self.callback_parameter(p) for p in parameters(taken))]
        return folded(f"{name} = c.CFUNCTYPE(", kinds, ")")

    def callback_parameter(self, text):
        """As a callback sees it: a pointer to a struct or a number can be looked into."""
        words = text.replace("const ", "").replace("*", " * ").split()
        if "*" not in words:
            return self.scalar(words[0])
        if words[0] in ("void", "char", "unsigned"):
            return "c.c_void_p"
        return f"c.POINTER({self.scalar(words[0])})"

    def parameter(self, text):
        """As a caller passes it: any pointer is an address, the bytes there, or what byref() gave."""
        if "*" in text or "[" in text:
            return "c.c_void_p"
        return self.scalar(text.removeprefix("const ").split()[0])

    def result(self, text):
        kind = text.removeprefix("const ").rstrip("* ")
        if "*" not in text:
            return "None" if kind == "void" else self.scalar(kind)
        return "c.c_char_p" if kind == "char" else f"c.POINTER({self.known[kind]})"

    def function_type(self, match):
        result, name, taken = match.groups()
        self.known[name] = name.removeprefix("rlvc_").upper()
        self.types.append(self.callback(self.known[name], result, taken) + "\n")

    def struct(self, match):
        name, body = match.groups()
        fields = []
        for member in body.split(";")[:-1]:
            fields += self.fields(name, " ".join(member.split()))
        self.known[name] = python_name(name)
        self.structs[name] = [field for field, _ in fields]
        lines = folded("_fields_ = [", [f'("{field}", {kind})' for field, kind in fields], "]", "    ")
        self.types.append(f'class {self.known[name]}(c.Structure):\n    """``{name}``."""\n\n'
                          f"{lines}\n")

    def fields(self, struct, member):
        """The fields that a member declares: several of one type, or a callback."""
        found = CALLBACK.fullmatch(member)
        if found:
            name = f"{struct.removeprefix('rlvc_')}_{found[2]}".upper()
            self.types.append(self.callback(name, found[1], found[3]) + "\n")
            return [(found[2], name)]
        kind, rest = re.fullmatch(r"(?:const )?(?:unsigned )?(\w+) (.+)", member).groups()
        fields = []
        for part in rest.split(","):
            stars, name, count = DECLARATOR.fullmatch(part.strip()).groups()
            if stars:
                text = "c.c_char_p" if re.match("const char ", member) else "c.c_void_p"
            else:
                text = self.scalar(kind)
            if count:
                text += f" * {count if count.isdigit() else self.constants[count[5:]]}"
            fields.append((name, text))
        return fields


def bindings(headers):
    constants = [f"{name} = {value!r}" for name, value in headers.constants.items() if name != "UINT32_MAX"]
    structs = [f'    "{name}": {headers.known[name]},' for name in headers.structs]
    tables = []
    for table, functions in headers.functions.items():
        rows = []
        for name, (result, taken) in functions.items():
            rows.append(folded(f'"{name}": ({result}, [', taken, "]),", "    "))
        tables.append(f"{table}: Functions = {{\n" + "\n".join(rows) + "\n}\n")
    return "\n".join([
        "# SPDX-License-Identifier: MIT",
        '"""The C interface: constants, structs and functions. Written by tools/check/bindings.py --write."""\n',
        "from __future__ import annotations\n",
        "import ctypes as c",
        "from typing import Any\n",
        "Functions = dict[str, tuple[Any, list[Any]]]  # a name: what it returns, what it takes\n",
        *constants, "\n", *(f"{text}\n" for text in headers.types),
        "STRUCTS: dict[str, type[c.Structure]] = {", *structs, "}\n", *tables,
    ]).rstrip() + "\n"


def layout(headers):
    rows = []
    for name, fields in headers.structs.items():
        rows.append(f"    {{SIZE({name})}},")
        rows += [f"    {{FIELD({name}, {field})}}," for field in fields]
    includes = [header.relative_to(folder).as_posix() for header in TABLES["CORE"] + TABLES["VISION"]
                for folder in FOLDERS if header.is_relative_to(folder)]
    return "\n".join([
        "/* SPDX-License-Identifier: MIT */",
        "/* The layout of every struct of the interface, as this compiler made it: the package compares it",
        " * with its own. Written by tools/check/bindings.py --write. */",
        '#include "shim.h"\n',
        *(f'#include "{name}"' for name in sorted(includes) if name != "shim.h"),
        "",
        "#define SIZE(type) #type, sizeof(type)",
        '#define FIELD(type, field) #type "." #field, offsetof(type, field)\n',
        "static const rlvc_shim_entry layout[] = {", *rows, "    {NULL, 0},", "};\n",
        "const rlvc_shim_entry *rlvc_shim_layout(void) {", "    return layout;", "}",
    ]) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="write the two files")
    write = parser.parse_args().write
    headers = Headers()
    for table, paths in TABLES.items():
        for path in paths:
            headers.read(path, table)
    stale = False
    for file, text in ((BINDINGS, bindings(headers)), (LAYOUT, layout(headers))):
        if write:
            file.write_text(text, encoding="utf-8")
        elif not file.exists() or file.read_text(encoding="utf-8") != text:
            print(f"{file.relative_to(ROOT)} is stale: run tools/check/bindings.py --write", file=sys.stderr)
            stale = True
    return int(stale)


if __name__ == "__main__":
    sys.exit(main())
