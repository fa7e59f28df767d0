# SPDX-License-Identifier: MIT
"""``python -m rlvc fleet learn|convert|export``."""

from __future__ import annotations

import argparse
import sys
from typing import Any

from ..fleet.convert import FILE_ROWS, convert, export
from ..fleet.learn import learn_from
from ..fleet.run import FleetRun
from . import values
from .options import add_outputs


def add(commands: Any) -> None:
    """Add the command's parsers.

    Parameters
    ----------
    commands : argparse's sub-parsers
    """
    fleet = commands.add_parser(
        "fleet",
        help="learn from the logs of many machines",
        description="Learns from more interactions than one machine holds, and converts their logs.",
    )
    verbs = fleet.add_subparsers(dest="verb", required=True, metavar="VERB")
    _add_learn(verbs)

    made = verbs.add_parser("convert", help="write a log as Parquet files")
    made.add_argument("log", metavar="LOG", help="NPZ, CSV or controller log, or a Minari data set")
    made.add_argument("folder", metavar="FOLDER", help="a folder, or an address such as s3://...")
    made.add_argument(
        "--actions",
        type=values.positive,
        metavar="N",
        help="number of actions (default: as the log says)",
    )
    made.add_argument("--columns", metavar="A,B,...", type=values.listed,
        help="columns of a CSV that are observed")  # fmt: skip
    made.add_argument("--file-rows", type=values.positive, metavar="N", default=FILE_ROWS,
        help="interactions in a file (default: %(default)s)")  # fmt: skip
    made.add_argument(
        "--prefix", default="part", help="beginning of the names (default: %(default)s)"
    )

    back = verbs.add_parser("export", help="write Parquet files as one NPZ")
    back.add_argument("source", metavar="SOURCE", nargs="+", help="files, folders or addresses")
    back.add_argument("file", metavar="FILE.npz")


def _add_learn(verbs: Any) -> None:
    learn = verbs.add_parser("learn", help="learn, and print the tree")
    option = learn.add_argument
    option("source", metavar="SOURCE", nargs="+", help="files, folders, addresses or data sets")
    option(
        "--method",
        choices=["classes", "planner"],
        default="classes",
        help="classes: bits, by counts; planner: real numbers, by a sample (default: %(default)s)",
    )
    option("--cluster", metavar="ADDRESS", help="ray, ray://..., dask, tcp://... (default: none)")
    option(
        "--workers",
        type=values.positive,
        metavar="N",
        help="tasks at a time of a cluster on this machine",
    )
    option("--checkpoint", metavar="FILE", help="save to FILE after each pass, and go on from it")
    option(
        "--sample",
        type=values.natural,
        metavar="N",
        help="interactions that features are guessed from (0: none), or a planner learns from",
    )
    option(
        "--reward-bits",
        type=values.natural,
        metavar="N",
        help="tell rewards apart by N bits of their fraction",
    )
    option(
        "--reward-grid",
        type=values.number,
        metavar="X",
        help="tell rewards apart on a grid of step X",
    )
    option("--skip-broken", action="store_true", help="leave out row groups that are broken")
    option(
        "--actions",
        type=values.positive,
        metavar="N",
        help="number of actions (default: as the log says)",
    )
    option("--discount", type=values.number, metavar="X", help="discount of future rewards")
    option("--tolerance", type=values.number, metavar="X", help="accuracy of the values")
    option(
        "--capacity",
        type=values.positive,
        metavar="N",
        help="capacity of the controller that loads the result, in interactions",
    )
    add_outputs(option)


_OPTIONS = (
    "method", "cluster", "workers", "checkpoint", "sample", "reward_bits", "reward_grid", "actions",
    "discount", "tolerance", "capacity",
)  # fmt: skip


def run(parsed: argparse.Namespace) -> FleetRun | None:
    """Do what was asked.

    Parameters
    ----------
    parsed : Namespace

    Returns
    -------
    FleetRun or None
        The run of ``learn``.
    """
    if parsed.verb == "convert":
        files = convert(parsed.log, parsed.folder, columns=parsed.columns, actions=parsed.actions,
                        file_rows=parsed.file_rows, prefix=parsed.prefix)  # fmt: skip
        print(*files, sep="\n")
        return None
    if parsed.verb == "export":
        print(f"{export(parsed.source, parsed.file)} interactions")
        return None
    given = {name: getattr(parsed, name) for name in _OPTIONS}
    options = {name: value for name, value in given.items() if value is not None}
    made = learn_from(
        parsed.source, skip_broken=parsed.skip_broken, progress=not parsed.quiet, **options
    )
    for skipped in made.report.skipped:
        print(f"rlvc: left out: {skipped}", file=sys.stderr)
    if made.report.lost:
        print(
            f"rlvc: left out: {made.report.lost} interactions, as what came next is not in the log",
            file=sys.stderr,
        )
    return made
