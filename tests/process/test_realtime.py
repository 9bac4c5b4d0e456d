"""What is asked of the operating system for a run is given back after it."""

from __future__ import annotations

import ctypes
import gc

import pytest

from rig.process.realtime import PR_GET_TIMERSLACK, RealTime


def slack() -> int:
    return int(ctypes.CDLL(None).prctl(PR_GET_TIMERSLACK, 0, 0, 0, 0))


@pytest.mark.parametrize("collects", [True, False])
def test_timer_slack_and_collection_are_as_they_were(collects: bool) -> None:
    before = gc.isenabled(), slack()
    try:
        (gc.enable if collects else gc.disable)()
        with RealTime():
            assert not gc.isenabled()
        assert gc.isenabled() is collects
        assert slack() == before[1]
    finally:
        (gc.enable if before[0] else gc.disable)()
