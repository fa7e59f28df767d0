# SPDX-License-Identifier: MIT
"""Tables that are measured and committed: compared with what is measured now, or written."""

import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
SKIPPED = 77  # what ctest takes for "skipped"


def sources():
    return sorted(path for folder in ("src", "domains")
                  for path in (ROOT / "core" / folder).rglob("*.c"))


def settle(table, text, compilers, write):
    """The exit status of a script that measured `text`. A table that does not name the compilers, as `text`
    does, is of others, and cannot be compared."""
    assert compilers in text
    if write:
        table.write_text(text, encoding="utf-8")
        return 0
    committed = table.read_text(encoding="utf-8") if table.exists() else ""
    if committed == text:
        return 0
    if committed and compilers not in committed:
        print(f"the figures are not compared: they are of other compilers than {compilers.strip(' ,;')}")
        return SKIPPED
    print(f"{table.relative_to(ROOT)} is stale: run {pathlib.Path(sys.argv[0]).name} --write",
          file=sys.stderr)
    return 1
