# SPDX-License-Identifier: MIT
"""The rank-sum statistic: the core against method.py, that against SciPy, and its p-values against chance."""
import ctypes

import numpy
import pytest
import scipy.stats

import binding
import method

Ranks = binding.struct("Ranks", sum=binding.U64, cubes=binding.U64, begin=binding.U32, inside=binding.U32)
binding.LIBRARY.rlvc_rank_sum_add.argtypes = [binding.POINTER] + 3 * [binding.U32]
binding.LIBRARY.rlvc_rank_sum_add.restype = None
binding.LIBRARY.rlvc_rank_sum_statistic.argtypes = [binding.POINTER] + 2 * [binding.U32]
binding.LIBRARY.rlvc_rank_sum_statistic.restype = binding.FLOAT


def core(present, cuts):
    """The core's statistic."""
    begins = numpy.zeros(len(present), bool)
    begins[cuts] = True
    ranks = Ranks()
    for at in range(0, len(present), 32):
        words = (int.from_bytes(numpy.packbits(bits[at:at + 32], bitorder="little").tobytes(), "little")
                 for bits in (present, begins))
        binding.LIBRARY.rlvc_rank_sum_add(ctypes.byref(ranks), at, *words)
    return binding.LIBRARY.rlvc_rank_sum_statistic(ctypes.byref(ranks), int(present.sum()), len(present))


def draw(rng, count, levels, share):
    """Sorted targets of so many levels (0: all differ, negative: one is far more frequent), where clusters begin,
    and who shows the feature."""
    targets = rng.permutation(count) if levels == 0 else rng.integers(0, abs(levels), count)
    if levels < 0:
        targets[rng.random(count) < 0.9] = 1
    targets[:2] = 0, 1
    targets.sort()
    present = rng.random(count) < share
    present[rng.permutation(count)[:2]] = True, False
    return targets, method.cutpoints(targets, 0), present


@pytest.mark.parametrize("levels", [0, 2, 5, 100, -3, -100])
@pytest.mark.parametrize("count", [5, 40, 300, 3000])
@pytest.mark.parametrize("share", [0.5, 0.15, 0.97])
def test_statistic(count, levels, share):
    rng = numpy.random.default_rng([count, levels + 200, int(100 * share)])
    for _ in range(10):
        targets, cuts, present = draw(rng, count, levels, share)
        ours = method.rank_statistic(present, cuts)
        assert core(present, cuts) == pytest.approx(ours, rel=4e-6, abs=4e-6)
        deviation, variance, tau = method.rank_sum(present, cuts)
        known = scipy.stats.mannwhitneyu(targets[present], targets[~present], use_continuity=False,
                                         method="asymptotic")
        square = deviation**2 / variance
        assert scipy.stats.chi2.sf(square, 1) == pytest.approx(known.pvalue, rel=1e-9)
        assert ours <= square * (1 + 1e-9)
        if 2 * present.sum() == count or tau < 1e-4:
            assert ours == pytest.approx(square, rel=0.05)


# Sizes of the clusters, and how many samples show the feature.
CHANCES = [
    ([1] * 200, 3), ([1] * 200, 30), ([1] * 200, 100), ([100] + [1] * 100, 5), ([270] + [1] * 30, 5),
    ([15, 270, 15], 20), ([588, 12], 3), ([588, 12], 10), ([588, 12], 30), ([588, 12], 300),
    ([3, 294, 3], 10), ([180, 20], 5), ([150, 150], 20), ([200, 60, 30, 10], 20)]


@pytest.mark.parametrize("sizes, present", CHANCES)
def test_chance(sizes, present):
    """Were the feature to say nothing, p-values would be below 0.001 in no more than about as many cases."""
    rng = numpy.random.default_rng([present, *sizes])
    sizes, draws = numpy.array(sizes), 20000
    ends = numpy.cumsum(sizes)
    ranks = ends - (sizes - 1) / 2
    count, cubes = ends[-1], ((sizes / ends[-1]) ** 3).sum()
    shown = rng.multivariate_hypergeometric(sizes, present, size=draws, method="marginals")
    deviation = abs(shown @ ranks - present * (count + 1) / 2)
    variance = present * (count - present) / (count - 1) * (sizes @ (ranks - (count + 1) / 2) ** 2) / count
    jump = numpy.sqrt(((count - 2 * present) ** 2 + 1) * cubes) / 2
    u = jump * deviation / variance
    statistic = 2 * variance / jump**2 * ((1 + u) * numpy.log1p(u) - u)
    for level in (0.01, 0.001):
        found = (scipy.stats.chi2.sf(statistic, 1) < level).sum()
        assert found <= scipy.stats.binom.isf(1e-4, draws, 1.1 * level)


def test_jump():
    """The moments of ranks are such that Poisson's law with that jump has no shorter tails."""
    rng = numpy.random.default_rng(1)
    for _ in range(2000):
        shares = rng.dirichlet(numpy.full(rng.integers(2, 8), rng.choice([0.1, 0.3, 1, 3])))
        if rng.random() < 0.5:  # one part without ties
            shares = numpy.concatenate([shares[:1], numpy.full(200, shares[1] / 200), shares[2:]])
        ranks, tau = 2 * numpy.cumsum(shares) - shares - 1, (shares**3).sum()
        m2, m3, m4 = (shares @ ranks**k for k in (2, 3, 4))
        assert m2 == pytest.approx((1 - tau) / 3)
        assert abs(m3) <= m2 * numpy.sqrt(tau) * (1 + 1e-9) and m4 - 3 * m2**2 <= m2 * tau * (1 + 1e-9)


def test_chance_without_the_jump():
    """That is not so of z, by far: twice a reward of 2 in 100 for a feature of 3 in 600."""
    chance = scipy.stats.hypergeom(600, 12, 3).sf(1)
    z = (2 - 3 * 0.02) / numpy.sqrt(3 * 0.02 * 0.98 * 597 / 599)
    assert chance > 1e-3 and scipy.stats.chi2.sf(z**2, 1) < 1e-12
