# SPDX-License-Identifier: MIT
"""Learning by counts: the driver, which makes passes over the log and refines the tree."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import numpy.typing as npt

from ..agent.agent import Agent
from ..counts import rounds
from ..counts.part import Part, Question
from ..errors import CountError, LogError
from ..learning.actions import Actions
from ..learning.run import Record
from . import checkpoint as checkpoints
from .counting import Counting, Seen
from .engines import Engine, InProcess
from .run import Bar, FleetRun, Report
from .sources import Piece, Source

_SAMPLE_PAYS = 8  # times as many interactions in all


class Driver:
    """Makes passes, and keeps the checkpoint."""

    def __init__(
        self, agent: Agent, source: Source, engine: Engine, counting: Counting, bar: Bar
    ) -> None:
        self.agent, self.progress, self.rows = agent, rounds.Progress(), 0
        self.seen = Seen()
        self._source, self._engine, self._counting, self._bar = source, engine, counting, bar
        self._saved: checkpoints.State | None = None
        self._file: str | Path | None = None
        self._made_from = ""

    def resume(self, file: str | Path) -> None:
        """Go on from a checkpoint, if there is one, and keep one from now on."""
        self._file = file
        self._made_from = checkpoints.fingerprint(
            self._source, self._counting.rounding, self._counting.skip, self.agent.config
        )
        self._saved = checkpoints.load(file, self._made_from, self._question)
        if self._saved:
            domain, config = self.agent.domain, self.agent.config
            self.agent = Agent.restore(domain, config, self._saved.snapshot)
            self.progress = self._saved.progress
            self.seen = self._saved.seen

    def count(self, cell: tuple[int, ...]) -> Part:
        """Make a pass, unless the checkpoint has its result."""
        saved, self._saved = self._saved, None
        if saved and cell == saved.cell:
            self.progress.passes -= 1  # counted when it was made
            return saved.part
        kept = self.seen.sample
        self._bar.begin(
            self.progress.passes + 1,
            rounds=self.progress.rounds,
            classes=self.agent.classes,
            rows=self.rows,
        )
        question = self._question(cell)
        keep = 0 if kept is not None else self._counting.keep  # the first pass has seen all
        counting = dataclasses.replace(self._counting, question=question, keep=keep)
        part: Part
        part, self.seen = self._engine.total(counting, self._source.pieces, self._bar.note)
        self.seen.sample = kept or self.seen.sample
        if part.interactions == 0:
            raise LogError("the source holds no interaction")
        return part

    def _question(self, cell: tuple[int, ...]) -> Question:
        return rounds.question_of(self.agent, cell, bool(self._counting.rounding))

    def passed(self, part: Part, cell: tuple[int, ...]) -> None:
        """Save a checkpoint after a pass."""
        self.rows = len(part.row)
        if self._file:
            state = checkpoints.State(cell, part, self.agent.snapshot(), self.progress, self.seen)
            checkpoints.save(self._file, self._made_from, state)

    def saved_cell(self) -> set[int]:
        """The features that the checkpoint's counts tell apart."""
        return set(self._saved.cell) if self._saved else set()

    def learn(self, tested: set[int]) -> None:
        """Learn to the end."""
        rounds.learn(self.agent, self.count, self.progress, tested | self.saved_cell(), self.passed)


def _single(piece: Piece) -> list[Piece]:
    """Return the row groups of a piece, each by itself; or the piece, if it has none."""
    if piece.kind != "groups":
        return [piece]
    rows = piece.rows // max(1, len(piece.groups))
    return [dataclasses.replace(piece, groups=(group,), rows=rows) for group in piece.groups]


def _some(source: Source, sample: int) -> Source:
    """Return some row groups of a source, evenly apart, that hold about so many interactions."""
    single = [some for piece in source.pieces for some in _single(piece)]
    wanted = max(1, round(len(single) * sample / source.rows)) if single else 0
    step = max(1, len(single) // max(1, wanted))
    return dataclasses.replace(source, pieces=tuple(single[::step][:wanted]))


def _guess(agent: Agent, source: Source, counting: Counting, sample: int) -> set[int]:
    """Return the features that a tree of a sample tests: the first pass' guess of what is needed."""
    if source.rows < _SAMPLE_PAYS * sample or sample == 0:
        return set()
    some = _some(source, sample)
    if not some.pieces:
        return set()
    trial = Driver(
        Agent(agent.domain, agent.config),
        some,
        InProcess(),
        dataclasses.replace(counting, keep=0),
        Bar(False, 0),
    )
    try:
        trial.learn(set())
    except CountError:  # it will come again, if it is one
        return set()
    return rounds.tested_by(trial.agent)


def learn(
    agent: Agent,
    source: Source,
    counting: Counting,
    sample: int,
    checkpoint: str | Path | None,
    engine: Engine,
    bar: Bar,
) -> FleetRun:
    """Learn by counts, to the end.

    Parameters
    ----------
    agent : Agent
    source : Source
    counting : Counting
    sample : int
        Interactions that the first pass' features are guessed from; 0: none.
    checkpoint : str, Path or None
    engine : Engine
    bar : Bar
    """
    driver = Driver(agent, source, engine, counting, bar)
    if checkpoint is not None:
        driver.resume(checkpoint)
    guess = set() if driver.saved_cell() else _guess(agent, source, counting, sample)
    driver.learn(guess)
    return _run_of(driver, source)


def _nothing(agent: Agent) -> npt.NDArray[np.uint8]:
    return np.zeros((0, *agent.domain.percept_shape), np.uint8)


def _run_of(driver: Driver, source: Source) -> FleetRun:
    """Make the run of a driver that has come to the end."""
    known = source.known or Actions(driver.agent.config.actions)
    run = FleetRun(driver.agent, source.encoder, driver.agent.config.seed, known)
    progress, seen = driver.progress, driver.seen
    run.sample = driver.seen.sample.percepts if driver.seen.sample else _nothing(driver.agent)
    run.report = Report(
        progress.passes,
        progress.rounds,
        seen.rows,
        seen.bytes,
        driver.rows,
        seen.lost,
        seen.skipped,
    )
    classes = driver.agent.classes
    run.history.append(Record(1, seen.rows, classes, progress.splits, 0, float("nan")))
    return run
