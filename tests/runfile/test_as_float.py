"""Columns of any kind as numbers: what is not there is NaN, wherever in the column it is."""

from __future__ import annotations

import numpy as np
import pyarrow as pa
import pytest

from rig.runfile.columns import as_float

THIRDS = pa.array([float(i) if i % 3 else None for i in range(99)])


@pytest.mark.parametrize(
    "column",
    [
        pa.chunked_array([[1.0, None, 3.0], [], [None, None]], pa.float64()),
        pa.chunked_array([THIRDS.slice(11, 70), THIRDS.slice(98), THIRDS]),
        pa.chunked_array([pa.array(range(100)).slice(7, 60), pa.array([None] * 3, pa.int64())]),
        pa.chunked_array([pa.array([None, None], pa.null())]),
        pa.chunked_array([pa.array([1, None, 2], pa.uint8()), pa.array([1, 2], pa.uint8())]),
        pa.chunked_array([pa.array([0.5, None], pa.float32())]),
        pa.chunked_array([pa.array([True, None, False])]),
        pa.chunked_array([], pa.float64()),
    ],
    ids=["float64", "slices", "integers", "nothing", "bytes", "float32", "flags", "no rows"],
)
def test_every_value_is_in_its_place_and_what_is_missing_is_nan(column: pa.ChunkedArray) -> None:
    expected = [np.nan if value is None else float(value) for value in column.to_pylist()]
    np.testing.assert_array_equal(as_float(column), np.array(expected, dtype=float))


def test_text_is_refused() -> None:
    with pytest.raises(pa.ArrowException):
        as_float(pa.chunked_array([pa.array(["1.0 V"])]))
