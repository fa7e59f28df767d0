#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes chi2.csv, chi2_critical.csv, chi2_table.csv, fisher_table.csv and real.csv beside itself.

The numbers come from mpmath with 60 digits and are checked against SciPy where doubles can hold them.
Every argument is a binary32 number, written so that it reads back exactly.
On Debian: python3-mpmath, python3-scipy.
"""
import csv
import fractions
import pathlib

import mpmath
import numpy
import scipy.special
import scipy.stats

mpmath.mp.dps = 60
HERE = pathlib.Path(__file__).parent
LEAST = 1.2e-38  # the least normal float, rounded up: relative bounds end there


def f32(x):
    return float(numpy.float32(x))


def write(name, header, rows):
    with open(HERE / name, "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(header)
        for row in rows:
            out.writerow([x if isinstance(x, int) else "%.9g" % x for x in row])


def upper(x, k):
    return mpmath.gammainc(mpmath.mpf(k) / 2, mpmath.mpf(x) / 2, mpmath.inf, regularized=True)


def log_upper(x, k):
    lower = mpmath.gammainc(mpmath.mpf(k) / 2, 0, mpmath.mpf(x) / 2, regularized=True)
    return mpmath.log1p(-lower) if lower < 0.5 else mpmath.log(upper(x, k))


DEGREES = (1, 2, 3, 4, 5, 7, 10, 20, 31, 64, 100, 127, 128, 200, 254, 255)


def survival():
    shares = (1e-3, 0.03, 0.2, 0.5, 0.8, 0.9, 0.99, 1.01, 1.1, 1.3, 1.7, 2.5)
    statistics = (1e-6, 1e-4, 0.01, 0.1, 0.45, 0.46, 1, 3.84, 6.6349, 10.8276, 30, 60, 100, 130, 137,
                  200, 207, 209, 300, 500, 1e3, 5e3, 1e4, 1e5, 1e6, 1e7)
    for k in DEGREES:
        for x in sorted({f32(x) for x in statistics} | {f32(share * k) for share in shares} | {k}):
            p, log_p = upper(x, k), log_upper(x, k)
            if p > 1e-290:
                assert abs(scipy.special.gammaincc(k / 2, x / 2) / p - 1) < 1e-10
            yield k, x, float(p) if p > LEAST else 0.0, float(log_p) if -log_p > LEAST else 0.0


def critical():
    for k in DEGREES:
        for p in (1 - 2.0**-24, 0.9999, 0.99, 0.95, 0.9, 0.5, 0.317, 0.1, 0.05, 0.01, 1e-3, 1e-4, 1e-6,
                  1e-9, 1e-15, 1e-22, 1.0001e-30):
            p = f32(p)
            near = float(scipy.stats.chi2.isf(p, k))
            x = mpmath.findroot(lambda x: log_upper(x, k) - mpmath.log(p), near)
            assert abs(near / x - 1) < 1e-6
            yield k, p, float(x)


def table():
    most = 2**31 - 1
    tables = [(10, 20, 30, 40), (1, 0, 0, 1), (3, 1, 4, 1), (0, 5, 7, 0), (100, 100, 100, 100),
              (500000, 500001, 500002, 500000), (most - 3, 1, 1, 1), (1, most - 3, 1, 1),
              (most // 2, 0, 0, most // 2 + 1), (0, most // 2, most // 2 + 1, 0),
              (536870911, 536870912, 536870912, 536870912), (1000000000, 1, 1000000000, 3),
              (46341, 46340, 46339, 46342), (0, 0, 3, 4), (3, 4, 0, 0), (0, 3, 0, 4), (3, 0, 4, 0),
              (0, 0, 0, 0), (most, 0, 0, 0)]
    for a, b, c, d in tables:
        lines = (a + b) * (c + d) * (a + c) * (b + d)
        x = fractions.Fraction((a + b + c + d) * (a * d - b * c) ** 2, lines) if lines else 0
        if lines:
            scipys = scipy.stats.chi2_contingency([[a, b], [c, d]], correction=False)[0]
            assert abs(scipys - x) <= 1e-6 * x + 1e-6
        yield a, b, c, d, float(x)


def hypergeometric(x, r, c, n):
    f = mpmath.factorial
    return f(r) * f(n - r) * f(c) * f(n - c) / (f(n) * f(x) * f(r - x) * f(c - x) * f(n - r - c + x))


def fisher():
    """All tables of up to 9 samples in steps, and larger ones up to the greatest expected count, near the
    mean and far off it."""
    tables = [(a, b, c, d) for a in (0, 1, 3) for b in (0, 1, 2) for c in (0, 2) for d in (1, 3)]
    rng = numpy.random.default_rng(6)
    while len(tables) < 300:
        n = int(2 ** rng.uniform(2, 12))
        r, c = (int(x) for x in rng.integers(1, n, 2))
        if min(r, n - r) * min(c, n - c) <= 25 * n:
            low, high = max(0, r + c - n), min(r, c)
            near = int(rng.hypergeometric(r, n - r, c))
            x = int(rng.integers(low, high + 1)) if len(tables) % 3 == 0 else near
            tables.append((x, r - x, c - x, n - r - c + x))
    most = 2**31 - 1
    tables += [(3, 7, 12, most - 22), (0, 9, 2**28, 2**30), (0, 0, 3, 4), (9, 0, 0, most - 9),
               (25, 25, 25, 25), (40, 10, 10, 40), (49, 1, 1, 49)]
    for a, b, c, d in tables:
        n, rows, columns = a + b + c + d, a + b, a + c
        low, high = max(0, rows + columns - n), min(rows, columns)
        side = range(a, high + 1) if a * d >= b * c else range(low, a + 1)
        p = min(mpmath.mpf(1), 2 * mpmath.fsum(hypergeometric(x, rows, columns, n) for x in side))
        if n < 5000:
            law = scipy.stats.hypergeom(n, rows, columns)
            tail = law.sf(a - 1) if a * d >= b * c else law.cdf(a)
            assert abs(min(1, 2 * tail) / p - 1) < 1e-6
        yield a, b, c, d, float(p) if p > LEAST else 0.0, float(mpmath.log(p)) if p < 1 else 0.0


def real():
    """Logarithms over the normal floats, dense about 1; exp down to the least float."""
    functions = {"ln": mpmath.log, "sqrt": mpmath.sqrt}
    about_1 = [1 + sign * 2.0**-n for n in range(1, 24) for sign in (1, -1)]
    wide = [1.7**n for n in range(-164, 167, 3)] + [2.0**n for n in (-126, -1, 0, 1, 127)]
    for name, function in functions.items():
        for x in sorted({f32(x) for x in about_1 + wide}):
            yield name, x, float(function(mpmath.mpf(x)))
    for x in sorted({f32(1.25**n) for n in range(-80, 21)} | {0.0, 87.0, 95.0, 102.0, 103.5, 104.5}):
        y = mpmath.exp(-mpmath.mpf(x))
        yield "exp", -x, float(y)
    for q in sorted({f32(1.25**n) for n in range(-380, 0)} | {0.0, 0.25, f32(0.2499999), 0.9999}):
        yield "ln_1_minus", f32(q), float(mpmath.log1p(-mpmath.mpf(f32(q))))


def write_real():
    with open(HERE / "real.csv", "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        names = ("ln", "sqrt", "exp", "ln_1_minus")
        out.writerow(["function (" + " ".join(f"{i} {n}" for i, n in enumerate(names)) + ")", "x", "y"])
        for name, x, y in real():
            out.writerow([names.index(name), "%.9g" % x, "%.12g" % y])


if __name__ == "__main__":
    write("chi2.csv", ["degrees", "statistic", "p (0 if subnormal)", "log_p (0 if subnormal)"],
          survival())
    write("chi2_critical.csv", ["degrees", "p", "statistic"], critical())
    write("fisher_table.csv", ["a", "b", "c", "d", "p (0 if subnormal)", "log_p"], fisher())
    write("chi2_table.csv", ["a", "b", "c", "d", "statistic"], table())
    write_real()
