"""A mode above what is compared at first: whether something rings there, and what a look at fast rows may say of it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.fit.bank import reach
from rig.analysis.tracing.looks import fast
from rig.analysis.tracing.residual.above_the_band import Line, _from_speed_to_speed, rings_above
from rig.analysis.tracing.runs import campaign as campaign_module
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.runs.cannot import cannot
from rig.analysis.tracing.runs.look import Look
from rig.analysis.tracing.selection.score import HeldOutScore
from rig.analysis.tracing.thresholds import BANDWIDTH, FASTER
from rig.analysis.tracing.trace import trace
from rig.core.errors import UsageError
from rig.model.second_mode.rates import rate
from tests.blind.cases import Request
from tests.blind.generate import write_case


@pytest.mark.slow
@pytest.mark.long
def test_a_hub_before_the_torque_sensor_that_rings_at_79_hz_is_named(tmp_path: Path) -> None:
    write_case(Request("single", 885, "complete", "torsional_mode", "sensor_shaft", 1.7), tmp_path, "case")
    verdict = trace(tmp_path / "case").verdict
    assert (verdict.status, verdict.effects, verdict.rivals) == (Status.EXPLAINED, ("torsional_mode",), ())


@pytest.mark.slow
def test_runs_with_fast_rows_are_compared_at_twice_the_frequency_and_slow_ones_as_ever(shared: Path) -> None:
    found = read_campaign(shared / "cases" / "open-1", Look(fast=True))
    widths = {run.name: run.smoother.sigma_hz for run in found.runs}
    assert widths["speed_400rpm_1"] == pytest.approx(FASTER * BANDWIDTH, rel=0.01)
    assert widths["slow_ke_1"] <= BANDWIDTH  # rows every 4 ms, which a wider low-pass would fold over
    assert any("were compared up to 71 Hz, 36 Hz at first" in said for said in cannot(found.runs))
    turning = [run for run in found.runs if run.procedure in ("constant_torque", "kinematic_error")]
    assert reach(turning).band == pytest.approx(2 * FASTER * BANDWIDTH, rel=0.01)
    assert reach([replace(run, look=Look()) for run in turning]).band <= 2 * BANDWIDTH


def heights(amplitude: dict[tuple[int, int], complex], power: int) -> np.ndarray[Any, Any]:
    """Of orders in runs at 1, 2 and 3 turns a second."""
    lines = [Line(run, n, height, n * (run + 1.0), 1e-14) for (run, n), height in amplitude.items()]
    return _from_speed_to_speed(lines, power)


def test_an_order_that_is_the_same_at_every_speed_is_the_transmissions_own() -> None:
    own = {(run, n): 3e-6 * n + 1e-6j for run in range(3) for n in (5, 6)}
    assert np.abs(heights(own, 0)).max() < 1e-15
    own[2, 6] += 3e-6
    assert np.abs(heights(own, 0)) == pytest.approx([0, 1e-6, 0, 1e-6, 0, 2e-6], abs=1e-15)


def test_an_order_of_the_load_encoder_is_an_acceleration() -> None:
    own = {(run, 5): (0.2 + 0.1j) * (run + 1.0) ** 2 for run in range(3)}
    assert np.abs(heights(own, 2)).max() < 1e-15
    assert np.abs(heights(own, 0)).max() > 0.1


@pytest.mark.parametrize(("rms", "loud"), [([0.5, 0.5], True), ([0.5, 0.4], False), ([0.9], False), ([], False)])
def test_it_rings_where_two_runs_show_half_a_floor(
    monkeypatch: pytest.MonkeyPatch, rms: list[float], loud: bool
) -> None:
    floor, module = 2e-6, "rig.analysis.tracing.residual.above_the_band"
    runs = [SimpleNamespace(smoother=SimpleNamespace(sigma_hz=36.0)) for _ in rms]
    monkeypatch.setattr(f"{module}._shows", lambda run: True)
    monkeypatch.setattr(f"{module}._from_speed_to_speed", lambda lines, power: [line.height for line in lines])
    monkeypatch.setattr(
        f"{module}._lines",
        lambda s, i, channel: [
            Line(i, 9, rms[i] * floor / 2**0.5 + 0j, 60.0, 0.0),
            Line(i, 1, 1.0 + 0j, 10.0, 0.0),  # far below, where the equations are compared anyway
        ],
    )
    keys = [(i, "A") for i in range(len(rms))]
    s: Any = SimpleNamespace(design=SimpleNamespace(eq=SimpleNamespace(runs=runs)), keys=keys)
    assert rings_above(s, dict.fromkeys(keys, floor)) is loud


def scored(name: str, size: float, channel: str) -> HeldOutScore:
    return HeldOutScore(name, 1.0, size, 1.0, 1.0, ((0, channel),))


MODE = scored("torsional_mode", 4.0, "A")
HOUSING = scored("support_compliance", 2.0, "A")
LATE = scored("channel_time_skew", 1.5, "A")
COGGING = scored("cogging_torque", 1.5, "M")
LARGE = scored("stribeck_friction", 5.0, "M")


def standing(*scores: HeldOutScore, loud: bool = False) -> Any:
    first = SimpleNamespace(folder=Path("nowhere"), runs=())
    terms = [SimpleNamespace(name=score.name) for score in scores]
    solution = SimpleNamespace(design=SimpleNamespace(terms=terms))
    names = {score.name for score in scores}
    return SimpleNamespace(names=names, scores=scores, loud=loud, p=SimpleNamespace(campaign=first), solution=solution)


@pytest.mark.parametrize(
    ("before", "after", "counts"),
    [
        (standing(), standing(MODE), True),
        (standing(HOUSING), standing(MODE), True),
        (standing(COGGING), standing(COGGING, MODE), True),
        (standing(COGGING), standing(MODE), False),  # fast rows tell less of the motor's torque
        (standing(COGGING, loud=True), standing(MODE), True),  # but what does less than the mode left a rest
        (standing(LARGE, loud=True), standing(MODE), False),
        (standing(COGGING, loud=True), standing(MODE, loud=True), False),
        (standing(LATE), standing(MODE), True),  # of an angle they tell more
        (standing(LATE), standing(MODE, loud=True), False),
        (standing(), standing(MODE, LATE), False),  # a name that had not come before
        (standing(MODE), standing(MODE, HOUSING), False),
        (standing(), standing(), False),
        (standing(), standing(MODE, loud=True), False),
        (standing(loud=True), standing(MODE, loud=True), True),
    ],
)
def test_one_mode_comes_to_what_had_a_name(before: Any, after: Any, counts: bool) -> None:
    assert fast._counts(after, before) is counts


@pytest.mark.parametrize("repeated", [True, False])
@pytest.mark.parametrize(("shows", "first", "tried"), [
    (False, "torsional_mode", []),
    (True, "lost_motion", []),  # something else explains more
    (True, "torsional_mode", ["soft", "hub"]),  # until one stands on unseen runs
])  # fmt: skip
def test_laws_of_a_mode_are_tried_in_their_turn_where_one_shows(
    monkeypatch: pytest.MonkeyPatch, shows: bool, first: str, tried: list[str], repeated: bool
) -> None:
    nothing: Any = None
    laws = [SimpleNamespace(name=first, law=law) for law in ("soft", "hub", "never")]
    asked: list[str] = []

    def with_law(law: Any, *given: Any) -> Any:
        asked.append(law.law)
        return standing(MODE, loud=law.law == "soft")

    for name in ("design", "fit", "_covered", "is_calm", "_together"):
        monkeypatch.setattr(fast, name, lambda *given: nothing)
    prepared = SimpleNamespace(split=SimpleNamespace(fitted=()), eq=None, floors={})
    held: list[bool] = []

    def made(first: Any, hold_out: Any, swapped: bool) -> Any:
        held.append(swapped)
        return prepared

    monkeypatch.setattr(fast, "_prepared", made)
    monkeypatch.setattr(fast, "read_again", lambda first, **changed: SimpleNamespace(runs=()))
    monkeypatch.setattr(fast, "split", lambda runs, asked, swapped: SimpleNamespace(held_out=(repeated and swapped,)))
    monkeypatch.setattr(fast, "still", lambda start, floors: False)
    monkeypatch.setattr(fast, "replace", lambda found, **changed: found)
    monkeypatch.setattr(fast, "_shows_a_mode", lambda p, start, covered: shows)
    ranked = [SimpleNamespace(term=laws[0], laws=tuple(laws[1:]))]
    monkeypatch.setattr(fast, "_ranked", lambda p, start, covered: ranked)
    monkeypatch.setattr(fast, "_with", with_law)
    before, found = standing(), SimpleNamespace(ranking=())
    kept, _ = fast.taken(before, found, nothing, ())  # type: ignore[arg-type]
    assert asked == tried
    assert (kept is before) is not bool(tried)
    # where no mode shows other repeats are held out, if there are others: in the first all that show it may have been
    assert held == ([False, True] if repeated and not shows else [False])


def refusing(campaign: Any, hold_out: Any, swapped: bool) -> Any:
    raise UsageError("J_m comes out as -1 g·m², expected more than nothing")


@pytest.mark.parametrize(
    ("names", "prepare"), [(["a"], refusing), (["a", "b"], lambda campaign, hold_out, swapped: "prepared")]
)
def test_what_was_told_stands_where_fast_rows_cannot_be_fitted_or_are_of_other_runs(
    monkeypatch: pytest.MonkeyPatch, names: list[str], prepare: Any
) -> None:
    now = SimpleNamespace(runs=[SimpleNamespace(name=name) for name in names])
    monkeypatch.setattr(campaign_module, "read_campaign", lambda folder, look: now)
    monkeypatch.setattr(campaign_module, "looking", lambda campaign, looks: campaign)
    monkeypatch.setattr(campaign_module, "replace", lambda look, **changed: look)
    monkeypatch.setattr(fast, "prepare", prepare)
    monkeypatch.setattr(fast, "split", lambda runs, asked, swapped: SimpleNamespace(held_out=(swapped,)))
    before = standing()
    before.p.campaign.runs = [SimpleNamespace(name="a", look=None)]
    nothing: Any = None
    assert fast.taken(before, nothing, nothing, ()) == (before, None)


def test_a_rate_by_six_neighbours_holds_a_wave_of_a_sixth_of_the_rate() -> None:
    t = np.arange(200) * 2e-3
    omega = 2 * np.pi * 80.0
    off = rate(np.sin(omega * t), 2e-3)[3:-3] / omega - np.cos(omega * t)[3:-3]
    assert np.abs(off).max() < 0.01  # a difference of neighbours: 0.16
