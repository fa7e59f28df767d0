# SPDX-License-Identifier: MIT
"""Learning from logs: arrays, NPZ, CSV and Minari data sets.

A log is a list of episodes of T interactions. In arrays, the observations of all episodes follow one
another, T + 1 of each: the last one is what the last interaction led to. Everything else has T
elements an episode. An episode's end is where ``terminated`` or ``truncated`` is true; a log that stops
in the middle of an episode is taken as truncated there.
"""

from __future__ import annotations

import csv
import dataclasses
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from .agent import Agent
from .domain import Bits, Domain
from .encode import Encoder, Numbers, needs_samples
from .errors import ConfigError, LogError, PerceptError
from .learning import Record, Run, default_config, domain_of
from .results import CHOICE

_FIELDS = ("observations", "actions", "rewards", "terminated")
_OPTIONAL = ("truncated", "exploited")
_SAMPLES = 1000  # observations from which a Box gets its thresholds


@dataclasses.dataclass
class Log:
    """Interactions, one after another.

    Attributes
    ----------
    before, after : ndarray, [n, ...], or list of observations
        s and s'.
    actions : ndarray of int, [n]
        From 0 on.
    rewards : ndarray of float32, [n]
    ends : ndarray of uint8, [n]
        0: goes on; 1: terminated; 2: truncated.
    exploited : ndarray of bool, [n], or None
        Whether the action was the greedy one of the policy that acted; None if not known.
    where : str
        The file or the data set, for what is said about damage.
    columns : list of str
        What the numbers of an observation are called, as far as that is known.
    """

    before: Any
    after: Any
    actions: npt.NDArray[np.int64]
    rewards: npt.NDArray[np.float32]
    ends: npt.NDArray[np.uint8]
    exploited: npt.NDArray[np.bool_] | None
    where: str
    columns: list[str] = dataclasses.field(default_factory=list)

    def __len__(self) -> int:
        """Give the number of interactions."""
        return len(self.actions)


def _column(
    arrays: dict[str, Any], name: str, count: int, where: str, kind: str
) -> npt.NDArray[Any]:
    values = np.asarray(arrays[name])
    if values.ndim == 2 and values.shape[1] == 1:
        values = values[:, 0]
    if values.shape != (count,):
        raise LogError(f"{where}: {name}: {list(values.shape)}, not [{count}]")
    if values.dtype.kind not in kind:
        raise LogError(f"{where}: {name}: {values.dtype}, which is not of the kind that is wanted")
    return values


def _check_values(log: Log) -> Log:
    bad = np.flatnonzero(~np.isfinite(log.rewards))
    if len(bad):
        raise LogError(
            f"{log.where}: rewards: index {bad[0]}: {log.rewards[bad[0]]} is no finite number"
        )
    bad = np.flatnonzero((log.actions < 0) | (log.actions > 254))
    if len(bad):
        raise LogError(
            f"{log.where}: actions: index {bad[0]}: {log.actions[bad[0]]} is not in [0, 254]"
        )
    return log


