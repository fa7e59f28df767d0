# SPDX-License-Identifier: MIT
"""What the commands of ``python -m rlvc`` do."""

from __future__ import annotations

import argparse
import ast
import contextlib
import io
import json
import os
import sys
from pathlib import Path
from typing import Any

import numpy as np

from .. import files, logs
from ..agent.agent import Agent
from ..agent.config import CHOICES
from ..agent.planned_policy import PlannedPolicy, is_policy
from ..agent.planned_policy import read_file as read_policy
from ..agent.snapshot import read_file
from ..checks import named
from ..errors import ConfigError, EnvError, Error, RunError
from ..learning.encode import Encoder
from ..learning.learn import learn
from ..learning.run import Run
from ..learning.store import is_run, load
from ..logs import learn_from
from ..words import explain
from . import fleet
from .parser import config_fields

_LOG_OPTIONS = ("columns", "header", "roles", "bins")
_OF_FRAMES = ("frame_column", "save_metric")
_OF_ENV = ("env_arg", "every", "hold", "method", "run")
# The options that would do nothing, by what is learnt from.
_IDLE = {
    "an environment": (*_OF_FRAMES, "actions", "columns", "header", "roles", "steps"),
    "logs": (*_OF_FRAMES, *_OF_ENV),
    "--frames": (*_OF_ENV, "columns", "history", "names", "seeds", "thresholds"),
}
_WRITTEN = ("save", "json", "c", "save_metric")
_PRINTED = ("json", "c")  # where the file is '-'
INTERRUPTED = 130  # exit status: 128 and the number of the signal


def _chosen(arguments: argparse.Namespace, *names: str) -> dict[str, Any]:
    """The arguments that were given, of these names and of the configs."""
    listed = (*names, *config_fields(), *CHOICES)
    chosen = {name: getattr(arguments, name, None) for name in listed}
    return {name: value for name, value in chosen.items() if value is not None}


def _environment(name: str, given: list[str]) -> Any:
    try:
        import gymnasium
    except ImportError:
        raise ImportError("environments need Gymnasium: pip install 'rlvc[gym]'") from None
    if name.startswith("rlvc/"):
        from .. import envs

        envs.register()
    arguments = {}
    for text in given:
        key, sign, value = text.partition("=")
        if not sign:
            raise ConfigError(f"--env-arg: {text!r:.80} is not NAME=VALUE")
        try:
            arguments[key] = ast.literal_eval(value)
        except (SyntaxError, ValueError):
            arguments[key] = value
    try:
        return gymnasium.make(name, **arguments)
    except ImportError:
        raise
    except Exception as error:  # of Gymnasium, or of the environment
        why = f"{type(error).__name__} {error}" if isinstance(error, KeyError) else error
        raise EnvError(f"{name}: cannot be made: {why}") from error


def _with_past(env: Any, count: int | None) -> Any:
    """The environment with its last observations in one."""
    if count is None:
        return env
    from ..envs.history import History

    return History(env, count)


def _write(file: str, text: str) -> None:
    if file == "-":
        print(text, end="")
    else:
        files.replace(file, text.encode())


def _sort_out(arguments: argparse.Namespace) -> None:
    """What is named is one environment, or files of logs."""
    named, arguments.env = arguments.env, None
    if len(named) > 1 or (named and _is_log(named[0])):
        arguments.log = [*named, *(arguments.log or ())]
    elif named:
        arguments.env = named[0]
    if arguments.frames is not None and arguments.env is None:
        source = "--frames"
    elif (arguments.env is None) == (arguments.log is None) or arguments.frames is not None:
        raise Error("learn: give either ENV or files of logs, or --frames")
    else:
        source = "logs" if arguments.env is None else "an environment"
    for name in _IDLE[source]:
        if getattr(arguments, name) not in (None, []):
            raise ConfigError(f"--{name.replace('_', '-')}: does not go with {source}")


def _is_log(name: str) -> bool:
    """Whether a name is that of a log, and not of an environment."""
    others = (".npz", ".npy", ".hdf5", ".h5", ".parquet", ".pkl", ".gz", ".bz2", ".xz", ".zip")
    return Path(name).exists() or Path(name).suffix.lower() in (*logs.SUFFIXES, *others)


def _check_written(arguments: argparse.Namespace, read: list[str]) -> None:
    """Raise, before the work, if a file could not be written after it, or would replace another one."""
    taken = {_place(name): "the log" for name in read}
    for name in _WRITTEN:
        file, option = getattr(arguments, name, None), f"--{name.replace('_', '-')}"
        if file is None or (file == "-" and name in _PRINTED):
            continue
        files.check_place(file)
        if _place(file) in taken:
            raise ConfigError(f"{option}: {file} is also {taken[_place(file)]}")
        taken[_place(file)] = f"the file of {option}"


def _place(name: str) -> str:
    """The path of a file without links, also of what is no name."""
    with contextlib.suppress(OSError, ValueError):
        return os.path.realpath(name)
    return name


