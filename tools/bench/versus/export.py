#!/usr/bin/env python3
#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compares the exported policy of the Binary Gridworld with what emlearn and m2cgen make of the same tree.

    export.py RUN_GRIDWORLD

Learns the maze with run_gridworld and builds the exported minimal policy as a tree of scikit-learn. Exports
that with emlearn (inline, int16_t) and m2cgen, compiles all three for a Cortex-M0 with -Os, and counts
instructions under QEMU (board microbit). Of emlearn only the tree function is measured, without the vote
among trees. Both others get their features unpacked from the bits beforehand; ours reads the percept as it
is. All must act as the tree does.

Needs the Python packages emlearn, m2cgen and scikit-learn, and Debian's gcc-arm-none-eabi,
picolibc-arm-none-eabi and qemu-system-arm.
"""
import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import emlearn
import m2cgen
import numpy as np
from sklearn.tree import DecisionTreeClassifier
from sklearn.tree._tree import Tree

BITS = 18
PERCEPTS = 1000
CPU = ["-mthumb", "-mcpu=cortex-m0"]

HARNESS = r"""
#include <stdint.h>
#include <stdio.h>
unsigned decide(const void *percept);
extern const unsigned char percepts[%(percepts)d][%(bytes)d];
extern const unsigned char wanted[%(percepts)d];
#define TIMER(offset) (*(volatile uint32_t *)(0x40008000u + (offset))) /* TIMER0 of the nRF51 */
static uint32_t now(void) {
    TIMER(0x040) = 1; /* capture */
    return TIMER(0x540);
}
static unsigned idle(const void *percept) { return (unsigned)(uintptr_t)percept; }
static unsigned wrong;
static volatile unsigned sink;
static uint32_t run(unsigned (*volatile act)(const void *), int check) {
    unsigned (*const call)(const void *) = act;
    TIMER(0x508) = 3; /* 32 bits, */
    TIMER(0x510) = 0; /* of 62.5 ns each */
    TIMER(0x000) = 1; /* start */
    uint32_t start = now();
    for (int i = 0; i < %(percepts)d; i++)
        sink = call(percepts[i]);
    uint32_t ticks = now() - start;
    for (int i = 0; check && i < %(percepts)d; i++)
        wrong += call(percepts[i]) != wanted[i];
    return ticks;
}
int main(void) {
    uint32_t none = run(idle, 0), all = run(decide, 1);
    /* 62.5 ns a tick, 64 ns an instruction; idle() itself is one return. */
    printf("%%u %%ld\n", wrong, ((long)all - (long)none) / 128 * 125);
    return 0;
}
"""


def learn(program, folder):
    report, header = folder / "report.json", folder / "maze.h"
    subprocess.run([program, "binary", "--json", report, "--export-c", header], check=True,
                   stdout=subprocess.DEVNULL)
    nodes = json.loads(report.read_text())["policy"]["nodes"]
    return {node["node"]: node for node in nodes}, header.read_text()


def nested(nodes, at):
    """The tree below node `at` as nested tuples (bit, absent, present), or an action."""
    node = nodes[at]
    if "class" in node:
        return node["action"]
    return (int(node["test"].split()[1]), nested(nodes, node["absent"]),
            nested(nodes, node["present"]))


def leaves(tree):
    return leaves(tree[1]) + leaves(tree[2]) if isinstance(tree, tuple) else 1


def act(tree, percept):
    while isinstance(tree, tuple):
        tree = tree[2] if percept >> tree[0] & 1 else tree[1]
    return tree


def classifier(tree, threshold):
    """scikit-learn's form of a tree, node by node: fitted on something else, then given this state."""
    model = DecisionTreeClassifier()
    model.fit(np.eye(4, BITS, dtype=np.float32), np.arange(4))
    state = model.tree_.__getstate__()
    dtype = state["nodes"].dtype
    rows, values = [], []

    def add(node, depth):
        index = len(rows)
        rows.append(None)
        values.append(np.zeros((1, 4)))
        if isinstance(node, tuple):
            left = add(node[1], depth + 1)
            right = add(node[2], depth + 1)
            rows[index] = (left, right, node[0], threshold, 0.5, 2, 2.0, 0)
        else:
            values[index][0, node] = 1.0
            rows[index] = (-1, -1, -2, -2.0, 0.0, 1, 1.0, 0)
        return index

    add(tree, 0)
    model.tree_ = Tree(BITS, np.array([4], dtype=np.intp), 1)
    model.tree_.__setstate__({"max_depth": BITS, "node_count": len(rows),
                              "nodes": np.array(rows, dtype=dtype), "values": np.array(values)})
    return model


