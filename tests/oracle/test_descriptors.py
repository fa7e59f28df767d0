# SPDX-License-Identifier: MIT
"""The domain of local descriptors against numpy: presence, and nearest vectors."""
import ctypes

import numpy
import pytest

from binding import LIBRARY, struct

Descriptors = struct("Descriptors", points=ctypes.c_uint32, dimensions=ctypes.c_uint32,
                     candidates=ctypes.c_uint32, draws=ctypes.c_uint32, radius=ctypes.c_float,
                     margin=ctypes.c_float, form=ctypes.c_uint8, reserved=ctypes.c_uint8 * 3)


def record(head, vectors, size, dtype):
    """uint32 count or float radius, vectors, zeros."""
    made = head.tobytes() + numpy.asarray(vectors, dtype).tobytes()
    return made + bytes(size - len(made))


@pytest.mark.parametrize("form, dtype", [(0, numpy.float32), (1, numpy.int8)])
@pytest.mark.parametrize("dimensions", [1, 8, 30, 128, 256])
def test_nearest(form, dtype, dimensions):
    random = numpy.random.default_rng(dimensions)
    points, described = 7, Descriptors()
    assert LIBRARY.rlvc_descriptors_default(ctypes.byref(described), points, dimensions, form,
                                        ctypes.c_float(10.0)) == 0
    width = dimensions * numpy.dtype(dtype).itemsize
    for count in range(1, points + 1):
        vectors = random.normal(0, 40, (points, dimensions)).clip(-127, 127).astype(dtype)
        wanted = random.normal(0, 40, dimensions).clip(-127, 127).astype(dtype)
        percept = record(numpy.uint32(count), vectors, 4 + (points * width + 3) // 4 * 4, dtype)
        feature = record(numpy.float32(1.0), wanted, 4 + (width + 3) // 4 * 4, dtype)
        point, squared = ctypes.c_uint32(), ctypes.c_float()
        assert LIBRARY.rlvc_descriptors_nearest(ctypes.byref(described), percept, feature,
                                                ctypes.byref(point), ctypes.byref(squared)) == 0
        expected = ((vectors[:count].astype(float) - wanted.astype(float)) ** 2).sum(axis=1)
        assert point.value == expected.argmin()
        assert squared.value == pytest.approx(expected.min(), rel=0 if form else 1e-5)
