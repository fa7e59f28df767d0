# SPDX-License-Identifier: MIT
"""Run by tools/test with nothing installed but the wheel and numpy, and with no program to be found.

plain.py seeing|blind       a wheel that was made with vision, or without
"""

import contextlib
import shutil
import sys

import numpy as np

import rlvc

assert shutil.which("gcc") is None
agent = rlvc.Agent(3, 2)
agent.begin(bytes([5]))
agent.observe(agent.act(), 1.0, None, terminated=True)
assert agent.learn().done

random = np.random.default_rng(1)
numbers, actions = random.random((500, 1)), random.integers(2, size=500)
run = rlvc.learn_from({
    "observations": numbers, "next_observations": numbers, "actions": actions,
    "rewards": ((numbers[:, 0] > 0.5) == actions) * 1.0, "terminated": np.ones(500, bool),
})  # fmt: skip
assert [run.act(np.array([x])) for x in (0.1, 0.9)] == [0, 1]

missing = {"envs": "rlvc[gym]", "plot": "rlvc[plot]"}
if sys.argv[1] == "seeing":
    from rlvc import vision

    extractor = vision.Extractor(points=5)
    agent = rlvc.Agent(extractor.domain(radius=0.5), 2)
    agent.begin(extractor.extract(random.integers(256, size=(40, 40, 3), dtype=np.uint8)))
else:
    missing["vision"] = "libopencv-dev"

for module, wanted in missing.items():
    said = ""
    with contextlib.suppress(ModuleNotFoundError):
        try:
            __import__(f"rlvc.{module}")
        except ImportError as error:
            said = str(error)
    assert wanted in said, (module, said)
print(f"imports and learns with numpy alone, {sys.argv[1]}")
