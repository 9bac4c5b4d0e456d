"""Names that go again: of a size that may be zero, or without which no more is left."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from rig.analysis.tracing.selection import needless
from rig.analysis.tracing.thresholds import QUIET
from rig.model.effect import Parameter


def solution(eq: str, *terms: Any) -> Any:
    return SimpleNamespace(design=SimpleNamespace(eq=eq, terms=terms))


def prepared(*own: str) -> Any:
    """With those effects that every run has in its own way."""
    return SimpleNamespace(own=SimpleNamespace(made={name: {(0, "M"): None} for name in own}, parameters={}))


def scored(name: str, overall: float, **said: Any) -> Any:
    """A score of which nothing speaks for the name, but for what is said."""
    so_far = dict.fromkeys(("as_repeats", "fairly", "plain", "all_there_is", "is_foretold"), False) | {"share": 0.7}
    so_far["ground"] = ((0, "M"),)
    return SimpleNamespace(name=name, overall=overall, **(so_far | said))


@pytest.fixture(autouse=True)
def repeated(monkeypatch: pytest.MonkeyPatch) -> None:
    """Enough was repeated, where a test says no other."""
    monkeypatch.setattr(needless, "_few_repeats", lambda p, runs: False)


@pytest.mark.parametrize(("needed", "few", "over", "left"), [
    ("presliding", False, 1.5, ["presliding"]), ("both", False, 1.5, ["stribeck", "presliding"]),
    ("both", True, 1.5, []), ("both", False, 1.04, ["stribeck"]),
])  # fmt: skip
def test_of_two_sizes_that_may_be_zero_the_one_that_is_not_needed_goes(
    monkeypatch: pytest.MonkeyPatch, needed: str, few: bool, over: float, left: list[str]
) -> None:
    """The one that does less is tried first; where that cannot go the other is; where few repeats tell the floor, none
    is needed for what is left over that. Nor is one of them where all runs together leave no more than the floor
    without it, whatever a single run does, and the other one is known."""
    monkeypatch.setattr(needless, "_few_repeats", lambda p, runs: few)
    work = {"stribeck": 900.0, "presliding": 500.0}
    words = {name: (SimpleNamespace(name="size", holds_zero=over > QUIET or name == "presliding"),) for name in work}

    def with_(names: list[str], loud: bool) -> Any:
        scores = [scored(name, work[name]) for name in names]
        effect = SimpleNamespace(sizes=lambda parameters: parameters[:1], shape_names=(), loose=())
        terms = [SimpleNamespace(name=name, effect=effect) for name in names]
        s = solution("eq", *terms)
        rest = {"left": over if len(names) == 1 else 2.0, "solution": s, "p": prepared()}
        return SimpleNamespace(scores=scores, words=words, loud=loud, names=set(names), **rest)

    def without(of: Any, name: str, runs: object, covered: object) -> Any:
        rest = [n for n in of.names if n != name]
        return with_(rest, needed == "both" or needed not in rest)

    monkeypatch.setattr(needless, "_without", without)
    nothing: Any = None
    assert needless.without_insignificant(with_(["stribeck", "presliding"], False), (), nothing).names == set(left)


@pytest.mark.parametrize(("plain", "needed", "half", "together", "left"), [
    (True, True, 0.11, 1.0, {"stribeck"}), (False, True, 0.11, 1.0, set()), (True, False, 0.11, 1.0, set()),
    (True, True, 4.0, 1.0, set()), (True, True, 4.0, 67.0, {"stribeck"}), (False, True, 4.0, 67.0, set()),
])  # fmt: skip
def test_a_fall_that_is_all_there_is_stays_whatever_it_is_at_rest(
    monkeypatch: pytest.MonkeyPatch, plain: bool, needed: bool, half: float, together: float, left: set[str]
) -> None:
    """Runs at three speeds tell that friction falls, and not how large it is where none of them was (exam 67, 42); of
    what may be forty times itself, or as much the other way, nothing is told (66, 02), unless its coefficients together
    are: a drive that heats itself loses what is constant or what goes with the speed."""
    monkeypatch.setattr(needless, "_few_repeats", lambda p, runs: True)
    monkeypatch.setattr(needless, "covariance", lambda s: None)
    monkeypatch.setattr(needless, "_told", lambda s, known, terms: together)

    def with_(names: list[str], loud: bool) -> Any:
        scores = [scored(name, 9.0, all_there_is=plain) for name in names]
        effect = SimpleNamespace(sizes=lambda parameters: parameters[:1], shape_names=(), loose=())
        terms = [SimpleNamespace(name=name, effect=effect) for name in names]
        size = Parameter("tau_s_minus_tau_c", 0.1, (0.1 - half, 0.1 + half), "N·m")
        words = dict.fromkeys(names, (size,))
        s = solution("eq", *terms)
        return SimpleNamespace(scores=scores, words=words, loud=loud, names=set(names), solution=s, p=prepared())

    monkeypatch.setattr(needless, "_without", lambda of, name, runs, covered: with_([], needed))
    nothing: Any = None
    assert needless.without_insignificant(with_(["stribeck"], False), (), nothing).names == left


@pytest.mark.parametrize(("name", "foretold", "left"), [
    ("slow_2", True, {"presliding"}), ("slow_1 (part held out)", True, set()), ("slow_2", False, set()),
])  # fmt: skip
def test_what_another_run_shows_as_it_was_foretold_is_not_nothing(
    monkeypatch: pytest.MonkeyPatch, name: str, foretold: bool, left: set[str]
) -> None:
    """One run alone turned back among the fitted ones: its size is known to any number, and another run has just that
    (exam 104, 24). A part of the same run vouches for nothing."""
    monkeypatch.setattr(needless, "_few_repeats", lambda p, runs: True)
    p = prepared()
    p.eq = SimpleNamespace(runs=[SimpleNamespace(name=name)])

    def with_(names: list[str], loud: bool) -> Any:
        scores = [scored(n, 20.0, is_foretold=foretold, ground=((0, "R"),)) for n in names]
        effect = SimpleNamespace(sizes=lambda parameters: parameters[:1], shape_names=(), loose=())
        s = solution("eq", *(SimpleNamespace(name=n, effect=effect) for n in names))
        words = dict.fromkeys(names, (Parameter("tau_presliding", 0.1, (-0.1, 0.3), "N·m"),))
        return SimpleNamespace(scores=scores, words=words, loud=loud, names=set(names), solution=s, p=p)

    monkeypatch.setattr(needless, "_without", lambda of, n, runs, covered: with_([], True))
    nothing: Any = None
    assert needless.without_insignificant(with_(["presliding"], False), (), nothing).names == left


@pytest.mark.parametrize(("known", "left"), [(False, {"weight"}), (True, {"weight", "runout", "spring"})])
def test_beside_an_unknown_rest_two_sizes_that_lean_on_each_other_and_are_not_known_go_together(
    monkeypatch: pytest.MonkeyPatch, known: bool, left: set[str]
) -> None:
    """An arm's log of seven seconds: without either the other one is no effect any more."""
    half = 0.1 if known else 0.9
    words = {name: (Parameter("size", 1.0, (1.0 - half, 1.0 + half), "rad"),) for name in ("runout", "spring")}
    work, effect = {"weight": 47.0, "runout": 6.0, "spring": 2.0}, SimpleNamespace(sizes=lambda found: found[:1])
    vars(effect).update(shape_names=(), loose=())

    def with_(names: set[str]) -> Any:
        s = solution("eq", *(SimpleNamespace(name=name, effect=effect) for name in names))
        scores = [scored(name, work[name]) for name in names]
        return SimpleNamespace(scores=scores, words=words, loud=True, names=names, solution=s, p=prepared())

    def without(of: Any, name: str, runs: object, covered: object) -> Any:
        return with_({"weight"})

    monkeypatch.setattr(needless, "_without", without)
    nothing: Any = None
    assert needless.without_insignificant(with_(set(work)), (), nothing).names == left


