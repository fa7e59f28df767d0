#!/usr/bin/env python3
#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What learning from counts costs: a random walk in Sutton's maze, in Parquet files, by one process that counts, by two
of them, and by the learner in memory. Prints JSON. Needs the package with its extras `fleet` and `dask`."""

import argparse
import concurrent.futures
import contextlib
import hashlib
import importlib
import json
import multiprocessing
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np

import rlvc
import rlvc.fleet
from rlvc.counts.part import Question
from rlvc.counts.table import Table
from rlvc.fleet import layout

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "tests/shim"))
import worlds

FILES = 28
LOOPED = 200_000  # interactions
REPEATS = 3


def write(folder, interactions):
    """Files of the layout, each of its own walkers."""
    for number in range(FILES):
        some = worlds.maze(interactions // FILES, seed=number)
        writer = layout.Writer(f"{folder}/part-{number:02d}.parquet", worlds.BITS, 4)
        writer.write(some)
        writer.close()


def apart(function, *arguments):
    """The result of a function in a process of its own, its seconds and its most memory."""
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(1, context) as pool:
        return pool.submit(measured, function, *arguments).result()


def measured(function, *arguments):
    load_libraries()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    began, spent = time.perf_counter(), time.process_time()
    result = function(*arguments)
    seconds, spent = time.perf_counter() - began, time.process_time() - spent
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return {"seconds": round(seconds, 2), "CPU": round(spent, 2), "MiB": round((peak - before) / 1024, 1), **result}


def load_libraries():
    """What pyarrow would load while a clock runs, which takes longer than counting."""
    for name in ("pyarrow.parquet", "pandas"):
        with contextlib.suppress(ImportError):
            importlib.import_module(name)


def told(run):
    return {"classes": run.leaves, "tree": hash_of(run.agent)}


def hash_of(agent):
    return hashlib.sha256(agent.print("json").encode() + agent.q.tobytes()).hexdigest()[:16]


def by_counts(folder, sample):
    run = rlvc.fleet.learn_from(folder, sample=sample)
    return told(run) | {"passes": run.report.passes}


def in_memory(folder, python):
    """By an interpreter whose package may be of another version."""
    rlvc.fleet.export(folder, f"{folder}/all.npz")
    done = subprocess.run([python, str(pathlib.Path(__file__).with_name("in_memory.py")), f"{folder}/all.npz"],
                          stdout=subprocess.PIPE, text=True, check=True)
    os.unlink(f"{folder}/all.npz")
    return json.loads(done.stdout)


def by_workers(folder, workers):
    """Seconds of a run on a cluster of processes that runs already, the best of three, and the processor's time: of the
    driver, with the scheduler, and of each worker."""
    import distributed

    cluster = distributed.LocalCluster(n_workers=workers, threads_per_worker=1, host="127.0.0.1",
                                       dashboard_address="127.0.0.1:0")
    client = distributed.Client(cluster)
    rlvc.fleet.learn_from(f"{folder}/part-00.parquet", cluster=cluster.scheduler_address)  # workers import the package
    runs = [clocked(folder, cluster.scheduler_address, client) for _ in range(REPEATS)]
    client.close()
    cluster.close()
    return {"workers": workers} | min(runs, key=lambda run: run["counting"])


def clocked(folder, address, client):
    before, began, spent = client.run(time.process_time), time.perf_counter(), time.process_time()
    run = rlvc.fleet.learn_from(folder, cluster=address, sample=0)
    seconds, spent = time.perf_counter() - began, time.process_time() - spent
    after = client.run(time.process_time)
    each = [round(after[worker] - before[worker], 2) for worker in after]
    return {"counting": round(seconds, 2), "driver": round(spent, 2), "each worker": each} | told(run)


def instructions(follow):
    """Instructions that the loop takes for an interaction: by valgrind, the difference of counting once and thrice."""
    totals = []
    for times in (1, 3):
        program = (f"import sys; sys.path.insert(0, {str(pathlib.Path(__file__).parent)!r}); import fleet; "
                   f"fleet.count_again({times}, {follow})")
        done = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", sys.executable, "-c",
                               program], capture_output=True, text=True, check=True,
                              env=os.environ | {"PYTHONHASHSEED": "0"})
        totals.append(int(re.search(r"Collected : (\d+)", done.stderr)[1]))
    return (totals[1] - totals[0]) / (2 * LOOPED)


def count_again(times, follow):
    some = worlds.maze(LOOPED)
    table = Table(Question(worlds.BITS, 4, (0, 1, 2, 3, 15, 16, 17), follow=follow))
    for _ in range(times):
        table.count(some)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--interactions", type=float, default=1e6, help="default: %(default)s")
    parser.add_argument("--python", default=sys.executable, help="an interpreter whose package learns in memory, which may "
                        "be of another version; default: this one")
    parser.add_argument("--instructions", action="store_true", help="count those of the loop a row, by valgrind, and no more")
    arguments = parser.parse_args()
    if arguments.instructions:
        for follow in (False, True):
            told_of = {"what follows": follow, "instructions": round(instructions(follow), 1)}
            print(json.dumps(told_of), flush=True)
        return
    with tempfile.TemporaryDirectory() as folder:
        write(folder, int(arguments.interactions))
        for name, function, given in (
            ("counts, one process", by_counts, (0,)),
            ("counts, features guessed", by_counts, (1 << 17,)),
            ("counts, one worker", by_workers, (1,)),
            ("counts, two workers", by_workers, (2,)),
        ):
            print(json.dumps({"what": name} | apart(function, folder, *given)), flush=True)
        print(json.dumps({"what": "in memory"} | in_memory(folder, arguments.python)), flush=True)


if __name__ == "__main__":
    main()
