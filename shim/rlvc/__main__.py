# SPDX-License-Identifier: MIT
"""The command ``python -m rlvc``."""

from __future__ import annotations

import argparse
import json
import sys
from typing import Any

from . import __version__, files
from .agent.agent import Agent
from .agent.config import CHOICES
from .agent.snapshot import read_file
from .errors import Error
from .learning.encode import explain
from .learning.learn import learn
from .learning.run import Run
from .logs import learn_from

_PICTURES = ("maze", "values", "curve", "splits", "tree", "tiles", "features")  # of rlvc.plot
_CURVES = ("discount", "epsilon", "alpha", "tolerance")


def _whole(text: str) -> int:
    value = int(text)
    if value < 1:
        raise ValueError
    return value


_whole.__name__ = "whole number from 1 on"


def _seed(text: str) -> int:
    value = int(text)
    if value < 0:
        raise ValueError
    return value


_seed.__name__ = "whole number from 0 on"


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m rlvc", description="Learns readable decision trees from rewards alone."
    )
    parser.add_argument("--version", action="version", version=f"rlvc {__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")

    one = commands.add_parser(
        "learn",
        help="learn from an environment or from a log",
        description="Learns from a Gymnasium environment, or from a log, and prints the tree.",
    )
    one.add_argument("env", nargs="?", metavar="ENV", help="such as FrozenLake-v1, or MODULE:ID")
    one.add_argument(
        "--log", metavar="FILE", help="an NPZ or CSV file, or a Minari data set's name"
    )
    one.add_argument("--interactions", type=_whole, default=10_000, help="with ENV (10000)")
    one.add_argument("--seed", type=_seed, default=1, help="of everything random (1)")
    one.add_argument("--columns", metavar="A,B,...", help="of a CSV's observation")
    for name in _CURVES:
        one.add_argument(f"--{name}", type=float, help="see rlvc.Config")
    for name, values in CHOICES.items():
        one.add_argument(f"--{name}", choices=values, help="see rlvc.Config")
    one.add_argument("--steps", type=_whole, default=1, help="learning steps, with --log (1)")
    one.add_argument(
        "--episodes", type=_seed, default=100, help="to play afterwards, with ENV (100)"
    )
    one.add_argument("--json", metavar="FILE", help="write a report, which 'plot' draws")
    one.add_argument("--c", metavar="FILE", help="write the policy as a C header")
    one.add_argument("--save", metavar="FILE", help="write the agent, which 'show' reads")
    one.add_argument("--quiet", action="store_true", help="no progress bar")

    two = commands.add_parser(
        "plot",
        help="draw a run",
        description="Draws a report that 'learn --json' or run_gridworld --json wrote.",
    )
    two.add_argument("run", metavar="RUN.json")
    two.add_argument("kind", choices=_PICTURES)
    two.add_argument("file", metavar="FILE", help="a .png or a .svg")

    three = commands.add_parser(
        "show", help="print an agent", description="Prints the tree of an agent that was saved."
    )
    three.add_argument("agent", metavar="AGENT")

    four = commands.add_parser(
        "export",
        help="write an agent's policy as C",
        description="Writes the policy of an agent that was saved as a C header.",
    )
    four.add_argument("agent", metavar="AGENT")
    four.add_argument("--c", metavar="FILE", required=True)

    commands.add_parser(
        "bench", help="time the package's calls", description="Times the package's calls."
    )
    return parser


def _config(arguments: argparse.Namespace) -> dict[str, Any]:
    chosen = {name: getattr(arguments, name) for name in (*_CURVES, *CHOICES)}
    return {name: value for name, value in chosen.items() if value is not None}


def _environment(name: str) -> Any:
    try:
        import gymnasium
    except ImportError:
        raise ImportError("environments need Gymnasium: pip install 'rlvc[gym]'") from None
    if name.startswith("rlvc/"):
        from . import envs

        envs.register()
    return gymnasium.make(name)


def _write(file: str, text: str) -> None:
    if file == "-":
        print(text, end="")
    else:
        files.replace(file, text.encode())


def _learn(arguments: argparse.Namespace) -> None:
    if (arguments.env is None) == (arguments.log is None):
        raise Error("learn: either ENV or --log FILE is wanted")
    env = None
    if arguments.env is not None:
        env = _environment(arguments.env)
        run = learn(
            env,
            arguments.interactions,
            seed=arguments.seed,
            progress=not arguments.quiet,
            **_config(arguments),
        )
    else:
        columns = arguments.columns.split(",") if arguments.columns else None
        run = learn_from(
            arguments.log,
            columns=columns,
            steps=arguments.steps,
            seed=arguments.seed,
            **_config(arguments),
        )
    _show(run, env, arguments)


def _show(run: Run, env: Any, arguments: argparse.Namespace) -> None:
    print(run.text(), end="")
    statistics = run.agent.statistics
    print(f"{statistics.classes} classes after {statistics.interactions} interactions")
    if arguments.json:
        from . import report

        _write(arguments.json, json.dumps(report.make(run, env), indent=1) + "\n")
    if arguments.save:
        run.agent.save(arguments.save, run.encoder.names if run.encoder else ())
    if arguments.c:
        _write(arguments.c, (run.small or run.agent).export_c())
    if run.interrupted:
        print("interrupted: this is what was learnt until then", file=sys.stderr)
    elif env is not None and arguments.episodes > 0:
        mean = run.evaluate(env, arguments.episodes, seed=arguments.seed)
        print(f"mean return of {arguments.episodes} episodes: {mean:.4g}")


def _show_agent(file: str) -> None:
    names = read_file(file)[2]
    agent = Agent.load(file)
    text = agent.print("text")
    print(explain(text, names) if names else text, end="")
    statistics = agent.statistics
    print(f"{statistics.classes} classes after {statistics.interactions} interactions")


def _plot(arguments: argparse.Namespace) -> None:
    from . import plot

    plot.KINDS[arguments.kind](arguments.run, arguments.file)


def main(arguments: list[str] | None = None) -> int:
    """Run the command.

    Parameters
    ----------
    arguments : list of str or None
        None: those of the process.

    Returns
    -------
    int
        The exit status: 0, or 1 after an error, which is told in one line.
    """
    parsed = _parser().parse_args(arguments)
    try:
        if parsed.command == "learn":
            _learn(parsed)
        elif parsed.command == "plot":
            _plot(parsed)
        elif parsed.command == "show":
            _show_agent(parsed.agent)
        elif parsed.command == "export":
            _write(parsed.c, Agent.load(parsed.agent).export_c())
        else:
            from . import bench

            bench.main()
    except KeyboardInterrupt:
        print("rlvc: interrupted", file=sys.stderr)
        return 130
    except Exception as error:
        if not isinstance(error, Error | ImportError | OSError) and not type(
            error
        ).__module__.startswith("gymnasium"):
            raise
        print("rlvc: " + " ".join(str(error).split()), file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
