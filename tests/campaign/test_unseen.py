"""A sweep on a twin without the effect it looks for says so before anything moves, and which twin has it."""

from __future__ import annotations

from pathlib import Path

import pytest

from rig.bench import Bench, read
from rig.campaign import run, summary
from rig.campaign.dry_run import lines
from rig.campaign.plan import plan_of, read_plan
from rig.campaign.planner import planned
from rig.campaign.unseen import unseen
from tests.campaign.plans import LOADED, REST, campaign
from tests.campaign.rigs import make


def said(name: str, bench: Bench) -> list[str]:
    return list(unseen(planned(plan_of(name, {}), bench, 1)))


def test_a_load_sweep_on_the_plain_twin_is_told_to_show_nothing_and_where_fig_9_is() -> None:
    (sentence,) = said("load-sweep", read("twin"))
    for words in ("bench 'twin'", "A_inf = 1", "same under every weight", "--bench twin-paper", "Fig. 9"):
        assert words in sentence


def test_an_assembly_sweep_on_the_plain_twin_is_told_so_of_depth_and_of_load() -> None:
    by_load, by_depth = said("assembly-sweep", read("twin"))
    assert "Fig. 9" in by_load
    assert "error_per_mm = 0" in by_depth
    assert "Fig. 10" in by_depth


@pytest.mark.parametrize("name", ["load-sweep", "assembly-sweep"])
def test_where_the_twin_has_the_effect_nothing_is_said(name: str) -> None:
    assert said(name, read("twin-paper")) == []


@pytest.mark.parametrize("key", ["load_dependent_error.A_inf=0.55", "stiffness.by_angle=0.05"])
def test_what_the_operator_sets_counts(key: str) -> None:
    assert said("load-sweep", read("twin", [f"twin.effects.{key}"])) == []


def test_a_campaign_without_a_sweep_and_one_under_a_single_weight_are_told_nothing() -> None:
    assert list(unseen(campaign(REST, LOADED))) == []
    assert list(unseen(planned(read_plan("modest"), read("twin"), 1))) == []


def test_the_dry_run_ends_with_it() -> None:
    told = list(lines(planned(plan_of("load-sweep", {}), read("twin"), 1)))
    assert told[-1] == said("load-sweep", read("twin"))[0]


@pytest.mark.slow
def test_it_is_said_before_the_proof_and_stays_in_the_summary(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run, "unseen", lambda campaign: [f"nothing to see in {len(campaign.items)} runs"])
    _, journal, desk = make(tmp_path, campaign(REST))
    assert desk.said[0] == "nothing to see in 1 runs"
    assert "nothing to see in 1 runs" in list(summary.lines(journal))


@pytest.mark.slow  # imports the drivers
def test_a_real_rig_is_told_nothing() -> None:
    assert said("load-sweep", read("twin-can")) == []
