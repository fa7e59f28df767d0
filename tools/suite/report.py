# SPDX-License-Identifier: MIT
"""The table, in Markdown: a row for each task and learner, what the columns mean, and each bar."""

import dataclasses
import math
import statistics

import rlvc

from . import options
from .learners import LEARNERS
from .tasks import TASKS, median, worst

NONE = "-"
HEAD = (
    "task", "learner", "runs", "return", "optimal", "reached", "worst", "leaves", "compacted", "kept",
    "fewest", "distracted", "seconds", "KB",
)  # fmt: skip
LEGEND = """\
Figures are medians over runs.

- return: of an episode of the greedy policy at the end; exact on bits
- optimal: share of states in which the policy takes only optimal actions, whatever the distractors are
- reached, worst: interactions after which the policy was good enough at every check (see the task); the
  median and the worst run
- leaves: of the tree; compacted: of the compacted policy; kept: the return of that policy; fewest: of
  the smallest tree over the bits that is optimal everywhere
- distracted: runs whose tree tests a distractor
- seconds: of processor time; KB: memory of the agent, or of what another learner learns

Tasks:
"""


def _number(value, form=",.0f"):
    if value is None:
        return NONE
    return "never" if math.isinf(value) else format(value, form)


def _median(records, key, form=",.0f", scale=1.0):
    """The median over runs; a dash where there is no such figure."""
    values = [record[key] for record in records if record[key] is not None]
    return _number(statistics.median(values) * scale, form) if values else NONE


def _reached(records, key):
    return _number(median(key)(records)), _number(worst(key)(records))


def _rows(task, learner, records):
    judged = records[0]["value"] is not None
    distracted = [record["distractors"] for record in records]
    yield (
        task.name,
        options.LEARNERS[learner],
        str(len(records)),
        _median(records, "value", ".3g"),
        _median(records, "optimal", ".1f", 100) + ("" if records[0]["optimal"] is None else " %"),
        *(_reached(records, "reached") if judged else (NONE, NONE)),
        _median(records, "leaves"),
        _median(records, "compacted"),
        _median(records, "kept", ".3g"),
        _number(task.fewest),
        NONE if None in distracted else str(sum(count > 0 for count in distracted)),
        _median(records, "seconds", ",.1f"),
        _median(records, "bytes", ",.1f", 0.001),
    )
    if task.changed is not None:
        again = _reached(records, "reached_again")
        yield tuple(
            {"task": task.name + ", again", "reached": again[0], "worst": again[1]}.get(name, "")
            for name in HEAD
        )


def _aligned(rows):
    """Rows of text as a table; the first two columns are aligned left."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = []
    for row in rows:
        cells = [
            cell.ljust(width) if i < 2 else cell.rjust(width)
            for i, (cell, width) in enumerate(zip(row, widths, strict=True))
        ]
        lines.append("| " + " | ".join(cells) + " |")
    rule = ["-" * width if i < 2 else "-" * (width - 1) + ":" for i, width in enumerate(widths)]
    return [lines[0], "| " + " | ".join(rule) + " |", *lines[1:]]


def _about(task):
    best = f"; best return {task.world.best_return(task.discount):.3g}" if task.world else ""
    return (
        f"- {task.name}: {task.title}; {task.about}{best}; discount {task.discount}, "
        f"{task.interactions:,} interactions"
    )


def _bars(task, records, peers):
    for bar in task.bars:
        figure = bar.figure(records)
        if of_peer := [record for record in peers if record["learner"] == bar.peer]:
            bar = dataclasses.replace(bar, limit=bar.figure(of_peer))
        yield (
            f"- {'met' if bar.met(figure) else 'MISSED'}: {task.name}: {bar.text}: "
            f"{_number(figure, ',.5g')} ({'at least' if bar.least else 'at most'} {bar.limit:,.5g})"
        )


def _configuration(records):
    """The configuration of rlvc: the fields that no task chooses, with every value that was used."""
    own = {"actions", "capacity", "seed", "discount"}
    values = {}
    for record in records:
        for name, value in record.get("config", {}).items():
            if name not in own and value not in values.setdefault(name, []):
                values[name].append(value)
    if not values:
        return []
    fields = ", ".join(f"{name} {' or '.join(map(str, used))}" for name, used in values.items())
    return [
        f"rlvc {rlvc.__version__} with the defaults of rlvc.learn in all tasks: a planner on up to "
        "64 real numbers, else an agent. A task sets the seed, the number of interactions and, on bits, "
        "the discount. An agent learns after each hundredth of the interactions, at least 100; the "
        f"memory holds them all. The rest: {fields}.",
        "",
    ]


def _peers(learners):
    lines = [
        f"- {options.LEARNERS[name]}: {LEARNERS[name].about}"
        for name in learners
        if LEARNERS[name].about
    ]
    return ["Other learners:", "", *lines, ""] if lines else []


def render(records, tasks, learners):
    """The whole text, of the runs that are done."""
    rows, bars = [HEAD], []
    for name in tasks:
        for learner in learners:
            found = [r for r in records if (r["task"], r["learner"]) == (name, learner)]
            if found:
                rows += _rows(TASKS[name](), learner, found)
                if learner == "rlvc":
                    bars += _bars(TASKS[name](), found, [r for r in records if r["task"] == name])
    return "\n".join(
        [
            *_aligned(rows),
            "",
            LEGEND,
            *(_about(TASKS[name]()) for name in tasks),
            "",
            *_peers(learners),
            *_configuration(records),
            *(["Bars:", "", *bars] if bars else []),
        ]
    )
