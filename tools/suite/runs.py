# SPDX-License-Identifier: MIT
"""One run, as a record; and many runs, each in a process of its own."""

import concurrent.futures
import math
import multiprocessing
import signal
import sys
import time
import traceback
import warnings

import tqdm

from .learners import LEARNERS
from .tasks import TASKS, reached


def _finite(value):
    return None if value is None or math.isnan(value) else value


def measure(task_name, learner, seed):
    """One run, as a record: a row of the JSON file."""
    task = TASKS[task_name]()
    looks, looked = [], 0.0

    def check(interactions, act):
        nonlocal looked
        start = time.process_time()
        looks.append((interactions, task.look(act, interactions)))
        looked += time.process_time() - start

    start = time.process_time()
    found = LEARNERS[learner].learn(task, seed, check)
    seconds = time.process_time() - start - looked
    compact = found.pop("compact", None)
    record = {
        "task": task_name, "learner": learner, "seed": seed,
        "leaves": None, "distractors": None, "compacted": None, "kept": None, **found,
        "seconds": seconds,
        "value": _finite(looks[-1][1].value),
        "optimal": looks[-1][1].optimal,
        "reached": reached(looks, last=task.changed or math.inf),
    }  # fmt: skip
    if task.changed is not None:
        record["reached_again"] = reached(looks, first=task.changed)
        both = record["reached"] is not None and record["reached_again"] is not None
        record["again"] = record["reached_again"] / record["reached"] if both else None
    if compact:
        record["compacted"], act = compact()
        record["kept"] = _finite(task.look(act, task.interactions).value)
    record["looks"] = [[done, _finite(look.value), look.optimal] for done, look in looks]
    return record


def _attempt(job):
    """A run in a process of its own. If it fails the others go on."""
    try:
        return measure(*job)
    except Exception:
        return {"task": job[0], "learner": job[1], "seed": job[2], "error": traceback.format_exc()}


def _prepare():
    warnings.simplefilter("ignore")


def run_all(jobs, processes):
    """The records of the jobs that are done, and what ended the others: None if nothing did."""
    records, ended = [], None
    context = multiprocessing.get_context("spawn")
    pool = concurrent.futures.ProcessPoolExecutor(processes, context, _prepare)
    heard = signal.signal(signal.SIGINT, signal.SIG_IGN)  # the children inherit this
    futures = [pool.submit(_attempt, job) for job in jobs]
    signal.signal(signal.SIGINT, heard)
    bar = tqdm.tqdm(total=len(jobs), unit=" runs", dynamic_ncols=True, disable=None)
    try:
        for future in concurrent.futures.as_completed(futures):
            records.append(future.result())
            bar.update()
            bar.set_postfix_str("{task} {learner} {seed}".format(**records[-1]))
    except KeyboardInterrupt:
        ended = "interrupted"
        for child in multiprocessing.active_children():
            child.terminate()
    except concurrent.futures.process.BrokenProcessPool:
        ended = "a run's process died"
    pool.shutdown(wait=True, cancel_futures=True)
    bar.close()
    sys.stderr.flush()
    order = {job: i for i, job in enumerate(jobs)}
    records.sort(key=lambda r: order[r["task"], r["learner"], r["seed"]])
    return records, ended
