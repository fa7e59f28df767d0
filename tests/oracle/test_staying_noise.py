# SPDX-License-Identifier: MIT
"""Noise that stays, cycles or goes along with other noise is not taken for structure."""
import pytest

import staying_noise


@pytest.mark.parametrize("noise", staying_noise.NOISE)
@pytest.mark.parametrize("seed", [1000, 1001, 1002])
def test_noise(noise, seed):
    assert staying_noise.run(noise, seed) == (1.0, 11, 0)
