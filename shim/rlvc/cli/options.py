# SPDX-License-Identifier: MIT
"""Options that several commands have."""

from __future__ import annotations

from typing import Any

from . import values


def add_log_options(add: Any) -> None:
    """Add what says how a log is read."""
    add(
        "--columns",
        metavar="A,B,...",
        type=values.listed,
        help="columns of a log that are the observation",
    )
    add(
        "--header",
        metavar="A,B,...",
        type=values.listed,
        help="names of the columns of a log without a header",
    )
    add(
        "--roles",
        metavar="ROLE=COLUMN,...",
        type=values.roles,
        help="roles of columns whose names do not tell them, such as action=valve,done=stop",
    )


def add_env_options(add: Any) -> None:
    """Add what an environment is made with."""
    add("--env-arg", metavar="NAME=VALUE", action="append", default=[],
        help="argument of the environment, such as is_slippery=False")  # fmt: skip


def add_outputs(add: Any) -> None:
    """Add what is made of a run."""
    add("--json", metavar="FILE", help="write a report for 'plot'; -: print it")
    add("--c", metavar="FILE", help="write the policy as a C header; -: print it")
    add(
        "--save",
        metavar="FILE",
        help="write the run, which other commands read",
    )
    add("--quiet", action="store_true", help="show no progress bar")
