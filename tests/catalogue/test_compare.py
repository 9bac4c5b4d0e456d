"""A change is marked when it is larger than repeats scatter, and not otherwise."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rig.catalogue import compare, trend
from rig.catalogue.compare import Difference, Mark
from rig.catalogue.figures import Figure, common_label, figures
from rig.catalogue.sameness import beside
from rig.catalogue.scatter import Scatter, between, scatter
from rig.cli import main
from rig.commands.compare import changed, shown
from rig.core.errors import UsageError
from tests.catalogue.folders import run

DAYS = ["2026-11-16", "2026-11-17", "2026-11-18"]


def many(root: Path, values: list[float], day: str, first: int = 0) -> list[Path]:
    return [run(root, day, first + k, value) for k, value in enumerate(values)]


def test_a_difference_has_the_interval_of_both_runs(tmp_path: Path) -> None:
    a, b = run(tmp_path, DAYS[0], value=90.0, half=0.3), run(tmp_path, DAYS[1], value=91.0, half=0.4)
    (line,) = compare([a, b]).lines
    d = line.differences[1]
    assert d is not None
    assert (d.value, d.low, d.high) == pytest.approx((1.0, 0.5, 1.5))
    assert d.mark is Mark.UNKNOWN, "there are no repeats"
    assert "no repeats" in d.how


def test_a_change_beyond_the_scatter_of_repeats_is_marked_and_one_within_is_not(tmp_path: Path) -> None:
    first = many(tmp_path, [90.0, 90.2, 89.9, 90.1, 90.0, 90.1], DAYS[0])
    (same,) = many(tmp_path, [90.5], DAYS[1])
    (other,) = many(tmp_path, [93.0], DAYS[2])
    (line,) = compare([first[0], same, other]).lines
    marks = [d.mark if d else None for d in line.differences]
    assert marks == [None, Mark.WITHIN, Mark.CHANGED]
    d = line.differences[2]
    assert d is not None
    assert 0.3 < d.limit < 1.5
    assert "6 repeats" in d.how


def test_a_change_larger_than_scatter_but_within_its_own_interval_is_none(tmp_path: Path) -> None:
    first = many(tmp_path, [90.0, 90.02, 90.01, 90.0, 90.02], DAYS[0])
    vague = run(tmp_path, DAYS[1], value=92.0, half=5.0)
    (line,) = compare([first[0], vague]).lines
    assert line.differences[1] is not None
    assert line.differences[1].mark is Mark.WITHIN


def test_runs_at_other_conditions_or_of_another_origin_are_no_repeats_and_it_is_said(tmp_path: Path) -> None:
    a = run(tmp_path, DAYS[0], 0)
    run(tmp_path, DAYS[0], 1, conditions={"speed_rpm": 300.0})
    run(tmp_path, DAYS[0], 2, backend="sim")
    b = run(tmp_path, DAYS[1], 0, gear={"serial": "SN2"}, conditions={"speed_rpm": 300.0, "tau_ext": 5.0})
    found = compare([a, b])
    d = found.lines[0].differences[1]
    assert d is not None
    assert d.mark is Mark.UNKNOWN
    assert "is of gear SN2" in found.remarks[0]
    assert "speed 9.6 rpm and 300 rpm" in found.remarks[1]


def test_a_gear_that_nobody_named_is_told_as_such(tmp_path: Path) -> None:
    named, unnamed = run(tmp_path, DAYS[0]), run(tmp_path, DAYS[1], gear={})
    remark, *_ = compare([named, unnamed]).remarks
    assert f"{unnamed.name} is of a gear that nobody named, {named.name} of gear " in remark


def test_rounding_is_no_difference(tmp_path: Path) -> None:
    a, b = many(tmp_path, [0.9579, 0.9579 * (1 + 1e-11)], DAYS[0])
    d = compare([a, b]).lines[0].differences[1]
    assert d is not None
    assert (d.value, changed(d, "%")) == (0.0, "no difference")


def test_a_share_far_below_what_counts_has_no_powers_of_ten() -> None:
    rounding = Difference(-6.654e-11, math.nan, math.nan, math.nan, Mark.UNKNOWN, "")
    assert changed(rounding, "%").replace("\u00a0", " ") == "< 0.01 %  reproducibility not known"
    assert changed(replace(rounding, value=1e-3), "%").startswith("< 0.01")
    assert changed(replace(rounding, value=0.02), "%").startswith("+0.02")
    assert shown(Figure("x", "x", 2e-12, "%", math.nan, math.nan)).replace("\u00a0", " ") == "< 0.01 %"


def test_two_repeats_do_not_judge_themselves(tmp_path: Path) -> None:
    a, b = many(tmp_path, [90.0, 99.0], DAYS[0])
    d = compare([a, b]).lines[0].differences[1]
    assert d is not None
    assert d.mark is Mark.UNKNOWN


def test_what_was_counted_is_no_change(tmp_path: Path) -> None:
    a = run(tmp_path, DAYS[0], value=6.0, half=0.0, name="revolutions_forward")
    b = run(tmp_path, DAYS[1], value=12.0, half=0.0, name="revolutions_forward")
    d = compare([a, b]).lines[0].differences[1]
    assert d is not None
    assert d.mark is Mark.NONE


def test_scatter_by_successive_differences_is_that_of_the_runs_and_a_jump_hardly_counts() -> None:
    rng = np.random.default_rng(1)
    sets = [list(rng.normal(90.0, 0.5, 12) + 3.0 * k) for k in range(40)]  # assemblies far apart
    found = scatter(sets)
    assert found.sd == pytest.approx(0.5, rel=0.1)
    assert found.dof == pytest.approx(2 * 11 * 40 / 3, rel=0.05)
    jumped = scatter([[*rng.normal(90.0, 0.5, 15), *rng.normal(100.0, 0.5, 15)]])
    assert jumped.limit() < 10.0, "a jump of twenty standard deviations is seen though it lies among the repeats"


def test_one_in_a_hundred_unchanged_runs_is_marked() -> None:
    rng = np.random.default_rng(2)
    trials, marked = 20_000, 0
    for values in rng.normal(0.0, 1.0, (trials, 8)):
        marked += abs(values[7] - values[6]) > scatter([values[:6]]).limit()
    assert marked / trials == pytest.approx(0.01, abs=0.006)  # degrees of freedom are matched, not exact


def test_degrees_of_freedom_of_one_pair_are_one_and_limits_of_two_kinds_join() -> None:
    pair = scatter([[1.0, 2.0]])
    assert (pair.sd, pair.dof) == pytest.approx((math.sqrt(0.5), 1.0))
    assert between(pair, scatter([])) != between(pair, scatter([]))  # NaN
    assert between(scatter([[1.0, 1.0, 1.0]]), scatter([[2.0, 2.0]])) == 0.0
    big = scatter([list(np.tile([0.0, 1.0], 500))])
    assert between(big, big) == pytest.approx(big.limit(), rel=0.01)


def test_a_trend_marks_the_day_of_the_change_and_follows_on_from_there(tmp_path: Path) -> None:
    many(tmp_path, [90.0, 90.2, 89.9, 90.1], DAYS[0])
    changed, *_ = many(tmp_path, [93.0, 93.2, 92.9], DAYS[1])
    many(tmp_path, [93.1, 92.9], DAYS[2])
    (series,) = trend(tmp_path, "peak-to-peak").series
    assert [s.row.path for s in series.spots if s.changed] == [changed]
    assert [s.assembly for s in series.spots] == [1] * 4 + [2] * 3 + [3] * 2
    assert "1 change larger than reproducibility: 2026-11-17 by +2.95 arcsec" in series.sentence


def test_an_assembly_has_one_number_in_every_series_of_its_gear(tmp_path: Path) -> None:
    run(tmp_path, DAYS[0], 0)
    run(tmp_path, DAYS[1], 1)
    faster = {"speed_rpm": 300.0, "assembly": 1}  # not measured on the first day
    run(tmp_path, DAYS[1], 2, conditions=faster)
    run(tmp_path, DAYS[1], 3, gear={"serial": "SN2"})
    numbers = {(s.gear, s.title): [spot.assembly for spot in s.spots] for s in trend(tmp_path, "peak-to-peak").series}
    assert sorted(numbers.values()) == [[1], [1, 2], [2]]
    assert [found for (gear, _), found in numbers.items() if gear == "SN2"] == [[1]]


def test_a_trend_has_a_series_for_each_gear_procedure_and_point_and_leaves_out_what_does_not_count(
    tmp_path: Path,
) -> None:
    run(tmp_path, DAYS[0], 0)
    run(tmp_path, DAYS[0], 1, status="tripped")
    run(tmp_path, DAYS[0], 2, gear={"serial": "SN2"})
    run(tmp_path, DAYS[0], 3, conditions={"speed_rpm": 300.0})
    found = trend(tmp_path, "kinematic_error_peak_to_peak")
    assert [s.title for s in found.series] == [
        "SN1, kinematic-error, 9.6 rpm", "SN2, kinematic-error, 9.6 rpm", "SN1, kinematic-error, 300 rpm",
    ]  # fmt: skip
    assert found.left_out == 1
    assert len(trend(tmp_path, "PEAK_to_peak", gear="SN2").series) == 1
    with pytest.raises(UsageError, match="none of the runs has a figure 'K1'; expected one of ") as caught:
        trend(tmp_path, "K1")
    assert "peak-to-peak" in str(caught.value)
    assert "hysteresis-loss" not in str(caught.value), "a word that none of these runs can answer"


def test_a_trend_names_what_it_cannot_read_and_counts_it_to_no_other_kind(tmp_path: Path) -> None:
    good = run(tmp_path, DAYS[0], 0)
    bad = run(tmp_path, DAYS[0], 1)
    (bad / "manifest.json").write_text("{")
    found = trend(tmp_path, "peak-to-peak")
    assert (found.left_out, len(found.copies)) == (0, 1)
    assert found.copies[0].startswith(f"{bad.name} is left out: {bad / 'manifest.json'} is not JSON")
    (good / "manifest.json").write_text("")
    with pytest.raises(UsageError, match=rf"^there are no runs in {tmp_path} that can be read; .* is left out: "):
        trend(tmp_path, "peak-to-peak")


def test_a_trend_over_no_runs_says_so_and_blames_no_figure(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=f"^there are no runs in {tmp_path}$"):
        trend(tmp_path, "peak-to-peak")
    run(tmp_path, DAYS[0])
    with pytest.raises(UsageError, match=rf"^there are no runs in {tmp_path} of a gear 'SN9'$"):
        trend(tmp_path, "peak-to-peak", gear="SN9")


def test_a_trend_over_runs_that_were_not_analysed_says_what_analyses_them(tmp_path: Path) -> None:
    folders = [run(tmp_path, DAYS[0], number) for number in range(3)]
    for folder in folders[:2]:
        (folder / "result.json").unlink()
    assert len(trend(tmp_path, "peak-to-peak").series[0].spots) == 1
    others = f"; 2 of 3 are not analysed yet: `hdrig analyse {tmp_path}` makes their figures"
    with pytest.raises(UsageError, match=f"none of the runs has a figure 'K1'; expected one of .*{others}$"):
        trend(tmp_path, "K1")
    (folders[2] / "result.json").unlink()
    told = f"; 3 of 3 are not analysed yet: `hdrig analyse {tmp_path}` makes their figures$"
    for word in ("peak-to-peak", "PEAK_to_peak"):
        with pytest.raises(UsageError, match=f"^none of the runs has a figure '{word}'{told}"):
            trend(tmp_path, word)
    with pytest.raises(UsageError, match=f"^none of the runs has a figure 'peek-to-peak'; did you mean .*{told}"):
        trend(tmp_path, "peek-to-peak")


def test_a_trend_over_runs_whose_analysis_found_no_figures_does_not_ask_for_it_again(tmp_path: Path) -> None:
    folders = [run(tmp_path, DAYS[0], number) for number in range(3)]
    for folder in folders[:2]:
        (folder / "result.json").write_text('{"estimates": {}}')
    told = "2 of 3 were analysed and have no figures: their result.json says why$"
    with pytest.raises(UsageError, match=f"figure 'K1'; expected one of .*peak-to-peak; {told}"):
        trend(tmp_path, "K1")
    (folders[2] / "result.json").unlink()
    waiting = f"1 of 3 is not analysed yet: `hdrig analyse {tmp_path}` makes its figures"
    with pytest.raises(UsageError, match=f"^none of the runs has a figure 'K1'; {waiting}; {told}"):
        trend(tmp_path, "K1")


def test_both_are_json_for_programs_and_lines_for_people(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    first = many(tmp_path, [90.0, 90.2, 89.9, 90.1], DAYS[0])
    (other,) = many(tmp_path, [93.0], DAYS[1])
    assert main(["compare", str(first[0]), str(other)]) == 0
    said = capsys.readouterr().out
    assert "93.00 ± 0.30 arcsec" in said
    assert "+3.00 ± 0.42 arcsec  CHANGED, more than reproducibility" in said
    assert main(["compare", str(first[0]), str(other), "--json"]) == 0
    figure = json.loads(capsys.readouterr().out)["figures"][0]
    assert figure["differences"][1]["mark"] == "changed"
    assert main(["trend", "peak-to-peak", str(tmp_path)]) == 0
    assert "CHANGED by +2.95 arcsec" in capsys.readouterr().out
    assert main(["trend", "peak-to-peak", str(tmp_path), "--json"]) == 0
    points = json.loads(capsys.readouterr().out)["series"][0]["points"]
    assert [p["changed"] for p in points] == [False] * 4 + [True]


def test_a_figure_one_run_alone_has_is_no_line_of_dashes_but_a_sentence(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    a, b, c = run(tmp_path, DAYS[0]), run(tmp_path, DAYS[1]), run(tmp_path, DAYS[2])
    added(a, "drift", "Drift")
    for folder in (a, b):
        added(folder, "swing", "Swing")
    found = compare([a, b, c])
    assert [line.name for line in found.lines] == ["kinematic_error_peak_to_peak", "swing"]
    assert found.remarks == (
        f"{b.name} lacks a figure that another has: Drift",
        f"{c.name} lacks 2 figures that another has: Drift; Swing",
    )
    assert main(["compare", str(a), str(b), str(c)]) == 0
    said = capsys.readouterr().out
    assert "  3  not in this run" in said.split("\n\nSwing\n")[1]


def test_runs_that_share_no_figure_are_refused_with_who_lacks_what(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    a = run(tmp_path, DAYS[0])
    b = run(tmp_path, DAYS[1], name="coulomb", procedure="friction")
    c = run(tmp_path, DAYS[2])
    (c / "result.json").unlink()
    assert main(["compare", str(a), str(b), str(c)]) == 2
    out, err = capsys.readouterr()
    assert not out
    assert err.count("\n") == 1
    assert f"nothing to compare: {c.name} was not analysed (hdrig analyse does so); {b.name} (friction) has no" in err
    assert f"no figure of {a.name} (kinematic-error): Kinematic error, peak to peak" in err
    assert main(["compare", str(c), str(b), "--json"]) == 2
    assert "no figure of" not in capsys.readouterr().err, "the first run has none at all"


def added(folder: Path, name: str, label: str) -> None:
    """One more figure in the result of a run."""
    said = json.loads((folder / "result.json").read_text())
    said["estimates"][name] = {"label": label, "value": 1.0, "unit": "arcsec", "ci95": [0.5, 1.5], "how": "made up"}
    (folder / "result.json").write_text(json.dumps(said))


def test_a_damaged_result_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    a, b = run(tmp_path, DAYS[0]), run(tmp_path, DAYS[1])
    (b / "result.json").write_text("{")
    assert main(["compare", str(a), str(b)]) == 2
    assert "result.json is not JSON" in capsys.readouterr().err
    (series,) = trend(tmp_path, "peak-to-peak").series
    assert len(series.spots) == 1


def test_a_condition_is_told_with_its_unit_and_what_is_no_number_as_it_stands() -> None:
    assert beside("speed_rpm", 9.6, 300.0) == "speed 9.6 rpm and 300 rpm"
    assert beside("tau_ext", 0.0, -5.0) == "tau_ext 0 N·m and -5 N·m"
    assert beside("settle_s", 3.0, "not said") == "settle 3 s and not said"
    assert beside("output_locked", False, True) == "output locked False and True"
    assert beside("odd", 10**400, "x").startswith("odd ")


def test_a_figure_measured_at_unlike_speeds_is_not_called_by_one_of_them() -> None:
    def at(rpm: str) -> Figure:
        return Figure("x", f"θ̃ at {rpm} rpm, peak to peak", 1.0, "arcsec", 0.9, 1.1)

    assert common_label([at("121.2"), at("307.1")]) == "θ̃, peak to peak"
    assert common_label([at("121.2"), at("121.2")]) == "θ̃ at 121.2 rpm, peak to peak"


def test_one_run_alone_is_not_compared(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="given 1 run folder: expected two or more"):
        compare([run(tmp_path, DAYS[0])])


@pytest.mark.parametrize(
    ("said", "rejected"),
    [
        ({"how": "Rejected run. Series."}, True),  # of before `counts`
        ({"how": "Series."}, False),
        ({"how": "Series.", "counts": False}, True),
        ({"how": "Rejected run. Series.", "counts": True}, False),
    ],
)
def test_a_figure_that_does_not_count_is_told_by_its_key_and_in_old_files_by_its_words(
    tmp_path: Path, said: dict[str, Any], rejected: bool
) -> None:
    (tmp_path / "result.json").write_text(json.dumps({"estimates": {"K": {"value": 1.0, "unit": "N·m/rad", **said}}}))
    assert figures(tmp_path)["K"].rejected is rejected


@pytest.mark.parametrize(
    ("dof", "said"), [(1.0, ", 1 degree of freedom)"), (1.6, ", 1.6 degrees of freedom)"), (3.0, ", 3 degrees of")]
)
def test_one_degree_of_freedom_is_one_in_words(dof: float, said: str) -> None:
    assert said in Scatter(0.2, dof, repeats=2, sets=1).words("arcsec")


def test_runs_that_name_no_gear_are_compared_with_a_word(tmp_path: Path) -> None:
    a, b = (run(tmp_path, day, gear={}) for day in DAYS[:2])
    assert (
        "no run names its gear (gear.serial): whether they are of one gear nobody can tell" in compare([a, b]).remarks
    )
    named = run(tmp_path, DAYS[2])
    assert not any("gear.serial" in said for said in compare([a, named]).remarks)


def test_runs_that_turned_at_other_speeds_which_nobody_stated_are_no_repeats(tmp_path: Path) -> None:
    a, b, c = (
        run(tmp_path, DAYS[0], k, rpm, half=1.0, name="mean_speed", conditions={})
        for k, rpm in enumerate((169.1, 507.4, 169.8))
    )
    found = compare([a, b, c])
    (remark,) = [said for said in found.remarks if "conditions" in said]
    assert remark.startswith(b.name)
    assert remark.endswith("speed 170 rpm and 510 rpm")
