"""What a page is sent, and the figures of a run so far, from rows whose truth is known."""

from __future__ import annotations

import math
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rig.console import columns
from rig.console.columns import COLUMNS, HEADER, MAGIC, frame, of_reading, of_run
from rig.console.feed import Feed
from rig.console.link import Link
from rig.console.sofar import SoFar
from rig.core.channels import Flag

RATIO, ARCSEC = 50.0, math.pi / 180 / 3600
FIELDS = ("t", "theta_m", "theta_l", "omega_m", "tau_m", "tau_l", "tau_ask", "tau_applied", "theta_ref", "age")
PEAK = 40.0  # arcsec, zero to peak, of order 2


def rows(turns: float = 4.0, n: int = 4000, lag_deg: float = 0.5) -> np.ndarray[Any, Any]:
    """A motor that turns steadily, kinematic error of order 2, following its reference at a constant distance."""
    made = np.zeros(n, [*((name, "f8") for name in FIELDS), ("flags", "i8")])
    made["t"] = np.arange(n) * 1e-3
    made["theta_m"] = 1.0 + np.linspace(0.0, turns * 2 * math.pi, n)
    made["theta_l"] = made["theta_m"] / RATIO - PEAK * ARCSEC * np.cos(2 * made["theta_m"])
    made["theta_ref"] = made["theta_m"] + math.radians(lag_deg)
    made["omega_m"], made["age"] = math.pi, 2e-4
    return made


def test_the_units_are_those_that_are_announced() -> None:
    taken = rows()
    out = of_run(taken, RATIO, 0.0)
    units = dict(COLUMNS)
    assert out["motor_angle"][0] == pytest.approx(math.degrees(1.0))
    assert (units["speed"], out["speed"][5]) == ("rpm", pytest.approx(30.0))
    assert (units["following"], out["following"][9]) == ("deg", pytest.approx(0.5))
    assert np.ptp(out["kinematic_error"]) == pytest.approx(2 * PEAK, rel=1e-3)


def test_every_column_that_is_sent_is_drawn_and_none_is_what_was_asked_of_the_drive() -> None:
    page = "".join(path.read_text() for path in (Path(columns.__file__).parent / "static" / "js").rglob("*.js"))
    assert [name for name, _ in COLUMNS if f'"{name}"' not in page] == []
    assert not {name for name, _ in COLUMNS} & {"tau_ask", "tau_applied"}  # speeds or angles where the drive has a loop


def test_a_frame_can_be_read_by_its_description() -> None:
    block = of_run(rows(n=7), RATIO, 0.0)
    sent = frame(block, skipped=3)
    magic, version, width, n, skipped = HEADER.unpack_from(sent)
    assert (magic, version, width, n, skipped) == (MAGIC, 1, len(COLUMNS), 7, 3)
    assert len(sent) == 16 + 8 * 7 + 4 * 7 * len(COLUMNS)
    assert struct.unpack_from("<7d", sent, 16) == pytest.approx(block["t"])
    k = [name for name, _ in COLUMNS].index("speed")
    assert struct.unpack_from("<7f", sent, 16 + 8 * 7 + 4 * 7 * k) == pytest.approx(block["speed"])


def test_a_kinematic_error_of_an_arcsecond_survives_single_precision_after_a_thousand_turns() -> None:
    taken = rows()
    taken["theta_m"] += 2 * math.pi * 1000
    taken["theta_l"] += 2 * math.pi * 1000 / RATIO
    sent = of_run(taken, RATIO, 0.0)["kinematic_error"].astype("f4")
    assert np.ptp(sent) == pytest.approx(2 * PEAK, abs=0.1)


def test_what_nobody_measured_is_not_a_number_in_an_idle_reading() -> None:
    out = of_reading({"t": 3.0, "row": [1.0, None, 0.0, 0.1, None, 1e-3]})
    assert math.isnan(out["tau_l"][0])
    assert math.isnan(out["kinematic_error"][0])
    assert out["motor_angle"][0] == pytest.approx(57.29578)


@pytest.mark.parametrize("pieces", [1, 7, 400])
def test_peak_to_peak_and_following_do_not_depend_on_how_the_rows_come(pieces: int) -> None:
    so_far = SoFar(RATIO)
    for part in np.array_split(rows(), pieces):
        so_far.add(part)
    assert so_far.peak_to_peak == pytest.approx(2 * PEAK, rel=1e-3)
    assert so_far.following == pytest.approx(0.5)
    assert so_far.newest == pytest.approx(3.999)


def test_a_turn_that_was_not_passed_whole_says_nothing() -> None:
    so_far = SoFar(RATIO)
    so_far.add(rows(turns=0.9, n=900))
    assert so_far.peak_to_peak is None


def test_a_turn_in_which_the_motor_turned_back_does_not_count() -> None:
    forth = rows(turns=0.6, n=600)
    back = forth[::-1].copy()
    so_far = SoFar(RATIO)
    for part in (forth, back, forth):
        so_far.add(part)
    assert so_far.peak_to_peak is None


def test_a_turn_just_after_a_reversal_does_not_count_while_it_still_rings() -> None:
    forth = rows(turns=2.0 - 1.0 / (2 * math.pi) + 0.02, n=2000)  # 7° into the third turn, then back
    back = rows(turns=1.2, n=1200)
    for name in ("theta_m", "theta_l", "theta_ref"):
        back[name] += forth[name][-1] - back[name][-1]
    back = back[::-1].copy()
    back["theta_l"][100:140] += 100.0 * ARCSEC  # 30° after the reversal, in the next turn
    so_far = SoFar(RATIO)
    so_far.add(forth)
    so_far.add(back)
    assert so_far.peak_to_peak == pytest.approx(2 * PEAK, rel=1e-3)  # the turn before the reversal


def test_without_a_reference_nothing_is_said_of_following() -> None:
    taken = rows()
    taken["theta_ref"] = np.nan
    so_far = SoFar(RATIO)
    so_far.add(taken)
    assert so_far.following is None


class Rowed:
    """A ring's tail with these rows."""

    skipped = 0

    def __init__(self, taken: np.ndarray[Any, Any]) -> None:
        self.taken = taken

    def read(self) -> np.ndarray[Any, Any]:
        return self.taken


def test_a_page_is_sent_no_error_of_rows_whose_angles_are_of_two_moments() -> None:
    taken = rows(turns=0.01, n=40)
    taken["theta_l"][20:24] += 300.0 * ARCSEC
    taken["flags"][20:24] = Flag.STALE_M
    feed = Feed(Link(Path("/nowhere")))
    feed.so_far = SoFar(RATIO)
    sent, _ = feed._of_ring(Rowed(taken))  # type: ignore[arg-type]
    feed._link.release()
    errors = sent["kinematic_error"]
    assert np.nanmax(np.abs(errors - np.nanmedian(errors))) < 20.0
    assert np.isfinite(sent["motor_angle"]).all()
    assert np.isfinite(errors).sum() >= len(errors) - 2 * 2  # those four rows, and whatever shares a pair with them
