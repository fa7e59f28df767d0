# SPDX-License-Identifier: MIT
"""A driver's checkpoint: the tree and the counts after a pass, from where a new driver goes on.

The file is an NPZ with the arrays of the counts, the agent's snapshot and a line of JSON. It is
replaced as a whole.
"""

from __future__ import annotations

import dataclasses
import hashlib
import io
import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ..checks import flag, shown, whole
from ..counts.part import Part, Question
from ..counts.rounds import CELL_BITS_MAX, Progress
from ..errors import ConfigError, CountError, LogError
from ..files import read, replace
from .counting import Seen
from .sample import Sample

_VERSION = 2
_WHOLE = (0, 2**63 - 1)  # the range of counts


@dataclasses.dataclass
class State:
    """What a checkpoint holds.

    Attributes
    ----------
    cell : tuple of int
        The features that the counts tell apart.
    part : Part
    snapshot : bytes
        Of the agent, as it was before it saw the counts.
    progress : Progress
    seen : Seen
        What was read in a pass, and the sample of the first one.
    """

    cell: tuple[int, ...]
    part: Part
    snapshot: bytes
    progress: Progress
    seen: Seen


def fingerprint(*what: Any) -> str:
    """Return a hash of what a checkpoint was made from.

    Parameters
    ----------
    *what : object
        Pieces, config and options, whose ``repr`` tells all.
    """
    return hashlib.sha256(repr(what).encode()).hexdigest()


def save(file: str | Path, made_from: str, state: State) -> None:
    """Write a checkpoint. A failure leaves the old one.

    Parameters
    ----------
    file : str or Path
    made_from : str
        A :func:`fingerprint`.
    state : State
    """
    head = {
        "version": _VERSION,
        "made_from": made_from,
        "cell": state.cell,
        "progress": dataclasses.asdict(state.progress),
        "seen": [state.seen.rows, state.seen.bytes, state.seen.lost, state.seen.skipped],
    }
    sample = state.seen.sample
    arrays = {
        field.name: array
        for field in dataclasses.fields(Part)
        if (array := getattr(state.part, field.name)) is not None
    }
    content = io.BytesIO()
    np.savez(
        content,
        head=np.frombuffer(json.dumps(head).encode(), np.uint8),
        snapshot=np.frombuffer(state.snapshot, np.uint8),
        sample=np.zeros((0, 1), np.uint8) if sample is None else sample.percepts,
        **arrays,
    )
    replace(file, content.getvalue())


def _check(sample: Any, cell: tuple[int, ...], question: Question) -> None:
    """Raise CountError unless percepts and a cell are those of a question."""
    percept_bytes = -(-question.features // 8)
    if sample.dtype != np.uint8 or sample.ndim != 2 or sample.shape[1] not in (1, percept_bytes):
        raise CountError(f"sample: {sample.dtype}{list(sample.shape)}")
    if list(cell) != sorted(set(cell)) or len(cell) > CELL_BITS_MAX:
        raise CountError(f"cell: {shown(cell)}")
    if cell and cell[-1] >= question.features:
        raise CountError(f"cell: {cell[-1]} is not in [0, {question.features})")


def _progress(passes: Any, rounds: Any, splits: Any, done: Any) -> Progress:
    return Progress(
        whole("passes", passes, *_WHOLE),
        whole("rounds", rounds, *_WHOLE),
        whole("splits", splits, *_WHOLE),
        flag("done", done),
    )


def _state(
    head: dict[str, Any], arrays: dict[str, Any], asked: Callable[[tuple[int, ...]], Question]
) -> State:
    """Make the state of a file's members, each of which is checked."""
    snapshot, sample = arrays.pop("snapshot").tobytes(), arrays.pop("sample")
    rows, size, lost, skipped = head["seen"]
    seen = Seen(
        whole("seen", rows, *_WHOLE),
        whole("seen", size, *_WHOLE),
        whole("seen", lost, *_WHOLE),
        [str(why) for why in skipped],
        Sample(sample, max(1, len(sample))),
    )
    cell = tuple(whole("cell", feature, 0, _WHOLE[1]) for feature in head["cell"])
    question = asked(cell)
    _check(sample, cell, question)
    part = Part(**({"follow": None, "reward": None} | arrays))
    part.check(question)
    return State(cell, part, snapshot, _progress(**head["progress"]), seen)


def load(
    file: str | Path, made_from: str, asked: Callable[[tuple[int, ...]], Question]
) -> State | None:
    """Read a checkpoint, if there is one.

    Parameters
    ----------
    file : str or Path
    made_from : str
        A :func:`fingerprint`.
    asked : callable
        Of the features of a cell, returns what is counted.

    Raises
    ------
    LogError
        It is damaged.
    ConfigError
        It was made from other data or options.
    """
    if not os.path.exists(file):
        return None
    try:
        with np.load(io.BytesIO(read(file)), allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
        head = json.loads(arrays.pop("head").tobytes())
        same = (head["version"], head["made_from"]) == (_VERSION, made_from)
        state = _state(head, arrays, asked) if same else None
    except Exception as error:  # of zipfile, of numpy's parser, of JSON
        raise LogError(f"{file}: damaged: {error!s:.300}: delete it to begin anew") from error
    if not same:
        raise ConfigError(
            f"checkpoint: {file} was made from other data or options: name another file, or delete it"
        )
    return state
