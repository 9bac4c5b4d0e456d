"""What drivers tell of their latch times ends in timing.json, channel by channel."""

from __future__ import annotations

import pytest

from rig.bench import read
from rig.timing.latching import LatchOffsets
from rig.timing.ticks import LoopTiming
from tests.drivers.running import run
from tests.drivers.virtual import wired


def test_mean_and_scatter_are_those_of_the_rows() -> None:
    offsets = LatchOffsets()
    for value in (1e-3, 3e-3, 2e-3):
        offsets.add(value)
    told = offsets.summary()
    assert told["mean"] == pytest.approx(2e-3)
    assert told["deviation"] == pytest.approx(1e-3)
    assert told["rows"] == 3


def test_a_channel_the_bench_lacks_tells_nothing() -> None:
    rig = read("twin").open("virtual")
    assert rig.told() == {}


@pytest.mark.slow
def test_devices_that_latch_at_one_sync_tell_no_offset_and_each_run_counts_anew() -> None:
    w = wired()
    w.instruments.connect()
    timing = LoopTiming(1e-3, virtual=True)
    for _ in range(2):
        _, sink = run(w, timing=timing)
        told = timing.summary()["latch_offsets"]
        assert set(told) == {"theta_l", "tau_l"}
        assert told["theta_l"]["mean"] == pytest.approx(0.0, abs=1e-6)
        assert told["theta_l"]["rows"] == len(sink.rows)
    w.instruments.close()
