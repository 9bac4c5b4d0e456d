"""Forms of many numbers, one at each port: where what has no name acts is told by what all channels say of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Final, cast

import numpy as np
import pytest

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.free_form import along_another as another
from rig.analysis.tracing.free_form import drawn as drawn_of
from rig.analysis.tracing.free_form import fitted as fitted_of
from rig.analysis.tracing.free_form.along import BY_THE_CLOCK, BY_THE_OUTPUT
from rig.analysis.tracing.free_form.factors import began, hats, motor_waves, past_torque, turned
from rig.analysis.tracing.free_form.forms import forms
from rig.analysis.tracing.free_form.ranges import Ranges
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.residual.home import SIMPLE, Home
from rig.analysis.tracing.runs.recording import Recording
from rig.model.effect import Port, Signals
from tests.analysis.tracing.spiked import Columns, spiked
from tests.contract.test_effects import motion

ONE_WAY = motion(1.0)
SWING = 30.0 * np.sin(0.6 * ONE_WAY.t)
FORTH_AND_BACK = replace(
    ONE_WAY,
    theta_m=SWING,
    theta_l=SWING / 50,
    omega_m=18.0 * np.cos(0.6 * ONE_WAY.t),
    way=np.sign(np.cos(0.6 * ONE_WAY.t)),
)
RUNS = ("slow_ke_1", "slow_ke_2", "load_20nm_1", "load_20nm_2", "speed_60rpm_1", "speed_60rpm_2", "lock_60_1")
NOBODY: Final = cast("Prepared", None), cast("Solution", None)
SHARP: Final = f"a torque on the load: {BY_THE_OUTPUT}"
DRAWN = [name for name in SIMPLE if name != "time_periodic"]  # of what comes by the clock each run has its own phase


@dataclass(frozen=True)
class Curve:
    """Stands for a form."""

    words: str
    surface: bool = False


class Seen(Ranges):
    """What one piece of a run covers."""

    def __init__(self, piece: Signals) -> None:
        object.__setattr__(self, "piece", piece)

    def _values(self, of):  # type: ignore[no-untyped-def]
        x = np.asarray(of(self.piece))
        return x[np.isfinite(x)]


@pytest.mark.parametrize("coordinate", DRAWN)
def test_every_form_is_finite_and_has_as_many_columns_at_all_its_ports(coordinate: str) -> None:
    made = forms(coordinate, Seen(FORTH_AND_BACK), 1)
    assert len({form.words for form in made}) == len(made) > 10
    for form in made:
        columns = form.columns(FORTH_AND_BACK, ())
        assert len({z.shape for z in columns.values()}) == 1
        assert all(np.isfinite(z).all() for z in columns.values()), form.words
        assert (Port.LEVER in columns) == (Port.KINEMATIC_ERROR in columns)


@pytest.mark.parametrize("coordinate", DRAWN)
def test_a_part_of_a_run_remembers_what_was_before_it(coordinate: str) -> None:
    rows = np.r_[200:260, 500:900]
    part = FORTH_AND_BACK.part(rows)
    for form in forms(coordinate, Seen(FORTH_AND_BACK), 1):
        whole, cut = (form.columns(s, ()) for s in (FORTH_AND_BACK, part))
        for port, z in cut.items():
            np.testing.assert_array_equal(z, whole[port][rows], form.words)


@pytest.mark.parametrize("coordinate", DRAWN)
def test_finer_ones_are_the_same_forms_with_more_columns(coordinate: str) -> None:
    coarse, fine = (forms(coordinate, Seen(FORTH_AND_BACK), finer) for finer in (1, 2))
    assert [form.words for form in coarse] == [form.words for form in fine]
    wide = [[next(iter(f.columns(FORTH_AND_BACK, ()).values())).shape[1] for f in some] for some in (coarse, fine)]
    assert all(a <= b for a, b in zip(*wide, strict=True))


def test_a_torque_on_the_load_is_not_told_by_what_its_own_reading_has_been() -> None:
    made = [
        form for form in forms("memory", Seen(FORTH_AND_BACK), 1) if form.words.endswith("what the torque has been")
    ]
    assert len(made) > 5
    assert all(Port.LOAD_TORQUE not in form.columns(FORTH_AND_BACK, ()) for form in made)


def test_nothing_is_drawn_along_the_clock() -> None:
    assert forms("time_periodic", Seen(FORTH_AND_BACK), 1) == []


def test_the_slope_of_a_form_is_that_of_its_waves() -> None:
    angle, step = FORTH_AND_BACK.theta_m, 1e-6
    at = np.argsort(angle)[::50]
    slopes = motor_waves(FORTH_AND_BACK, 3, 5, slopes=True)[at]
    orders = np.repeat([3, 4, 5], 2)
    phase = np.tile([0.0, -np.pi / 2], 3)
    by_hand = [
        (np.cos(orders * (x + step) + phase) - np.cos(orders * (x - step) + phase)) / 2 / step for x in angle[at]
    ]
    np.testing.assert_allclose(slopes, by_hand, atol=1e-6)


def test_hats_share_every_row_between_two_knots_and_are_level_beyond() -> None:
    made = hats(np.array([-5.0, 0.0, 0.25, 3.0, np.nan]), np.array([0.0, 1.0, 2.0]))
    np.testing.assert_allclose(made.sum(1), 1.0)
    np.testing.assert_allclose(made[[0, 2, 3]], [[1, 0, 0], [0.75, 0.25, 0], [0, 0, 1]])


def test_what_wears_off_since_a_reversal_is_none_before_the_first_unless_asked() -> None:
    s = FORTH_AND_BACK
    back = int(np.flatnonzero(np.diff(s.way))[0])
    only, also = turned(s, 1, False), turned(s, 1, True)
    assert not only[: back + 1].any()
    assert only[back + 1].min() > 0.99
    assert not turned(ONE_WAY, 1, False).any()
    assert also[0].min() > 0.99
    np.testing.assert_array_equal(only[-100:], also[-100:])
    assert turned(s, 2, True).shape[1] == 2 * also.shape[1] - 1


def test_what_wears_off_since_a_run_began_is_all_there_at_first() -> None:
    made = began(FORTH_AND_BACK, 1)
    np.testing.assert_allclose(made[0], 1.0)
    assert (np.diff(made, axis=0) < 0).all()


def test_a_torque_that_never_changed_has_no_past() -> None:
    assert np.isfinite(past_torque(FORTH_AND_BACK)).all()


def test_knots_of_what_wavers_about_a_few_speeds_are_those_speeds(rng: np.random.Generator) -> None:
    run = Recording.__new__(Recording)
    seen = Ranges((run,))
    x = np.concatenate([v + 0.001 * rng.standard_normal(1000) for v in (1.0, 10.0, 40.0)])
    object.__setattr__(run, "pieces", (FORTH_AND_BACK,))
    knots = seen.crowded(lambda _: np.repeat(x, 7), 9)
    assert knots == pytest.approx([1.0, 10.0, 40.0], abs=0.01)
    assert seen.crowded(lambda _: np.ones(100), 9).size == 0
    assert seen.even(lambda _: np.full(100, np.nan), 9).size == 0


def gauges(c: Columns, began: float) -> Columns:
    """The torque sensor reads two orders of the motor that no law has."""
    return {"tau_l": c["tau_l"] + 0.4 * np.cos(3 * c["theta_m"]) + 0.3 * np.sin(7 * c["theta_m"])}


@pytest.mark.slow
@pytest.mark.long
def test_what_is_in_one_sensor_is_drawn_there_and_gone_from_every_channel(tmp_path: Path, shared: Path) -> None:
    found = spiked(tmp_path / "gauges", shared / "cases" / "open-1", gauges, RUNS)
    assert (found.verdict.status, found.verdict.coordinate) == (Status.UNKNOWN, "motor_angle")
    assert found.added_curves[0].acts == "the reading of the torque sensor: waves of the motor's angle"
    assert found.ratios_before["tau_l"] > 4.0
    assert all(found.ratios_after[channel] < 1.2 for channel in ("theta_l", "tau_m", "tau_l"))


@pytest.mark.parametrize(
    ("port", "of"),
    [
        (Port.WIND_UP, lambda s: s.torque),
        (Port.WIND_UP, lambda s: s.torque_rate),
        (Port.MOTOR_TORQUE, lambda s: s.way),
        (Port.MOTOR_TORQUE, lambda s: s.way * np.abs(s.torque)),
        (Port.MOTOR_TORQUE, lambda s: s.omega_m),
        (Port.MOTOR_TORQUE, lambda s: s.alpha_m),
        (Port.LOAD_TORQUE, lambda s: s.way),
        (Port.LOAD_TORQUE, lambda s: s.omega_l),
        (Port.LOAD_TORQUE, lambda s: s.alpha_l),
        (Port.READS_THETA_L, lambda s: s.omega_l),
    ],
)
@pytest.mark.parametrize("coordinate", ["load_angle", "speed", "load", "time"])
def test_every_number_of_the_model_may_change_along_a_coordinate(
    coordinate: str, port: Port, of: Callable[[Signals], np.ndarray]
) -> None:
    """Stiffness, damping, inertias, frictions and a delay: none of them is drawn as if it were another."""
    s = FORTH_AND_BACK
    by = {"load_angle": s.theta_l, "speed": np.abs(s.omega_m), "load": s.torque, "time": s.t}[coordinate]
    wanted = of(s) * (by - by.mean())
    made = [z[port] for form in forms(coordinate, Seen(s), 1) if port in (z := form.columns(s, ()))]
    left = [np.linalg.norm(wanted - z @ np.linalg.lstsq(z, wanted, rcond=None)[0]) for z in made]
    assert min(left) < 1e-6 * np.linalg.norm(wanted)


@pytest.mark.parametrize(("vouched", "wide", "drawn"), [
    ({"a", "b"}, 50, ("a", 2)),
    ({"a", "b"}, 200, ("a", 1)),  # 800 numbers would have no room
    ({"b"}, 50, ("b", 1)),
    ({"d"}, 50, None),
    (set(), 50, None),
])  # fmt: skip
def test_the_form_that_fitted_runs_want_most_is_drawn_as_fine_as_is_worth_it_if_unseen_runs_vouch_for_it(
    vouched: set[str], wide: int, drawn: tuple[str, int] | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    evidence = {("a", 1): 50.0, ("a", 2): 60.0, ("a", 4): 55.0, ("b", 1): 40.0, ("c", 1): 5.0, ("d", 1): 4.0}

    def fitted(p: Prepared, s: Solution, form: SimpleNamespace) -> SimpleNamespace:
        nats = evidence.get((form.words, form.finer), -1.0)
        solution = SimpleNamespace(x=np.zeros(70 + wide * form.finer))
        return SimpleNamespace(form=form, evidence=nats, worth=nats, solution=solution)

    def possible(p: Prepared, coordinate: str, finer: int = 1) -> list[SimpleNamespace]:
        return [SimpleNamespace(words=words, finer=finer) for words in "dbca"]

    def vouched_for(p: Prepared, after: object, one: SimpleNamespace) -> tuple[str, int] | None:
        return (one.form.words, one.form.finer) if one.form.words in vouched else None

    def likeliest(p: Prepared, s: Solution, made: list[SimpleNamespace], count: int) -> list[SimpleNamespace]:
        return made

    ours = {"fitted": fitted, "possible": possible, "likeliest": likeliest, "_vouched_for": vouched_for}
    for name, made in ours.items():
        monkeypatch.setattr(drawn_of, name, made)
    nobody, alone = NOBODY[0], SimpleNamespace(x=np.zeros(70))
    assert drawn_of.drawn(nobody, alone, {}, "speed") == drawn  # type: ignore[arg-type]


def noisy(left: dict[str, float]) -> Solution:
    """A fit of which sensors leave so much noise in each channel, RMS."""
    noise = {(run, c): np.full(5, rms) for c, rms in left.items() for run in (0, 3)}
    design = SimpleNamespace(noise=noise, noise_left=lambda key, x: noise[key])
    return cast("Solution", SimpleNamespace(design=design, x=np.zeros(3)))


@pytest.mark.parametrize(
    ("with_it", "itself"),
    [
        ({"L": 0.0002, "M": 0.001}, True),  # a curve along the torque that is the torque's own reading
        ({"L": 0.0074, "M": 0.001}, True),
        ({"L": 0.0112, "M": 0.0014}, False),
        ({"L": 0.0089, "M": 0.001}, False),  # an inertia came out smaller beside it
    ],
)
def test_a_form_that_foretells_the_noise_of_a_sensor_is_told_by_its_reading(
    with_it: dict[str, float], itself: bool
) -> None:
    assert fitted_of._takes_noise(noisy({"L": 0.0112, "M": 0.001}), noisy(with_it)) == itself


@pytest.mark.parametrize(
    ("said", "evidence", "expected"),
    [
        ("time", {"time": 70.0, "speed": 100.0, "load": 20.0}, "speed"),  # a plain one is said sooner than time
        ("time", {"time": 70.0, "speed": 75.0, "load": 20.0}, None),
        ("time", {"time": 70.0, "memory": 100.0}, None),  # one of many numbers for another has to be far better
        ("time", {"time": 50.0, "memory": 100.0}, "memory"),
        ("speed", {"speed": 70.0, "load": 100.0}, None),
        ("speed", {"speed": 50.0, "load": 100.0}, "load"),
        ("speed", {"load": 100.0}, "load"),
        ("speed", {"speed": 50.0, "load": 90.0, "memory": 100.0}, "load"),
        ("speed", {"speed": 3.0, "load": 10.0}, None),  # nothing speaks for any
        ("memory", {"memory": 50.0, "time": 100.0}, "time"),  # what settles anew in every run
        ("memory", {"memory": 50.0, BY_THE_CLOCK: 100.0}, None),  # runs lie one after another, whatever they remember
        ("speed", {"speed": 50.0, BY_THE_CLOCK: 100.0}, "time"),
    ],
)
def test_another_coordinate_is_said_where_far_more_speaks_for_it(
    said: str, evidence: dict[str, float], expected: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(another, "of_some_rows", lambda p, s: s)
    made = {"time" if n == BY_THE_CLOCK else n: (SimpleNamespace(words=n), e) for n, e in evidence.items()}
    monkeypatch.setattr(another, "_best_along_each", lambda p, s: made)
    monkeypatch.setattr(another, "fitted", lambda p, s, form: None)
    takes = {True: 0.9, False: 0.7}  # of what is left; less than what is said takes, the form is no better
    for enough in (True, False):
        monkeypatch.setattr(another, "_share", lambda p, s, one, channel: takes[enough])  # noqa: B023
        found = another.along_another(*NOBODY, Home(said, "M", 0.9))
        assert (found.coordinate if found else None) == (expected if enough else None)
        if found:
            assert (found.channel, found.share) == ("M", 0.9)


@pytest.mark.parametrize("home", [Home("time_periodic", "M", 0.9), Home("time", "M", 0.9, first=True)])
def test_what_comes_by_the_clock_or_began_at_one_moment_is_asked_along_nothing_else(home: Home) -> None:
    assert another.along_another(*NOBODY, home) is None


def test_of_each_coordinate_the_few_curves_that_few_rows_want_most_are_fitted_to_all(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    curves = {"speed": ("a", "b", "d", "e"), "load": ("c",), "memory": ()}
    few = {"a": 5.0, "b": 7.0, "c": 6.0, "d": 4.0, "e": 9.0, SHARP: 3.0}
    all_rows = {"a": 75.0, "b": 80.0, "c": 70.0, "d": 90.0, "e": 60.0, SHARP: 50.0}

    def possible(p: Prepared, name: str, finer: int = 1) -> list[Any]:
        surface = SimpleNamespace(words="surface", surface=True)
        if finer == another.SHARP:
            assert name == "load_angle"
            return [surface, Curve("waves"), Curve(SHARP)]
        return [surface, *(Curve(words) for words in curves.get(name, ()))]

    def likeliest(p: Prepared, s: Solution, made: list[Any], count: int) -> list[Any]:
        assert count == len(made) == 6
        return sorted(made, key=lambda form: -few[form.words])

    monkeypatch.setattr(another, "possible", possible)
    monkeypatch.setattr(another, "likeliest", likeliest)
    monkeypatch.setattr(another, "fitted", lambda p, s, form: SimpleNamespace(evidence=all_rows[form.words]))
    found = another._best_along_each(*NOBODY)
    assert {name: (form.words, nats) for name, (form, nats) in found.items()} == {
        "speed": ("b", 80.0),
        "load": ("c", 70.0),
        "load_angle": (SHARP, 50.0),  # a dent is too narrow for the usual curve
    }
