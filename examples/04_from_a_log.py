#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Introduces learning from a log, without an environment: a heater, switched at random in a cold room.

An observation is the temperature and the price of a kilowatt-hour. Heating costs the price; a
temperature below 18 degrees costs 5, and one above 24 costs 1. What is learnt is when to heat.
"""

import pathlib
import tempfile

import numpy as np

import rlvc

random = np.random.default_rng(1)
lines = ["temperature,price,action,reward,terminated"]
temperature = 20.0
for _ in range(8000):
    price, heat = random.choice([0.2, 1.5]), int(random.integers(2))
    reward = -price * heat - 5 * (temperature < 18) - 1 * (temperature > 24)
    lines.append(f"{temperature:.2f},{price},{heat},{reward:.2f},0")
    temperature += (1.2 if heat else -1.0) + random.normal(0, 0.2)
    temperature = float(np.clip(temperature, 14, 28))

with tempfile.TemporaryDirectory() as folder:
    file = pathlib.Path(folder) / "heater.csv"
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    run = rlvc.learn_from(file, columns=["temperature", "price"], discount=0.9)

print(run.text())
for temperature, price in ((16.0, 1.5), (20.0, 0.2), (27.0, 1.5)):
    heat = run.act(np.array([temperature, price]))
    print(f"{temperature} degrees, price {price}: {'heat' if heat else 'wait'}")
