# SPDX-License-Identifier: MIT
"""The page of results: RESULTS.md, whose tables become plots that are drawn from their rows, so that none can be stale.
The rows follow each plot, folded. What RESULTS.md links to is in the repository, not in the site."""

import dataclasses
import pathlib
import re
import textwrap

import matplotlib as mpl
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from rlvc.plot.drawing import BLUE, ORANGE, tidy

ROOT = pathlib.Path(__file__).resolve().parents[2]
COLOURS = (BLUE, ORANGE, "#009E73")
TABLE = re.compile(r"(?:^\|.*\n)+", re.MULTILINE)


@dataclasses.dataclass
class Chart:
    section: str
    axis: str
    pattern: str  # of the figures in a cell: each match is a bar
    column: int = -1
    series: tuple = ("",)  # a bar each; one name: the first match alone
    log: bool = False
    least: float = 0  # where the axis begins
    file: str = "RESULTS.md"


CHARTS = (
    Chart("The paper's maze", "interactions until the policy is optimal (medians)", r"(?:median |after )([\d,]+)", log=True),
    Chart("Known tasks, one configuration", "interactions (medians)", r"after ([\d,]+)", log=True),
    Chart("Fleets", "seconds for 10,000,000 interactions", r"([\d.]+)", column=1, series=("", "two workers")),
    Chart("Photographs", "% of decisions that are optimal", r"([\d.]+) %", series=("poses seen", "held-out poses"), least=90),
    Chart("On microcontrollers", "bytes of memory, stack included", r"([\d,]+) bytes of memory"),
    Chart("Speed", "times as fast", r"(\d+)(?= times| to \d+ times)", series=("", "at best"), log=True),
)
SIZES = Chart("By what a program uses", "KiB of flash", "", series=("policy", "learner on bits", "learner on numbers"),
              file="core/SIZE.md")  # fmt: skip


def cells(line):
    return [cell.strip(" *") for cell in line.replace("\\|", "/").strip("|\n").split("|")]


def first_table(chart):
    """The text of the first table of a chart's section."""
    text = (ROOT / chart.file).read_text(encoding="utf-8")
    return TABLE.search(text, text.index(f"## {chart.section}\n"))[0]


def rows_of(chart, table):
    """Label, figures, and whether they are of what was not learnt, of each row that has figures."""
    found = []
    for line in table.splitlines()[2:]:
        parts = cells(line)
        figures = [float(each.replace(",", "")) for each in re.findall(chart.pattern, parts[chart.column])]
        if figures:
            label = re.sub(r"`", "", parts[0])
            missed = bool(re.match(r"not (optimal|within|learnt)", parts[chart.column]))
            found.append((label, figures[: len(chart.series)], missed))
    if len(found) < 2:
        raise SystemExit(f"{chart.file}: the table of '{chart.section}' has no figures like '{chart.pattern}'")
    return found


def sizes():
    """The rows of core/SIZE.md: flash of three programs on each machine."""
    found = []
    for line in first_table(SIZES).splitlines()[2:]:
        parts = cells(line)
        found.append((parts[0], [int(parts[i].replace(",", "")) / 1024 for i in (2, 4, 6)], False))
    return found


def draw(chart, rows, file):
    """Draws bars, and returns what they say in words."""
    count = sum(len(figures) for _, figures, _ in rows)
    figure = Figure(figsize=(5.6, 0.24 * count + 0.24 * len(rows) + 1.0), layout="constrained")  # legible on a phone
    axes = figure.subplots()
    at, places, words = 0.0, [], []
    for label, figures, missed in rows:
        places.append(at + (len(figures) - 1) / 2)
        for series, value in enumerate(figures):
            said = f"{value:,.0f}" if value >= 100 else f"{value:.3g}"
            axes.barh(at, value - chart.least, left=chart.least, color=COLOURS[series], hatch="//" if missed else "",
                      edgecolor="white")  # fmt: skip
            axes.annotate(f"{said}, and not learnt" if missed else said, (value, at), xytext=(4, 0),
                          textcoords="offset points", va="center", fontsize=9)  # fmt: skip
            at += 1
        words.append(f"{label} {' and '.join(f'{value:.4g}' for value in figures)}")
        at += 0.6
    axes.set_yticks(places, [textwrap.fill(textwrap.shorten(label, 60), 30) for label, _, _ in rows], fontsize=9)
    axes.invert_yaxis()
    if chart.log:
        axes.set_xscale("log")
    else:
        axes.xaxis.set_major_locator(MaxNLocator(5))
        axes.xaxis.set_major_formatter("{x:,.0f}")
    axes.set_xlabel(chart.axis)
    axes.margins(x=0.22)
    named = [Patch(color=COLOURS[i], label=name) for i, name in enumerate(chart.series) if name]
    if named:
        figure.legend(handles=named, frameon=False, fontsize=9, loc="outside upper right", ncols=len(named))
    tidy(axes, grid="x")
    figure.savefig(file, bbox_inches="tight", metadata={"Date": None})
    return f"{chart.axis}: {'; '.join(words)}".replace('"', "").replace("[", "(").replace("]", ")")


def folded(table):
    indented = "".join(f"    {line}\n" for line in table.splitlines())
    return f'??? note "The rows, with their commands"\n\n{indented}'


def write(folder):
    """Makes results.md and its pictures in the folder of the pages."""
    text = (ROOT / "RESULTS.md").read_text(encoding="utf-8")
    (folder / "pictures").mkdir(exist_ok=True)
    with mpl.rc_context({"svg.fonttype": "none", "svg.hashsalt": "rlvc", "font.family": "sans-serif"}):
        for number, chart in enumerate(CHARTS):
            table, file = first_table(chart), f"pictures/results_{number}.svg"
            words = draw(chart, rows_of(chart, table), folder / file)
            text = text.replace(table, f"![{words}]({file})\n\n{folded(table)}", 1)
        words = draw(SIZES, sizes(), folder / "pictures/sizes.svg")
        text = text.replace("\nFlash and RAM on eight", f"\n![{words}](pictures/sizes.svg)\n\nFlash and RAM on eight", 1)
    text = re.sub(rf"({TABLE.pattern})(?=\n!\[)", lambda match: folded(match[0]), text, flags=re.MULTILINE)
    text = text.replace("](shim/docs/pictures/", "](pictures/")
    text = re.sub(r"\[([^\]]+)\]\((?!https?:|#|pictures/)[^)]+\)", r"`\1`", text).replace("``", "`")
    (folder / "results.md").write_text(text, encoding="utf-8")
