# SPDX-License-Identifier: MIT
"""The driver: learns from the logs of a fleet, pass by pass."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..agent.agent import Agent
from ..agent.results import CHOICE
from ..checks import flag, real, whole
from ..counts import rounds
from ..counts.part import Part, Question
from ..counts.table import MEMORY
from ..domains.bits import Bits
from ..domains.domain import Domain
from ..errors import ConfigError, CountError, LogError
from ..learning.actions import Actions
from ..learning.learn import default_config
from ..learning.run import Record, Run
from . import checkpoint as checkpoints
from .counting import Counting, Rounding, Seen
from .engines import Engine, InProcess, engine_of
from .sources import Piece, Source, opened

SAMPLE = 1 << 20  # interactions of which the first pass' features are guessed
_SAMPLE_PAYS = 8  # times as many interactions in all
_SAMPLE_MOST = 1 << 14  # percepts, which compact() looks at by default
_CAPACITY = 2000  # a controller's, to which the snapshot goes


@dataclasses.dataclass(frozen=True)
class Report:
    """How a fleet's run came about.

    Attributes
    ----------
    passes, rounds : int
        Passes over the data, and rounds of the tree.
    interactions, bytes : int
        Of a pass.
    rows : int
        Of the last table of counts.
    lost : int
        Interactions of a pass that were left out, as what came next is not in a LeRobot data set: the
        last of episodes that are cut short.
    skipped : list of str
        Row groups that were left out, and why; empty unless that was asked for.
    """

    passes: int
    rounds: int
    interactions: int
    bytes: int
    rows: int
    lost: int
    skipped: list[str]


class FleetRun(Run):
    """A run of :func:`learn_from`.

    Attributes
    ----------
    report : Report
    sample : ndarray of uint8, [n, bytes]
        Distinct percepts, at most as many as the agent holds: what :meth:`compact` looks at.
    """

    report: Report
    sample: npt.NDArray[np.uint8]

    def _seeing(self) -> Agent:
        """A copy of the agent that holds the sample, as interactions that end at once."""
        agent = Agent.restore(self.agent.domain, self.agent.config, self.agent.snapshot())
        count = len(self.sample)
        agent.observe_many(
            self.sample,
            np.zeros(count, CHOICE),
            np.zeros(count, np.float32),
            self.sample,
            np.full(count, _native.TERMINATED, np.uint8),
        )
        return agent

    @property
    def interactions(self) -> int:
        """Number that was learnt from."""
        return self.report.interactions


class _Bar:
    """A progress bar over the pieces of a pass; nothing if none is wanted."""

    def __init__(self, wanted: bool, total: int) -> None:
        self._bar: Any = None
        if wanted:
            try:
                from tqdm import tqdm
            except ImportError:
                raise ImportError("a progress bar needs tqdm: pip install 'rlvc[fleet]'") from None
            self._bar = tqdm(total=total or None, unit=" interactions", unit_scale=True)

    def begin(self, driver: _Driver) -> None:
        if self._bar is not None:
            progress = driver.progress
            self._bar.reset()
            self._bar.set_description(f"pass {progress.passes + 1}")
            self._bar.set_postfix(
                rounds=progress.rounds, classes=driver.agent.classes, rows=driver.rows
            )

    def note(self, rows: int) -> None:
        if self._bar is not None:
            self._bar.update(rows)

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()


class _Driver:
    """Makes passes, and keeps the checkpoint."""

    def __init__(
        self, agent: Agent, source: Source, engine: Engine, counting: Counting, bar: _Bar
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
        self._bar.begin(self)
        question = self._question(cell)
        keep = 0 if kept is not None else self._counting.keep  # the first pass has seen all
        counting = dataclasses.replace(self._counting, question=question, keep=keep)
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
    trial = _Driver(
        Agent(agent.domain, agent.config),
        some,
        InProcess(),
        dataclasses.replace(counting, keep=0),
        _Bar(False, 0),
    )
    try:
        trial.learn(set())
    except CountError:  # it will come again, if it is one
        return set()
    return rounds.tested_by(trial.agent)


def _domain_of(domain: Domain | int | None, source: Source) -> Domain:
    if domain is None:
        return Bits(source.bits)
    made = Bits(domain) if isinstance(domain, int) else domain
    if isinstance(made, Bits) and -(-made.bits // 8) != -(-source.bits // 8):
        raise ConfigError(f"domain: {made.bits} bits, but the log's percepts have {source.bits}")
    return made


def _rounding(bits: int | None, grid: float | None) -> Rounding:
    if bits is not None and grid is not None:
        raise ConfigError("reward_bits and reward_grid: give one of them")
    if bits is not None:
        bits = whole("reward_bits", bits, 0, 22)
    if grid is not None:
        grid = real("reward_grid", grid)
        if not 0 < grid <= 1e12:
            raise ConfigError(f"reward_grid: {grid} is not in (0, 1e12]")
    return Rounding(bits, grid)


def learn_from(
    source: Any,
    *,
    cluster: str | None = None,
    workers: int | None = None,
    domain: Domain | int | None = None,
    actions: int | None = None,
    sample: int = SAMPLE,
    reward_bits: int | None = None,
    reward_grid: float | None = None,
    memory: int = MEMORY,
    skip_broken: bool = False,
    progress: bool = False,
    checkpoint: str | Path | None = None,
    **config: Any,
) -> FleetRun:
    """Learn from more interactions than one machine holds.

    The tree is the one that :func:`rlvc.learn_from` would make of them all, bit for bit, however they
    are spread over files and workers.

    Parameters
    ----------
    source : str, Path, minari.MinariDataset or sequence of these
        Files, folders, or addresses such as ``s3://bucket/folder``: Parquet files
        (:mod:`rlvc.fleet.layout`, or RLlib's columns), NPZ, CSV, or the logs of controllers; the folder
        or address of a LeRobot data set; a Minari data set, its name or its folder.
    cluster : str or None
        None: this process. ``"ray"`` or ``"dask"``: a cluster on this machine. ``"ray://..."`` or
        Dask's ``"tcp://..."``: one that runs.
    workers : int or None
        Tasks at a time of a cluster on this machine.
    domain : Domain, int or None
        The percepts; None: as the log says. Bits only.
    actions : int or None
        Number of actions; None: as the log says.
    sample : int
        Interactions that a guess is made from of the features that the tree will test, if there are
        eight times as many. A good guess saves passes and changes nothing else. 0: no guess.
    reward_bits : int or None
        Tell rewards apart by so many bits of their fraction, [0, 22]. Their sums stay exact.
    reward_grid : float or None
        Tell rewards apart on a grid of this width. With the width of ``tolerance`` the values are
        within half of it over (1 - discount).
    memory : int
        Bytes that a table of counts may grow to.
    skip_broken : bool
        Whether to leave out row groups that cannot be read or hold what is out of range; the report
        lists them. False: they are an error.
    progress : bool
        Whether to show a progress bar.
    checkpoint : str, Path or None
        File to save tree and counts to after each pass, and to go on from if it is there.
    **config
        Fields of :class:`rlvc.Config`. Defaults that differ: those of :func:`rlvc.learn_from`, but
        ``capacity`` is 2000, for a controller that loads the result.

    Returns
    -------
    FleetRun

    Raises
    ------
    LogError
        A file is broken. The message names it, the row group and the column.
    ConfigError
        A field is out of range, or what it asks for does not follow from counts.
    CountError
        There are too many distinct rows, or the tree tests too many features.
    """
    rounding = _rounding(reward_bits, reward_grid)
    found = opened(source)
    seed = whole("seed", config.pop("seed", 1), 0, 2**32 - 1)
    actions = whole("actions", actions if actions is not None else found.actions, 1, 255)
    changes = {"capacity": _CAPACITY} | config
    settings = default_config(actions, 1, seed, changes)
    made = _domain_of(domain, found)
    agent = Agent(made, settings)
    rounds.refuse(agent)
    memory = whole("memory", memory, 1, 2**63 - 1)
    counting = Counting(
        rounds.question_of(agent, (), bool(rounding)),
        rounding,
        memory,
        flag("skip_broken", skip_broken),
        min(settings.capacity, _SAMPLE_MOST),
    )
    sample = whole("sample", sample, 0, 2**48)
    engine = engine_of(cluster, workers)
    bar = _Bar(flag("progress", progress), found.rows)
    try:
        driver = _Driver(agent, found, engine, counting, bar)
        if checkpoint is not None:
            driver.resume(checkpoint)
        guess = set() if driver.saved_cell() else _guess(agent, found, counting, sample)
        driver.learn(guess)
    finally:
        bar.close()
        engine.close()
    return _run_of(driver, found, seed)


def _nothing(agent: Agent) -> npt.NDArray[np.uint8]:
    return np.zeros((0, *agent.domain.percept_shape), np.uint8)


def _run_of(driver: _Driver, source: Source, seed: int) -> FleetRun:
    """Make the run of a driver that has come to the end."""
    known = source.known or Actions(driver.agent.config.actions)
    run = FleetRun(driver.agent, source.encoder, seed, known)
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
