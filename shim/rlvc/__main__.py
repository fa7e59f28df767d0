# SPDX-License-Identifier: MIT
"""The command ``python -m rlvc``."""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import sys
from collections.abc import Callable
from typing import Any, NoReturn, get_args

from . import __version__, files
from .agent.agent import Agent
from .agent.config import CHOICES
from .agent.planned_policy import PlannedPolicy, is_policy
from .agent.planned_policy import read_file as read_policy
from .agent.snapshot import read_file
from .errors import EnvError, Error, RunError
from .fleet import command
from .learning.learn import Method, learn
from .learning.run import Run
from .learning.store import is_run, load
from .logs import learn_from
from .words import explain

_FIGURES = ("maze", "values", "curve", "splits", "tree", "tiles", "features")  # of rlvc.plot
_INTERRUPTED, _CLOSED_PIPE = 130, 141  # exit statuses: 128 and the number of the signal
_NUMBERS = {
    "discount": "discount factor, in [0, 1]",
    "epsilon": "probability of exploring, in [0, 1]",
    "alpha": "significance level of splits, in (0, 1]",
    "tolerance": "accuracy of values, in units of reward",
}


class _Parser(argparse.ArgumentParser):
    """Prints an error on one line."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"rlvc: {message}; {self.prog} --help tells more\n")


def _number(least: int) -> Callable[[str], int]:
    """Make the type of integers that are at least `least`."""

    def taken(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            value = least - 1
        if value < least:
            raise argparse.ArgumentTypeError(f"{text!r:.80} is not an integer of at least {least}")
        return value

    return taken


_whole, _seed = _number(1), _number(0)


def _add_learn(commands: Any) -> None:
    learn = commands.add_parser(
        "learn",
        help="learn from an environment or a log",
        description="Learns from a Gymnasium environment or from a log, and prints the tree.",
    )
    add = learn.add_argument
    add("env", nargs="?", metavar="ENV", help="environment, such as FrozenLake-v1 or MODULE:ID")
    add("--log", metavar="FILE", help="NPZ, CSV or controller log, or name of a Minari data set")
    add("--interactions", type=_whole, metavar="N", default=10_000,
        help="number of interactions with ENV (default: %(default)s)")  # fmt: skip
    add("--seed", type=_seed, metavar="N", default=1,
        help="seed of all random numbers (default: %(default)s)")  # fmt: skip
    add("--columns", metavar="A,B,...", help="columns of a CSV that form the observation")
    add("--steps", type=_whole, metavar="N", default=1,
        help="number of learning steps with --log (default: %(default)s)")  # fmt: skip
    add("--episodes", type=_seed, metavar="N", default=100,
        help="number of episodes to play after learning (default: %(default)s)")  # fmt: skip
    add("--json", metavar="FILE", help="write a report for 'plot'; -: print it")
    add("--c", metavar="FILE", help="write the policy as a C header; -: print it")
    add(
        "--save",
        metavar="FILE",
        help="write the agent, or a planner's policy, for 'show' and 'export'",
    )
    add("--quiet", action="store_true", help="show no progress bar")
    add("--method", choices=get_args(Method),
        help="how to learn (default: planner on real numbers from ENV, else classes)")  # fmt: skip
    config = learn.add_argument_group(
        "config of the agent", "rlvc.Config documents these; of the method 'classes'."
    )
    for name in _NUMBERS:
        config.add_argument(f"--{name}", type=float, metavar="X", help=_NUMBERS[name])
    for name, values in CHOICES.items():
        config.add_argument(f"--{name}", choices=values)


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="python -m rlvc", description="Learns small, readable decision trees from rewards."
    )
    parser.add_argument("--version", action="version", version=f"rlvc {__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    _add_learn(commands)
    command.add(commands)

    plot = commands.add_parser(
        "plot",
        help="draw a report",
        description="Draws a report of 'learn --json' or of run_gridworld --json.",
    )
    plot.add_argument("run", metavar="RUN.json")
    plot.add_argument("kind", choices=_FIGURES)
    plot.add_argument("file", metavar="FILE", help="a .png or a .svg")

    show = commands.add_parser(
        "show",
        help="print what was saved",
        description="Prints the tree of a saved agent or policy.",
    )
    show.add_argument("agent", metavar="FILE")

    export = commands.add_parser(
        "export",
        help="write what was saved as C",
        description="Writes the policy of a saved agent, or a saved policy, as a C header.",
    )
    export.add_argument("agent", metavar="FILE")
    export.add_argument("--c", metavar="FILE", required=True, help="the header")

    commands.add_parser(
        "bench", help="time the package", description="Measures the time of the package's calls."
    )
    return parser


def _config(arguments: argparse.Namespace) -> dict[str, Any]:
    chosen = {name: getattr(arguments, name) for name in (*_NUMBERS, *CHOICES)}
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
                method=arguments.method,
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
        print("rlvc: interrupted: the result is incomplete", file=sys.stderr)
        return _INTERRUPTED
    if env is not None and arguments.episodes > 0:
        mean = run.evaluate(env, arguments.episodes, seed=arguments.seed).mean
        print(f"mean return of {arguments.episodes} episodes: {mean:.4g}")
    return 0


def _summary(count: int, interactions: int, one: str = "class", many: str = "classes") -> str:
    """The number of classes or leaves, and of interactions."""
    return f"{count} {one if count == 1 else many} after {interactions} interactions"


def _keep(run: Run, env: Any, arguments: argparse.Namespace) -> None:
    """Write the result: files first, as the reader of the text may close the output."""
    if arguments.save:
        run.save(arguments.save)
    if arguments.json:
        from . import report

        _write(arguments.json, json.dumps(report.make(run, env), indent=1) + "\n")
    if arguments.c:
        _write(arguments.c, run.export_c())
    print(run.text(), end="")
    print(_counted(run))


def _counted(run: Run) -> str:
    words = ("class", "classes") if isinstance(run.acting, Agent) else ("leaf", "leaves")
    return _summary(run.leaves, run.interactions, *words)


def _show(file: str) -> None:
    if is_run(file):
        run = load(file)
        print(run.text(), end="")
        print(_counted(run))
        return
    if is_policy(file):
        policy, names = read_policy(file)
        print(explain(policy.print("text"), names), end="")
        return
    names = read_file(file)[2]
    agent = Agent.load(file)
    print(explain(agent.print("text"), names), end="")
    print(_summary(agent.classes, agent.statistics.interactions))


def _loaded(file: str) -> Run | Agent | PlannedPolicy:
    if is_run(file):
        return load(file)
    return PlannedPolicy.load(file) if is_policy(file) else Agent.load(file)


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
    if parsed.command == "fleet":
        run = command.run(parsed)
        if run is not None:
            _keep(run, None, parsed)
        return 0
    if parsed.command == "plot":
        _plot(parsed)
    elif parsed.command == "show":
        _show(parsed.agent)
    elif parsed.command == "export":
        _write(parsed.c, _loaded(parsed.agent).export_c())
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
        None: the arguments of the process.

    Returns
    -------
    int
        The exit status: 0; 1 after an error, which is printed on one line; 130 after Ctrl-C; 141 if
        the reader closed the output.
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
