# SPDX-License-Identifier: MIT
"""Runs tasks, learners and seeds, several at a time, and prints the table. See options.py."""

import json
import os
import signal
import sys
import tempfile

from . import options, report, runs
from .learners import LEARNERS
from .tasks import TASKS


def _jobs(args, learners):
    """The runs of each learner, on the tasks that suit it."""
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


def _check_writable(path):
    """End the program, before any run, if the file cannot be written."""
    if not os.access(os.path.dirname(os.path.abspath(path)), os.W_OK):
        sys.exit(f"tools/yardstick: --json: cannot write {path}")


def _write_json(path, content):
    """Write the whole file, or leave the old one as it was."""
    folder = os.path.dirname(os.path.abspath(path))
    handle, temporary = tempfile.mkstemp(dir=folder, prefix=".yardstick-")
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            json.dump(content, file, indent=1)
            file.write("\n")
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise


def _complain(records, absent, ended, jobs):
    """Say what is missing from the table, and why."""
    for name, packages in absent.items():
        needed = ", ".join(packages)
        print(f"- not measured: {options.LEARNERS[name]}: needs {needed} (tools/setup peers)")
    for record in records:
        if "error" in record:
            print("{task} {learner} {seed} failed:\n{error}".format(**record), file=sys.stderr)
    if ended:
        print(f"tools/yardstick: {ended} after {len(records)} of {jobs} runs", file=sys.stderr)


def main():
    """Run the command line; returns the exit status."""
    args = options.parse()
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # treated as Ctrl-C
    if args.json:
        _check_writable(args.json)
    absent = {name: packages for name in args.learners if (packages := LEARNERS[name].missing())}
    learners = [name for name in args.learners if name not in absent]
    jobs = _jobs(args, learners)
    records, ended = runs.run_all(jobs, args.jobs)
    done = [record for record in records if "error" not in record]
    try:
        print(report.render(done, args.tasks, learners), flush=True)
    finally:  # also if the reader of the table is gone
        if args.json:
            _write_json(args.json, {"ended": ended, "missing": absent, "runs": records})
    _complain(records, absent, ended, len(jobs))
    if ended == "interrupted":
        return 130
    return int(ended is not None or len(done) < len(records))


if __name__ == "__main__":
    try:
        status = main()
        sys.stdout.flush()
    except BrokenPipeError:  # the reader is gone, as with `| head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        status = 1
    sys.exit(status)
