"""The picture of the error over one turn: known curves in, known curves and orders out."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Page

from tests.console.browser.look import in_state
from tests.console.browser.puppet import BENCH, RUN, Puppet
from tests.some import some

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("browser")]
SORT = """async ([angles, errors]) => {
  const { Turns } = await import('/static/js/charts/turns.js');
  const turns = new Turns();
  angles.forEach((angle, k) => turns.add(angle, errors[k]));
  const { forward, reverse } = turns.ways;
  return { forward: forward.curve(turns.level), reverse: reverse.curve(turns.level), level: turns.level,
           orders: forward.orders(15), turns: forward.revolutions, latest: turns.latest.map(one => one.way) };
}"""
C_2, PSI_2 = 39.6, -1.08  # arcsec, rad: the largest order of the twin
APART = 60.0  # arcsec between the two directions: the gear is wound up by its friction


def _stroke(step: float) -> tuple[np.ndarray, np.ndarray]:
    """Five turns forth and back, the error of order 2 on top of the wind-up, a stretch at rest at the end."""
    forth = np.arange(100.0, 1900.0, step)
    angle = np.concatenate((forth, forth[::-1], np.full(200, 100.0)))
    way = np.concatenate((np.ones(len(forth)), -np.ones(len(forth)), -np.ones(200)))
    error = C_2 * np.cos(2 * np.radians(angle) - PSI_2) + APART / 2 * way + 500.0
    return angle, error


def _sorted(page: Page, angle: np.ndarray, error: np.ndarray) -> dict[str, Any]:
    found: dict[str, Any] = page.evaluate(SORT, [angle.tolist(), error.tolist()])
    return found


@pytest.mark.parametrize("step", some([0.9, 0.12, 7.2], 1))  # deg between rows: 9.6 rpm, 75 rpm, 600 rpm
def test_both_directions_come_out_as_they_went_in(page: Page, step: float) -> None:
    found = _sorted(page, *_stroke(step))
    at = np.radians(np.arange(360) + 0.5)
    expected = C_2 * np.cos(2 * at - PSI_2)
    close = 1.5 + 0.6 * step  # arcsec: 0.7 arcsec per deg within a bin, and the straight line between rows
    assert np.max(np.abs(np.array(found["forward"]) - expected - APART / 2)) < close
    assert np.max(np.abs(np.array(found["reverse"]) - expected + APART / 2)) < close
    assert found["level"] == pytest.approx(500.0, abs=1.5)
    assert found["orders"][1] == pytest.approx(C_2, rel=0.02)
    assert max(c for n, c in enumerate(found["orders"]) if n != 1) < 0.5
    assert found["turns"] >= 4
    assert set(found["latest"]) == {"reverse"}


def test_the_gear_winding_up_the_other_way_at_the_turn_stays_out_of_the_mean(page: Page) -> None:
    angle, error = _stroke(0.12)
    turn = len(angle) // 2 - 100
    swing = np.linspace(0.0, 1.0, 300)
    ringing = 150.0 * np.cos(40 * swing) * np.exp(-3 * swing)  # while the motor stands
    angle = np.insert(angle, turn, np.full(300, angle[turn]))
    error = np.insert(error, turn, 500.0 + ringing)
    found = _sorted(page, angle, error)
    assert max(abs(x) for x in found["forward"] + found["reverse"] if x is not None) < C_2 + APART / 2 + 3


def test_rows_that_tell_nothing_of_the_gear_leave_no_trace_in_the_picture(page: Page) -> None:
    angle, error = _stroke(0.12)
    error[5000:5040] = np.nan  # 5° of the fourth turn, as after ticks that were missed
    found = _sorted(page, angle, error)
    at = np.radians(np.arange(360) + 0.5)
    expected = C_2 * np.cos(2 * at - PSI_2)
    assert np.max(np.abs(np.array(found["forward"]) - expected - APART / 2)) < 2.0


def test_a_motor_at_rest_draws_nothing_and_orders_wait_for_a_whole_turn(page: Page) -> None:
    rest = np.full(500, 12.0) + 0.02 * np.sin(np.arange(500))
    found = _sorted(page, rest, np.zeros(500))
    assert all(value is None for value in found["forward"] + found["reverse"])
    assert found["orders"] is None


def test_samples_are_drawn_and_a_locked_run_shows_torque_over_wind_up(page: Page, station: Puppet) -> None:
    station.tell(state="running", bench=BENCH, run=RUN)
    in_state(page, "running")
    page.wait_for_selector("#chart-picture .empty", state="visible")
    angle, error = _stroke(2.0)
    t = np.arange(len(angle)) * 0.03
    station.show({"t": t, "motor_angle": angle, "kinematic_error": error, "tau_l": 0 * t, "following": 0 * t})
    page.wait_for_selector("#chart-picture .empty", state="hidden")
    assert _inked(page, "#chart-picture .wave canvas") > 2000
    assert _inked(page, "#chart-orders canvas") > 500

    station.tell(run={**RUN, "uid": "u2", "locked": True})
    page.wait_for_selector("#chart-picture .loop", state="visible")
    twist = 400 * np.sin(t)
    station.show({"t": t, "motor_angle": 0 * t, "kinematic_error": twist, "tau_l": 10 * np.sin(t + 0.1)})
    page.wait_for_selector("#chart-picture .empty", state="hidden")
    assert _inked(page, "#chart-picture .loop canvas") > 1000


def test_a_frame_that_is_cut_short_or_of_another_kind_is_left_alone(
    page: Page, station: Puppet, wrong: list[str]
) -> None:
    station.tell(state="running", bench=BENCH, run=RUN)
    station.frames += [b"", b"\0" * 40, b"GDRH\x01\0\x0b\0\xff\xff\xff\x7f" + b"\0" * 100]
    station.show({"t": np.linspace(0, 1, 9), "speed": np.full(9, 9.6)})
    page.wait_for_selector("[data-tile=speed]:has-text('9.6')")
    assert wrong == []


def _inked(page: Page, canvas: str) -> int:
    """Pixels that are strongly coloured or dark: lines, not the grid."""
    page.wait_for_timeout(150)
    count: int = page.locator(canvas).evaluate(
        """canvas => {
          const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
          let n = 0;
          for (let k = 0; k < data.length; k += 4) if (data[k + 3] > 128 && Math.min(data[k], data[k + 2]) < 70) n++;
          return n;
        }"""
    )
    return count
