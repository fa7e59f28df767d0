# SPDX-License-Identifier: MIT
"""Runs tasks, learners and seeds, several at a time, and writes the table. See options.py."""

import json
import os
import signal
import sys
import tempfile

from . import options, runs, table
from .learners import missing
from .tasks import TASKS


def _jobs(args, learners):
    """The runs of each learner, on the tasks that it is for."""
    jobs = []
    for learner in learners:
        for name in args.tasks:
            task = TASKS[name]()
            count = args.peer_seeds
            if learner == "rlvc":
                count = args.seeds * task.runs_a_seed
            elif learner not in task.peers:
                continue
            jobs += [(name, learner, seed) for seed in range(1, 1 + count)]
    return jobs


def _write_whole(path, report):
    """The file is there as a whole, or as it was before."""
    folder = os.path.dirname(os.path.abspath(path))
    handle, temporary = tempfile.mkstemp(dir=folder, prefix=".yardstick-")
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            json.dump(report, file, indent=1)
            file.write("\n")
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise


def main():
    args = options.parse()
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # ends it as Ctrl-C does
    if args.json and not os.access(os.path.dirname(os.path.abspath(args.json)), os.W_OK):
        sys.exit(f"tools/yardstick: --json: cannot write {args.json}")
    absent = {name: packages for name in args.learners if (packages := missing(name))}
    learners = [name for name in args.learners if name not in absent]
    jobs = _jobs(args, learners)
    records, ended = runs.run_all(jobs, args.jobs)
    done = [record for record in records if "error" not in record]
    print(table.render(done, args.tasks, learners), flush=True)
    if args.json:
        _write_whole(args.json, {"ended": ended, "missing": absent, "runs": records})
    for name, packages in absent.items():
        needed = ", ".join(packages)
        print(f"- missing: {options.LEARNERS[name]}, which needs {needed}: tools/setup peers")
    for record in records:
        if "error" in record:
            print("{task} {learner} {seed} failed:\n{error}".format(**record), file=sys.stderr)
    if ended:
        print(f"tools/yardstick: {ended}: {len(records)} of {len(jobs)} runs", file=sys.stderr)
    if ended == "interrupted":
        return 130
    return int(ended is not None or len(done) < len(records))


if __name__ == "__main__":
    try:
        status = main()
        sys.stdout.flush()
    except BrokenPipeError:  # whoever read has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        status = 1
    sys.exit(status)
