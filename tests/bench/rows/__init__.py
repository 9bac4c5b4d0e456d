"""The rows of the table, in its order."""

from __future__ import annotations

from tests.bench.row import Row
from tests.bench.rows.can_cycle import CanCycle
from tests.bench.rows.commands import Commands
from tests.bench.rows.day import Day
from tests.bench.rows.fit import Fit
from tests.bench.rows.live import LiveView
from tests.bench.rows.plant import Plant
from tests.bench.rows.recording import Recording
from tests.bench.rows.resampling import Resampling
from tests.bench.rows.solvers import Solvers
from tests.bench.rows.sweep import Sweep
from tests.bench.rows.tick import Tick
from tests.bench.rows.trace import Trace
from tests.bench.rows.wake import WakeUp

ROWS: tuple[type[Row], ...] = (
    WakeUp,
    Tick,
    CanCycle,
    Plant,
    Solvers,
    Sweep,
    Fit,
    Resampling,
    Trace,
    Recording,
    LiveView,
    Commands,
    Day,
)
