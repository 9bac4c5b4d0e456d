"""Where a rest lives: the coordinate it was made with is found, whatever else changes beside it."""

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from rig.analysis.tracing.residual import joined, unknown
from rig.analysis.tracing.residual.binned import Beside, Halves, folds, own_excess, straightened
from rig.analysis.tracing.residual.home import Home, plainest
from rig.analysis.tracing.residual.joined import Rest
from rig.analysis.tracing.residual.lines import SENSES, best_order
from rig.analysis.tracing.residual.own_phases import own_phases
from rig.analysis.tracing.residual.past import since_turned
from rig.analysis.tracing.residual.shares import rising
from rig.analysis.tracing.residual.sudden import turned_since
from rig.analysis.tracing.residual.unknown import homes
from rig.analysis.tracing.residual.whose_order import of_the_output
from rig.analysis.tracing.residual.worn import worn_off
from rig.model.memory import play
from tests.some import some

DT = 1 / 125
ROWS = 6000
RUNS = 4
At = dict[str, np.ndarray]
NO_BASELINE = (np.zeros((RUNS * ROWS, 0)), np.zeros((0, 0)))


def coordinates(rng: np.random.Generator) -> At:
    """Runs of 48 s at two speeds, each way; the torque wanders as a shaft's does that two waves swing."""
    parts = []
    for run in range(RUNS):
        t = np.arange(ROWS) * DT
        way = 1.0 if run % 2 else -1.0
        speed = 12.0 + 18.0 * (run // 2) + 6.0 * np.sin(0.4 * t)
        swing = np.convolve(rng.normal(0, 1, ROWS), np.hanning(101), "same")
        load = way * 5.0 + 8.0 * swing / swing.std() + rng.normal(0, 0.2, ROWS)
        angle = np.cumsum(way * speed) * DT
        parts.append(
            {
                "motor_angle": angle,
                "load_angle": angle / 50,
                "speed": way * speed,
                "load": load,
                "motor_torque": load / 50 + 0.2 * way,
                "direction": np.full(ROWS, way),
                "time": run * 60.0 + t,
                "temperature": np.full(ROWS, np.nan),
                "torque_rate": np.gradient(load, DT),
            }
        )
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def lagging(at: At) -> np.ndarray:
    return np.concatenate([x - play(np.ascontiguousarray(x), 3.0) for x in np.split(at["load"], RUNS)])


def slipping(at: At) -> np.ndarray:
    over = at["load"] - np.clip(at["load"], -1.0, 1.0)
    return np.concatenate([np.cumsum(x) * DT for x in np.split(over, RUNS)])


def whirling(at: At, order: float = 0.47) -> np.ndarray:
    phase = np.repeat([0.4, 2.9, 4.4, 1.6], ROWS)
    return np.abs(at["speed"]) / 12.0 * np.cos(order * at["motor_angle"] + phase)


MADE: dict[str, tuple[str, Callable[[At], np.ndarray]]] = {
    "a hump of friction at one speed": (
        "speed",
        lambda at: at["direction"] * np.exp(-(((np.abs(at["speed"]) - 20) / 3) ** 2)),
    ),
    "a dent at one output angle": (
        "load_angle",
        lambda at: np.exp(-((np.mod(at["load_angle"] - 2, 6.283) / 0.1) ** 2)),
    ),
    "a cable that winds up": ("load_angle", lambda at: at["load_angle"] + 0.1 * at["load_angle"] ** 2),
    "a motor angle's seventh wave": ("motor_angle", lambda at: np.cos(7 * at["motor_angle"])),
    "a ball bearing's order, which is no whole one": ("motor_angle", lambda at: np.cos(12.437 * at["motor_angle"])),
    "a dent in a race, sharp and of no whole order": (
        "motor_angle",
        lambda at: at["direction"] * np.exp(-((np.mod(5.537 * at["motor_angle"], 6.283) - 2) ** 2) / 0.02),
    ),
    "an oil film that whirls, in another phase in each run": ("motor_angle", lambda at: whirling(at)),
    "a brake that rubs every ten seconds": ("time_periodic", lambda at: 1.0 * (np.mod(at["time"], 9.7) < 1.4)),
    "friction that breathes with a thermostat": (
        "time_periodic",
        lambda at: at["direction"] * np.sin(2 * np.pi * at["time"] / 38.0),
    ),
    "a torque sensor whose gain breathes": ("time_periodic", lambda at: at["load"] * np.sin(2.7 * at["time"])),
    "a brinell mark in the race": (
        "motor_angle",
        lambda at: np.exp(-((np.mod(at["motor_angle"] - 3.8, 2 * np.pi) - np.pi) ** 2) / 2 / 0.02**2),
    ),
    "waves of a torque sensor's scale": ("load", lambda at: np.sin(2 * np.pi * at["load"] / 3.0)),
    "a first wave that the load brings and soon is whole": (
        "load",
        lambda at: (0.3 - np.exp(-np.abs(at["load"]) / 5)) * np.cos(at["motor_angle"]),
    ),
    "a knee in the load": ("load", lambda at: np.abs(at["load"])),
    "a sensor that keeps a part of its last excursion": ("memory", lagging),
    "a clamp that slips under torque": ("memory", slipping),
    "friction that is more from one moment on": ("time", lambda at: at["direction"] * (at["time"] > 100.0)),
    "an inertia of the load that is another one from one moment on": (
        "time",
        lambda at: at["load"] * (at["time"] > 130.0),
    ),
    "a second wave that is another one on the way back": (
        "direction",
        lambda at: at["direction"] * np.sin(2 * at["motor_angle"]),
    ),
    "a wave generator that slipped between two runs": (
        "time",
        lambda at: np.where(at["time"] > 50.0, 1.0, -3.0) * np.sin(2 * at["motor_angle"] + 0.4),
    ),
    "growth over the day": ("time", lambda at: at["time"] / 240 * np.cos(2 * at["motor_angle"])),
}


@pytest.mark.slow
@pytest.mark.parametrize("what", some(MADE, 10))
def test_the_coordinate_it_was_made_with_is_said(what: str) -> None:
    rng = np.random.default_rng(5)
    at = coordinates(rng)
    expected, law = MADE[what]
    made = law(at)
    own_zero = np.concatenate([x - x.mean() for x in np.split(made, RUNS)])
    e = 4.0 * own_zero / own_zero.std() + rng.normal(0, 1, own_zero.size)
    channel = "L" if "inertia" in what else "A"
    found = plainest(homes(Rest(e, np.repeat(np.arange(RUNS), ROWS), at, DT, *NO_BASELINE), channel))
    assert found[0].coordinate == expected, [(h.coordinate, round(h.share, 2)) for h in found[:4]]
    assert found[0].share > 0.5


def said(at: At, e: np.ndarray, channel: str = "A") -> str:
    """The coordinate of a rest (n,) over its floor."""
    return plainest(homes(Rest(e, np.repeat(np.arange(RUNS), ROWS), at, DT, *NO_BASELINE), channel))[0].coordinate


def test_a_wave_all_runs_have_in_common_is_said_before_a_memory_that_tells_less() -> None:
    """How far something is behind its past tells when in a run a row is (exam 106, case 07)."""

    def first(wave: float, *others: Home) -> str:
        return plainest([*others, Home("time_periodic", "M", wave, frequency_hz=0.058, late=True)])[0].coordinate

    memory = Home("memory", "M", 0.60)
    assert first(0.63, memory) == "time_periodic"
    assert first(0.59, memory) == "memory"
    assert first(0.63, memory, Home("load", "M", 0.61)) == "load"  # plainer than either


def test_what_a_torque_has_been_holds_nothing_of_what_is_left_of_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """A rest that goes slowly would be told by its own past (exam 106, case 07)."""
    read = {"motor_torque": np.full(9, 0.5), "load": np.full(9, 7.0)}
    monkeypatch.setattr(joined, "_coordinates", lambda eq, key: dict(read))
    smooth = SimpleNamespace(dt=0.001, step=8)
    eq: Any = SimpleNamespace(runs=[SimpleNamespace(smoother=smooth, has=())], timed=True)
    eq.share_of_mean = lambda key, n: 0.0
    for channel, name, expected in (("M", "motor_torque", 0.4), ("L", "load", 6.9)):
        r = joined.rest(eq, {(0, channel): np.full(9, 0.1)}, {(0, channel): 0.01}, channel, beside=False)
        assert r is not None
        assert {n: x[0] for n, x in r.at.items()} == pytest.approx({"motor_torque": 0.5, "load": 7.0, name: expected})


@pytest.mark.slow
def test_waves_of_the_motor_s_torque_as_large_as_its_speed_squared_are_of_its_angle() -> None:
    """An angle that is read wrong has no size of its own in a torque (exam 94, case 16); what grows otherwise has."""
    rng = np.random.default_rng(9)
    at = coordinates(rng)
    noise, waves = rng.normal(0, 1, RUNS * ROWS), 9.0 * np.cos(2 * at["motor_angle"] + 0.3)
    e = (at["speed"] / 30.0) ** 2 * waves + noise
    assert said(at, e, "M") == "motor_angle"
    r = Rest(e, np.repeat(np.arange(RUNS), ROWS), at, DT, *NO_BASELINE)
    h = Halves(r, folds(r))
    assert [home.coordinate for home in unknown._read_wrong(h, 1.0)] == ["motor_angle"]
    grown = Halves(replace(r, e=np.sqrt(np.abs(at["speed"])) / 5.0 * waves + noise), folds(r))
    assert unknown._read_wrong(grown, 1.0) == []


def test_where_nothing_stands_out_of_the_floor_the_channel_is_taken_that_can_be_foretold(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Repeats differ by it, so it is in the floor: the channel with a hair more left than others says nothing."""
    shares = {"A": 9.6, "M": 1.2, "L": 1.1}
    monkeypatch.setattr(unknown, "rest", lambda eq, e, floors, channel: channel)
    monkeypatch.setattr(
        unknown, "homes", lambda r, channel: [Home("time" if channel == "A" else "load", channel, shares[channel])]
    )
    e = {(0, "A"): 0.80 * np.ones(9), (0, "M"): 0.95 * np.ones(9), (0, "L"): 0.9 * np.ones(9)}
    found = unknown.home(cast(Any, None), e, dict.fromkeys(e, 1.0))
    assert [(h.coordinate, h.channel) for h in found] == [("time", "A")]


@pytest.mark.slow
@pytest.mark.long
def test_a_torque_of_the_motor_that_is_alike_both_ways_at_a_speed_is_what_one_way_has_more() -> None:
    """Friction turns with the way, what the baseline's own friction leaves of one way alone does not."""
    rng = np.random.default_rng(6)
    at = coordinates(rng)
    noise, hump = rng.normal(0, 0.05, RUNS * ROWS), np.exp(-(((np.abs(at["speed"]) - 20) / 3) ** 2))
    assert said(at, hump + noise, "M") == "direction"
    assert said(at, at["direction"] * hump + noise, "M") == "speed"
    forth = {**at, "direction": np.ones(RUNS * ROWS)}
    assert said(forth, hump + noise, "M") == "speed"


def test_a_drive_whose_gain_comes_and_goes_is_told_by_its_period() -> None:
    """Within 23 s, as much of its torque as that is."""
    rng = np.random.default_rng(8)
    at = coordinates(rng)
    at["time"] = at["time"] + 100.0 * np.repeat(np.arange(RUNS), ROWS)  # long enough for what is slow to be no trend
    e = 30.0 * at["motor_torque"] * np.sin(2 * np.pi * at["time"] / 23.0) + rng.normal(0, 1, RUNS * ROWS)
    found = plainest(homes(Rest(e, np.repeat(np.arange(RUNS), ROWS), at, DT, *NO_BASELINE, own_zeros=False), "M"))
    assert found[0].coordinate == "time_periodic"
    assert found[0].frequency_hz == pytest.approx(1 / 23.0, rel=0.01)


def test_friction_that_wears_off_after_a_start_is_memory_though_runs_begin_at_one_angle() -> None:
    """Within 12 rad; the angle of the output tells as much, with a number for every place of it."""
    rng = np.random.default_rng(7)
    at = coordinates(rng)
    gone = np.concatenate([np.abs(x - x[0]) for x in np.split(at["motor_angle"], RUNS)])
    e = 12.0 * at["direction"] * np.exp(-gone / 12.0) + rng.normal(0, 1, RUNS * ROWS)
    found = plainest(homes(Rest(e, np.repeat(np.arange(RUNS), ROWS), at, DT, *NO_BASELINE, own_zeros=False), "M"))
    assert (found[0].coordinate, found[0].first) == ("memory", True)
    unread = at | {"motor_angle": np.full(RUNS * ROWS, np.nan)}
    blind = Rest(e, np.repeat(np.arange(RUNS), ROWS), unread, DT, *NO_BASELINE, own_zeros=False)
    assert not worn_off(Halves(blind, folds(blind)), "M")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("warmth", "waves"),
    [
        (lambda t: 6.0 * (1.0 - np.exp(-t / 90.0)) - 3.0, lambda at: np.cos(2 * at["motor_angle"])),
        (lambda t: 6.0 * np.sin(t / 40.0), lambda at: np.cos(3 * at["load_angle"])),
    ],
    ids=["kinematic error, though time goes on as well", "lobes of a scale"],
)
def test_waves_that_follow_a_thermometer_live_in_the_temperature(
    warmth: Callable[[np.ndarray], np.ndarray], waves: Callable[[At], np.ndarray]
) -> None:
    rng = np.random.default_rng(8)
    at = coordinates(rng)
    above = warmth(at["time"]) + rng.normal(0, 0.02, at["time"].size)
    at["temperature"] = 28.0 + above
    assert said(at, 0.8 * above * waves(at) + rng.normal(0, 1, above.size)) == "temperature"


@pytest.mark.slow
def test_waves_that_are_smaller_for_a_while_after_each_reversal_live_in_memory() -> None:
    rng = np.random.default_rng(9)
    at = coordinates(rng)
    at["direction"] = np.where(np.mod(at["time"] + at["time"] ** 2 / 900, 17.0) < 8.0, 1.0, -1.0)
    at["speed"] = at["direction"] * np.abs(at["speed"])
    at["motor_angle"] = np.concatenate([np.cumsum(x) * DT for x in np.split(at["speed"], RUNS)])
    at["load_angle"] = at["motor_angle"] / 50
    worn = np.exp(-since_turned(at["motor_angle"], at["direction"], np.repeat(np.arange(RUNS), ROWS)) / 30.0)
    e = 6.0 * (worn - worn.mean()) * np.cos(2 * at["motor_angle"])
    assert said(at, e + rng.normal(0, 1, e.size)) == "memory"


@pytest.mark.slow
def test_order_and_frequency_are_said_with_it() -> None:
    rng = np.random.default_rng(7)
    at = coordinates(rng)
    run = np.repeat(np.arange(RUNS), ROWS)
    for law, of in (
        (np.exp(8 * np.cos(5.537 * at["motor_angle"]) - 8), lambda h: (h.order, 5.537, 0.002)),
        (np.cos(12.437 * at["motor_angle"]), lambda h: (h.order, 12.437, 0.002)),
        (1.0 * (np.mod(at["time"], 9.7) < 1.4), lambda h: (h.frequency_hz, 1 / 9.7, 0.002)),
    ):
        found = plainest(
            homes(
                Rest(6 * law + rng.normal(0, 1, law.size), run, at, DT, *NO_BASELINE),
                "A",
            )
        )
        said, expected, near = of(found[0])
        assert said == pytest.approx(expected, abs=near)


@pytest.mark.slow
def test_noise_lives_nowhere() -> None:
    rng = np.random.default_rng(6)
    at = coordinates(rng)
    found = homes(
        Rest(
            rng.normal(0, 1.3, RUNS * ROWS),
            np.repeat(np.arange(RUNS), ROWS),
            at,
            DT,
            np.zeros((RUNS * ROWS, 0)),
            np.zeros((0, 0)),
        ),
        "A",
    )
    assert found[0].share < 0.1


@pytest.mark.slow
def test_what_the_baseline_has_taken_on_does_not_hide_the_coordinate() -> None:
    """An even spring in a lock test: θ̃_p, fitted without it, bends to it and is wrong in the slow runs instead."""
    rng = np.random.default_rng(8)
    slow, ramp = np.linspace(-25, 25, ROWS), 1.05 * triangle(np.linspace(0, 4, ROWS))
    motor = np.concatenate([slow, slow + 1.3, slow + 2.6, slow + 3.9, ramp])
    load = np.concatenate([rng.normal(0, 0.5, 4 * ROWS), 160 * ramp])
    made = 0.12 * np.abs(load)
    z = np.stack([f(k * motor) for k in range(1, 16) for f in (np.cos, np.sin)], 1)
    for column in (made, *z.T):
        column -= np.repeat([part.mean() for part in np.split(column, 5)], ROWS)
    e = made - z @ np.linalg.lstsq(z, made, rcond=None)[0] + rng.normal(0, 1, 5 * ROWS)
    at = {
        "motor_angle": motor,
        "load_angle": np.concatenate([*[slow / 50] * 4, np.zeros(ROWS)]),
        "speed": np.concatenate([np.full(4 * ROWS, 1.0), np.full(ROWS, 0.1)]),
        "load": load,
        "direction": np.concatenate([np.ones(4 * ROWS), np.sign(np.gradient(ramp))]),
        "time": np.repeat(100.0 * np.arange(5), ROWS) + np.tile(np.arange(ROWS) * DT, 5),
        "torque_rate": np.gradient(load, DT),
    } | dict.fromkeys(("motor_torque", "temperature"), np.full(5 * ROWS, np.nan))
    run = np.repeat(np.arange(5.0), ROWS)
    found = plainest(homes(Rest(e, run, at, DT, z, np.zeros((30, 30))), "A"))
    assert found[0].coordinate == "load", [(h.coordinate, round(h.share, 2)) for h in found[:4]]
    assert found[0].share > 0.8
    as_it_is = homes(Rest(e, run, at, DT, np.zeros((5 * ROWS, 0)), np.zeros((0, 0))), "A")
    assert max(h.share for h in as_it_is if h.coordinate == "load") < found[0].share - 0.05


def triangle(x: np.ndarray) -> np.ndarray:
    """Between −1 and 1, period 4."""
    return np.abs(np.mod(x - 1, 4) - 2) - 1


@pytest.mark.slow
def test_a_channel_that_coefficients_shared_with_another_one_bend_is_straight_beside_a_baseline_of_its_own() -> None:
    """A seventh wave of θ̃_p that the motor's torque asks for and the angle does not."""
    rng = np.random.default_rng(9)
    at = coordinates(rng)
    run = np.repeat(np.arange(RUNS), ROWS)
    z = np.stack([np.cos(7 * at["motor_angle"]), np.sin(7 * at["motor_angle"])], 1)
    believed = 100.0 * np.eye(2)  # what the other channel knows, for each row: a hundred times what these rows do
    bent = Rest(8.0 * z[:, 0] + rng.normal(0, 1, run.size), run, at, DT, z, believed)
    assert own_excess(bent) < 0.1
    assert np.mean(straightened(bent).e ** 2) == pytest.approx(1.0, abs=0.05)
    dented = Rest(bent.e + 3.0 * (np.abs(at["load"]) > 8.0), run, at, DT, z, believed)
    assert own_excess(dented) > 0.5
    assert plainest(homes(straightened(dented), "M"))[0].coordinate == "load"


@pytest.mark.slow
def test_another_kinematic_error_from_one_run_on_is_one_thing_and_not_what_the_way_or_the_load_makes() -> None:
    rng = np.random.default_rng(8)
    at = coordinates(rng)

    def told(e: np.ndarray) -> float:
        r = Rest(6.0 * e + rng.normal(0, 1, e.size), np.repeat(np.arange(RUNS), ROWS), at, DT, *NO_BASELINE)
        found = turned_since(Halves(r, folds(r)), "A")
        return found.share if found else 0.0

    wave = np.sin(2 * at["motor_angle"] + 0.4)
    assert told((at["time"] > 50.0) * wave) > 0.95
    assert told(at["direction"] * wave) < 0.5
    assert told(at["load"] / 8.0 * wave) < 0.1


def drives(rng: np.random.Generator) -> At:
    """Slow runs first, fast ones after."""
    at = coordinates(rng)
    return at | {"speed": at["direction"] * np.repeat(np.linspace(1.0, 40.0, RUNS), ROWS)}


def bent_by_a_step(at: At, rng: np.random.Generator, worth: np.ndarray, offset: np.ndarray) -> Rest:
    """Friction that is more from one moment on, of which the baseline has taken on what dry and viscous friction can;
    rows where a floor is worth less of it, and of whose mean a share is the run's own."""
    made = np.stack([at["direction"] * (at["time"] > 70.0), at["direction"], at["speed"]], 1)
    means = np.concatenate([np.tile(x.mean(0), (ROWS, 1)) for x in np.split(made, RUNS)])
    step, *z = (worth[:, None] * (made - offset[:, None] * means)).T
    e = 8.0 * step + rng.normal(0, 1, step.size)
    baseline = np.stack(z, 1)
    left = e - baseline @ np.linalg.lstsq(baseline, e, rcond=None)[0]
    run = np.repeat(np.arange(RUNS), ROWS)
    return Rest(left, run, at, DT, baseline, np.zeros((2, 2)), own_zeros=False, worth=worth, offset=offset)


@pytest.mark.slow
@pytest.mark.parametrize("uneven", [False, True], ids=["one floor", "floors and offsets of their own"])
def test_friction_that_steps_up_before_all_fast_runs_is_told_beside_the_baseline_it_bent(uneven: bool) -> None:
    rng = np.random.default_rng(11)
    at = drives(rng)
    odd = np.repeat(np.arange(RUNS) % 3 == 2, ROWS) & uneven
    bent = bent_by_a_step(at, rng, np.where(odd, 0.2, 1.0), np.where(odd, 0.6, 0.0))
    found = plainest(homes(bent, "M"))[0]
    assert (found.coordinate, found.share) == ("time", pytest.approx(1.0, abs=0.05))


@pytest.mark.parametrize(("most", "first"), [(0.5, True), (0.86, False)])
def test_a_step_in_time_is_said_first_unless_the_speed_beside_the_way_foretells_more(
    monkeypatch: pytest.MonkeyPatch, most: float, first: bool
) -> None:
    """Shoes that drag on a shaft below some speed, and slow runs that were mostly taken first."""
    nothing: Any = None
    monkeypatch.setattr(unknown, "since", lambda h, channel, sense: Home("time", channel, 0.72))
    steps = unknown._at_once(nothing, "M", [Home("speed", "M", 0.3), Home("time", "M", 0.7)], most)
    assert {step.first for step in steps} == {first}


def test_within_a_seventh_of_a_turn_no_order_is_told_that_does_not_come_round_once() -> None:
    rng = np.random.default_rng(10)
    swing = 0.44 * np.sin(np.linspace(0.0, 20.0, RUNS * ROWS))  # rad
    at = coordinates(rng) | {"load_angle": swing}
    bent = Rest(8.0 * np.cos(3 * swing) + rng.normal(0, 1, swing.size), np.repeat(np.arange(RUNS), ROWS), at, DT,
                *NO_BASELINE)  # fmt: skip
    found = best_order(Halves(bent, folds(bent)), "load_angle", "A", SENSES[0])
    assert found is not None
    assert (found.order or 0.0) > 7.0


def test_where_no_run_could_be_fitted_none_has_a_zero() -> None:
    r = Rest(np.ones(5), np.zeros(5), {}, 0.01, np.zeros((5, 0)), np.zeros((0, 0)))
    assert Beside(np.empty(0), np.empty(0), np.empty(0)).of(r).tolist() == [0.0] * 5


def test_a_torque_rises_nowhere_in_a_log_too_short_to_say() -> None:
    assert rising(np.arange(30.0)).tolist() == [0.0] * 30
    assert (rising(np.arange(200.0))[60:140] > 0).all()


@pytest.mark.parametrize(
    ("channel", "sensed", "expected"),
    [("A", True, "load_angle"), ("M", False, "load_angle"), ("M", True, "motor_angle")],
)
def test_what_a_torque_sensor_before_the_output_does_not_see_is_the_motors(
    channel: str, sensed: bool, expected: str
) -> None:
    motor = np.linspace(0.0, 900.0, 4000)
    at = {"motor_angle": motor, "load_angle": motor / 50.0}
    r = Rest(np.ones(4000), np.zeros(4000), at, DT, np.zeros((4000, 0)), np.zeros((0, 0)), sensed=sensed)
    found = of_the_output(Home("motor_angle", channel, 1.0, order=0.4), r)
    assert found.coordinate == expected


@pytest.mark.parametrize(
    ("channel", "sensed", "order", "expected"),
    [("L", True, 0.393, "load_angle"), ("L", True, 0.5, "motor_angle"), ("L", True, 1.393, "motor_angle"),
     ("M", True, 0.393, "motor_angle"), ("L", False, 0.393, "motor_angle")],
)  # fmt: skip
def test_what_a_torque_sensor_sees_less_than_once_a_turn_of_the_motor_is_the_outputs(
    channel: str, sensed: bool, order: float, expected: str
) -> None:
    """A slug that slips in a drum goes by the way of the output, 19.65 times a turn; but every second turn of the motor
    is the motor's."""
    motor = np.linspace(0.0, 900.0, 4000)
    at = {"motor_angle": motor, "load_angle": motor / 50.0}
    r = Rest(np.ones(4000), np.zeros(4000), at, DT, np.zeros((4000, 0)), np.zeros((0, 0)), sensed=sensed)
    found = of_the_output(Home("motor_angle", channel, 1.0, order=order), r)
    assert (found.coordinate, found.order) == (
        expected,
        pytest.approx(50 * order if expected == "load_angle" else order),
    )


@pytest.mark.parametrize(("order", "expected"), [(3.46, "load_angle"), (9.46, "motor_angle"), (1.5, "motor_angle")])
def test_neither_too_many_teeth_nor_two_turns_of_the_motor_are_the_outputs(order: float, expected: str) -> None:
    motor = np.linspace(0.0, 900.0, 4000)
    at = {"motor_angle": motor, "load_angle": motor / 50.0}
    r = Rest(np.ones(4000), np.zeros(4000), at, DT, np.zeros((4000, 0)), np.zeros((0, 0)))
    assert of_the_output(Home("motor_angle", "A", 1.0, order=order), r).coordinate == expected


@pytest.mark.parametrize(
    ("made", "order"),
    [(lambda at: whirling(at), 0.47), (lambda at: whirling(at, 3.0), None), (lambda at: 0.0 * at["time"], None)],
)
def test_an_order_of_another_phase_in_each_run_is_no_whole_one(
    made: Callable[[At], np.ndarray], order: float | None, rng: np.random.Generator
) -> None:
    """A whole one comes back at the same angle in every run, and is looked for so."""
    at = coordinates(rng)
    e = made(at) + rng.normal(0, 1, RUNS * ROWS)
    r = Rest(e, np.repeat(np.arange(RUNS), ROWS), at, DT, *NO_BASELINE)
    found = own_phases(Halves(r, folds(r)), "M")
    assert (found.order if found else None) == (pytest.approx(order, abs=0.005) if order else None)


def test_one_of_runs_of_one_speed_may_as_well_be_a_frequency(rng: np.random.Generator) -> None:
    at = coordinates(rng)
    slow = {name: x[: 2 * ROWS] for name, x in at.items()}
    e = 3.0 * np.cos(0.47 * slow["motor_angle"]) + rng.normal(0, 1, 2 * ROWS)
    r = Rest(e, np.repeat(np.arange(2), ROWS), slow, DT, *(x[: 2 * ROWS] if len(x) else x for x in NO_BASELINE))
    assert own_phases(Halves(r, folds(r)), "M") is None


def test_one_that_is_a_whole_one_of_the_output_is_the_outputs(rng: np.random.Generator) -> None:
    at = coordinates(rng)
    r = Rest(whirling(at, 0.48) + rng.normal(0, 1, RUNS * ROWS), np.repeat(np.arange(RUNS), ROWS), at, DT, *NO_BASELINE)
    found = own_phases(Halves(r, folds(r)), "L")
    assert found is not None
    assert (found.coordinate, found.order) == ("load_angle", 24.0)
