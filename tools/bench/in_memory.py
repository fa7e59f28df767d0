#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What the learner in memory costs on a log: reads an NPZ file and learns from it with 4 actions. Prints JSON. fleet.py
runs it, also with the interpreter of another version of the package."""

import hashlib
import json
import resource
import sys
import time

import numpy as np

import rlvc


def main():
    with np.load(sys.argv[1]) as log:
        arrays = {name: log[name] for name in log.files}
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    began, spent = time.perf_counter(), time.process_time()
    run = rlvc.learn_from(arrays, actions=4, capacity=2 * len(arrays["actions"]))
    seconds, spent = time.perf_counter() - began, time.process_time() - spent
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    told = hashlib.sha256(run.agent.print("json").encode() + run.agent.q.tobytes()).hexdigest()[:16]
    print(json.dumps({"seconds": round(seconds, 2), "CPU": round(spent, 2), "MiB": round((peak - before) / 1024, 1),
                      "classes": run.agent.statistics.classes, "tree": told}))


if __name__ == "__main__":
    main()
