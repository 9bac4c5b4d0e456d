"""The page of a trace: each verdict in its own words, errors beside their floors, what others wrote only shown."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rig.analysis.tracing.answer import Candidate
from rig.analysis.tracing.fit.channels import AT_REVERSALS
from rig.analysis.tracing.outcome.each_run import AT_LOAD, beside_the_numbers, of_each_run
from rig.analysis.tracing.outcome.record import document
from rig.analysis.tracing.outcome.result import Before, Floor, Found, Trace
from rig.analysis.tracing.outcome.told import PARAMETERS
from rig.model.effect import parameter
from rig.model.effects import LIBRARY
from rig.report.trace import page
from rig.report.trace import words as in_words
from rig.report.trace.campaign import Provenance, provenance
from rig.report.trace.cards import cards
from rig.report.trace.figures import home
from rig.report.trace.tables import floors
from tests.report.test_page import HOSTILE, Reader
from tests.report.trace import made_up

pytestmark = pytest.mark.xdist_group("trace page")  # what the module makes is made once, not for every worker


def bare(trace: Trace) -> Trace:
    """Without what figures are drawn from: the words alone, which takes no time."""
    return replace(trace, curves={}, before=Before({}, trace.before.pooled), after=Before({}, trace.after.pooled))


def read(trace: Trace, source: Provenance | None = None) -> Reader:
    return Reader(page.render(trace, source or made_up.source()))


@pytest.fixture(scope="module")
def pages() -> dict[str, Reader]:
    return {name: read(bare(make())) for name, make in made_up.ALL.items()}


@pytest.mark.slow
@pytest.mark.parametrize("status", made_up.ALL)
def test_the_page_holds_together(pages: dict[str, Reader], status: str) -> None:
    found = pages[status]
    assert len(found.ids()) == len(set(found.ids()))
    wanted = {value[1:] for _, name, value in found.attributes if name == "href"}
    assert wanted <= set(found.ids())
    assert not any(later - earlier > 1 for earlier, later in zip(found.headings, found.headings[1:], strict=False))


@pytest.mark.parametrize(
    ("status", "said"),
    [
        ("explained", "Explained"),
        ("no_missing_effect", "it does not say that the gear has no other effect"),
        ("ambiguous", "Naming one would be a guess"),
        ("unknown_effect", "no physics is claimed for it"),
    ],
)
def test_every_verdict_has_its_own_honest_words(pages: dict[str, Reader], status: str, said: str) -> None:
    assert said in pages[status].words
    assert all(said not in other.words for name, other in pages.items() if name != status)


def test_orders_beside_a_load_that_shrinks_them_say_at_which_load_they_hold(pages: dict[str, Reader]) -> None:
    assert "Amplitudes after are those without load" in pages["explained"].words
    assert "of order 2 28.8 arcsec" in pages["explained"].words  # 62.4 times A_inf
    assert "many times T_c" not in pages["ambiguous"].words


def test_the_floors_of_the_page_are_told_apart(pages: dict[str, Reader]) -> None:
    assert "A held-out run is judged by the floor of its own condition" in pages["explained"].words


def test_a_floor_stands_with_its_interval_where_it_has_one() -> None:
    angle, motor = floors(made_up.explained())
    assert angle[1] == "0.908 (0.846 to 0.990)\xa0arcsec"
    assert motor[1] == "2.00\xa0mN·m"


def test_what_each_run_has_to_itself_is_said_of_vibrations_and_steps_alone() -> None:
    steps, shaken = (Found(name, (), 0.9, each_run=True) for name in ("missed_counts", "external_vibration"))
    drag, way, load = (
        Found(name, (), 0.9) for name in ("quadratic_drag", "missed_counts", "load_dependent_kinematic_error")
    )
    assert of_each_run([drag]) == of_each_run([way]) == ""  # one law for all runs
    said = of_each_run([steps, shaken])
    assert "its own instants of the steps or zero after them and phase and amplitude of the vibration" in said
    assert beside_the_numbers([steps]) == [of_each_run([steps])]
    assert beside_the_numbers([load]) == [AT_LOAD]
    assert beside_the_numbers([drag]) == []


def test_what_stands_beside_its_numbers_is_not_said_again_below() -> None:
    words = read(bare(replace(made_up.explained(), notes=(AT_LOAD,)))).words
    assert AT_LOAD not in words
    assert "Amplitudes after are those without load" in words


def test_no_share_in_the_json_is_above_all() -> None:
    base = made_up.explained()
    more = replace(base, effects=tuple(replace(e, share=1.4) for e in base.effects))
    assert [e["share_removed"] for e in document(more)["effects"].values()] == [1.0]


def test_a_law_without_a_name_is_told_in_the_place_of_the_curve() -> None:
    said = "The torque sensor has two gains: for positive torque the gain is larger by 2.0 ± 0.1 %."
    words = read(bare(replace(made_up.unknown(), law=(said,), added_curves=()))).words
    assert f"A law that is no effect of the library. {said}" in words
    assert "A curve without a name" not in words
    beside = read(bare(replace(made_up.unknown(), law=(said,)))).words
    assert f"{said} A curve without a name beside it, in the load angle, order 37 per turn; no physics" in beside


def test_a_curve_that_was_not_added_is_not_said_to_be() -> None:
    words = read(bare(replace(made_up.unknown(), added_curves=()))).words
    assert "Nothing was added: no curve in the load angle, order 37 per turn foretells" in words
    assert "no physics is claimed for it" not in words


def test_runs_beyond_the_fitted_range_decide_nothing_and_no_rival_is_spoken_of() -> None:
    verdict = replace(made_up.ambiguous().verdict, effects=(), rivals=())
    words = read(bare(replace(made_up.ambiguous(), verdict=verdict, effects=(), next_run=None))).words
    assert "The fit was asked for more than it was told" in words
    assert "Nothing was added: the fitted runs do not reach" in words
    assert "More than one effect" not in words


def test_no_coordinate_predicts_more_than_all() -> None:
    assert "177" not in " ".join(home.told({"share.A": np.array([1.77, *[0.1] * 10])}))


def test_the_error_before_and_after_stands_beside_its_floor(pages: dict[str, Reader]) -> None:
    words = pages["explained"].words
    assert "8.20 → 0.910 arcsec" in words
    assert "9.10 → 1.01 × the floor" in words
    assert "each run over the floor of its conditions, RMS 0.900 arcsec" in words
    assert "2.80 → 2.00 mN·m" in words  # 0.0028 and 0.002 N·m


def test_where_nothing_was_added_there_is_no_before_and_after(pages: dict[str, Reader]) -> None:
    words = pages["no_missing_effect"].words
    assert "0.900 arcsec" in words
    assert "→" not in words
    assert "How far the baseline moved" not in words


def test_the_size_of_the_effect_has_its_interval_in_the_verdict(pages: dict[str, Reader]) -> None:
    words = pages["explained"].words
    assert "A_inf = 0.461 ± 0.011 (A_∞, share of the largest order" in words
    assert "lag = 4.30 ± 0.20 ms (time constant by which the kinematic error follows the torque)" in words


def test_no_parameter_of_an_effect_is_dropped_from_the_head_without_a_word_where_it_is() -> None:
    base = bare(made_up.explained())

    def head(count: int) -> str:
        some = tuple(parameter(f"x_{i}", float(i), 0.1, "1") for i in range(1, count + 1))
        return in_words.sizes([replace(base.effects[0], parameters=some)])[0]

    assert head(5).endswith("x_5 = 5.00 ± 0.10.")
    assert "more" not in head(7)
    assert head(9).endswith("x_6 = 6.00 ± 0.10; 3 more under 4, What was added.")


def test_two_effects_are_effects() -> None:
    base = made_up.explained()
    two = replace(base, effects=(*base.effects, Found("quadratic_drag", (parameter("drag", 0.1, 0.01, "N·m"),), 0.9)))
    assert "Baseline and effect were" in in_words.added(base)
    assert "Baseline and effects were" in in_words.added(two)


def test_what_the_refit_could_not_move_is_said_below_the_table(pages: dict[str, Reader]) -> None:
    still = (*made_up.explained().baseline, parameter("J_l", 0.88, 0.003, "kg·m²"))
    moved = (*made_up.explained().baseline_after, still[-1])
    words = read(bare(replace(made_up.explained(), baseline=still, baseline_after=moved))).words
    assert "J_l stands in the equation of the shaft torque alone, where what was added has no term" in words


def test_no_symbol_of_the_baseline_is_one_of_an_effect() -> None:
    ours = {symbol for name, (symbol, _) in PARAMETERS.items() if name == "lag"}
    theirs = {text.split(",")[0] for effect in LIBRARY.values() for text in effect.glosses.values()}
    theirs |= {name for effect in LIBRARY.values() for name in effect.glosses}
    assert not ours & theirs


def test_a_channel_counts_the_runs_that_have_it() -> None:
    counts = {card.label: card.how for card in cards(made_up.explained())}
    assert "over 4 held-out runs" in counts["Kinematic error"]
    assert "over 3 held-out runs" in counts["Shaft torque error"]  # the locked one has none


def test_beside_each_parameter_of_an_effect_stands_what_it_is(pages: dict[str, Reader]) -> None:
    words = pages["explained"].words
    assert "A_inf A_∞, share of the largest order that stays under a high load (no unit) 0.461 ± 0.011" in words
    assert "lag time constant by which the kinematic error follows the torque 4.30 ± 0.20 ms" in words


@pytest.mark.slow
def test_errors_of_the_free_simulation_stand_in_a_table_of_their_own_with_their_unit() -> None:
    base = made_up.explained()

    def simulated(errors: Before, size: float) -> Before:
        first, second = list(made_up.RUNS)[:2]
        one = replace(errors.per_run[first], free_kinematic_error_rms_arcsec=size)
        two = replace(errors.per_run[second], free_kinematic_error_rms_arcsec=2 * size)
        pooled = replace(errors.pooled, free_kinematic_error_rms_arcsec=1.6 * size)
        return Before(errors.per_run | {first: one, second: two}, pooled)

    trace = replace(base, curves={}, before=simulated(base.before, 10.0), after=simulated(base.after, 2.7))
    words = read(trace).words
    assert "RMS in arcsec before → after floor" in words
    assert "slow_ke_2 10.0 → 2.70 0.900 3.00 × – speed_400rpm_2 20.0 → 5.40 0.900 6.00 × –" in words
    assert "Together 16.0 → 4.32 0.900 4.80 × –" in words
    assert "The free simulation stays at 3 to 6 times the floor. That does not speak against the verdict" in words
    none = read(replace(base, curves={})).words
    assert "By free simulation of the whole model" not in none, "no run was simulated"


def test_a_baseline_parameter_that_moved_beyond_its_interval_is_marked() -> None:
    text = page.render(bare(made_up.explained()), made_up.source())
    rows = [part for part in text.split("<tr") if '<th scope="row">K ' in part or '<th scope="row">J_m ' in part]
    assert ["far" in row.split(">")[0] for row in rows] == [True, False]
    assert "+2.0 %" in " ".join(rows[0].split()).replace("\u00a0", " ")  # 7160 to 7300 N·m/rad


def test_rivals_are_both_called_so_and_the_deciding_run_is_given(pages: dict[str, Reader]) -> None:
    words = pages["ambiguous"].words
    assert words.count("rival") >= 2
    assert "Sentinel run" in words
    assert "120 rpm" in words
    assert "separates quadratic drag from thermal friction drift" in words


@pytest.mark.slow
def test_what_has_a_name_beside_a_rest_is_not_headed_as_unexplained() -> None:
    trace = made_up.unknown()
    in_part = replace(trace, verdict=replace(trace.verdict, effects=("cogging_torque",)))
    assert "Named in part" in read(bare(in_part)).words
    assert "Named in part" not in read(bare(trace)).words


def test_an_unknown_effect_says_where_it_lives_and_is_given_no_name(pages: dict[str, Reader]) -> None:
    assert "in the load angle, order 37 per turn" in pages["unknown_effect"].words


def test_an_explanation_that_leaves_a_channel_above_its_floor_says_so() -> None:
    base = bare(made_up.explained())
    partly = replace(base, ratios_after=base.ratios_after | {"tau_l": 1.73})
    assert "Not all of it: the shaft torque stays at 1.73 times its floor." in read(partly).words
    assert "Not all of it" not in read(base).words


def test_every_candidate_is_shown_with_the_reason_it_was_dismissed(pages: dict[str, Reader]) -> None:
    words = pages["explained"].words
    assert "Alone it removes 3 % of the excess, 60 % would be asked for." in words
    assert "No more than chance gives." in words  # 5 nats
    assert "stribeck friction" in words  # of those that explained nothing


def test_effects_fitted_in_each_run_are_not_passed_off_as_unseen() -> None:
    vibration = Found("external_vibration", (parameter("frequency", 8.0, 0.01, "Hz"),), 0.99, each_run=True)
    found = read(bare(replace(made_up.explained(), effects=(vibration,))))
    assert found.words.count("read from that run itself") == 2  # where it was added, and where the errors stand
    assert "read from that run itself" not in read(bare(made_up.explained())).words


@pytest.mark.slow
def test_simulated_runs_are_called_so_whatever_their_manifests_say() -> None:
    source = Provenance({"slow_ke_1": {"backend": "can"}})
    assert "SIMULATED" in read(bare(made_up.explained()), source).words
    measured = read(bare(replace(made_up.explained(), simulated=False)), source)
    assert "MEASURED" in measured.words
    assert "SIMULATED" not in measured.words


def test_runs_of_the_twin_among_others_are_said_to_be_some_of_them() -> None:
    mixed = Provenance({"slow_ke_1": {"backend": "sim"}, "slow_ke_2": {"backend": "imported"}})
    alone = Provenance({"slow_ke_1": {"backend": "sim"}, "slow_ke_2": {"backend": "sim"}})
    trace = bare(replace(made_up.explained(), simulated=True))
    assert "Some of its runs were computed by the digital twin" in read(trace, mixed).words
    assert "No gear was measured." not in read(trace, mixed).words
    assert "No gear was measured." in read(trace, alone).words


def test_manifests_that_disagree_leave_the_origin_unknown() -> None:
    source = Provenance({"a": {"backend": "can"}, "b": {"backend": "imported"}})
    assert "ORIGIN UNKNOWN" in read(bare(replace(made_up.explained(), simulated=False)), source).words


def test_every_run_is_listed_with_what_it_was_used_for() -> None:
    text = page.render(bare(made_up.explained()), made_up.source())
    used = {"standstill": "not used", "slow_ke_2": "held out", "slow_ke_1": "fitted", "speed_400rpm_2": "held out"}
    for run, said in used.items():
        row = next(part for part in text.split("<tr>") if part.startswith(f'<td class="code">{run}<'))
        assert said in row


def test_words_of_others_are_escaped() -> None:
    base = bare(made_up.explained())
    hostile = replace(
        base,
        campaign=HOSTILE,
        notes=(HOSTILE,),
        candidates=(Candidate("quadratic_drag", 20.0, HOSTILE),),
        floors=(Floor(HOSTILE, 1.0, "rad", HOSTILE),),
    )
    text = page.render(hostile, Provenance({HOSTILE: {"backend": HOSTILE, "procedure": HOSTILE}}))
    assert "<script" not in text
    assert "<img" not in text
    Reader(text)


def test_a_trace_of_nearly_nothing_still_makes_a_page() -> None:
    base = made_up.explained()
    empty = replace(
        bare(base), baseline=(), baseline_after=(), floors=(), candidates=(), effects=(), ratios_before={}, notes=()
    )
    assert "No effect of the library explained anything" in read(empty, Provenance()).words


def test_manifests_that_cannot_be_read_are_left_out(tmp_path: Path) -> None:
    for name, text in (("good", '{"backend": "sim"}'), ("torn", '{"backend": '), ("list", "[1]")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "manifest.json").write_text(text)
    found = provenance(tmp_path, {}, "")
    assert found.manifests["good"] == {"backend": "sim"}
    assert "torn" not in found.manifests


def test_runs_in_folders_of_their_day_are_found_as_the_trace_finds_them(tmp_path: Path) -> None:
    run = tmp_path / "2026-11-20" / "0718-log"
    run.mkdir(parents=True)
    (run / "manifest.json").write_text('{"backend": "imported"}')
    assert provenance(tmp_path, {}, "").manifests == {"0718-log": {"backend": "imported"}}


def test_the_page_of_a_sweep_is_kept_beside_that_of_its_trace(tmp_path: Path) -> None:
    (tmp_path / page.run_page.NAME).write_text("of the sweep")
    (tmp_path / "result.json").write_text("{}")
    for text in ("of its trace", "of its trace, anew"):
        assert page.put(tmp_path, text).read_text() == text
        assert (tmp_path / page.SWEEP).read_text() == "of the sweep"


def test_the_page_of_an_older_trace_is_not_kept(tmp_path: Path) -> None:
    for text in ("first", "second"):
        page.put(tmp_path, text)
    assert [path.name for path in tmp_path.iterdir()] == [page.run_page.NAME]


@pytest.mark.long
def test_a_full_page_needs_nobody_else_and_is_the_same_twice(tmp_path: Path) -> None:
    written = page.put(tmp_path, page.render(made_up.explained(), made_up.source()))
    text = written.read_text()
    assert text == page.render(made_up.explained(), made_up.source())
    found = Reader(text)
    outside = [v for _, name, v in found.attributes if name in ("src", "href") and not v.startswith("#")]
    assert outside == []
    assert text.count("<figure") == 9  # the shaft torque is at its floor and has no close-up
    assert len(text) < 1_500_000


def test_what_stands_only_where_the_motor_turns_back_is_told_beside_the_whole_motor_torque() -> None:
    base = made_up.explained()
    quiet = cards(base)
    loud = cards(
        replace(base, ratios_before=base.ratios_before | {AT_REVERSALS: 6.1}, ratios_after={AT_REVERSALS: 1.0})
    )
    (card,) = (c for c in loud if c.label == "Motor torque error")
    assert "where the motor turns back 6.10 → 1.00 ×" in card.ratio
    assert "1.50 times that where the motor turns back" in card.how
    assert not any("turns back" in f"{c.ratio}{c.how}" for c in quiet)


@pytest.mark.slow
def test_the_header_says_how_many_of_how_many_runs_were_read_and_names_the_others() -> None:
    whole = replace(bare(made_up.explained()), read=7)
    assert "Trace of 7 runs, simulated" in read(whole).words
    assert "Left out:" not in read(whole).words
    some = read(replace(whole, left_out=("load_5nm_1", "torn"))).words
    header = some[: some.index("Explained", some.index("What the model lacks"))]
    assert "Trace of 7 of 9 runs" in header
    assert "Left out: load_5nm_1 and torn." in header
    fitted, held = len(whole.fitted), len(whole.held_out)
    assert f"{fitted} runs fitted {held} held out {7 - fitted - held} neither" in header


def test_a_run_that_was_left_out_is_called_so_in_the_list_of_runs() -> None:
    trace = replace(made_up.explained(), left_out=("torn",))
    rows = Provenance({"torn": {}, "slow_ke_1": {}}).rows(trace)
    assert {row.name: row.part for row in rows if row.name in ("torn", "slow_ke_1")} == {
        "torn": "left out",
        "slow_ke_1": "fitted",
    }


def test_a_part_of_a_run_stands_beside_it_with_its_procedure_and_conditions() -> None:
    manifests = {
        name: {"procedure": "kinematic_error", "started_utc": f"2026-11-21T09:0{i}:00Z", "conditions": {"tau_ext": 5.0}}
        for i, name in enumerate(("first", "second"))
    }
    trace = replace(made_up.explained(), fitted=("first", "second"), held_out=("first (part held out)",))
    rows = Provenance(manifests).rows(trace)
    assert [(row.name, row.part) for row in rows] == [
        ("first", "fitted"),
        ("first (part held out)", "held out"),
        ("second", "fitted"),
    ]
    assert len({(row.procedure, row.conditions) for row in rows}) == 1
    assert "Unknown" not in {row.procedure for row in rows}