def learn_command(arguments: argparse.Namespace) -> int:
    """Learn, write and print what was learnt."""
    _sort_out(arguments)
    _check_written(arguments, arguments.log or [])
    if arguments.seeds is not None:
        return _learn_often(arguments)
    env = None
    try:
        if arguments.frames is not None:
            run = _learnt_from_frames(arguments)
        elif arguments.env is not None:
            env = _with_past(_environment(arguments.env, arguments.env_arg), arguments.history)
            run = _learnt(env, arguments, load(arguments.run) if arguments.run else None)
        else:
            options: tuple[str, ...] = (
                *("columns", "header", "roles", "actions", "bins", "thresholds", "names"),
                *("history", "steps"),
            )
            found = arguments.log[0] if len(arguments.log) == 1 else arguments.log
            run = learn_from(found, seed=arguments.seed, **_chosen(arguments, *options))
    except Exception as error:
        if isinstance(getattr(error, "run", None), Run):
            _keep(error.run, env, arguments)  # type: ignore[attr-defined]
        raise
    if arguments.compact:
        run.compact()
    _keep(run, env, arguments)
    if run.interrupted:
        print("rlvc: interrupted: the result is incomplete", file=sys.stderr)
        return INTERRUPTED
    if env is not None and arguments.episodes > 0:
        evaluation = run.evaluate(env, arguments.episodes, seed=arguments.seed)
        cut = f" ({evaluation.cut} cut off)" if evaluation.cut else ""
        print(f"mean return of {arguments.episodes} episodes{cut}: {evaluation.mean:.4g}")
    return 0


def _learnt_from_frames(arguments: argparse.Namespace) -> Run:
    """Learn from what a camera saw."""
    from ..frames import learn_from_frames

    found = arguments.log or [None]
    if len(found) > 1:
        raise ConfigError("--frames: goes with one log")
    run = learn_from_frames(
        arguments.frames,
        found[0],
        column=arguments.frame_column,
        scale_depth=arguments.scale_depth,
        seed=arguments.seed,
        **_chosen(arguments, "header", "roles", "actions", "bins", "steps"),
    )
    if arguments.save_metric:
        eye: Any = run.encoder
        eye.extractor.metric.save(arguments.save_metric)
    return run


def _learnt(env: Any, arguments: argparse.Namespace, run: Run | None = None) -> Run:
    """Learn in an environment."""
    options = ("every", "thresholds", "names", "bins", "hold", "method")
    return learn(
        env,
        arguments.interactions,
        seed=arguments.seed,
        progress=not arguments.quiet,
        run=run,
        **_chosen(arguments, *options),
    )


def _learn_often(arguments: argparse.Namespace) -> int:
    """Learn with several seeds, and print each return as it comes."""
    for name in ("log", "run", "save", "json", "c"):
        if getattr(arguments, name) is not None:
            raise ConfigError(f"--seeds: goes with an environment alone: leave --{name} out")
    returns = []
    for seed in range(arguments.seed, arguments.seed + arguments.seeds):
        arguments.seed = seed
        env = _with_past(_environment(arguments.env, arguments.env_arg), arguments.history)
        run = _learnt(env, arguments)
        if run.interrupted:
            print("rlvc: interrupted: the seeds above are complete", file=sys.stderr)
            return INTERRUPTED
        if arguments.compact:
            run.compact()
        evaluation = run.evaluate(env, max(1, arguments.episodes), seed=seed)
        returns.append(evaluation.mean)
        print(f"seed {seed}: return {evaluation}; {_counted(run)}", flush=True)
    print(f"{len(returns)} seeds: median return {np.median(returns):.4g}, least {min(returns):.4g}")
    return 0


def _summary(count: int, interactions: int, one: str = "class", many: str = "classes") -> str:
    """The number of classes or leaves, and of interactions."""
    return f"{count} {one if count == 1 else many} after {interactions} interactions"


def _counted(run: Run) -> str:
    words = ("class", "classes") if isinstance(run.acting, Agent) else ("leaf", "leaves")
    return _summary(run.leaves, run.interactions, *words)


def _keep(run: Run, env: Any, arguments: argparse.Namespace) -> None:
    """Write the result: files first, as the reader of the text may close the output."""
    if arguments.save:
        run.save(arguments.save)
    if arguments.json:
        from .. import report

        _write(arguments.json, json.dumps(report.make(run, env), indent=1) + "\n")
    if arguments.c:
        _write(arguments.c, run.export_c())
    print(run.text(), end="")
    print(_counted(run))


def show_command(arguments: argparse.Namespace) -> int:
    """Print the tree of what was saved."""
    file = arguments.file
    if is_run(file):
        run = load(file)
        print(run.text(), end="")
        print(_counted(run))
    elif is_policy(file):
        policy, names = read_policy(file)
        print(explain(policy.print("text"), names), end="")
    else:
        names = read_file(file)[2]
        agent = Agent.load(file)
        print(explain(agent.print("text"), names), end="")
        print(_summary(agent.classes, agent.statistics.interactions))
    return 0


