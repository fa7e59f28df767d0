# SPDX-License-Identifier: MIT
"""Learning from a log of any kind."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _native
from ..agent.agent import Agent
from ..agent.results import CHOICE
from ..checks import whole
from ..domains.bits import Bits
from ..domains.domain import Domain
from ..errors import ConfigError, LogError, PerceptError
from ..learning.actions import Actions
from ..learning.encode import Encoder, Numbers
from ..learning.learn import default_config, domain_of
from ..learning.run import Record, Run
from .array_log import from_arrays, from_npz
from .controller_log import from_records, is_records
from .csv_log import from_csv
from .log import Log
from .minari_log import from_minari


def read(log: Any, columns: Sequence[str] | None = None) -> Log:
    """Read a log of any kind.

    Parameters
    ----------
    log : dict of arrays, path of a file, Minari data set or its name, or Log
        A file is an NPZ, a CSV or the log of a controller.
    columns : sequence of str or None
        Columns of a CSV that form the observation.
    """
    if isinstance(log, Log):
        return log
    if isinstance(log, dict):
        return from_arrays(log)
    if isinstance(log, str | Path):
        if is_records(log):
            return from_records(log)
        suffix = Path(log).suffix.lower()
        if suffix == ".npz":
            return from_npz(log)
        if suffix == ".csv":
            return from_csv(log, columns)
        if isinstance(log, Path) or Path(log).exists():
            raise LogError(f"{log}: neither .npz nor .csv, nor the log of a controller")
    if isinstance(log, str) or hasattr(log, "iterate_episodes"):
        return from_minari(log)
    raise LogError(
        "a log is a dict of arrays, the path of a file, or a Minari data set or its name, and not "
        f"{type(log).__name__}"
    )


def _space_of(log: Log) -> Numbers:
    values = np.asarray(log.before)
    if values.dtype.kind not in "fiu":
        raise LogError(f"{log.where}: observations: {values.dtype}: pass their space")
    return Numbers(values.shape[1:])


def _in_words(name: str, columns: list[str]) -> str:
    """Replace ``x[i]``, or ``x`` if there is only one, by the name of its column."""
    return re.sub(r"^x(?:\[(\d+)\])?", lambda match: columns[int(match[1] or 0)], name)


def _domain_of_records(log: Log, domain: Domain | int | None) -> Domain:
    """Return the domain of a log of percepts."""
    if domain is None:
        domain = 8 * log.record_bytes
        if domain > _native.BITS_MAX:
            raise ConfigError(
                f"domain: {log.where} has percepts of {log.record_bytes} bytes, too many to be bits: "
                "pass their domain"
            )
    if isinstance(domain, int):
        domain = Bits(domain)
    if domain.percept_bytes != log.record_bytes:
        raise ConfigError(
            f"domain: its percepts have {domain.percept_bytes} bytes, and those of {log.where} "
            f"have {log.record_bytes}"
        )
    return domain


def encoded(
    log: Log, encoder: Encoder | None, space: Any, thresholds: int
) -> tuple[Domain, Encoder | None, npt.NDArray[Any], npt.NDArray[Any]]:
    """Return the domain, the encoder, and the percepts before and after each interaction.

    Parameters
    ----------
    log : Log
        Of observations.
    encoder, space, thresholds
        As for :func:`learn_from`.
    """
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
        encoder = Encoder(chosen, thresholds)
        if log.columns:
            encoder.names = [_in_words(name, log.columns) for name in encoder.names]
    domain = domain_of(encoder)
    sides = []
    for side, name in ((log.before, "observations"), (log.after, "next observations")):
        records = []
        for i in range(len(log)):
            try:
                records.append(encoder.encode(side[i]))
            except PerceptError as error:
                raise LogError(f"{log.where}: {name}: index {i}: {error}") from error
        flat = np.frombuffer(b"".join(records), domain.percept_dtype)
        sides.append(flat.reshape(len(log), *domain.percept_shape))
    return domain, encoder, sides[0], sides[1]


def learn_from(
    log: Any,
    *,
    columns: Sequence[str] | None = None,
    actions: int | None = None,
    space: Any = None,
    encoder: Encoder | None = None,
    domain: Domain | int | None = None,
    thresholds: int = 15,
    steps: int = 1,
    **config: Any,
) -> Run:
    """Learn from a log, without an environment.

    Parameters
    ----------
    log : dict of arrays, path of a file, Minari data set or its name
        The formats are in :mod:`rlvc.logs`. A file is an NPZ, a CSV or the log of a controller.
    columns : sequence of str or None
        Columns of a CSV that form the observation.
    actions : int or None
        Number of actions. None: as the log says, or the highest action plus one.
    space : gymnasium.Space or None
        Space of the observations. None: bits if they are bool, else real numbers.
    encoder : object or None
        As for :func:`rlvc.learn`.
    domain : Domain, int or None
        Domain of the percepts in the log of a controller; an int is the number of bits. None: all
        bits of the percepts.
    thresholds : int
        Maximum number of cutpoints for each element of an observation; 0: no limit.
    steps : int
        Number of learning steps. The residual criterion needs one. With the criterion of returns,
        step k looks k interactions ahead, and each step uses the whole log.
    **config
        Fields of :class:`~rlvc.Config`. The criterion ``"returns"`` needs a log with ``exploited``.

    Returns
    -------
    Run

    Raises
    ------
    LogError
        The log is damaged. The message names the file, the place and the fault.
    ConfigError
        A field is out of range, or the log lacks what the criterion needs.

    Notes
    -----
    Ctrl-C ends learning: the run so far is returned, with ``interrupted`` True.
    """
    if isinstance(columns, str):
        columns = [columns]
    read_log = read(log, columns)
    if config.get("criterion") == "returns" and read_log.exploited is None:
        raise ConfigError("criterion: returns needs a log with exploited")
    steps = whole("steps", steps, 1, 2**31)
    seed = whole("seed", config.pop("seed", 1), 0, 2**32 - 1)
    highest = int(read_log.actions.max())
    if actions is None:
        actions = read_log.action_count or highest + 1
    count = whole("actions", actions, 1, 255)
    if highest >= count:
        index = int(np.argmax(read_log.actions >= count))
        raise LogError(
            f"{read_log.where}: actions: index {index}: {read_log.actions[index]} is not in [0, {count})"
        )
    if read_log.record_bytes:
        domain = _domain_of_records(read_log, domain)
        encoder, before, after = None, read_log.before, read_log.after
    else:
        domain, encoder, before, after = encoded(read_log, encoder, space, thresholds)
    settings = default_config(count, len(read_log), seed, config)
    run = Run(Agent(domain, settings), encoder, settings.seed, Actions(count))
    choices = np.zeros(len(read_log), CHOICE)
    choices["action"] = read_log.actions
    if read_log.exploited is not None:
        choices["exploited"] = read_log.exploited
    for k in range(steps):
        if k == 0 or settings.criterion == "returns":
            run.agent.observe_many(before, choices, read_log.rewards, after, read_log.ends)
        try:
            splits = run.agent.learn().splits
        except KeyboardInterrupt:
            run.interrupted = True
            break
        classes = run.agent.classes
        run.history.append(Record(k + 1, len(read_log), classes, splits, 0, float("nan")))
    return run
