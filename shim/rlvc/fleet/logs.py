# SPDX-License-Identifier: MIT
"""From a log that the readers of ``rlvc.logs`` have understood to what is counted."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ..counts.table import Columns
from ..domains.bits import Bits
from ..errors import LogError
from ..logs.learn_from import encoded
from ..logs.log import Log


def numbered(log: Log) -> Log:
    """Return the log with its actions as the numbers that they are: the same in every file.

    Parameters
    ----------
    log : Log

    Raises
    ------
    LogError
        They are no numbers from 0 on.
    """
    known = log.known
    if known.table is not None or known.words:
        raise LogError(
            f"{log.where}: actions: {known.name(0)}, ... are not numbers from 0 to 254, so that each "
            "file may number them in its own way: convert all at once with rlvc.fleet.convert"
        )
    if not 0 <= known.start <= 254:
        raise LogError(f"{log.where}: actions: {known.start} is not in [0, 254]")
    log.actions = log.actions + known.start
    return log


def columns_of_log(log: Log, encoder: Any = None, space: Any = None) -> tuple[Columns, int, Any]:
    """Return a log as columns, the bits of a percept, and the encoder of the observations.

    Parameters
    ----------
    log : Log
        Of percepts, or of observations that are bits, or 0 and 1 throughout.
    encoder, space
        As for :func:`rlvc.learn_from`.
    """
    if log.record_bytes:
        bits, before, after = 8 * log.record_bytes, np.asarray(log.before), np.asarray(log.after)
        encoder = None
    else:
        domain, encoder, before, after = encoded(log, encoder, space, 0)
        if isinstance(domain, Bits):
            bits = domain.bits
        else:
            bits, encoder = before.shape[1], None
            before, after = _packed(log, before), _packed(log, after)
    rewards = np.ascontiguousarray(log.rewards, np.float32)
    columns = Columns(
        np.ascontiguousarray(before),
        np.ascontiguousarray(after),
        log.actions.astype(np.uint8),
        rewards,
        np.ascontiguousarray(log.ends),
        rewards,
    )
    return columns, bits, encoder


def reals_of_log(log: Log) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32], Any]:
    """Return the observations before and after each interaction as real numbers, and their encoder.

    Parameters
    ----------
    log : Log
    """
    if log.record_bytes:
        raise LogError(f"{log.where}: percepts of bits: a planner needs real numbers")
    domain, encoder, before, after = encoded(log, None, None, 0)
    if isinstance(domain, Bits):
        raise LogError(f"{log.where}: observations of bits: a planner needs real numbers")
    return before, after, encoder


def _packed(log: Log, values: npt.NDArray[Any]) -> npt.NDArray[np.uint8]:
    """Numbers that are 0 and 1 as bits."""
    if not ((values == 0) | (values == 1)).all():
        raise LogError(
            f"{log.where}: observations: real numbers, not bits: convert the log with "
            "rlvc.fleet.convert and an encoder to bits"
        )
    return np.packbits(values.astype(np.bool_), axis=1, bitorder="little")