@pytest.mark.parametrize(("plain", "share", "left"), [
    (True, 0.99, {"eccentricity", "drag"}), (False, 0.99, {"eccentricity"}), (True, 0.85, {"eccentricity"}),
])  # fmt: skip
def test_a_law_that_takes_nearly_all_plainly_stands_though_its_size_at_one_speed_is_hardly_known(
    monkeypatch: pytest.MonkeyPatch, plain: bool, share: float, left: set[str]
) -> None:
    """A drag with the cube of the speed, 0.44 ± 0.33 mN·m at 10 rad/s and all there is at 50."""
    words = {
        "drag": (Parameter("drag_at_10_rad_s", 4.4e-4, (1.1e-4, 7.6e-4), "N·m"),),
        "eccentricity": (Parameter("size", 5e-3, (4.6e-3, 5.4e-3), "rad"),),
    }
    effect = SimpleNamespace(sizes=lambda found: found[:1], shape_names=(), loose=())

    def with_(names: set[str]) -> Any:
        s = solution("eq", *(SimpleNamespace(name=name, effect=effect) for name in sorted(names)))
        scores = [
            scored(
                name, 30.0 if name == "eccentricity" else 20.0, plain=plain, share=share,
            )
            for name in sorted(names)
        ]  # fmt: skip
        return SimpleNamespace(scores=scores, words=words, loud=True, names=names, solution=s, p=prepared())

    monkeypatch.setattr(needless, "_without", lambda of, name, runs, reach: with_(of.names - {name}))
    nothing: Any = None
    assert needless.without_insignificant(with_({"eccentricity", "drag"}), (), nothing).names == left


