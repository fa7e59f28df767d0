# SPDX-License-Identifier: MIT
"""Learning with many seeds, in several processes: a curve with its spread."""

from __future__ import annotations

import dataclasses
import multiprocessing
import os
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ..checks import listed, shown, told, whole
from ..errors import ConfigError, EnvError
from .callbacks import EvalCallback
from .learn import learn
from .run import Run


@dataclasses.dataclass
class Many:
    """Runs with several seeds.

    Attributes
    ----------
    runs : list of Run
    seeds : list of int
    interactions : ndarray of int64, [points]
        When the policies were evaluated.
    returns : ndarray of float64, [seeds, points]
        The mean return without exploring.
    """

    runs: list[Run]
    seeds: list[int]
    interactions: npt.NDArray[np.int64]
    returns: npt.NDArray[np.float64]

    def plot(self, file: str | Path | None = None, **arguments: Any) -> Any:
        """Draw the median return over interactions, with a band: :func:`rlvc.plot.returns`."""
        from .. import plot

        return plot.returns(self, file, **arguments)

    def __repr__(self) -> str:
        """Describe the runs."""
        last = np.median(self.returns[:, -1])
        return f"<rlvc.Many: {len(self.runs)} runs, median return {last:.4g}>"


def _made(env: Any) -> Any:
    import gymnasium

    if not isinstance(env, str) and not callable(env):
        raise EnvError(
            f"env: {shown(env)}: give its name, or a function that makes one, as each seed has its own"
        )
    try:
        return gymnasium.make(env) if isinstance(env, str) else env()
    except Exception as error:
        raise EnvError(f"env: making one raised {told(error)}") from error


def _one(job: tuple[Any, int, int, int, int, dict[str, Any]]) -> tuple[Run, list[int], list[float]]:
    env, interactions, seed, points, episodes, arguments = job
    watch = EvalCallback(_made(env), max(1, interactions // points), episodes, seed=10_000 + seed)
    run = learn(_made(env), interactions, seed=seed, callback=watch, **arguments)
    if not watch.interactions or watch.interactions[-1] < run.interactions:
        watch.interactions.append(run.interactions)
        watch.evaluations.append(run.evaluate(watch.env, episodes, watch.seed))
    return run, watch.interactions, [evaluation.mean for evaluation in watch.evaluations]


_jobs: list[Any] = []  # of a worker


def _take(jobs: list[Any]) -> None:
    _jobs[:] = jobs


def _nth(index: int) -> Any:
    return _one(_jobs[index])


def learn_many(
    env: str | Callable[[], Any],
    interactions: int,
    *,
    seeds: int | Sequence[int] = 20,
    processes: int | None = None,
    points: int = 20,
    episodes: int = 20,
    **arguments: Any,
) -> Many:
    """Learn with many seeds, and evaluate the policies without exploring as they are learnt.

    Parameters
    ----------
    env : str or callable
        Name of a Gymnasium environment, or a function that makes one; where processes cannot be
        forked, one of a module.
    interactions : int
        Of each run.
    seeds : int or sequence of int
        An int: 1 to that number.
    processes : int or None
        None: as many as there are processors. 1: in this process.
    points : int
        About how often the policies are evaluated.
    episodes : int
        Of each evaluation.
    **arguments
        Of :func:`rlvc.learn`, but for ``seed``, ``callback`` and ``run``.

    Returns
    -------
    Many
    """
    own = [name for name in ("seed", "callback", "run") if name in arguments]
    if own:
        raise ConfigError(f"{own[0]}: learn_many gives each run its own: leave it out")
    chosen = _seeds(seeds)
    processes = None if processes is None else whole("processes", processes, 1, 10**6)
    points, episodes = whole("points", points, 1, 10**6), whole("episodes", episodes, 1, 10**9)
    interactions = whole("interactions", interactions, 1, 2**53)
    jobs = [(env, interactions, seed, points, episodes, arguments) for seed in chosen]
    if processes == 1:
        done = [_one(job) for job in jobs]
    else:
        # By a fork, scripts and notebooks need no main guard, and env may be a lambda.
        forks = "fork" in multiprocessing.get_all_start_methods() and sys.platform == "linux"
        context = multiprocessing.get_context("fork" if forks else "spawn")
        workers = min(processes or os.cpu_count() or 1, len(jobs))  # all begin at once
        try:
            with ProcessPoolExecutor(workers, context, _take, (jobs,)) as pool:
                done = list(pool.map(_nth, range(len(jobs))))
        except RuntimeError as error:  # the pool cannot end what had not begun when Ctrl-C came
            if isinstance(error.__context__, KeyboardInterrupt):
                raise KeyboardInterrupt from None
            raise
    grid = np.unique(np.linspace(0, interactions, points + 1)[1:].astype(np.int64))
    returns = np.array([_on_grid(grid, when, values) for _, when, values in done])
    return Many([run for run, _, _ in done], chosen, grid, returns)


def _seeds(seeds: Any) -> list[int]:
    if isinstance(seeds, int | np.integer):
        return list(range(1, 1 + whole("seeds", seeds, 1, 10**6)))
    found = [whole("seeds", seed, 0, 2**63 - 1) for seed in listed("seeds", seeds, "numbers")]
    if not found:
        raise ConfigError("seeds: give at least one")
    return found


def _on_grid(grid: Any, when: list[int], values: list[float]) -> npt.NDArray[np.float64]:
    """The newest value at each point; before the first one, that."""
    place = np.searchsorted(when, grid, side="right") - 1
    return np.array([values[i] for i in np.maximum(place, 0)])
