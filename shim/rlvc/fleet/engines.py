# SPDX-License-Identifier: MIT
"""Who counts, or draws a sample: this process, Ray or Dask. Each engine adds up the parts of all pieces.

Tables add up in any order, so that no engine needs to keep one, and a task that is done again, since its
worker was lost, changes nothing. Retries are the engine's. Its ports run what they are sent: they belong
in a private network.
"""

from __future__ import annotations

import logging
import os
from collections.abc import Callable, Sequence
from typing import Any, Protocol

from ..checks import shown
from ..errors import ConfigError
from .counting import Seen
from .sources import Piece

_TASKS = 4  # for each worker, at most: enough for the slow and the fast to end together
_TASK_ROWS = 1 << 21  # interactions of a task, at least, if each worker has one: some 0.1 s
_FAN_IN = 16  # parts that are added up at once
_RETRIES = 4  # of a task whose worker was lost

Note = Callable[[int], None]
Counted = tuple[Any, Seen]  # the result of a job, and what was read


class Job(Protocol):
    """What a pass makes of pieces: counts, or a sample."""

    def pieces(self, pieces: Sequence[Piece], note: Note | None = None) -> Counted:
        """Return what some pieces come to; `note` hears how many more interactions are done."""
        ...

    def nothing(self) -> Any:
        """Return what none come to: its ``add(part)`` adds, in any order, and ``part()`` is the sum."""
        ...


class Engine(Protocol):
    """What all engines do."""

    def total(self, job: Job, pieces: Sequence[Piece], note: Note) -> Counted:
        """Return the counts of all pieces; `note` hears how many more interactions are counted."""
        ...

    def close(self) -> None:
        """Let go of the cluster, and stop it if it was started here."""
        ...


class InProcess:
    """Counts here, a piece after another, into one table."""

    def total(self, job: Job, pieces: Sequence[Piece], note: Note) -> Counted:
        """Return the counts of all pieces."""
        return job.pieces(pieces, note)

    def close(self) -> None:
        """Nothing to let go of."""


def count(job: Job, pieces: Sequence[Piece]) -> Counted:
    """Count some pieces: the task of an engine.

    Parameters
    ----------
    job : Job
    pieces : sequence of Piece
    """
    return job.pieces(pieces)


def add(job: Job, *parts: Counted) -> Counted:
    """Add up parts: the other task.

    Parameters
    ----------
    job : Job
    *parts : tuple
    """
    total = _Sum(job)
    for part in parts:
        total.add(part)
    return total.made()


class _Sum:
    """Adds up parts as they come: the same in whatever order."""

    def __init__(self, job: Job) -> None:
        self._total = job.nothing()
        self._seen = Seen()

    def add(self, part: Counted) -> None:
        self._total.add(part[0])
        self._seen += part[1]

    def made(self) -> Counted:
        return self._total.part(), self._seen


def tasks_of(pieces: Sequence[Piece], workers: int) -> list[tuple[Piece, ...]]:
    """Cut the pieces into tasks of about equal numbers of interactions.

    A task's counts hardly grow with its interactions, so that few large tasks are less to add up.

    Parameters
    ----------
    pieces : sequence of Piece
    workers : int
        There are one to four tasks for each.
    """
    workers, total = max(1, workers), _rows(pieces)
    most = workers * min(max(1, total // (workers * _TASK_ROWS)), _TASKS)
    tasks: list[list[Piece]] = [[] for _ in range(most)]
    before = 0
    for piece in pieces:
        middle = before + piece.rows / 2
        tasks[min(int(most * middle / max(1, total)), most - 1)].append(piece)
        before += piece.rows
    return [tuple(task) for task in tasks if task]


def _rows(task: Sequence[Piece]) -> int:
    return sum(piece.rows for piece in task)


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

    def total(self, job: Job, pieces: Sequence[Piece], note: Note) -> Counted:
        """Return the counts of all pieces."""
        ray = self._ray
        counter, adder = (ray.remote(max_retries=_RETRIES)(task) for task in (count, add))
        asked = ray.put(job)
        tasks = tasks_of(pieces, int(ray.cluster_resources().get("CPU", 1)))
        parts = [counter.remote(asked, task) for task in tasks]
        rows = {part: _rows(task) for part, task in zip(parts, tasks, strict=True)}
        waiting = list(parts)
        while len(parts) > _FAN_IN:
            parts = [adder.remote(asked, *some) for some in _in_groups(parts)]
            waiting += parts
        last, total = set(parts), _Sum(job)
        try:
            while waiting:
                ready, waiting = ray.wait(waiting, fetch_local=False)
                for part in ready:
                    if part in last:
                        total.add(ray.get(part))
                    note(rows.get(part, 0))
        except ray.exceptions.RayTaskError as error:
            for task in waiting:
                ray.cancel(task)
            raise error.cause from None
        return total.made()

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

    def total(self, job: Job, pieces: Sequence[Piece], note: Note) -> Counted:
        """Return the counts of all pieces."""
        tasks = tasks_of(pieces, sum(self._client.nthreads().values()))
        parts = [self._submit(count, job, task) for task in tasks]
        rows = {part.key: _rows(task) for part, task in zip(parts, tasks, strict=True)}
        done = self._as_completed(parts)
        while len(parts) > _FAN_IN:
            parts = [self._submit(add, job, *some) for some in _in_groups(parts)]
            done.update(parts)
        last, total = {part.key for part in parts}, _Sum(job)
        del parts  # workers keep those that are needed
        for part in done:
            if part.key in last or part.status == "error":
                total.add(part.result())
            note(rows.get(part.key, 0))
        return total.made()

    def _submit(self, function: Callable[..., Counted], *arguments: Any) -> Any:
        return self._client.submit(function, *arguments, pure=False, retries=_RETRIES)

    def close(self) -> None:
        """Disconnect; a cluster that was started here ends."""
        self._client.close()
        if self._cluster is not None:
            self._cluster.close()


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
        f"cluster: {shown(cluster)} is neither None, 'ray', 'ray://...', 'dask', 'tcp://...' nor 'tls://...'"
    )
