"""What stays when every effect was eliminated, the gear as the baseline alone told it; and what stands in for what."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from rig.analysis.tracing.selection import select


def solution(eq: str, *terms: Any) -> Any:
    return SimpleNamespace(design=SimpleNamespace(eq=eq, terms=terms))


@pytest.mark.parametrize("astray", [True, False])
def test_what_eliminated_effects_made_of_the_gear_goes_with_them(monkeypatch: pytest.MonkeyPatch, astray: bool) -> None:
    p: Any = SimpleNamespace(eq="as prepared", held_out=None, split=SimpleNamespace(fitted=()))
    p.own = SimpleNamespace(made={}, parameters={})
    found: Any = SimpleNamespace(solution=solution("as searched", "an effect"), rough=False)
    none_left = solution("astray" if astray else p.eq)
    monkeypatch.setattr(select, "backward_elimination", lambda s, at: (none_left, "held", []))
    monkeypatch.setattr(select, "without_insignificant", lambda selected, runs, covered: selected)
    monkeypatch.setattr(select, "_floored", lambda p, s, runs: p)
    monkeypatch.setattr(select, "_polished", lambda p, s, so_far, runs, covered: so_far)
    monkeypatch.setattr(select, "_own_kept", lambda p, s: (p, s))
    monkeypatch.setattr(select, "with_confounders", lambda s, runs, covered: s)
    monkeypatch.setattr(select, "design", lambda eq, terms, runs: SimpleNamespace(eq=eq, terms=terms))
    monkeypatch.setattr(select, "carrying", lambda eq, terms: eq)
    monkeypatch.setattr(select, "fit", lambda d: SimpleNamespace(design=d))
    monkeypatch.setattr(select, "unseen", lambda s, at: f"held out {s.design.eq}")
    nothing: Any = None
    left = select.select(p, found, (), nothing)
    assert left.solution.design.eq == "as prepared"
    assert left.held == ("held out as prepared" if astray else "held")


def leaving(left: dict[str, float]) -> Any:
    """Prepared, with unseen runs of which a model of one term leaves that many floors, by its name; at reversals
    friction that builds up leaves more, and less beside the second of them by nothing that counts."""

    def residuals(s: Any, held: Any) -> dict[tuple[int, str], float]:
        name = s.design.terms[0].name
        return {(0, "A"): left[name], (0, "R"): 3.36 - 1e-4 * list(left).index(name)}

    def worst(e: dict[tuple[int, str], float]) -> tuple[float, float]:
        return max(e.values()), max(e.values())

    return SimpleNamespace(held_out=SimpleNamespace(residuals=residuals, worst=worst))


@pytest.mark.parametrize(("leaves", "stays"), [(1.17, "loop in the spring"), (1.0, "loop in the sensor")])
def test_a_confounder_that_leaves_more_of_unseen_runs_takes_no_name_away(
    monkeypatch: pytest.MonkeyPatch, leaves: float, stays: str
) -> None:
    left = {"loop in the spring": 1.09, "loop in the sensor": leaves}
    spring, sensor = (solution("eq", SimpleNamespace(name=name)) for name in left)
    monkeypatch.setattr(select, "with_confounders", lambda s, runs, covered: sensor)
    monkeypatch.setattr(select, "backward_elimination", lambda s, at: (s, "held", []))
    p = leaving(left)
    held: Any = "held"
    nothing: Any = None
    stood = select._stood_in_for(p, (spring, held, []), (), nothing)
    assert [term.name for term in stood[0].design.terms] == [stays]


@pytest.mark.parametrize(
    ("of_motor", "of_shaft", "stays"),
    [
        (1.09, 1.26, "sensor_loop"),  # a little less where no zero was freed (exam 97, case 01)
        (1.11, 1.00, "hysteretic_stiffness"),  # less where every zero is the run's own, as any law would leave
    ],
)
def test_a_law_that_frees_the_zeros_of_a_channel_is_not_judged_by_it(
    monkeypatch: pytest.MonkeyPatch, of_motor: float, of_shaft: float, stays: str
) -> None:
    left = {"hysteretic_stiffness": (1.10, 1.26), "sensor_loop": (of_motor, of_shaft)}
    spring, sensor = (solution("eq", SimpleNamespace(name=name)) for name in left)

    def residuals(s: Any, held: Any) -> dict[tuple[int, str], float]:
        return dict(zip([(0, "M"), (0, "L")], left[s.design.terms[0].name], strict=True))

    monkeypatch.setattr(select, "with_confounders", lambda s, runs, covered: sensor)
    monkeypatch.setattr(select, "backward_elimination", lambda s, at: (s, "held", []))
    p: Any = SimpleNamespace(held_out=SimpleNamespace(residuals=residuals, worst=lambda e: (max(e.values()), 0.0)))
    held: Any = "held"
    nothing: Any = None
    stood = select._stood_in_for(p, (spring, held, []), (), nothing)
    assert [term.name for term in stood[0].design.terms] == [stays]


@pytest.mark.parametrize(("amiss", "stays"), [(1.73, "creep"), (1.2, "hysteretic_stiffness")])
def test_a_loop_that_leaves_much_is_not_named_where_a_creep_explains_nearly_as_much(
    monkeypatch: pytest.MonkeyPatch, amiss: float, stays: str
) -> None:
    """Of unseen runs the creep leaves 1.40 times the floor, the loop 1.20, and more than that where it acts."""
    left = {"hysteretic_stiffness": 1.20, "creep": 1.40}
    loop, creep = (solution("eq", SimpleNamespace(name=name)) for name in left)
    score = SimpleNamespace(name="hysteretic_stiffness", left=amiss)
    monkeypatch.setattr(select, "with_confounders", lambda s, runs, covered: creep)
    monkeypatch.setattr(select, "backward_elimination", lambda s, at: (s, "held", [score] if s is loop else []))
    p = leaving(left)
    held: Any = "held"
    nothing: Any = None
    stood = select._stood_in_for(p, (loop, held, []), (), nothing)
    assert [term.name for term in stood[0].design.terms] == [stays]


@pytest.mark.parametrize(
    ("beside", "without", "sensors", "is_one"),
    [
        (0.037, 0.085, 0.036, True),  # turns under a weight differ by what the load does (exam 102, case 31)
        (0.037, 0.040, 0.036, False),  # the same floor, nearly
        (0.060, 0.120, 0.036, False),  # more than the sensors make: some of it may be noise of friction
        (0.037, 0.085, None, False),
    ],
)
def test_a_floor_beside_effects_that_the_sensors_make_is_one(
    beside: float, without: float, sensors: float | None, is_one: bool
) -> None:
    def measured(rms: float) -> Any:
        noise = SimpleNamespace(sigma=dict.fromkeys("AM", 1.0) | {"L": rms})
        return SimpleNamespace(noise=noise, white={} if sensors is None else {(0, "L"): sensors, (1, "A"): 9.0})

    p: Any = SimpleNamespace(measured=measured(beside), first=measured(without))
    assert select._is_the_sensors(p, measured(without)) is is_one


@pytest.mark.parametrize(
    ("beside", "sensors", "took"),
    [
        (0.022, 0.036, True),  # an inertia that is damped away took on what J_l·θ̈_l makes (exam 104, case 07)
        (0.037, 0.036, False),  # what the sensors make
        (0.022, None, False),
    ],
)
def test_a_floor_beside_effects_below_what_the_sensors_make_is_none(
    beside: float, sensors: float | None, took: bool
) -> None:
    def measured(rms: float) -> Any:
        noise = SimpleNamespace(sigma=dict.fromkeys("AM", 1.0) | {"L": rms})
        return SimpleNamespace(noise=noise, white={} if sensors is None else {(0, "L"): sensors, (1, "A"): 1.0})

    p: Any = SimpleNamespace(measured=measured(beside), first=measured(0.085))
    assert select._took_noise(p, measured(0.085)) is took
