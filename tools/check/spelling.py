#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks the spelling of the pages that are written for people: the project's Markdown, and the documentation as it was
built, with what it takes from docstrings and headers.

    spelling.py [FOLDER...]

FOLDER holds built pages (HTML). Words are British, as hunspell knows them (on Debian: hunspell hunspell-en-gb), or
stand in spelling.txt beside this script. Code is left out, and so is whatever holds a digit, an underscore, or
capitals within."""

import html.parser
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
WORDS = HERE / "spelling.txt"
QUIET = {"code", "pre", "script", "style", "svg", "autoref", "math"}
WORD = re.compile(r"(?<![\w@/.\\-])[A-Za-z]+(?:['\u2019][a-z]+)?(?![\w@/\\]|\.\w)")


class Page(html.parser.HTMLParser):
    """The text of a page, without its code."""

    def __init__(self):
        super().__init__()
        self.quiet, self.parts = 0, []

    def handle_starttag(self, tag, attrs):
        self.quiet += tag in QUIET

    def handle_endtag(self, tag):
        self.quiet -= tag in QUIET
        if tag not in ("em", "strong", "a"):
            self.parts.append("\n")

    def handle_data(self, data):
        if not self.quiet:
            self.parts.append(data)


def text_of(path):
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".html":
        page = Page()
        page.feed(text)
        return "".join(page.parts)
    text = re.sub(r"^( *)```.*?^\1```", "", text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"(?<=\n\n)(?: {4}.*\n)+", "", text)
    return re.sub(r"`[^`]*`|\]\([^)]*\)|<[^>]*>|^\[.*?\]: .*$", " ", text, flags=re.MULTILINE)


def strange(words):
    """Those that neither hunspell nor the project knows."""
    known = {line for line in WORDS.read_text(encoding="utf-8").splitlines() if not line.startswith("#")}
    asked = sorted({re.sub(r"['\u2019]s$", "", word) for word in words})
    said = subprocess.run(["hunspell", "-d", "en_GB", "-l"], input="\n".join(asked), capture_output=True, text=True,
                          check=True).stdout
    return {word for word in said.split() if word not in known and word.lower() not in known}


def main():
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-z", "*.md"], capture_output=True, text=True, check=True)
    paths = [ROOT / name for name in filter(None, listed.stdout.split("\0"))]
    for folder in sys.argv[1:]:
        paths += sorted(pathlib.Path(folder).rglob("*.html"))
    words_of = {path: set(WORD.findall(text_of(path))) for path in paths if path.exists()}
    words_of = {path: {word for word in words if not re.search(r"[a-z].*[A-Z]", word)} for path, words in words_of.items()}
    unknown = strange(set().union(*words_of.values()))
    for path, words in words_of.items():
        for word in sorted(word for word in words if re.sub(r"['\u2019]s$", "", word) in unknown):
            print(f"{path}: {word}")
    print(f"spelling: {len(words_of)} pages, {len(unknown)} words that nobody knows (mend them, or add them to {WORDS.name})")
    return bool(unknown)


if __name__ == "__main__":
    sys.exit(main())