def from_arrays(arrays: dict[str, Any], where: str = "log") -> Log:
    """Make a log of arrays.

    Parameters
    ----------
    arrays : dict
        ``observations`` [sum(T + 1), ...], ``actions`` [sum(T)], ``rewards``, ``terminated``, and if
        they are known ``truncated`` and ``exploited``. Or ``next_observations`` beside observations
        [sum(T), ...].
    where : str
        What to call it in errors.

    Returns
    -------
    Log

    Raises
    ------
    LogError
        A part is missing, or of the wrong shape or kind; the text says where.
    """
    for name in _FIELDS:
        if name not in arrays:
            raise LogError(
                f"{where}: {name}: missing (there are: {', '.join(sorted(arrays)) or 'none'})"
            )
    known = {*_FIELDS, *_OPTIONAL, "next_observations"}
    unknown = sorted(set(arrays) - known)
    if unknown:
        raise LogError(f"{where}: {unknown[0]}: not known; a log has {', '.join(sorted(known))}")
    count = np.size(arrays["actions"])
    if count == 0:
        raise LogError(f"{where}: actions: no interaction in it")
    actions = _column(arrays, "actions", count, where, "iu").astype(np.int64)
    rewards = _column(arrays, "rewards", count, where, "fiu").astype(np.float32)
    terminated = _column(arrays, "terminated", count, where, "biu").astype(np.bool_)
    truncated = np.zeros(count, np.bool_)
    if "truncated" in arrays:
        truncated = _column(arrays, "truncated", count, where, "biu").astype(np.bool_)
    exploited = None
    if "exploited" in arrays:
        exploited = _column(arrays, "exploited", count, where, "biu").astype(np.bool_)
    ends = np.where(terminated, 1, np.where(truncated, 2, 0)).astype(np.uint8)
    observations = np.asarray(arrays["observations"])
    if "next_observations" in arrays:
        before, after = observations, np.asarray(arrays["next_observations"])
        for name, values in (("observations", before), ("next_observations", after)):
            if len(values) != count:
                raise LogError(f"{where}: {name}: {len(values)} of them for {count} actions")
    else:
        before, after = _split_episodes(observations, ends, where)
    return _check_values(Log(before, after, actions, rewards, ends, exploited, where))


def _split_episodes(
    observations: npt.NDArray[Any], ends: npt.NDArray[np.uint8], where: str
) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
    """S and s' of each interaction, where each episode has an observation more than actions."""
    if ends[-1] == 0:
        ends[-1] = 2
    starts = np.concatenate(([0], ends[:-1] != 0))
    index = np.arange(len(ends)) + np.cumsum(starts)
    wanted = int(index[-1]) + 2
    if len(observations) != wanted:
        raise LogError(
            f"{where}: observations: {len(observations)} of them; {len(ends)} actions in "
            f"{int(starts.sum()) + 1} episodes need {wanted}"
        )
    return observations[index], observations[index + 1]


