# SPDX-License-Identifier: MIT
"""Watching a run while it learns: callbacks for :func:`rlvc.learn`.

Each is called with the run after every learning step. Several may be given, as a list.
"""

from __future__ import annotations

import contextlib
import csv
import dataclasses
import io
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..checks import named, real, shown, whole
from ..errors import ConfigError, StoreError
from ..files import replace
from . import boundary

if TYPE_CHECKING:
    from .evaluation import Evaluation
    from .run import Record, Run


def _name(what: str, path: Any) -> str:
    """Return the name of a file or a folder, which is to be written later."""
    if not isinstance(path, str | Path) or not str(path):
        raise ConfigError(f"{what}: {shown(path)} is not the name of a {what}")
    return str(path)


class _Every:
    """Says when so many interactions have passed since the last time."""

    def __init__(self, every: int) -> None:
        self.every = whole("every", every, 1, 2**53)
        self._last = 0

    def due(self, run: Run) -> bool:
        """Whether it is time."""
        now = run.history[-1].interactions
        if now // self.every <= self._last // self.every:
            return False
        self._last = now
        return True


class EvalCallback(_Every):
    """Plays episodes without exploring now and then: the curve that shows what was learnt.

    Parameters
    ----------
    env : gymnasium.Env or gymnasium.vector.VectorEnv
        Another one than that of learning.
    every : int
        Interactions between two evaluations; at the next learning step.
    episodes : int
    seed : int
        The same starts each time.
    best : str, Path or None
        Where to save the run whenever its mean return is the best so far.
    stop_at : float or None
        Learning ends when the mean return reaches it.

    Attributes
    ----------
    interactions : list of int
    evaluations : list of Evaluation
    """

    def __init__(
        self,
        env: Any,
        every: int = 1000,
        episodes: int = 20,
        seed: int = 0,
        best: str | Path | None = None,
        stop_at: float | None = None,
    ) -> None:
        super().__init__(every)
        boundary.check(env)
        self.env, self.episodes, self.seed = env, episodes, seed
        self.best = None if best is None else _name("file", best)
        self.stop_at = None if stop_at is None else real("stop_at", stop_at)
        self.interactions: list[int] = []
        self.evaluations: list[Evaluation] = []

    def __call__(self, run: Run) -> bool:
        """Evaluate, if it is time; True ends learning."""
        if not self.due(run):
            return False
        evaluation = run.evaluate(self.env, self.episodes, self.seed)
        better = all(evaluation.mean > earlier.mean for earlier in self.evaluations)
        self.interactions.append(run.history[-1].interactions)
        self.evaluations.append(evaluation)
        if better and self.best is not None:
            run.save(self.best)
        return self.stop_at is not None and evaluation.mean >= self.stop_at


class CheckpointCallback(_Every):
    """Saves the run now and then: :func:`rlvc.load` reads it, and learning can go on.

    Parameters
    ----------
    file : str or Path
        ``{}`` in it becomes the number of interactions; without it the file is replaced.
    every : int
        Interactions between two files; at the next learning step.
    """

    def __init__(self, file: str | Path, every: int = 10_000) -> None:
        super().__init__(every)
        self.file = _name("file", file)

    def __call__(self, run: Run) -> None:
        """Save, if it is time."""
        if self.due(run):
            run.save(self.file.replace("{}", str(run.history[-1].interactions)))


class CsvCallback:
    """Writes the history to a CSV file after each learning step.

    Parameters
    ----------
    file : str or Path
    """

    def __init__(self, file: str | Path) -> None:
        self.file = _name("file", file)

    def __call__(self, run: Run) -> None:
        """Write the file anew."""
        write_csv(run.history, self.file)


def write_csv(history: list[Record], file: str | Path) -> None:
    """Write the history of a run as CSV, with a line for each learning step.

    Parameters
    ----------
    history : list of Record
    file : str or Path
    """
    from .run import Record

    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([field.name for field in dataclasses.fields(Record)])
    writer.writerows(dataclasses.astuple(record) for record in history)
    replace(file, text.getvalue().encode())


class TensorBoardCallback:
    """Writes the history for TensorBoard; needs tensorboardX.

    Parameters
    ----------
    folder : str or Path
        TensorBoard's log directory.

    Raises
    ------
    StoreError
        The folder cannot be written; also when called.
    """

    def __init__(self, folder: str | Path) -> None:
        self.folder = _name("folder", folder)
        try:
            from tensorboardX import SummaryWriter
        except ImportError:
            raise ImportError(
                "TensorBoardCallback needs tensorboardX: pip install 'rlvc[watch]'"
            ) from None
        with self._writing():
            self.writer = SummaryWriter(self.folder)

    def __call__(self, run: Run) -> None:
        """Write the newest record."""
        record = run.history[-1]
        with self._writing():
            self.writer.add_scalar("rlvc/classes", record.classes, record.interactions)
            if record.episodes:
                self.writer.add_scalar("rlvc/mean_return", record.mean_return, record.interactions)
            self.writer.flush()

    @contextlib.contextmanager
    def _writing(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            raise StoreError(
                f"{named(self.folder)}: cannot be written: {error.strerror or error}"
            ) from error