@pytest.mark.parametrize(("loud", "speed", "all_there_is", "left"), [
    (True, (-0.2, 1.6), "", ["play"]), (False, (-0.2, 1.6), "", ["play", "stribeck"]),
    (True, (0.2, 1.6), "", ["play", "stribeck"]), (True, (-0.2, 1.6), "stribeck", ["play", "stribeck"]),
])  # fmt: skip
def test_beside_an_unknown_rest_no_law_is_named_whose_scale_may_be_zero(
    monkeypatch: pytest.MonkeyPatch, loud: bool, speed: tuple[float, float], all_there_is: str, left: list[str]
) -> None:
    """Its size may be as sure as it likes: any law that lifts the same runs has that. But where it leaves nothing of
    the channels it acts in, the rest is in another one."""
    words = {
        "stribeck": (Parameter("dF", 0.9, (0.8, 1.0), "N·m"), Parameter("w_s", 0.7, speed, "rad/s")),
        "play": (Parameter("b", 1e-4, (0.9e-4, 1.1e-4), "rad"),),
    }
    shapes: dict[str, tuple[str, ...]] = {"stribeck": ("w_s",), "play": ()}

    def with_(names: list[str]) -> Any:
        effect = {
            name: SimpleNamespace(
                sizes=lambda found: found[:1], shape_names=shapes[name], loose=(True,) * len(shapes[name])
            )
            for name in names
        }
        terms = [SimpleNamespace(name=name, effect=effect[name]) for name in names]
        scores = [scored(name, 9.0 if name == "play" else 5.0, all_there_is=name == all_there_is) for name in names]
        s = solution("eq", *terms)
        return SimpleNamespace(scores=scores, words=words, loud=loud, names=set(names), solution=s, p=prepared())

    monkeypatch.setattr(needless, "_without", lambda of, name, runs, reach: with_([n for n in of.names if n != name]))
    nothing: Any = None
    assert needless.without_insignificant(with_(["play", "stribeck"]), (), nothing).names == set(left)


@pytest.mark.parametrize(("half", "own", "left"), [
    (2.1e-6, ("missed_counts",), []), (0.5e-6, ("missed_counts",), ["spring"]), (2.1e-6, (), ["spring"]),
])  # fmt: skip
def test_beside_counts_that_runs_lose_no_name_stands_whose_size_is_hardly_known(
    monkeypatch: pytest.MonkeyPatch, half: float, own: tuple[str, ...], left: list[str]
) -> None:
    """A spring softer by (2.2 ± 2.1)·10⁻⁶ rad/(N·m), in half of one lock test that jumped."""
    words = {"spring": (Parameter("extra_compliance", 2.2e-6, (2.2e-6 - half, 2.2e-6 + half), "rad/(N·m)"),)}
    effect = SimpleNamespace(sizes=lambda found: found[:1])

    def with_(names: list[str]) -> Any:
        s = solution("eq", *(SimpleNamespace(name=name, effect=effect) for name in names))
        scores = [scored(name, 3.0) for name in names]
        return SimpleNamespace(scores=scores, words=words, loud=False, names=set(names), solution=s, p=prepared(*own))

    monkeypatch.setattr(needless, "_without", lambda of, name, runs, reach: with_([n for n in of.names if n != name]))
    nothing: Any = None
    assert needless.without_insignificant(with_(["spring"]), (), nothing).names == set(left)


@pytest.mark.parametrize(("unread", "now", "left", "expected"), [
    (True, 1.0, 1.01, ["weight"]), (True, 1.0, 1.1, ["weight", "mode"]), (False, 1.0, 1.01, ["weight", "mode"]),
    (True, 0.5, 0.9, ["weight"]),  # nothing above the floor without it
])  # fmt: skip
def test_under_a_load_nobody_read_a_name_goes_without_which_no_more_is_left(
    monkeypatch: pytest.MonkeyPatch, unread: bool, now: float, left: float, expected: list[str]
) -> None:
    """A mode stood for an inertia that was not known yet; the weight is needed."""
    size = {"weight": 9.0, "mode": 2.0}
    run = SimpleNamespace(load_unread=unread, look=SimpleNamespace(inertia=True), carries=True)

    def with_(names: list[str], left: float) -> Any:
        scores = [SimpleNamespace(name=name, size=size[name]) for name in names]
        return SimpleNamespace(scores=scores, left=left, names=names, fitted_runs=[run])

    def without(of: Any, name: str, runs: object, covered: object) -> Any:
        return with_([n for n in of.names if n != name], left if name == "mode" else 40.0)

    monkeypatch.setattr(needless, "_without", without)
    nothing: Any = None
    assert needless.without_needless(with_(["weight", "mode"], now), (), nothing).names == expected