def from_npz(path: str | Path) -> Log:
    """Read a log from an NPZ file with the arrays that :func:`from_arrays` describes.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    Log

    Raises
    ------
    LogError
        It cannot be read, or is damaged.
    """
    import zipfile
    import zlib

    try:
        with open(path, "rb") as file, np.load(file, allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
    except (OSError, ValueError, EOFError, zipfile.BadZipFile, zlib.error, AttributeError) as error:
        raise LogError(f"{path}: cannot be read as NPZ: {error}") from error
    return from_arrays(arrays, str(path))


def from_csv(path: str | Path, columns: Sequence[str] | None = None) -> Log:
    """Read a log from a CSV file whose first line names the columns.

    Parameters
    ----------
    path : str or Path
        With the columns ``action``, ``reward``, ``terminated``, perhaps ``truncated``, ``exploited`` and
        ``episode``, and others, which are the observation: what was seen before the action. What an
        interaction led to is the observation of the next line. A line without an action only says
        what was seen at the end of an episode. An interaction that is not terminated and of which
        the file does not say what it led to is left out.
    columns : sequence of str or None
        Those of the observation. None: all that have no other meaning, in the order of the file.

    Returns
    -------
    Log

    Raises
    ------
    LogError
        It cannot be read, or a line is damaged; the text says which, and what is wrong.
    """
    try:
        with open(path, newline="", encoding="utf-8") as file:
            reader = csv.reader(file, strict=True)
            head = next(reader, [])
            rows = [(reader.line_num, row) for row in reader if row]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise LogError(f"{path}: cannot be read as CSV: {error}") from error
    special = ("action", "reward", "terminated", "truncated", "exploited", "episode")
    for name in (*special[:3], *(columns or ())):
        if name not in head:
            raise LogError(
                f"{path}: line 1: no column {name} (there are: {', '.join(head) or 'none'})"
            )
    if len(set(head)) != len(head):
        raise LogError(f"{path}: line 1: a column is named twice")
    seen = list(columns) if columns else [name for name in head if name not in special]
    if not seen:
        raise LogError(f"{path}: line 1: no column of the observation")
    table = {name: np.empty(len(rows)) for name in head}
    for i, (line, row) in enumerate(rows):
        if len(row) != len(head):
            raise LogError(f"{path}: line {line}: {len(row)} fields, not {len(head)}")
        for name, text in zip(head, row, strict=True):
            table[name][i] = _number(text, name, f"{path}: line {line}")
    return _from_table(table, seen, [line for line, _ in rows], str(path))


_WORDS = {"true": 1.0, "false": 0.0, "": float("nan")}


def _number(text: str, name: str, where: str) -> float:
    word = text.strip().lower()
    if word in _WORDS:
        return _WORDS[word]
    try:
        return float(word)
    except ValueError:
        raise LogError(f"{where}: {name}: {text!r:.40} is no number") from None


def _flags(table: dict[str, npt.NDArray[Any]], name: str, lines: list[int], where: str) -> Any:
    values = table.get(name, np.zeros(len(lines)))
    for i in np.flatnonzero(~np.isin(values, (0.0, 1.0)) & ~np.isnan(values)):
        raise LogError(f"{where}: line {lines[i]}: {name}: {values[i]} is neither 0 nor 1")
    return values == 1


def _need(
    wanted: npt.NDArray[np.bool_],
    table: dict[str, npt.NDArray[Any]],
    name: str,
    kind: str,
    lines: list[int],
    where: str,
) -> None:
    """Refuse a table whose column has no number of that kind where one is wanted."""
    values = table[name]
    good = np.isfinite(values) & ((values % 1 == 0) if kind == "whole" else True)
    for i in np.flatnonzero(wanted & ~good):
        raise LogError(f"{where}: line {lines[i]}: {name}: {values[i]} is no {kind} number")


def _from_table(
    table: dict[str, npt.NDArray[Any]], seen: list[str], lines: list[int], where: str
) -> Log:
    count = len(lines)
    everywhere = np.ones(count, np.bool_)
    for name in seen:
        _need(everywhere, table, name, "finite", lines, where)
    terminated = _flags(table, "terminated", lines, where)
    truncated = _flags(table, "truncated", lines, where)
    exploited = _flags(table, "exploited", lines, where)
    acted = ~np.isnan(table["action"])
    for i in np.flatnonzero(terminated & ~acted):
        raise LogError(f"{where}: line {lines[i]}: terminated without an action")
    episode = table.get("episode", np.zeros(count))
    # What an interaction led to stands in the next line, if that is of the same episode.
    same = np.append(episode[1:] == episode[:-1], False)
    last_seen = np.append(~acted[1:], False) & same
    kept = acted & (terminated | last_seen | (same & ~truncated))
    _need(kept, table, "action", "whole", lines, where)
    _need(kept, table, "reward", "finite", lines, where)
    rows = np.flatnonzero(kept)
    if len(rows) == 0:
        raise LogError(f"{where}: no interaction in it")
    ends = np.where(terminated, 1, np.where(truncated | last_seen, 2, 0)).astype(np.uint8)
    observations = np.stack([table[name] for name in seen], axis=1)
    following = np.minimum(rows + 1, count - 1)  # not looked at where terminated
    return _check_values(
        Log(
            observations[rows],
            observations[following],
            table["action"][rows].astype(np.int64),
            table["reward"][rows].astype(np.float32),
            ends[rows],
            exploited[rows] if "exploited" in table else None,
            where,
            seen,
        )
    )


def from_minari(dataset: Any) -> Log:
    """Make a log of a Minari data set.

    Parameters
    ----------
    dataset : minari.MinariDataset or str
        A name is loaded from where Minari keeps its data sets. If the episodes' infos have an
        ``exploited``, it is used.

    Returns
    -------
    Log

    Raises
    ------
    LogError
        It cannot be read, or an episode is damaged; the text says which.
    """
    if isinstance(dataset, str):
        try:
            import minari
        except ImportError:
            raise ImportError("Minari data sets need Minari: pip install 'rlvc[logs]'") from None
        try:
            dataset = minari.load_dataset(dataset)
        except (OSError, ValueError, KeyError) as error:
            raise LogError(f"{dataset}: cannot be loaded: {error}") from error
    name = str(dataset.spec.dataset_id)
    parts: dict[str, list[Any]] = {key: [] for key in ("before", "after", "a", "r", "e", "x")}
    for episode in dataset.iterate_episodes():
        where = f"{name}: episode {episode.id}"
        count = len(episode.actions)
        seen = _observations(episode.observations)
        if len(seen) != count + 1:
            raise LogError(f"{where}: {len(seen)} observations for {count} actions")
        if count == 0:
            continue
        ends = np.where(episode.terminations, 1, np.where(episode.truncations, 2, 0)).astype(
            np.uint8
        )
        if ends[-1] == 0:
            ends[-1] = 2
        early = np.flatnonzero(ends[:-1])
        if len(early):
            raise LogError(f"{where}: index {early[0]}: ends before its last interaction")
        parts["before"] += seen[:-1]
        parts["after"] += seen[1:]
        parts["a"].append(np.asarray(episode.actions))
        parts["r"].append(np.asarray(episode.rewards, np.float32))
        parts["e"].append(ends)
        infos = episode.infos or {}
        if "exploited" in infos:
            parts["x"].append(np.asarray(infos["exploited"], np.bool_)[-count:])
    if not parts["a"]:
        raise LogError(f"{name}: no interaction in it")
    actions = np.concatenate(parts["a"])
    if actions.dtype.kind not in "iu" or actions.ndim != 1:
        raise LogError(
            f"{name}: actions: {actions.dtype}{list(actions.shape)}: not of a finite set"
        )
    rewards, ends = np.concatenate(parts["r"]), np.concatenate(parts["e"])
    exploited = np.concatenate(parts["x"]) if parts["x"] else None
    if exploited is not None and len(exploited) != len(actions):
        raise LogError(
            f"{name}: infos: exploited: {len(exploited)} of them for {len(actions)} actions"
        )
    start = int(getattr(dataset.spec.action_space, "start", 0))
    actions = actions.astype(np.int64) - start
    return _check_values(
        Log(parts["before"], parts["after"], actions, rewards, ends, exploited, name)
    )


def _observations(observations: Any) -> list[Any]:
    if isinstance(observations, dict):
        parts = {key: _observations(value) for key, value in observations.items()}
        count = len(next(iter(parts.values())))
        return [{key: value[i] for key, value in parts.items()} for i in range(count)]
    if isinstance(observations, tuple):
        return list(zip(*(_observations(value) for value in observations), strict=True))
    return list(observations)


def read(log: Any, columns: Sequence[str] | None = None) -> Log:
    """Read a log of any kind.

    Parameters
    ----------
    log : dict of arrays, path of an NPZ or CSV file, Minari data set or its name, or Log
    columns : sequence of str or None
        Of a CSV's observation.

    Returns
    -------
    Log

    Raises
    ------
    LogError
        It is damaged; the text says where.
    """
    if isinstance(log, Log):
        return log
    if isinstance(log, dict):
        return from_arrays(log)
    if isinstance(log, str | Path):
        suffix = Path(log).suffix.lower()
        if suffix == ".npz":
            return from_npz(log)
        if suffix == ".csv":
            return from_csv(log, columns)
        if isinstance(log, Path) or Path(log).exists():
            raise LogError(f"{log}: neither .npz nor .csv")
    return from_minari(log)


def _space_of(log: Log) -> Numbers:
    values = np.asarray(log.before)
    if values.dtype.kind not in "fiu":
        raise LogError(f"{log.where}: observations: {values.dtype}: give the space they are of")
    return Numbers(values.shape[1:])


def _in_words(name: str, columns: list[str]) -> str:
    """Call ``x[i]``, or ``x`` if there is but one, by its column's name."""
    return re.sub(r"^x(?:\[(\d+)\])?", lambda match: columns[int(match[1] or 0)], name)


def _encoded(
    log: Log, encoder: Encoder | None, space: Any, thresholds: int
) -> tuple[Domain, Encoder | None, npt.NDArray[Any], npt.NDArray[Any]]:
    """The domain of the percepts, the encoder, and the percepts before and after."""
    values = None if isinstance(log.before, list) else np.asarray(log.before)
    if encoder is None and space is None and values is not None and values.dtype == np.bool_:
        if values.ndim != 2:
            raise LogError(
                f"{log.where}: observations: bool{list(values.shape)}, not bool[n, bits]"
            )
        pack = [np.packbits(v, axis=1, bitorder="little") for v in (values, np.asarray(log.after))]
        return Bits(values.shape[1]), None, pack[0], pack[1]
    if encoder is None:
        chosen = space if space is not None else _space_of(log)
        samples: list[Any] = []
        if needs_samples(chosen):
            step = max(1, len(log) // _SAMPLES)
            samples = [log.before[i] for i in range(0, len(log), step)]
        encoder = Encoder(chosen, samples, thresholds)
        if log.columns:
            encoder.names = [_in_words(name, log.columns) for name in encoder.names]
    sides = []
    for side, name in ((log.before, "observations"), (log.after, "next observations")):
        records = []
        for i in range(len(log)):
            try:
                records.append(encoder.encode(side[i]))
            except PerceptError as error:
                raise LogError(f"{log.where}: {name}: index {i}: {error}") from error
        sides.append(np.frombuffer(b"".join(records), np.uint8).reshape(len(log), -1))
    return domain_of(encoder), encoder, sides[0], sides[1]


def learn_from(
    log: Any,
    *,
    columns: Sequence[str] | None = None,
    actions: int | None = None,
    space: Any = None,
    encoder: Encoder | None = None,
    thresholds: int = 15,
    steps: int = 1,
    **config: Any,
) -> Run:
    """Learn from a log, without an environment.

    Parameters
    ----------
    log : dict of arrays, path of an NPZ or CSV file, Minari data set or its name
        :mod:`rlvc.logs` says what is in each.
    columns : sequence of str or None
        Of a CSV's observation.
    actions : int or None
        How many there are. None: one more than the highest in the log.
    space : gymnasium.Space or None
        Of the observations. None: bits if they are bool, else numbers, which get thresholds.
    encoder : object or None
        As for :func:`rlvc.learn`.
    thresholds : int
        For each number of an observation, at most.
    steps : int
        Learning steps. Under the residual criterion one finds all; under that of returns, step k
        looks k interactions ahead, each at the whole log.
    **config
        Fields of :class:`~rlvc.Config`. The criterion is ``residual`` unless one is given;
        that of returns needs a log that says what was exploited.

    Returns
    -------
    Run

    Raises
    ------
    LogError
        The log is damaged; the text says in which file, where, and what is wrong.
    ConfigError
        A field is out of range, or the criterion needs what the log has not.
    """
    read_log = read(log, columns)
    if config.get("criterion") == "returns" and read_log.exploited is None:
        raise ConfigError("criterion: returns need a log that says what was exploited")
    if steps < 1:
        raise ConfigError("steps: at least 1")
    highest = int(read_log.actions.max())
    count = highest + 1 if actions is None else actions
    if highest >= count:
        index = int(np.argmax(read_log.actions >= count))
        raise LogError(
            f"{read_log.where}: actions: index {index}: {read_log.actions[index]} is not in [0, {count})"
        )
    domain, encoder, before, after = _encoded(read_log, encoder, space, thresholds)
    settings = default_config(count, len(read_log), int(config.get("seed", 1)), config)
    run = Run(Agent(domain, settings), encoder, settings.seed)
    choices = np.zeros(len(read_log), CHOICE)
    choices["action"] = read_log.actions
    if read_log.exploited is not None:
        choices["exploited"] = read_log.exploited
    for k in range(steps):
        if k == 0 or settings.criterion == "returns":
            run.agent.observe_many(before, choices, read_log.rewards, after, read_log.ends)
        splits = run.agent.learn().splits
        classes = run.agent.classes
        run.history.append(Record(k + 1, len(read_log), classes, splits, 0, float("nan")))
    return run
