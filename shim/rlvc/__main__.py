# SPDX-License-Identifier: MIT
"""The command ``python -m rlvc``."""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import sys
from collections.abc import Callable
from typing import Any, NoReturn

from . import __version__, files
from .agent.agent import Agent
from .agent.config import CHOICES
from .agent.snapshot import read_file
from .errors import EnvError, Error, RunError
from .learning.encode import explain
from .learning.learn import learn
from .learning.run import Run
from .logs import learn_from

_PICTURES = ("maze", "values", "curve", "splits", "tree", "tiles", "features")  # of rlvc.plot
_INTERRUPTED, _CLOSED_PIPE = 130, 141  # exit statuses: 128 and the number of the signal
_CURVES = ("discount", "epsilon", "alpha", "tolerance")


class _Parser(argparse.ArgumentParser):
    """Tells what is wrong in one line."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"rlvc: {message}; {self.prog} --help tells more\n")


def _number(least: int) -> Callable[[str], int]:
    """Take a whole number from so many on."""

    def taken(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            value = least - 1
        if value < least:
            raise argparse.ArgumentTypeError(f"{text!r:.80} is not a whole number from {least} on")
        return value

    return taken


_whole, _seed = _number(1), _number(0)


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
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
    one.add_argument(
        "--json", metavar="FILE", help="write a report, which 'plot' draws; -: print it"
    )
    one.add_argument("--c", metavar="FILE", help="write the policy as a C header; -: print it")
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
    try:
        return gymnasium.make(name)
    except ImportError:
        raise
    except Exception as error:  # of Gymnasium, or of the environment
        raise EnvError(f"{name}: cannot be made: {error}") from error


def _write(file: str, text: str) -> None:
    if file == "-":
        print(text, end="")
    else:
        files.replace(file, text.encode())


def _learn(arguments: argparse.Namespace) -> int:
    if (arguments.env is None) == (arguments.log is None):
        raise Error("learn: give either ENV or --log FILE")
    env = None
    try:
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
    except Exception as error:
        if isinstance(getattr(error, "run", None), Run):
            _keep(error.run, env, arguments)  # type: ignore[attr-defined]
        raise
    _keep(run, env, arguments)
    if run.interrupted:
        print("rlvc: interrupted: this is what was learnt until then", file=sys.stderr)
        return _INTERRUPTED
    if env is not None and arguments.episodes > 0:
        mean = run.evaluate(env, arguments.episodes, seed=arguments.seed)
        print(f"mean return of {arguments.episodes} episodes: {mean:.4g}")
    return 0


def _keep(run: Run, env: Any, arguments: argparse.Namespace) -> None:
    """Write what was learnt; first into files, as who reads the text may leave."""
    if arguments.save:
        run.agent.save(arguments.save, run.encoder.names if run.encoder else ())
    if arguments.json:
        from . import report

        _write(arguments.json, json.dumps(report.make(run, env), indent=1) + "\n")
    if arguments.c:
        _write(arguments.c, (run.small or run.agent).export_c())
    print(run.text(), end="")
    statistics = run.agent.statistics
    print(f"{statistics.classes} classes after {statistics.interactions} interactions")


def _show_agent(file: str) -> None:
    names = read_file(file)[2]
    agent = Agent.load(file)
    text = agent.print("text")
    print(explain(text, names) if names else text, end="")
    statistics = agent.statistics
    print(f"{statistics.classes} classes after {statistics.interactions} interactions")


def _plot(arguments: argparse.Namespace) -> None:
    from . import plot

    try:
        plot.KINDS[arguments.kind](arguments.run, arguments.file)
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        if isinstance(error, Error):
            raise
        raise RunError(f"{arguments.run}: damaged: {error!r:.200}") from error


def _run(parsed: argparse.Namespace) -> int:
    if parsed.command == "learn":
        return _learn(parsed)
    if parsed.command == "plot":
        _plot(parsed)
    elif parsed.command == "show":
        _show_agent(parsed.agent)
    elif parsed.command == "export":
        _write(parsed.c, Agent.load(parsed.agent).export_c())
    else:
        from . import bench

        bench.main()
    return 0


def _told(error: Exception) -> str:
    """Give an error in one line."""
    text = " ".join(str(error).split())
    if isinstance(error, Error | ImportError | OSError):
        return text
    return f"the environment raised {type(error).__name__}: {text}"


def main(arguments: list[str] | None = None) -> int:
    """Run the command.

    Parameters
    ----------
    arguments : list of str or None
        None: those of the process.

    Returns
    -------
    int
        The exit status: 0; 1 after an error, which is told in one line; 130 after Ctrl-C; 141 if nobody
        reads the output any more.
    """
    try:
        try:
            return _run(_parser().parse_args(arguments))
        finally:
            if sys.stdout is not None:
                sys.stdout.flush()
    except KeyboardInterrupt:
        print("rlvc: interrupted", file=sys.stderr)
        return _INTERRUPTED
    except BrokenPipeError:
        with contextlib.suppress(
            OSError
        ):  # what is left in the buffer must not be written at the end
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return _CLOSED_PIPE
    except Exception as error:
        if not isinstance(error, Error | ImportError | OSError) and not hasattr(error, "run"):
            raise
        print(f"rlvc: {_told(error)}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
