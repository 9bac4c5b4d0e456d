"""Parameters as they are typed, and what the page offers."""

from __future__ import annotations

import math
from typing import Any

import pytest

from rig.console.check import check
from rig.console.described import catalogue
from rig.procedures import CATALOGUE


def looked_at(parameters: Any, procedure: str = "kinematic-error") -> dict[str, Any]:
    return check({"procedure": procedure, "parameters": parameters}, "twin", [])


def test_what_is_right_comes_with_its_dry_run_and_margins() -> None:
    found = looked_at({"cycles": 1.0})
    assert found["ok"]
    assert any(line.startswith("duration    at most 101.0 s") for line in found["plan"])
    speed = next(m for m in found["margins"] if m["what"] == "speed")
    assert (speed["unit"], speed["limit"]) == ("rpm", pytest.approx(600.0))
    assert speed["fraction"] == pytest.approx(9.6 / 600, rel=1e-3)


def test_what_a_run_stores_how_long_it_takes_and_its_tightest_margin_are_told_as_numbers() -> None:
    slow, lock = looked_at({})["sums"], looked_at({}, "stiffness-lock")["sums"]
    assert slow["duration_s"] == pytest.approx(201.0)
    assert (slow["nearest"], slow["left"]) == ("motor speed", pytest.approx(1 - 9.6 / 600, rel=1e-3))
    inertia = 1.1e-3 + 0.32 / 50**2  # kg·m² at the motor, of twin.toml
    assert slow["stored_j"] == pytest.approx(0.5 * inertia * (9.6 * math.pi / 30) ** 2, rel=0.01)
    assert (lock["nearest"], lock["left"]) == ("shaft torque", pytest.approx(0.5))
    assert lock["stored_j"] == pytest.approx(0.5 * 22.5**2 / 7160, rel=0.01)


def test_of_a_plan_the_largest_of_its_runs_stand_beside_each_limit() -> None:
    found = check({"plan": "quick"}, "twin", [])
    shares = {m["what"]: m["fraction"] for m in found["margins"]}
    assert set(shares) == {"travel", "speed", "torque", "shaft"}
    assert 1 - found["sums"]["left"] == pytest.approx(max(s for what, s in shares.items() if what != "torque"))
    longest = float(next(line.split()[1] for line in found["plan"] if line.startswith("duration")))  # min
    assert found["sums"]["duration_s"] == pytest.approx(60 * longest, rel=0.02)


def test_each_wrong_parameter_is_told_by_its_name() -> None:
    found = looked_at({"cycles": "many", "amplitude_deg": -3, "nonsense": 1})
    assert not found["ok"]
    assert set(found["problems"]) == {"cycles", "amplitude_deg", "nonsense"}


def test_what_no_single_parameter_shows_is_told_of_the_whole_with_its_margins() -> None:
    found = looked_at({"frequency": 9.0})
    assert "asks for up to 8640 rpm of motor speed" in found["problems"]["*"]
    assert any(m["fraction"] > 1 for m in found["margins"])


@pytest.mark.parametrize(
    "parameters",
    [
        None,
        {},
        [],
        "x",
        7,
        {"cycles": None},
        {"cycles": [1]},
        {"": ""},
        {"cycles": 1e400},
        {"cycles": 10**400},
        {"amplitude_deg": 1e308},
        {"amplitude_deg": 1e99},
        {"frequency": 1e-99},
    ],
)
def test_nothing_a_page_could_send_breaks_it(parameters: Any) -> None:
    assert set(looked_at(parameters)) == {"ok", "problems", "plan", "margins", "sums"}


@pytest.mark.slow
def test_a_run_into_the_resonance_is_refused_as_on_the_command_line() -> None:
    faster = ["limits.speed_rpm=2000"]
    found = check({"procedure": "kinematic-error", "parameters": {"frequency": 1.0}}, "twin", faster)
    assert "meets the torsional resonance at 755 rpm" in found["problems"]["*"]
    assert any(line.startswith("predicted   the shaft torque swings") for line in found["plan"])


def test_an_unknown_procedure_or_bench_is_a_sentence() -> None:
    assert "no procedure called" in looked_at({}, "rm -rf")["problems"]["*"]
    assert "no bench called" in check({"procedure": "jog"}, "nowhere", [])["problems"]["*"]


def test_a_plan_is_told_line_by_line() -> None:
    found = check({"plan": "quick"}, "twin", [])
    assert found["ok"]
    assert any("by hand: fit the lock pin" in line for line in found["plan"])
    assert not check({"plan": "nonsense"}, "twin", [])["ok"]


def test_every_procedure_is_offered_with_unit_or_name_for_every_number() -> None:
    offered = {p["name"]: p for p in catalogue("twin")["procedures"]}
    assert set(offered) == set(CATALOGUE)
    amplitude = offered["kinematic-error"]["parameters"][0]
    assert (amplitude["name"], amplitude["unit"], amplitude["default"]) == ("amplitude_deg", "deg", 1440.0)
    assert offered["stiffness-lock"]["needs_lock"]
    assert all(p["summary"] for p in offered.values())


@pytest.mark.parametrize("name", CATALOGUE)
def test_the_defaults_that_are_offered_are_accepted_as_they_stand(name: str) -> None:
    offered = next(p for p in catalogue("twin")["procedures"] if p["name"] == name)
    given = {p["name"]: p["default"] for p in offered["parameters"] if p["default"] != []}
    found = looked_at(given, name)
    assert found["ok"], found["problems"]