def evaluate_command(arguments: argparse.Namespace) -> int:
    """Play episodes with a saved run."""
    env = _with_past(_environment(arguments.env, arguments.env_arg), arguments.history)
    evaluation = load(arguments.file).evaluate(env, arguments.episodes, arguments.seed)
    print(f"return {evaluation}, {evaluation.lengths.mean():.4g} decisions an episode")
    return 0


def _observation(text: str, source: Any) -> Any:
    """What was typed: the file of a picture if the run has an eye, else JSON."""
    encoder = getattr(source, "encoder", None)
    if encoder is not None and not isinstance(encoder, Encoder):
        from .. import objects

        return objects.read(text)
    try:
        return json.loads(text)
    except ValueError as error:
        raise ConfigError(f"observation: {text!r:.80} is not JSON: {error}") from None


def explain_command(arguments: argparse.Namespace) -> int:
    """Print the path of an observation."""
    run = load(arguments.file)
    print(run.explain(_observation(arguments.observation, run)))
    return 0


def importances_command(arguments: argparse.Namespace) -> int:
    """Print what matters to a policy."""
    for name, share in load(arguments.file).importances().items():
        print(f"{share:7.3f}  {name}")
    return 0


def export_command(arguments: argparse.Namespace) -> int:
    """Write what was saved as C."""
    file = arguments.file
    if is_run(file):
        text = load(file).export_c(name=arguments.name)
    else:
        saved = PlannedPolicy.load(file) if is_policy(file) else Agent.load(file)
        text = saved.export_c(arguments.name)
    _write(arguments.c, text)
    return 0


def _drawn(arguments: argparse.Namespace, source: Any) -> dict[str, Any]:
    """What a figure is asked for beside the run."""
    given = {name: getattr(arguments, name) for name in ("components", "observation", "env")}
    chosen = {name: value for name, value in given.items() if value is not None}
    takes = {"regions": ("components", "observation"), "path": ("observation",), "grid": ("env",)}
    for name in chosen:
        if name not in takes.get(arguments.kind, ()):
            raise ConfigError(f"--{name}: {arguments.kind} does not take it")
    if "observation" in chosen:
        chosen["observation"] = _observation(chosen["observation"], source)
    if "env" in chosen:
        chosen["env"] = _environment(chosen["env"], arguments.env_arg)
    return chosen


def plot_command(arguments: argparse.Namespace) -> int:
    """Draw a run or a report."""
    from .. import plot

    try:
        source = load(arguments.run) if is_run(arguments.run) else arguments.run
        plot.KINDS[arguments.kind](source, arguments.file, **_drawn(arguments, source))
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        if isinstance(error, Error):
            raise
        raise RunError(f"{arguments.run}: damaged: {error!r:.200}") from error
    return 0


def log_command(arguments: argparse.Namespace) -> int:
    """Show how logs are understood."""
    options = {name: getattr(arguments, name) for name in _LOG_OPTIONS}
    found = arguments.log[0] if len(arguments.log) == 1 else arguments.log
    print(logs.described(found, **options), end="")
    return 0


def convert_command(arguments: argparse.Namespace) -> int:
    """Write a log as NPZ."""
    if not arguments.to.endswith(".npz"):  # as it may be another log
        raise ConfigError(f"{named(arguments.to)}: is written, so that its name has to end in .npz")
    files.check_place(arguments.to)
    log = logs.read(arguments.log, **{name: getattr(arguments, name) for name in _LOG_OPTIONS})
    if log.record_bytes:
        raise ConfigError(
            f"{arguments.log}: has percepts, not observations: read it with its domain"
        )
    arrays: dict[str, Any] = {
        "actions": log.known.of_many(log.actions),
        "rewards": log.rewards,
        "terminated": log.ends == 1,
        "truncated": log.ends == 2,
    }
    for name, side in (("", log.before), ("next_", log.after)):
        if isinstance(side, dict):
            arrays |= {f"{name}obs_{key}": np.asarray(v, _plain(v)) for key, v in side.items()}
        else:
            arrays[f"{name}observations"] = np.asarray(side)
    content = io.BytesIO()
    np.savez(content, allow_pickle=False, **arrays)
    files.replace(arguments.to, content.getvalue())
    print(log.describe(), end="")
    return 0


def _plain(values: Any) -> Any:
    """The dtype to keep a column in: words as text."""
    return str if values.dtype == object else values.dtype


def fleet_command(arguments: argparse.Namespace) -> int:
    """Learn from the logs of many machines."""
    if arguments.verb == "learn":
        _check_written(arguments, arguments.source)
    run = fleet.run(arguments)
    if run is not None:
        _keep(run, None, arguments)
    return 0


def bench_command(_: argparse.Namespace) -> int:
    """Time the package."""
    from .. import bench

    bench.main()
    return 0


COMMANDS = {
    "learn": learn_command,
    "show": show_command,
    "evaluate": evaluate_command,
    "explain": explain_command,
    "importances": importances_command,
    "export": export_command,
    "plot": plot_command,
    "log": log_command,
    "convert": convert_command,
    "fleet": fleet_command,
    "bench": bench_command,
}
