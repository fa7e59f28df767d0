# SPDX-License-Identifier: MIT
"""Columns of others: those of RLlib's recorded episodes, if their observations are bits.

RLlib writes ``eps_id``, ``obs``, ``actions``, ``rewards``, ``new_obs``, ``terminateds``,
``truncateds`` and ``t``. Observations are read if each is a list of bool, or of 0 and 1. All else
is to be converted first (:func:`rlvc.fleet.convert`), with an encoder.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ..counts.table import Columns
from ..errors import LogError
from . import layout

_NAMES = ("obs", "actions", "rewards", "new_obs", "terminateds", "truncateds")


def bits_of(kind: Any, where: str) -> int:
    """Return the bits of an observation of such a file.

    Parameters
    ----------
    kind : pyarrow.Schema
    where : str
        The file, in errors.
    """
    pa = layout.arrow()
    names_of(kind, where)
    found: Any = kind.field("obs").type
    if pa.types.is_fixed_size_list(found):
        size: int = found.list_size
        return size
    raise LogError(
        f"{where}: column obs: {found}, not lists of a fixed size: convert the log with "
        "rlvc.fleet.convert"
    )


def names_of(kind: Any, where: str = "log") -> list[str]:
    """Return the columns that are read.

    Parameters
    ----------
    kind : pyarrow.Schema
    where : str
    """
    for name in _NAMES:
        if name not in kind.names:
            raise LogError(
                f"{where}: column {name}: missing; the columns are neither those of rlvc (percept, ...) "
                f"nor of RLlib ({', '.join(_NAMES)})"
            )
    return list(_NAMES)


def _packed(group: Any, name: str, where: str) -> npt.NDArray[np.uint8]:
    column = group.column(name).combine_chunks()
    size = column.type.list_size
    values = column.flatten().to_numpy(zero_copy_only=False)
    if values.dtype == object or not ((values == 0) | (values == 1)).all():
        raise LogError(f"{where}: column {name}: holds other values than 0 and 1")
    bits = values.astype(np.bool_).reshape(-1, size)
    return np.packbits(bits, axis=1, bitorder="little")


def columns_of(group: Any, where: str) -> Columns:
    """Return a row group as arrays.

    Parameters
    ----------
    group : pyarrow.Table
    where : str
        File and row group, in errors.
    """

    def numbers(name: str, kind: type) -> npt.NDArray[Any]:
        values = group.column(name).to_numpy()
        if values.dtype.kind not in "biuf":
            raise LogError(f"{where}: column {name}: {values.dtype}, not numbers")
        return np.ascontiguousarray(values, kind)

    actions = numbers("actions", np.int64)
    if len(actions) and not 0 <= actions.min() <= actions.max() <= 254:
        raise LogError(f"{where}: column actions: not within [0, 254]")
    rewards = numbers("rewards", np.float32)
    ends = np.where(numbers("terminateds", np.bool_), 1, 2 * numbers("truncateds", np.bool_))
    return Columns(
        _packed(group, "obs", where),
        _packed(group, "new_obs", where),
        actions.astype(np.uint8),
        rewards,
        ends.astype(np.uint8),
        rewards,
    )
