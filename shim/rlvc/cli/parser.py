# SPDX-License-Identifier: MIT
"""The arguments of ``python -m rlvc``."""

from __future__ import annotations

import argparse
import dataclasses
from typing import Any, NoReturn, get_args

from .._version import __version__
from ..agent.config import CHOICES, Config
from ..agent.planner_config import PlannerConfig
from ..learning.learn import Method
from . import fleet, values
from .options import add_env_options, add_log_options, add_outputs

FIGURES = (
    *("maze", "values", "curve", "splits", "tree", "tiles", "features"),
    *("regions", "importances", "path", "grid"),  # of a saved run
)
"""The figures of rlvc.plot."""


class _Parser(argparse.ArgumentParser):
    """Prints an error on one line."""

    def error(self, message: str) -> NoReturn:
        what = message.removeprefix("argument ")  # as other errors begin: with the option
        self.exit(2, f"rlvc: {what}; {self.prog} --help tells more\n")

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        """Tell a wrong choice as other wrong values are told."""
        if action.choices is not None and value not in action.choices:
            names = ", ".join(map(str, action.choices))
            raise argparse.ArgumentError(action, f"{value!r:.80} is not one of {names}")


def config_fields() -> dict[str, dict[str, Any]]:
    """The fields of the configs that have an option of their own, and what values these take."""
    kinds = {
        "int": {"type": values.whole(), "metavar": "N"},
        "float": {"type": values.number, "metavar": "X"},
        "bool": {"type": values.truth, "metavar": "yes|no"},
    }
    found: dict[str, dict[str, Any]] = {}
    for field in (*dataclasses.fields(Config), *dataclasses.fields(PlannerConfig)):
        kind = str(field.type).split(" |")[0]
        if kind in kinds and field.name not in ("actions", "seed"):
            found[field.name] = kinds[kind]
    return found


def _option(name: str) -> str:
    return "--" + name.replace("_", "-")


def _add_frames(add: Any) -> None:
    add(
        "--frames",
        metavar="SOURCE",
        help="a folder of pictures or a video of a camera, with a log in it, beside it, or of --log",
    )
    add("--frame-column", metavar="NAME", help="column of the log that names the frames")
    add("--scale-depth", action="store_true", help="scale frames of 16 bits a channel to 8")
    add("--save-metric", metavar="FILE", help="write the metric of the frames' vectors")


def _add_percepts(add: Any) -> None:
    """What is observed, and which actions there are."""
    add(
        "--thresholds",
        type=values.natural,
        metavar="N",
        help="maximum number of cutpoints of a component; 0: no limit",
    )
    add(
        "--names",
        type=values.listed,
        metavar="A,B,...",
        help="names of the numbers of an observation",
    )
    add(
        "--bins",
        type=values.bins,
        metavar="N",
        help="number of discrete actions for each element of a Box of actions",
    )
    add(
        "--hold",
        type=values.positive,
        metavar="N",
        help="number of steps for which an action is held",
    )
    add(
        "--history",
        type=values.positive,
        metavar="N",
        help="observe the last N observations, and the actions between them",
    )


def _add_learn(commands: Any) -> None:
    learn = commands.add_parser(
        "learn",
        help="learn from an environment or a log",
        description="Learns from a Gymnasium environment or from a log, and prints the tree.",
    )
    add = learn.add_argument
    add("env", nargs="*", metavar="ENV",
        help="environment, such as FrozenLake-v1 or MODULE:ID; or files of logs")  # fmt: skip
    add("--log", metavar="FILE", nargs="+", help="logs of any kind, or name of a Minari data set")
    _add_frames(add)
    add("--interactions", type=values.positive, metavar="N", default=10_000,
        help="number of interactions with ENV (default: %(default)s)")  # fmt: skip
    add("--seed", type=values.natural, metavar="N", default=1,
        help="seed of all random numbers (default: %(default)s)")  # fmt: skip
    add(
        "--seeds",
        type=values.positive,
        metavar="N",
        help="learn N times in ENV, from --seed on, and print the return of each seed",
    )
    add("--run", metavar="FILE", help="go on with a saved run in ENV")
    add_env_options(add)
    add(
        "--every", type=values.positive, metavar="N", help="interactions between two learning steps"
    )
    _add_percepts(add)
    add_log_options(add)
    add("--actions", type=values.positive, metavar="N", help="number of actions of --log")
    add(
        "--steps",
        type=values.positive,
        metavar="N",
        help="number of learning steps with --log (default: 1)",
    )
    add("--episodes", type=values.natural, metavar="N", default=100,
        help="number of episodes to play after learning (default: %(default)s)")  # fmt: skip
    add("--compact", action="store_true", help="use the smallest tree that acts as well")
    add_outputs(add)
    add("--method", choices=get_args(Method),
        help="how to learn (default: planner on real numbers from ENV, else classes)")  # fmt: skip
    config = learn.add_argument_group(
        "config",
        "Fields of rlvc.Config (classes) and rlvc.PlannerConfig (planner), which document them.",
    )
    for name, kind in config_fields().items():
        config.add_argument(_option(name), **kind)
    for name, choices in CHOICES.items():
        config.add_argument(_option(name), choices=choices)


