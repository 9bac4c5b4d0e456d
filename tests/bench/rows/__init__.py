"""The rows of the table, in its order."""

from __future__ import annotations

from tests.bench.row import Row
from tests.bench.rows.fit import Fit
from tests.bench.rows.resampling import Resampling

ROWS: tuple[type[Row], ...] = (Fit, Resampling)
