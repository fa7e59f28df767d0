#!/usr/bin/env python3
#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Holds the Python package to its bars: its calls beside the same calls in C and beside empty calls.

Needs the package and gcc. Prints each figure with its bar; exit status 1 if one is missed. The times are
the best of several rounds.
"""

import ctypes
import subprocess
import sys
import tempfile

import numpy as np

from rlvc import _native, bench

LOOP = r"""
#include <stddef.h>
#include <stdint.h>
int rlvc_predict(void *agent, const void *percept, uint32_t *class_id, uint32_t *action);
int loop(void *agent, const unsigned char *percepts, uint32_t bytes, size_t count,
         uint32_t *classes, uint32_t *actions) {
    for (size_t i = 0; i < count; i++)
        if (rlvc_predict(agent, percepts + i * bytes, classes + i, actions + i) != 0)
            return -1;
    return 0;
}
"""
ROUNDS = 15


def c_loop(folder):
    """The loop over rlvc_predict in C, which calls that very library."""
    subprocess.run(
        ["gcc", "-O3", "-shared", "-fPIC", "-o", f"{folder}/loop.so", "-x", "c", "-", "-x", "none",
         str(_native.PATH)],
        input=LOOP, text=True, check=True,
    )  # fmt: skip
    loop = ctypes.CDLL(f"{folder}/loop.so").loop
    loop.argtypes = [
        *[ctypes.c_void_p] * 2, ctypes.c_uint32, ctypes.c_size_t, *[ctypes.c_void_p] * 2,
    ]  # fmt: skip
    return loop


def predict_ratio(agent):
    percepts = bench.many_percepts()
    found, out = (tuple(np.zeros(len(percepts), np.uint32) for _ in range(2)) for _ in range(2))
    with tempfile.TemporaryDirectory() as folder:
        loop = c_loop(folder)
        arguments = (agent._handle, percepts.ctypes.data, 3, len(percepts))
        pointers = [array.ctypes.data for array in found]
        times = [
            (bench.best(lambda: loop(*arguments, *pointers), 1),
             bench.best(lambda: agent.predict(percepts, out), 1))
            for _ in range(ROUNDS)
        ]  # fmt: skip
    in_c, in_python = (min(column) for column in zip(*times, strict=True))
    assert all((a == b).all() for a, b in zip(found, out, strict=True))
    print(
        f"predict of 1e6 percepts: {in_c * 1e3:.1f} ms in C, {in_python * 1e3:.1f} ms from Python"
    )
    return in_python / in_c


def main():
    agent = bench.grown_agent()
    print(agent)
    results = [("predict, of C's time", predict_ratio(agent), 1.3)]
    step, empty = bench.step_times(agent)
    print(f"act and observe: {step * 1e9:.0f} ns; two empty calls: {empty * 1e9:.0f} ns")
    results.append(("act and observe, of two empty calls", step / empty, 4.0))
    for environments in (16, 64, 256, 1024):
        ratio = bench.batch_time(agent, environments) / step
        bar = 0.1 if environments >= 64 else None
        results.append((f"a step in a vector of {environments}, of one alone", ratio, bar))
    missed = False
    for name, ratio, bar in results:
        missed |= bar is not None and ratio > bar
        print(f"{ratio:8.3f}  {name}" + (f" (at most {bar})" if bar else ""))
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())