def _add_of_a_run(commands: Any) -> None:
    def command(name: str, text: str, description: str) -> Any:
        added = commands.add_parser(name, help=text, description=description)
        added.add_argument("file", metavar="RUN", help="a saved run, agent or policy")
        return added.add_argument

    command("show", "print what was saved", "Prints the tree of a saved run, agent or policy.")
    add = command("evaluate", "play with a saved run", "Plays episodes without exploring.")
    add("env", metavar="ENV", help="environment, such as FrozenLake-v1 or MODULE:ID")
    add_env_options(add)
    add(
        "--history",
        type=values.positive,
        metavar="N",
        help="observe the last N observations, as in learning",
    )
    add("--episodes", type=values.positive, metavar="N", default=100,
        help="number of episodes (default: %(default)s)")  # fmt: skip
    add(
        "--seed",
        type=values.natural,
        metavar="N",
        default=1,
        help="seed of the first reset (default: %(default)s)",
    )
    add = command(
        "explain", "say why a run acts so", "Prints the path of an observation through the tree."
    )
    add(
        "observation",
        metavar="JSON",
        help="such as 5, '[0.1, -0.2]' or '{\"mode\": \"heat\"}'; for a run on pictures: its file",
    )
    command(
        "importances", "measure what matters", "Prints how often the action depends on each number."
    )
    add = command("export", "write what was saved as C", "Writes the policy as a C header.")
    add("--c", metavar="FILE", required=True, help="the header; -: print it")
    add("--name", metavar="NAME", default="policy", help="prefix in C (default: %(default)s)")


def _add_plot(commands: Any) -> None:
    plot = commands.add_parser(
        "plot",
        help="draw a run or a report",
        description="Draws a saved run, or a report of 'learn --json' or of run_gridworld --json. "
        "Regions, importances, path and grid need a saved run.",
    )
    add = plot.add_argument
    add("run", metavar="RUN", help="a saved run, or a report")
    add("kind", choices=FIGURES, help="what to draw")
    add("file", metavar="FILE", help="a .png, .svg or .pdf")
    add(
        "--components",
        type=values.listed,
        metavar="A,B",
        help="for regions: the two components that are drawn",
    )
    add(
        "--observation",
        metavar="JSON",
        help="for path: the observation; for regions: what the other components are",
    )
    add("--env", metavar="ENV", help="for grid: FrozenLake-v1, CliffWalking-v1 or Taxi-v4")
    add_env_options(add)


def make_parser() -> argparse.ArgumentParser:
    """Make the parser of all commands.

    Returns
    -------
    argparse.ArgumentParser
    """
    parser = _Parser(
        prog="python -m rlvc", description="Learns small, readable decision trees from rewards."
    )
    parser.add_argument("--version", action="version", version=f"rlvc {__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    _add_learn(commands)
    _add_of_a_run(commands)

    _add_plot(commands)

    log = commands.add_parser(
        "log",
        help="show how logs are understood",
        description="Shows how logs are understood, and what of them is left out, without learning.",
    )
    log.add_argument("log", metavar="FILE", nargs="+")
    convert = commands.add_parser(
        "convert",
        help="write a log of any kind as NPZ",
        description="Writes a log of any kind as arrays in an NPZ file, which 'learn --log' reads.",
    )
    convert.add_argument("log", metavar="FILE")
    convert.add_argument("to", metavar="FILE.npz")
    for each in (log, convert):
        add_log_options(each.add_argument)
        each.add_argument("--bins", type=values.positive, metavar="N",
            help="number of discrete actions for each real action")  # fmt: skip

    fleet.add(commands)
    commands.add_parser(
        "bench", help="time the package", description="Measures the time of the package's calls."
    )
    return parser
