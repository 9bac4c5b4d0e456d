"""Missed ticks: rows that do not tell of the gear are told from those that do, however the rows come."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from rig.console.sofar import SoFar
from rig.core.channels import Flag
from rig.live.calm import AWAY, SETTLES, Calm
from rig.live.view.folded import Folded
from tests.live.view.kept import Kept, turning

PERIOD = 1e-3  # s
PEAK = 40.0  # arcsec, zero to peak, of order 2
SPEED = 1.0  # rad/s of the motor: 9.6 rpm
ARCSEC = np.pi / 180 / 3600
Array = np.ndarray[Any, Any]


def stalled(rows: int, at: int, away: float) -> tuple[Array, Array]:
    """Times and bits at 1 kHz; before row `at` the host was away for `away` s, that row still has the old angles."""
    t, flags = np.arange(rows) * PERIOD, np.zeros(rows, np.int64)
    t[at:] += away
    t[at] = t[at - 1]
    flags[at] = Flag.MISSED | Flag.STALE_M | Flag.STALE_L
    return t, flags


@pytest.mark.parametrize("pieces", [1, 7, 900])
def test_after_a_stall_nothing_is_told_until_the_gear_has_settled(pieces: int) -> None:
    t, flags = stalled(2000, at=500, away=0.04)
    calm = Calm()
    told = np.concatenate([calm.of(t[part], flags[part]) for part in np.array_split(np.arange(2000), pieces)])
    assert told[:500].all()
    assert not told[500 : 501 + round(SETTLES / PERIOD)].any()
    assert told[501 + round(SETTLES / PERIOD) :].all()


def test_a_few_ticks_missed_cost_no_more_than_their_own_rows() -> None:
    t, flags = stalled(1000, at=500, away=AWAY - 5 * PERIOD)
    assert np.flatnonzero(~Calm().of(t, flags)).tolist() == [500]


@pytest.mark.parametrize("old", [Flag.STALE_M, Flag.STALE_L])
def test_a_row_of_which_only_one_angle_is_new_tells_nothing(old: Flag) -> None:
    flags = np.zeros(50, np.int64)
    flags[20] = old
    assert np.flatnonzero(~Calm().of(np.arange(50) * PERIOD, flags)).tolist() == [20]


def test_a_slow_encoder_is_not_a_host_that_was_away() -> None:
    flags = np.full(1000, int(Flag.STALE_L), np.int64)
    flags[::50] = 0
    assert Calm().of(np.arange(1000) * PERIOD, flags).sum() == 20


def _played(away: float) -> Array:
    """Four slow turns, in the third of which the host is away: the first row back has a new load angle and the motor
    angle of before; then the motor is pulled back to its reference, which winds the gear up by 100 arcsec.
    """
    n = round(4.2 * 2 * np.pi / SPEED / PERIOD)
    names = ("t", "theta_m", "theta_l", "theta_ref")
    rows = np.zeros(n, [*((name, "f8") for name in names), ("flags", "i8")])
    rows["t"] = np.arange(n) * PERIOD
    at = round(2.75 * 2 * np.pi / SPEED / PERIOD)
    rows["t"][at:] += away
    rows["theta_m"] = SPEED * rows["t"]
    after = rows["t"] - rows["t"][at]
    rung = np.where(after > 0, 100.0 * np.exp(-after / 0.1), 0.0) if away > AWAY else 0.0
    rows["theta_l"] = rows["theta_m"] / 50 - (PEAK * np.cos(2 * rows["theta_m"]) + rung) * ARCSEC
    rows["theta_m"][at] = rows["theta_m"][at - 1]
    rows["flags"][at] = Flag.MISSED | Flag.STALE_M
    return rows


@pytest.mark.parametrize("away", [0.012, 0.05, 0.3])  # s
def test_missed_ticks_make_no_spike_of_the_figure_on_the_page(away: float) -> None:
    so_far, rows, shown = SoFar(50.0), _played(away), []
    raw = (rows["theta_m"] / 50 - rows["theta_l"]) / ARCSEC
    assert np.ptp(raw) > 2 * PEAK + 20.0  # the spike is in the rows
    for part in np.array_split(rows, 600):
        so_far.add(part)
        shown.append(so_far.peak_to_peak)
    told = [peak for peak in shown if peak is not None]
    assert told
    assert told == pytest.approx([2 * PEAK] * len(told), rel=2e-3)


def test_missed_ticks_make_no_spike_in_the_live_view() -> None:
    rows = turning(5.5, PEAK)
    at = 4000
    rows.rows["theta_l"][at] += 200.0 * ARCSEC
    rows.rows["flags"][at] = Flag.MISSED | Flag.STALE_M
    canvas = Kept()
    Folded(50.0, "").add(rows, canvas)
    assert canvas.shown["/folded/peak"] == ["last turn 80.0 arcsec peak to peak"]
    assert canvas.shown["/folded/frame/numbers"][9:] == _numbers()


def _numbers() -> list[str]:
    """Of the same picture without the row."""
    canvas = Kept()
    Folded(50.0, "").add(turning(5.5, PEAK), canvas)
    return list(canvas.shown["/folded/frame/numbers"][9:])
