# SPDX-License-Identifier: MIT
"""Who counts: this process, Ray or Dask. Each engine adds up the counts of all pieces.

Tables add up in any order, so that no engine needs to keep one, and a task that is done again, since its
worker was lost, changes nothing. Retries are the engine's. Its ports run what they are sent: they belong
in a private network.
"""

from __future__ import annotations

import logging
import os
from collections.abc import Callable, Sequence
from typing import Any, Protocol

from ..counts.part import Part
from ..counts.table import Table, added
from ..errors import ConfigError
from .counting import Counting, Seen
from .sources import Piece

_FAN_IN = 8  # parts that a task adds up
_RETRIES = 4  # of a task whose worker was lost

Note = Callable[[Seen], None]


class Engine(Protocol):
    """What all engines do."""

    def total(self, counting: Counting, pieces: Sequence[Piece], note: Note) -> Part:
        """Return the counts of all pieces; `note` hears of each piece that is done."""
        ...

    def close(self) -> None:
        """Let go of the cluster, and stop it if it was started here."""
        ...


class InProcess:
    """Counts here, a piece after another, into one table."""

    def total(self, counting: Counting, pieces: Sequence[Piece], note: Note) -> Part:
        """Return the counts of all pieces."""
        table = Table(counting.question, counting.memory)
        for piece in pieces:
            note(counting.into(table, piece))
        return table.part()

    def close(self) -> None:
        """Nothing to let go of."""


def count(counting: Counting, piece: Piece) -> tuple[Part, Seen]:
    """Count a piece: the task of an engine.

    Parameters
    ----------
    counting : Counting
    piece : Piece
    """
    return counting.piece(piece)


def add(counting: Counting, *parts: Part) -> Part:
    """Add up parts: the other task.

    Parameters
    ----------
    counting : Counting
    *parts : Part
    """
    return added(counting.question, list(parts), counting.memory)


def _in_groups(items: list[Any]) -> list[list[Any]]:
    return [items[i : i + _FAN_IN] for i in range(0, len(items), _FAN_IN)]


class Ray:
    """Counts by tasks of Ray core.

    Parameters
    ----------
    address : str
        ``"ray"``: a cluster on this machine, without dashboard, that ends with the process; else the
        address of one, such as ``ray://head:10001``.
    workers : int or None
        Tasks at a time of a local cluster. None: as many as there are processors.
    """

    def __init__(self, address: str, workers: int | None = None) -> None:
        os.environ["RAY_USAGE_STATS_ENABLED"] = "0"
        try:
            import ray
        except ImportError:
            raise ImportError("this cluster needs Ray: pip install 'rlvc[fleet]'") from None
        self._ray = ray
        self._started = not ray.is_initialized()
        quiet: dict[str, Any] = {"log_to_driver": False, "logging_level": "ERROR"}
        if self._started and address == "ray":
            ray.init(
                num_cpus=workers or os.cpu_count(),
                include_dashboard=False,
                _node_ip_address="127.0.0.1",
                **quiet,
            )
        elif self._started:
            ray.init(address, **quiet)

    def total(self, counting: Counting, pieces: Sequence[Piece], note: Note) -> Part:
        """Return the counts of all pieces."""
        ray = self._ray
        counter = ray.remote(num_returns=2, max_retries=_RETRIES)(count)
        adder = ray.remote(max_retries=_RETRIES)(add)
        asked = ray.put(counting)
        pairs = [counter.remote(asked, piece) for piece in pieces]
        waiting = [seen for _, seen in pairs]
        try:
            while waiting:
                ready, waiting = ray.wait(waiting)
                for seen in ray.get(ready):
                    note(seen)
            parts = [part for part, _ in pairs]
            while len(parts) > 1:
                parts = [adder.remote(asked, *some) for some in _in_groups(parts)]
            total: Part = ray.get(parts[0])
        except ray.exceptions.RayTaskError as error:
            for task in waiting:
                ray.cancel(task)
            raise error.cause from None
        return total

    def close(self) -> None:
        """Disconnect; a cluster that was started here ends."""
        if self._started:
            self._ray.shutdown()


class Dask:
    """Counts by tasks of Dask.

    Parameters
    ----------
    address : str
        ``"dask"``: a cluster on this machine, on the loopback interface; else the scheduler's address,
        such as ``tcp://host:8786``.
    workers : int or None
        Processes of a local cluster. None: as many as there are processors.
    """

    def __init__(self, address: str, workers: int | None = None) -> None:
        try:
            import distributed
        except ImportError:
            raise ImportError("this cluster needs Dask: pip install 'rlvc[dask]'") from None
        library: Any = distributed
        self._as_completed = library.as_completed
        self._cluster: Any = None
        if address == "dask":
            self._cluster = library.LocalCluster(
                n_workers=workers or os.cpu_count(),
                threads_per_worker=1,
                host="127.0.0.1",
                dashboard_address="127.0.0.1:0",
                silence_logs=logging.CRITICAL,
            )
        self._client: Any = library.Client(self._cluster or address)

    def total(self, counting: Counting, pieces: Sequence[Piece], note: Note) -> Part:
        """Return the counts of all pieces."""
        submit = self._client.submit
        pairs = [submit(count, counting, piece, pure=False, retries=_RETRIES) for piece in pieces]
        seen = [submit(_second, pair, pure=False, retries=_RETRIES) for pair in pairs]
        parts = [submit(_first, pair, pure=False, retries=_RETRIES) for pair in pairs]
        del pairs
        for future in self._as_completed(seen):
            note(future.result())
        while len(parts) > 1:
            parts = [
                submit(add, counting, *some, pure=False, retries=_RETRIES)
                for some in _in_groups(parts)
            ]
        total: Part = parts[0].result()
        return total

    def close(self) -> None:
        """Disconnect; a cluster that was started here ends."""
        self._client.close()
        if self._cluster is not None:
            self._cluster.close()


def _first(pair: tuple[Part, Seen]) -> Part:
    return pair[0]


def _second(pair: tuple[Part, Seen]) -> Seen:
    return pair[1]


def engine_of(cluster: str | None, workers: int | None = None) -> Engine:
    """Return the engine that an address names.

    Parameters
    ----------
    cluster : str or None
        None; ``"ray"`` or ``ray://...``; ``"dask"``, ``tcp://...`` or ``tls://...``.
    workers : int or None
        Of a cluster on this machine.
    """
    if cluster is None:
        return InProcess()
    if isinstance(cluster, str) and (cluster == "ray" or cluster.startswith("ray://")):
        return Ray(cluster, workers)
    if isinstance(cluster, str) and (cluster == "dask" or cluster.startswith(("tcp://", "tls://"))):
        return Dask(cluster, workers)
    raise ConfigError(
        f"cluster: {cluster!r:.80} is neither None, 'ray', 'ray://...', 'dask', 'tcp://...' nor 'tls://...'"
    )
