# SPDX-License-Identifier: MIT
"""The reference of C: a page for each public header, an anchor for each name that it defines.

Reads our own headers, which are regular: blank lines at the top level part one thing from the next, and a comment
stands before what it is about. Names of functions and types in the text become links."""

import html
import pathlib
import re
import textwrap

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEADERS = [*sorted((ROOT / "core/include/rlvc").glob("*.h")), ROOT / "vision/include/rlvc/vision.h"]

COMMENT = re.compile(r"/\*(.*?)\*/", re.DOTALL)
RULE = re.compile(r"^-{10,} (.*)$")
DEFINED = (
    re.compile(r"^#define (RLVC_\w+)", re.MULTILINE),
    re.compile(r"^RLVC_API\s[^;(]*?(\w+)\(", re.MULTILINE),
    re.compile(r"^typedef (?:struct|enum) (\w+)", re.MULTILINE),
    re.compile(r"^typedef [\w\s*]+\(\*(\w+)\)", re.MULTILINE),
    re.compile(r"^static inline [\w\s*]+?(\w+)\(", re.MULTILINE),
    re.compile(r"^ +(RLVC_\w+) = -?\d", re.MULTILINE),  # of an enumeration
)
# What makes a header a header, and is of no use to its reader.
GUARD = re.compile(r"^#(?:ifndef|define) RLVC_\w+_H\n", re.MULTILINE)
FRAME = re.compile(r"^#(include .*|ifdef __cplusplus|endif|if .*|else|elif .*)$|"
                   r'^extern "C" \{$|^\}$|^/\* clang-format o\w+ \*/$')
NAME = re.compile(r"\b(rlvc_\w+|RLVC_\w+)\b")


def blocks(header):
    """The parts of a header between blank lines that are within neither a comment nor braces."""
    text = GUARD.sub("", header.read_text(encoding="utf-8"))
    part, depth, inside = [], 0, False
    for line in [*text.splitlines(), ""]:
        if not line.strip() and not depth and not inside:
            if part:
                yield "\n".join(part)
            part = []
            continue
        if not part and FRAME.match(line):
            continue
        part.append(line)
        bare = re.sub(r"/\*.*?\*/", "", line)
        inside = "*/" not in bare if inside else "/*" in bare
        if not inside and "extern" not in line:
            depth += bare.count("{") - bare.count("}")


def names_of(code):
    """What a piece of code defines, in its order."""
    found = [(match.start(1), match[1]) for pattern in DEFINED for match in pattern.finditer(code)]
    return list(dict.fromkeys(name for _, name in sorted(found)))


def divide(block):
    """The comment before a block's code, and the code."""
    match = COMMENT.match(block)
    if not match:
        return "", block
    lines = [re.sub(r"^ \* ?", "", line.rstrip()) for line in match[1].strip("\n").splitlines()]
    return "\n".join(lines).strip(), block[match.end() :].strip("\n")


class Reference:
    """The pages, and where each name is."""

    def __init__(self):
        self.page_of = {}
        for header in HEADERS:
            for block in blocks(header):
                for name in names_of(divide(block)[1]):
                    self.page_of.setdefault(name, header.stem)

    def linked(self, text, here):
        """A text in Markdown whose names are links. What stands between backticks there is code here."""
        parts = re.split(r"(`[^`]+`)", text)
        return "".join(part if i % 2 else self.linked_prose(part, here) for i, part in enumerate(parts))

    def linked_prose(self, text, here):
        text = re.sub(r"([*_\\`\[\]])", r"\\\1", html.escape(text, quote=False))

        def link(match):
            name = match[0].replace("\\", "")
            page = self.page_of.get(name)
            where = "" if page == here else f"{page}.md"
            return f"[`{name}`]({where}#{name})" if page else f"`{name}`"

        return re.sub(r"\b(?:rlvc|RLVC)(?:\\_\w+)+(?!\w)", link, text)

    def prose(self, text, here):
        """A comment as Markdown: paragraphs, indented code, and a list of @param and @return."""
        parts = re.split(r"(?m)^@(param|return)\b", text)
        lines = []
        for paragraph in re.split(r"\n\n", parts[0].strip("\n")):
            code = all(line.startswith("    ") for line in paragraph.splitlines())
            lines += [f"```text\n{textwrap.dedent(paragraph)}\n```" if code and paragraph else self.linked(paragraph, here), ""]
        for kind, rest in zip(parts[1::2], parts[2::2], strict=True):
            words = " ".join(rest.split())
            if kind == "return":
                lines.append(f"- **returns** {self.linked(words, here)}")
                continue
            # Several parameters share one entry: "split, feature each optional".
            match = re.match(r"((?:\w+, )*\w+)\s*(.*)", words)
            lines.append(f"- **{self.linked(match[1], here)}** {self.linked(match[2], here)}")
        return "\n".join(lines)

    def entry(self, block, here):
        comment, code = divide(block)
        rule = RULE.match(comment)
        if rule and not code:
            return f"## {rule[1].capitalize()}\n"
        names = names_of(code)
        if names == ["RLVC_API"]:  # how functions are exported
            return ""
        own = [name for name in names if self.page_of[name] == here]
        anchors = "".join(f'<span id="{name}"></span>' for name in own[1:])
        title = f"### {own[0].replace('_', chr(92) + '_')} {{#{own[0]}}}\n\n" if own else ""
        shown = f"```c\n{code.replace('RLVC_API ', '')}\n```\n" if code else ""
        return f"{title}{anchors}\n\n{shown}\n{self.prose(comment, here)}\n"

    def page(self, header):
        here = header.stem
        parts = [block for block in blocks(header)
                 if "SPDX" not in block.splitlines()[0] or len(block.splitlines()) > 1]
        entries = [self.entry(re.sub(r"^/\* SPDX.*\*/\n", "", block), here) for block in parts]
        return re.sub(r"\n{3,}", "\n\n", f"# rlvc/{header.name}\n\n" + "\n".join(entries))

    def write(self, folder):
        folder.mkdir(parents=True, exist_ok=True)
        for header in HEADERS:
            (folder / f"{header.stem}.md").write_text(self.page(header), encoding="utf-8")
        rows = [f"- [rlvc/{header.name}]({header.stem}.md): {self.about(header)}" for header in HEADERS]
        text = "# C\n\nEach public header has a page here; the headers say the same.\n\n" + "\n".join(rows) + "\n"
        (folder / "index.md").write_text(text, encoding="utf-8")

    def about(self, header):
        """The first sentence of a header."""
        comments = [match for match in COMMENT.findall(header.read_text(encoding="utf-8")) if "SPDX" not in match]
        first = " ".join(re.sub(r"^ \* ?", "", line) for line in comments[0].strip().splitlines())
        return self.linked(re.match(r".*?\.(?=\s|$)", " ".join(first.split()))[0], "index")
