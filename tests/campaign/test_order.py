"""Repeats, random order, sentinels: what is moved and what stays."""

from __future__ import annotations

from rig.campaign.order import shuffled
from tests.campaign.plans import HEAD, LOCKED, REST, campaign, turning

RANDOM = HEAD + 'order = "random"\n'
SENTINEL = "\n[sentinel]\nwith = { speed_rpm = 200 }\n"
MANY = [turning(speed, "repeats = 2") for speed in (60, 120, 200, 300, 400)]


def speeds(found: object) -> list[float]:
    return [item.parameters.get("speed_rpm", 0.0) for item in found.items]  # type: ignore[attr-defined]


def test_as_written_means_as_written_repeats_one_after_the_other() -> None:
    found = campaign(turning(60, "repeats = 2"), turning(120))
    assert [(item.parameters["speed_rpm"], item.repeat, item.of) for item in found.items] == [
        (60, 1, 2), (60, 2, 2), (120, 1, 1),
    ]  # fmt: skip


def test_the_same_seed_gives_the_same_order_and_another_seed_another() -> None:
    once, again, other = (speeds(campaign(*MANY, head=RANDOM, seed=seed)) for seed in (4, 4, 5))
    assert once == again
    assert once != other
    assert sorted(once) == sorted(other) == [60, 60, 120, 120, 200, 200, 300, 300, 400, 400]


def test_every_first_repeat_comes_before_any_second_so_that_repeats_lie_apart() -> None:
    found = campaign(*MANY, head=RANDOM, seed=7)
    assert [item.repeat for item in found.items] == [1] * 5 + [2] * 5


def test_random_order_never_moves_a_run_past_a_change_by_hand() -> None:
    parts = [*MANY[:2], turning(200, "weight = 5.0"), turning(300, "weight = 5.0"), LOCKED]
    for seed in range(20):
        found = campaign(*parts, head=RANDOM, seed=seed)
        assert [item.rigging.tau_ext for item in found.items] == [0, 0, 0, 0, 5, 5, 0]
        assert found.items[-1].rigging.output_locked


def test_over_many_seeds_every_run_gets_to_every_place() -> None:
    items = list(campaign(*[turning(speed) for speed in (60, 120, 200)]).items)
    first = {shuffled(items, seed)[0].parameters["speed_rpm"] for seed in range(50)}
    assert first == {60, 120, 200}


def test_sentinels_stand_at_the_start_the_middle_and_the_end() -> None:
    found = campaign(*[turning(300) for _ in range(6)], head=HEAD + SENTINEL)
    kinds = [item.kind for item in found.items]
    assert kinds == ["sentinel", "step", "step", "step", "sentinel", "step", "step", "step", "sentinel"]
    assert [item.note for item in found.items if item.kind == "sentinel"] == [
        "sentinel, start", "sentinel, middle", "sentinel, end",
    ]  # fmt: skip


def test_the_middle_is_that_of_the_time_and_not_of_the_count() -> None:
    long = '\n[[step]]\nprocedure = "standstill"\nwith = { duration = 500 }\n'
    found = campaign(long, *[turning(300) for _ in range(5)], head=HEAD + SENTINEL)
    assert [item.kind for item in found.items].index("sentinel", 1) == 2


def test_the_middle_sentinel_goes_where_nothing_has_to_be_taken_off_for_it() -> None:
    loaded = [turning(300, "weight = 5.0") for _ in range(3)]
    found = campaign(turning(300), turning(300), *loaded, head=HEAD + SENTINEL)
    assert [item.kind for item in found.items].index("sentinel", 1) == 3


def test_a_sentinel_is_made_in_the_assembly_the_rig_then_has_and_never_loaded() -> None:
    found = campaign(turning(300), turning(300, "depth_mm = 0.1", "weight = 5.0"), head=HEAD + SENTINEL)
    last = found.items[-1]
    assert (last.kind, last.rigging.tau_ext, last.rigging.assembly, last.rigging.depth_mm) == ("sentinel", 0.0, 2, 0.1)


def test_the_warm_up_comes_before_everything_as_often_as_it_is_repeated() -> None:
    warm = '\n[warm_up]\nprocedure = "constant-torque"\nwith = { speed_rpm = 100 }\nrepeats = 3\n'
    found = campaign(REST, head=HEAD + SENTINEL + warm)
    assert [item.kind for item in found.items][:4] == ["warm-up"] * 3 + ["sentinel"]
