# SPDX-License-Identifier: MIT
"""Runs in files.

The file (:mod:`rlvc.agent.kept`) holds the library's snapshot of the learner and the percepts that were
seen. Its JSON has ``bits``, ``descriptors`` and ``thresholds``, one of which holds the parameters of the
domain; ``config`` of an agent, ``planner``, the config of a planner, or ``nodes`` of a policy; and the
encoder, which may be the ``eye`` of pictures, the actions and the history.
"""

from __future__ import annotations

import dataclasses
import math
import sys
from pathlib import Path
from typing import Any

from ..agent.agent import Agent
from ..agent.config import Config
from ..agent.kept import is_kind, pack, read_content, unpack
from ..agent.planned_policy import PlannedPolicy
from ..agent.planner import Planner
from ..agent.planner_config import PlannerConfig
from ..agent.snapshot import described, domain_of
from ..checks import flag, real, whole
from ..domains.domain import Domain
from ..domains.thresholds import Thresholds
from ..errors import BusyError, Error, SnapshotError
from ..files import replace
from .actions import Actions
from .encode import Encoder
from .explanation import Seen
from .run import Record, Run

_WHOLE = (0, 2**63 - 1)  # the range of counts


def is_run(file: str | Path) -> bool:
    """Whether a file can be read and begins as that of a run."""
    return is_kind(file, "run")


def packed(run: Run) -> bytes:
    """Return the content of a run's file.

    Parameters
    ----------
    run : Run

    Returns
    -------
    bytes
    """
    learner, snapshot = run.learner, b""
    head: dict[str, Any] = {}
    if isinstance(learner, Agent | Planner):
        snapshot = _snapshot(learner)
        name = "config" if isinstance(learner, Agent) else "planner"
        head[name] = dataclasses.asdict(learner.config)
    else:
        head |= {"actions": learner.actions, "nodes": learner.nodes}
    head |= {
        **described(learner.domain),
        "encoder": run.encoder.to_json() if type(run.encoder) is Encoder else None,
        "own_encoder": run.encoder is not None and type(run.encoder) is not Encoder,
        "eye": _eye_of(run.encoder),
        "spelled": run.actions.to_dict(),
        "compaction": run.compaction if run.small is not None else None,
        "seed": run.seed,
        "interrupted": run.interrupted,
        "masked": run.masked,
        "interactions": run.interactions,
        "warning": run.warning,
        "history": [dataclasses.astuple(record) for record in run.history],
        "seen": [len(run.seen.percepts), run.seen.count, run.seen.stride],
        "bytes": len(snapshot),
    }
    return pack("run", head, b"".join([snapshot, *run.seen.percepts]))


def _eye_of(encoder: Any) -> dict[str, Any] | None:
    """What an encoder of pictures is made of; None: it is another one."""
    seeing = sys.modules.get("rlvc.vision.eye")  # where the vision module is missing there is no eye
    known: bool = seeing is not None and type(encoder) is seeing.Eye
    return encoder.to_dict() if known else None


def _snapshot(learner: Agent | Planner) -> bytes:
    """The learner's snapshot; a planner's step that was interrupted is finished first."""
    try:
        return learner.snapshot()
    except BusyError:
        learner.learn()
        return learner.snapshot()


def write(run: Run, file: str | Path) -> None:
    """Write a run to a file: see :meth:`rlvc.Run.save`."""
    replace(file, packed(run))


def load(file: str | Path, encoder: Any = None, domain: Domain | None = None) -> Run:
    """Read a run that :meth:`rlvc.Run.save` wrote: it acts and learns on exactly as the original.

    Parameters
    ----------
    file : str or Path
    encoder : object or None
        The encoder of the run, if it was neither an :class:`rlvc.Encoder` nor an
        :class:`rlvc.vision.Eye`.
    domain : Domain or None
        The domain, if it was a user-defined one.

    Returns
    -------
    Run

    Raises
    ------
    StoreError
        The file cannot be read.
    SnapshotError
        It is not such a file, is corrupt, or needs the encoder or the domain.
    ImportError
        Its encoder is an eye, and the vision module is missing.
    """
    content = read_content(file)
    try:
        return unpacked(content, encoder, domain)
    except Error as error:
        raise SnapshotError(f"{file}: {error}") from None


