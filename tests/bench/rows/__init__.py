"""The rows of the table, in its order."""

from __future__ import annotations

from tests.bench.row import Row
from tests.bench.rows.commands import Commands
from tests.bench.rows.fit import Fit
from tests.bench.rows.plant import Plant
from tests.bench.rows.resampling import Resampling

ROWS: tuple[type[Row], ...] = (Plant, Fit, Resampling, Commands)
