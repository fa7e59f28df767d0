# SPDX-License-Identifier: MIT
"""A run as C: the policy that acts, and what its actions are."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np

from ..checks import shown
from ..errors import RangeError
from .encode import Encoder

if TYPE_CHECKING:
    from .run import Run

_WIDTH = 90


def header(run: Run, name: str) -> str:
    """Return the header: see :meth:`rlvc.Run.export_c`."""
    if not isinstance(name, str) or not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]{0,47}", name):
        raise RangeError(f"name: {shown(name)} is not an identifier of C of at most 48 characters")
    text = _masks(run, name) + run.acting.export_c(name)
    more = _percept(run) + _actions(run, name)
    if not more:
        return text
    end = text.rindex("#endif")
    return f"{text[:end]}{more}\n{text[end:]}"


def _masks(run: Run, name: str) -> str:
    """A comment on what the policy was spared while it learnt."""
    if not run.masked:
        return ""
    return (
        f"/* Learnt with action masks, which {name}_act does not know: it may return an action that is\n"
        " * forbidden. Check it before you take it. */\n"
    )


def _percept(run: Run) -> str:
    """A comment on what the elements of a percept are."""
    if not isinstance(run.encoder, Encoder):
        return ""
    names = (f"{i} {name}" for i, name in enumerate(run.encoder.names))
    return _comment("The percept: ", names)


def _comment(head: str, parts: Any) -> str:
    lines, line = [], f"/* {head}"
    for part in parts:
        part = part.replace("*/", "* /").replace("/*", "/ *")
        if len(line) + len(part) > _WIDTH:
            lines.append(line.rstrip())
            line = " * "
        line += f"{part}; "
    return "\n".join([*lines, line.rstrip("; ") + " */\n"])


def _actions(run: Run, name: str) -> str:
    """A table of the actions, unless they are the numbers of the tree; and how long one is held."""
    actions, text = run.actions, ""
    if actions.words:
        text += _comment("The actions: ", (f"{i} {word}" for i, word in enumerate(actions.words)))
    elif actions.table is not None:
        rows = np.reshape(actions.table, (actions.count, -1))
        real = rows.dtype.kind == "f"
        listed = ",\n".join(
            "    {" + ", ".join(_number(v, real) for v in row) + "}" for row in rows
        )
        kind = "float" if real else "int"
        text += (
            f"/* What each action of {name}_act is in the environment. */\n"
            f"static const {kind} {name}_actions[{len(rows)}][{rows.shape[1]}] = {{\n{listed}}};\n"
        )
    elif actions.start:
        numbers = ", ".join(str(actions.of(i)) for i in range(actions.count))
        text += (
            f"/* What each action of {name}_act is in the environment. */\n"
            f"static const int {name}_actions[{actions.count}] = {{{numbers}}};\n"
        )
    if actions.hold > 1:
        text += (
            f"#define {name.upper()}_HOLD {actions.hold} /* steps for which an action is held */\n"
        )
    return text


def _number(value: Any, real: bool) -> str:
    if not real:
        return str(int(value))
    text = np.format_float_scientific(np.float32(value), unique=True, trim="0")
    return f"{text}f"
