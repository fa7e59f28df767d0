# SPDX-License-Identifier: MIT
"""The chi-square distribution and Fisher's test against SciPy, densely."""
import ctypes
import os

import numpy
import pytest
import scipy.special
import scipy.stats

LIBRARY = ctypes.CDLL(os.environ["RLVC_TESTING_LIB"])
FLOAT_P = ctypes.POINTER(ctypes.c_float)
LIBRARY.rlvc_chi2_survival.argtypes = [ctypes.c_float, ctypes.c_uint32, FLOAT_P, FLOAT_P]
LIBRARY.rlvc_chi2_critical.argtypes = [ctypes.c_float, ctypes.c_uint32, FLOAT_P]
LEAST_NORMAL = 1.2e-38
BOUND = 1e-5  # the header's promise


def survival(statistics, degrees):
    p, log_p = ctypes.c_float(), ctypes.c_float()
    results = []
    for x in statistics:
        assert LIBRARY.rlvc_chi2_survival(x, degrees, p, log_p) == 0
        results.append((p.value, log_p.value))
    return numpy.array(results).T


def all_near(got, wanted, relative=BOUND):
    return numpy.max(numpy.abs(got - wanted) / numpy.abs(wanted)) <= relative


@pytest.mark.parametrize("degrees", [*range(1, 16), *range(16, 256, 17), 254])
def test_survival(degrees):
    rng = numpy.random.default_rng(degrees)
    x = numpy.concatenate([10 ** rng.uniform(-6, 3.1, 1000), rng.uniform(0.3, 1.6, 1000) * degrees])
    x = x.astype(numpy.float32).astype(float)
    p, log_p = survival(x, degrees)

    upper = scipy.special.gammaincc(degrees / 2, x / 2)
    lower = scipy.special.gammainc(degrees / 2, x / 2)
    assert all_near(p[upper >= 1e-30], upper[upper >= 1e-30])
    held = (upper > 1e-290) & (lower > LEAST_NORMAL)  # by a double, by a normal float
    log_upper = numpy.where(lower < 0.5, numpy.log1p(-numpy.minimum(lower, 0.5)),
                            numpy.log(numpy.maximum(upper, 1e-300)))
    assert all_near(log_p[held], log_upper[held])


@pytest.mark.parametrize("degrees", [1, 2, 3, 10, 77, 255])
def test_critical(degrees):
    statistic = ctypes.c_float()
    for p in (10.0 ** numpy.linspace(-29.9, -0.01, 200)).astype(numpy.float32):
        assert LIBRARY.rlvc_chi2_critical(float(p), degrees, statistic) == 0
        wanted = 2 * scipy.special.gammainccinv(degrees / 2, float(p))
        assert statistic.value == pytest.approx(wanted, rel=BOUND)


def test_fisher():
    """All tables whose sums are small, against SciPy."""
    LIBRARY.rlvc_fisher_table.argtypes = [ctypes.c_uint32] * 4 + [FLOAT_P, FLOAT_P]
    p, log_p = ctypes.c_float(), ctypes.c_float()
    for a, b, c, d in numpy.ndindex(7, 7, 7, 7):
        assert LIBRARY.rlvc_fisher_table(a, b, c, d, p, log_p) == 0
        law = scipy.stats.hypergeom(a + b + c + d, a + b, a + c)
        wanted = min(1, 2 * (law.sf(a - 1) if a * d >= b * c else law.cdf(a)))
        assert p.value == pytest.approx(wanted, rel=BOUND), (a, b, c, d)
        assert log_p.value == pytest.approx(numpy.log(wanted), abs=BOUND), (a, b, c, d)