def by_emlearn(tree):
    # The threshold is compared as an integer, with "less than".
    text = emlearn.convert(classifier(tree, 1.0), method="inline", dtype="int16_t").save(
        name="t", format="c")
    text = text[:text.index("int32_t t_predict(")] if "int32_t t_predict(" in text else text
    return text + "\nunsigned decide(const void *f) { return (unsigned)t_tree_0(f, 18); }\n", "int16_t"


def by_m2cgen(tree):
    text = m2cgen.export_to_c(classifier(tree, 0.5))
    return text + """
unsigned decide(const void *f) {
    double scores[4]; unsigned best = 0;
    score((double *)f, scores);
    for (unsigned a = 1; a < 4; a++) if (scores[a] > scores[best]) best = a;
    return best;
}
""", "double"


def by_rlvc(header):
    return header + "\nunsigned decide(const void *percept) { return maze_act(percept); }\n", "bits"


def table(percepts, form):
    if form == "bits":
        return "".join("{%s}," % ",".join(str(p >> 8 * i & 255) for i in range(3)) for p in percepts), 3
    dtype = np.dtype({"int16_t": "<i2", "double": "<f8"}[form])
    rows = []
    for p in percepts:
        raw = np.array([p >> b & 1 for b in range(BITS)], dtype).tobytes()
        rows.append("{%s}," % ",".join(str(byte) for byte in raw))
    return "".join(rows), BITS * dtype.itemsize


def measure(text, form, percepts, wanted, folder):
    """Bytes of code and constants, and instructions a decision."""
    def compiler(*arguments):
        subprocess.run(["arm-none-eabi-gcc", "-std=c99", "-Os", "-w", *CPU, "--specs=picolibc.specs",
                        *map(str, arguments)], check=True)
    (folder / "policy.c").write_text(text)
    compiler("-ffunction-sections", "-fdata-sections", "-c", folder / "policy.c", "-o", folder / "policy.o")
    rows, size = table(percepts, form)
    (folder / "main.c").write_text(HARNESS % {"percepts": len(percepts), "bytes": size} + (
        "const unsigned char percepts[%d][%d] __attribute__((aligned(8))) = {%s};\n"
        "const unsigned char wanted[%d] = {%s};\n") % (
            len(percepts), size, rows, len(percepts), ",".join(map(str, wanted))))
    image = folder / "image.elf"
    linked = ["--crt0=semihost", "--oslib=semihost", "-Wl,--gc-sections", "-Wl,--defsym=__flash=0",
              "-Wl,--defsym=__flash_size=0x40000", "-Wl,--defsym=__ram=0x20000000",
              "-Wl,--defsym=__ram_size=0x4000", "-Wl,--defsym=__stack_size=0x800"]
    compiler(*linked, "-Wl,-Map=%s" % (folder / "map"), folder / "main.c", folder / "policy.o", "-o", image)
    out = subprocess.run(["qemu-system-arm", "-M", "microbit", "-nographic", "-monitor", "none",
                          "-serial", "none", "-chardev", "stdio,id=s0", "-semihosting-config",
                          "enable=on,target=native,chardev=s0", "-icount", "shift=6,sleep=off",
                          "-kernel", str(image)], check=True, capture_output=True, text=True,
                         timeout=120).stdout
    wrong, instructions = map(int, out.split())
    if wrong:
        sys.exit(f"{wrong} of {len(percepts)} decisions differ from the tree's")
    # What the policy brings into the image: its own sections, and what of the C library it alone needs.
    bare = folder / "bare.elf"
    (folder / "none.c").write_text("unsigned decide(const void *p) { return p != 0; }\n")
    compiler(*linked, folder / "main.c", folder / "none.c", "-o", bare)
    return flash(image) - flash(bare), instructions / len(percepts)


def flash(image):
    out = subprocess.run(["arm-none-eabi-size", str(image)], check=True, capture_output=True, text=True).stdout
    text, data = re.findall(r"\d+", out.splitlines()[1])[:2]
    return int(text) + int(data)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", help="the run_gridworld that was built")
    args = parser.parse_args()
    percepts = [int(p) for p in np.random.default_rng(1).integers(0, 1 << BITS, PERCEPTS)]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        nodes, header = learn(args.program, folder)
        tree = nested(nodes, 0)
        wanted = [act(tree, p) for p in percepts]
        contenders = [("rlvc", by_rlvc(header)), ("emlearn", by_emlearn(tree)),
                      ("m2cgen", by_m2cgen(tree))]
        print(f"{leaves(tree)} leaves, Cortex-M0, -Os     bytes   instructions a decision")
        for name, (text, form) in contenders:
            size, instructions = measure(text, form, percepts, wanted, folder)
            print(f"  {name:24}{size:9}{instructions:12.1f}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