def unpacked(content: bytes, encoder: Any = None, domain: Domain | None = None) -> Run:
    """Make a run of the content of its file: see :func:`load`."""
    head, rest = unpack("run", content)
    try:
        return _made(head, rest, encoder, domain)
    except (ImportError, SnapshotError):
        raise
    except Exception as error:  # members of any kind
        raise SnapshotError(f"damaged: the header is not valid ({error})") from error


def _made(head: dict[str, Any], rest: bytes, encoder: Any, domain: Domain | None) -> Run:
    domain = domain_of(head) or domain
    if domain is None:
        raise SnapshotError("the run has a user-defined domain: pass it as domain")
    made = _encoder(head, encoder is not None)
    snapshot, kept = rest[: head["bytes"]], rest[head["bytes"] :]
    learner: Agent | Planner | PlannedPolicy
    if "config" in head:
        learner = Agent.restore(domain, Config(**head["config"]), snapshot)
    elif "planner" in head and isinstance(domain, Thresholds):
        learner = Planner.restore(domain, PlannerConfig(**head["planner"]), snapshot)
    elif isinstance(domain, Thresholds):
        learner = PlannedPolicy(domain, head["actions"], head["nodes"])
    else:
        raise SnapshotError("damaged: the policy of a planner has percepts of real numbers")
    actions = Actions.from_dict(head["spelled"])
    known = learner.actions if isinstance(learner, PlannedPolicy) else learner.config.actions
    if actions.count != known:
        raise SnapshotError(f"damaged: {actions.count} actions, and the learner has {known}")
    if made is not None and made.domain.percept_bytes != domain.percept_bytes:
        raise SnapshotError("damaged: the encoder makes percepts of another size")
    run = Run(learner, encoder if made is None else made, whole("seed", head["seed"], *_WHOLE), actions)
    run.interrupted = flag("interrupted", head["interrupted"])
    run.masked = flag("masked", head.get("masked", False))  # older files do not say it
    run.history = [_record(record) for record in head["history"]]
    run.seen = _seen(kept, domain.percept_bytes, *head["seen"])
    if isinstance(learner, PlannedPolicy):
        run._kept = (whole("interactions", head["interactions"], *_WHOLE), str(head["warning"]))
    if head["compaction"] is not None:
        run.compact(**head["compaction"])
    return run


def _encoder(head: dict[str, Any], given: bool) -> Any:
    """The encoder that is in the file; None: there is none, or the caller gives it."""
    if head["encoder"] is not None:
        return Encoder.from_json(head["encoder"])
    if given or not head["own_encoder"]:
        return None
    if head.get("eye") is None:  # nor have older files one
        raise SnapshotError("the run has an encoder of its own: pass it as encoder")
    from ..vision.eye import Eye

    return Eye.from_dict(head["eye"])


def _record(fields: list[Any]) -> Record:
    *names, last = (field.name for field in dataclasses.fields(Record))
    *counts, mean = fields
    made: dict[str, Any] = {n: whole(n, v, *_WHOLE) for n, v in zip(names, counts, strict=True)}
    unknown = isinstance(mean, float) and math.isnan(mean)
    made[last] = mean if unknown else real(last, mean)
    return Record(**made)


def _seen(kept: bytes, size: int, count: Any, seen: Any, stride: Any) -> Seen:
    count = whole("seen", count, 0, Seen.room)
    if len(kept) != count * size:
        raise SnapshotError(f"damaged: {len(kept)} bytes of percepts, expected {count * size}")
    percepts = [kept[i * size : (i + 1) * size] for i in range(count)]
    return Seen(percepts, whole("seen", seen, *_WHOLE), whole("stride", stride, 1, _WHOLE[1]))
