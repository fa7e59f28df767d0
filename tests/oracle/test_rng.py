# SPDX-License-Identifier: MIT
"""The random numbers' second implementation: it is PCG, and tests/golden/rng.csv is what it gives."""
import csv
import importlib.util
import pathlib

GOLDEN = pathlib.Path(__file__).parent.parent / "golden"


def second_implementation():
    spec = importlib.util.spec_from_file_location("make_rng", GOLDEN / "make_rng.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_is_pcg():
    """The numbers that the generator's author publishes for state 42 and sequence 54."""
    generator = second_implementation().Pcg32(0, increment=2 * 54 + 1)
    generator.next()
    generator.state += 42
    generator.next()
    published = [0xA15C02B7, 0x7B47F409, 0xBA1D3330, 0x83D2F293, 0xBFA4784B, 0xCBED606E]
    assert [generator.next() for _ in published] == published


def test_golden_file_is_current():
    make_rng = second_implementation()
    with open(GOLDEN / "rng.csv", newline="") as file:
        header, *rows = csv.reader(file)
    assert tuple(header) == make_rng.HEADER
    assert [tuple(map(int, row)) for row in rows] == list(make_rng.rows())
