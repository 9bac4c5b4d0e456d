"""Each check judges numbers; what it measures them with is the machine's business."""

from __future__ import annotations

from datetime import date

import pytest

from rig.bench import read
from rig.commands import doctor as verb
from rig.doctor import CHECKS
from rig.doctor.bus_load import bits, judge
from rig.doctor.calibration import judge as judge_calibration
from rig.doctor.devices import check_devices
from rig.doctor.disk import LEAST_HOURS
from rig.doctor.disk import judge as judge_disk
from rig.doctor.finding import Health
from rig.doctor.governor import judge as judge_governor
from rig.doctor.latency import measure
from rig.doctor.scheduling import check_scheduling
from rig.runfile.room import rows_bytes


@pytest.mark.parametrize(("count", "most"), [(0, 55), (4, 95), (5, 105), (6, 115), (8, 135)])
def test_a_frame_is_as_long_as_the_standard_says(count: int, most: int):
    assert bits(count) == most


def test_the_lean_cycle_fits_one_megabit_at_a_kilohertz_and_not_half_of_it():
    up, down = [0, 5, 8, 6, 4], [4]
    at_1M = judge("rig", up, down, 1_000_000, 1000.0, 0.0006)
    assert at_1M.health is Health.GOOD
    assert "60 %" in at_1M.sentence
    assert "505 µs" in at_1M.sentence
    at_500k = judge("rig", up, down, 500_000, 1000.0, 0.0)
    assert at_500k.health is Health.BAD
    assert "583 Hz would" in at_500k.sentence


def test_a_lead_shorter_than_the_answers_take_is_bad():
    found = judge("rig", [0, 5, 8, 6, 4], [4], 1_000_000, 500.0, 0.0003)
    assert found.health is Health.BAD
    assert "300 µs" in found.sentence


def test_the_bench_s_own_traffic_is_counted():
    assert read("twin-canopen").traffic() == {"rig": ([5, 4, 4, 4], [4])}
    assert read("twin").traffic() == {}


@pytest.mark.parametrize(
    ("made", "due", "health"),
    [
        (None, None, Health.DOUBTFUL),
        (date(2026, 1, 1), None, Health.DOUBTFUL),
        (date(2026, 1, 1), date(2027, 1, 1), Health.GOOD),
        (date(2025, 1, 1), date(2026, 1, 1), Health.BAD),
    ],
)
def test_a_calibration_is_known_and_valid_or_said_not_to_be(made: date | None, due: date | None, health: Health):
    assert judge_calibration("torque sensor", made, due, date(2026, 6, 1)).health is health


@pytest.mark.parametrize(("free", "health"), [(10**8, Health.BAD), (10**9, Health.DOUBTFUL), (10**11, Health.GOOD)])
def test_free_disk_is_told_in_hours(free: int, health: Health):
    assert judge_disk(free, 1000.0).health is health


def test_a_disk_is_judged_by_what_a_run_is_refused_by():
    rows = LEAST_HOURS * 3600 * 1000.0
    assert judge_disk(int(rows_bytes(rows)) + 1, 1000.0).health is Health.GOOD
    assert judge_disk(int(rows_bytes(rows)) - 1, 1000.0).health is Health.DOUBTFUL


def test_a_governor_that_changes_the_clock_is_doubtful():
    assert judge_governor({"powersave"}).health is Health.DOUBTFUL
    assert judge_governor({"performance"}).health is Health.GOOD
    assert judge_governor(set()).health is Health.GOOD


@pytest.mark.slow
def test_the_timer_is_measured_every_cycle():
    timing = measure(0.001, 0.05)
    assert timing.ticks + timing.missed >= 50


@pytest.mark.slow
def test_scheduling_is_asked_for_and_said():
    assert check_scheduling(read("twin"))[0].sentence


def test_devices_of_the_twin_answer_and_one_that_is_not_there_is_bad():
    assert [f.health for f in check_devices(read("twin"))] == [Health.GOOD] * 3
    missing = check_devices(read("twin-canopen", ["bus.rig.channel=/nowhere/can"]))
    assert missing[0].health is Health.BAD
    assert "/nowhere/can" in missing[0].sentence


@pytest.mark.slow
def test_the_verb_says_every_finding_and_ends_with_the_worst(capsys: pytest.CaptureFixture[str], monkeypatch):
    from argparse import Namespace

    monkeypatch.setattr("rig.doctor.latency.SECONDS", 0.02)
    assert verb.run(Namespace(bench="twin", set=[])) == 0
    told = capsys.readouterr().out.splitlines()
    assert len(told) >= len(CHECKS)
    assert told[-1].startswith("twin (SIMULATED): ")
