"""Estimates, tables, events and manifests as lines of text."""

from rig.analysis.findings.result import Estimate
from rig.report import rows
from rig.report.cards import cards
from rig.report.provenance import provenance
from rig.report.tables import tables
from rig.report.words import definition, named
from tests.report import made_up


def test_the_headline_comes_first_counts_last() -> None:
    found = (
        Estimate("stuck_share", "Time stuck", 0.1, "%", (0.1, 0.1), "counted"),
        Estimate("drift", "Drift", 1.0, "arcsec/min", (0.5, 1.5), "fitted"),
        Estimate("kinematic_error_peak_to_peak", "Kinematic error", 93.4, "arcsec", (93.0, 93.8), "series"),
    )
    assert [card.label for card in cards(found)] == ["Kinematic error", "Drift", "Time stuck"]
    assert cards(()) == []


def test_figures_found_alike_share_a_card_under_what_their_labels_share() -> None:
    ends = (1.0, 2.0)
    found = [Estimate("x", "First", 1.5, "rpm", ends, "apart")]
    found += [Estimate(f"a{n}", f"Amplitude of order {n}", 1.5, "arcsec", ends, "series") for n in (1, 2)]
    found += [Estimate("b", "Something else", 1.5, "arcsec", ends, "otherwise")]
    _, orders, other = cards(found)
    assert (orders.label, [line.name for line in orders.lines]) == ("Amplitude of order", ["1", "2"])
    assert (other.label, other.lines[0].name) == ("Something else", "")


def test_coefficients_come_first_with_intervals_and_a_phase_only_where_it_is_known() -> None:
    strokes, coefficients = {"stroke": 1, "direction": "forward"}, made_up.coefficients()
    first, second = tables({"strokes": [strokes], "coefficients": coefficients, "empty": []})
    assert first.title == "Fourier coefficients"
    assert [column.head for column in first.columns] == ["n", "aₙ", "bₙ", "Cₙ", "ψₙ, °"]
    assert first.rows[1][3].startswith("39.60 ± 0.")
    assert first.rows[14][3] == "0.22 (0.00 to 0.29)"
    assert first.rows[14][4] == "–"
    assert [column.text for column in second.columns] == [False, True]


def test_a_row_with_a_factor_of_its_own_is_widened_by_it() -> None:
    row = {"order": 1.0, "a_arcsec": 10.0, "u_a": 1.0, "k95": 12.706}
    (table,) = tables({"coefficients": [row]})
    assert table.rows[0][1] == "10 ± 13"


def test_a_condition_has_its_name_and_unit() -> None:
    assert named("tau_ext") == ("External torque on the load", "N·m")
    assert named("oil_temperature_c") == ("Oil temperature", "°C")
    assert named("colour") == ("Colour", "")


def test_a_condition_nobody_knows_is_unknown_and_never_zero() -> None:
    assert rows.conditions({"conditions": {"depth_mm": None}}) == [rows.Row("Assembly depth", "unknown")]


def test_every_number_of_the_bench_has_where_it_comes_from() -> None:
    bench = {
        "schema": "hdrig.bench/1",
        "gear": {"serial": "A", "K": {"value": 7160.0, "unit": "N·m/rad", "from": "paper"}, "N": 50.0},
        "twin": {"error": {"from": "assumed", "C_deg": [0.1, 0.2]}},
    }
    found = list(rows.bench_numbers(bench))
    assert [(n.key, n.source) for n in found] == [
        ("gear.K", "paper"),
        ("gear.N", "declared"),
        ("twin.error.C_deg", "assumed"),
    ]


def test_an_event_has_its_time_in_the_run_or_else_in_utc() -> None:
    ready, running, _ = rows.events(made_up.EVENTS)
    assert ready == ("2026-11-20 01:47:12 UTC", "State", "ready")
    assert running[0] == "0.000\u00a0s"
    assert rows.events([{"odd": 1}]) == [("", "", "odd 1")]


def test_a_time_without_a_zone_stays_as_it_stands() -> None:
    assert rows.utc("2026-11-20T03:47:12+02:00") == "2026-11-20 01:47:12 UTC"
    assert rows.utc("2026-11-20T03:47:12") == "2026-11-20T03:47:12"
    assert rows.utc("yesterday") == "yesterday"


def test_a_duration_on_a_virtual_clock_is_said_to_be_one() -> None:
    found = provenance(made_up.manifest(loop={"clock": "virtual"}), "run")
    assert rows.Row("Duration", "3\u00a0min 20\u00a0s on a virtual clock") in found
    assert rows.Row("Duration", "3\u00a0min 20\u00a0s") in provenance(made_up.manifest(), "run")


def test_a_search_for_the_slow_speed_is_headed_by_the_speed_and_not_by_the_peak_to_peak_there() -> None:
    found = (
        Estimate("kinematic_error_peak_to_peak", "Kinematic error", 93.4, "arcsec", (93.0, 93.8), "series"),
        Estimate("speed_limit", "Speed at which speed adds 2 %", 62.8, "rpm", (59.0, 66.6), "fitted"),
    )
    assert cards(found)[0].label == "Speed at which speed adds 2 %"


def test_the_energy_of_a_loop_is_not_explained_as_its_width() -> None:
    assert "two branches" in definition("hysteresis_loss")
    assert definition("hysteresis_energy") == ""
