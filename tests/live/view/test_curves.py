"""What is drawn over time."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.core.channels import Flag
from rig.live.view.block import of_ring
from rig.live.view.curves import Curves, measured_in, others, speed, thinned
from rig.live.view.lateness import Lateness
from tests.live.view.kept import ABOUT, Kept, block, turning


def sent(every: int) -> dict[str, np.ndarray]:
    canvas = Kept()
    rows = turning(3.0, 30.0)
    rows.rows["tau_l"][1234] = 55.5  # one row in eight thousand
    Curves(ABOUT, every).add(rows, canvas)
    return {path: values for path, _, values in canvas.sent}


def test_a_peak_of_one_row_is_drawn_at_its_full_height_however_much_is_left_out() -> None:
    assert sent(1)["/curves/shaft"].max() == 55.5
    thin = sent(400)["/curves/shaft"]
    assert len(thin) == 40
    assert thin.max() == 55.5


def test_the_error_is_formed_of_angles_of_one_moment_and_only_then_thinned() -> None:
    whole, thin = sent(1)["/curves/error"], sent(400)["/curves/error"]
    assert thin.max() == pytest.approx(30.0, abs=0.01)
    assert (thin.min(), thin.max()) == (whole.min(), whole.max())


def test_all_curves_of_a_unit_travel_as_one_vector() -> None:
    values = sent(1)
    assert values["/curves/angle"].shape == (8000, 3)
    assert values["/curves/motor"].shape == (8000, 3)


def test_times_never_run_back_when_rows_are_left_out() -> None:
    t, values = thinned(np.arange(1000) * 1e-3, np.random.default_rng(1).normal(size=(1000, 2)), 50)
    assert (np.diff(t) >= 0).all()
    assert values.shape == (40, 2)


def test_speeds_that_were_asked_of_the_drive_are_not_drawn_as_torques() -> None:
    rows = block(4, tau_ask=3.0, tau_applied=3.0, tau_m=0.1)
    drawn = of_ring(rows.rows, "velocity")
    assert np.isnan(drawn["tau_ask"]).all()
    assert (drawn["tau_m"] == 0.1).all()
    assert (of_ring(rows.rows, "torque")["tau_ask"] == 3.0).all()


def test_a_file_without_speed_gets_the_slope_of_its_angle() -> None:
    rows = block(100, theta_m=np.arange(100) * 2e-3)
    assert speed(rows) == pytest.approx(np.full(100, 2.0))


def test_curves_without_a_value_are_left_out() -> None:
    measured = measured_in(turning(1.0, 1.0), 50.0)
    assert measured("/curves/shaftτ_l")
    assert not measured("/curves/motorasked")


def test_lateness_is_counted_from_the_grid_and_not_from_the_row_before() -> None:
    late = Lateness(1e-3).add(np.array([0.0, 1e-3, 2.4e-3, 3e-3]), np.zeros(4, np.int64))
    assert late == pytest.approx([0.0, 0.0, 0.4e-3, 0.0])


def test_the_earliest_row_is_the_one_that_was_not_late() -> None:
    lateness = Lateness(1e-3)
    assert lateness.add(np.array([0.0005, 0.001, 0.002]), np.zeros(3, np.int64)) == pytest.approx([0.0005, 0, 0])
    assert lateness.add(np.array([0.0031]), np.zeros(1, np.int64)) == pytest.approx([0.0001])


def test_cycles_the_loop_left_out_are_not_counted_against_the_rows_that_follow() -> None:
    missed = np.array([0, 0, Flag.MISSED, 0, 0])  # 2.3 periods late: two deadlines were skipped
    late = Lateness(1e-3).add(np.array([0.0, 1e-3, 4.3e-3, 5e-3, 6e-3]), missed)
    assert late == pytest.approx([0.0, 0.0, 2.3e-3, 0.0, 0.0])


def test_rows_the_reader_never_saw_are_no_lateness_either() -> None:
    lateness = Lateness(1e-3)
    lateness.add(np.array([0.0, 1e-3]), np.zeros(2, np.int64))
    assert lateness.add(np.array([0.500, 0.501]), np.zeros(2, np.int64)) == pytest.approx([0.0, 0.0])


def test_without_a_period_nothing_is_said() -> None:
    assert np.isnan(Lateness(0.0).add(np.array([0.0, 0.1]), np.zeros(2, np.int64))).all()


def test_channels_the_table_lacks_are_drawn_with_their_own_units() -> None:
    more = others({"tau_current": "N·m", "bus": "V", "tau_other": "N·m"})
    assert [(one.unit, [curve.name for curve in one.curves]) for one in more] == [
        ("N·m", ["tau_current", "tau_other"]),
        ("V", ["bus"]),
    ]


def away_from_whole(periods: float) -> bool:
    """Whether a clock that rounds can tell which period this is in."""
    return periods < 1.0 or 1e-3 < periods % 1.0 < 1.0 - 1e-3


@pytest.mark.slow
@given(
    st.lists(st.one_of(st.floats(0.0, 0.75), st.floats(1.01, 40.0)).filter(away_from_whole), max_size=60),
    st.integers(1, 9),
)
def test_the_loops_own_lateness_is_found_again_from_its_rows(periods: list[float], piece: int) -> None:
    t, flags, k = [], [], 0
    for late in (0.0, *periods):  # in periods; the first row was in time
        t.append((k + late) * 1e-3)
        flags.append(int(Flag.MISSED) if late >= 1.0 else 0)
        k += 1 + (int(late) if late >= 1.0 else 0)
    lateness = Lateness(1e-3)
    pieces = range(0, len(t), piece)
    found = [lateness.add(np.array(t[i : i + piece]), np.array(flags[i : i + piece])) for i in pieces]
    assert np.concatenate(found) == pytest.approx(1e-3 * np.array([0.0, *periods]), abs=2e-7)


def test_nothing_is_drawn_across_rows_the_viewer_did_not_take_or_nobody_read() -> None:
    curves, heard, rows = Curves(ABOUT, 4), Kept(), turning(3.0, 30.0)
    pieces = list(rows.slices(500))
    for piece, canvas in zip(pieces[:6], (heard, heard, Kept(), heard, heard, heard), strict=True):
        curves.add(piece, canvas)
    curves.add(pieces[9], heard)
    breaks = [bool(np.isnan(values[0, 0])) for path, _, values in heard.sent if path == "/curves/error"]
    assert breaks == [False, False, True, False, False, True]
    times = np.concatenate([t for path, t, _ in heard.sent if path == "/curves/error"])
    assert (np.diff(times) >= 0).all()
