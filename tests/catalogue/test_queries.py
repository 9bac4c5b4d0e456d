"""Every query on the page runs over run folders as they lie, damaged ones among them, and says what is so."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from tests.catalogue.folders import run
from tests.catalogue.queries import queries

duckdb = pytest.importorskip("duckdb")
pytestmark = pytest.mark.slow  # its first connection reads its own tables of time zones


@pytest.fixture(scope="module")
def answers(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[tuple[Any, ...]]]:
    """What each query gives over two gears, five assemblies, one trip, samples, and two damaged files."""
    root = tmp_path_factory.mktemp("runs")
    for day, value in (("2026-11-16", 90.0), ("2026-11-17", 90.5), ("2026-11-18", 95.0)):
        for k in range(3):
            folder = run(root, day, k, value + 0.1 * k, software={"commit": "1234567890"})
            table = pa.table({"t": [0.0, 0.1], "tau_applied": [0.5, -0.6], "theta_l": pa.array([0.1, None])})
            pq.write_table(table, folder / "samples.parquet")
    run(root, "2026-11-18", 7, gear={"serial": "SN2"}, value=70.0)
    run(root, "2026-11-18", 8, status="tripped")
    run(root, "2026-11-18", 9, 39.0, name="fourier_amplitude_2", software={"commit": "fedcba9876"})
    loaded = {"tau_ext": 20.0, "speed_rpm": 9.6}
    run(root, "2026-11-18", 10, 45.0, name="fourier_amplitude_2", software={"commit": "fedcba9876"}, conditions=loaded)
    for name in ("manifest.json", "result.json"):
        (root / f"damaged-{name}").mkdir()
        (root / f"damaged-{name}" / name).write_text('{"schema": "hdrig.run/1", "proc')
    connection = duckdb.connect()
    return {heading: connection.execute(sql).fetchall() for heading, sql in queries(root).items()}


def answer(answers: dict[str, list[tuple[Any, ...]]], number: int) -> list[tuple[Any, ...]]:
    return next(rows for heading, rows in answers.items() if heading.startswith(f"{number}."))


def test_runs_are_counted_by_gear_procedure_verdict(answers: dict[str, list[tuple[Any, ...]]]) -> None:
    assert [row[:4] for row in answer(answers, 1)] == [
        ("SN1", "kinematic_error", "PASS", 12),
        ("SN2", "kinematic_error", "PASS", 1),
    ]


def test_trips_and_damaged_manifests_are_found(answers: dict[str, list[tuple[Any, ...]]]) -> None:
    found = {row[0]: row[1:] for row in answer(answers, 2)}
    assert found["kinematic_error"][:2] == ("tripped", 1)
    assert found["manifest cannot be read"][0] is None
    assert found["manifest cannot be read"][2].endswith("damaged-manifest.json")


def test_gears_are_ranked_by_their_median(answers: dict[str, list[tuple[Any, ...]]]) -> None:
    assert [row[:4] for row in answer(answers, 3)] == [("SN1", "can", 9, 90.6), ("SN2", "can", 1, 70.0)]


def test_scatter_within_and_between_assemblies_is_told_apart(answers: dict[str, list[tuple[Any, ...]]]) -> None:
    (row,) = answer(answers, 4)
    assert row[6:8] == (9, 3)
    assert row[8] == pytest.approx(0.1)
    assert row[9] == pytest.approx(2.754, abs=0.001)


def test_a_figure_is_told_by_commit(answers: dict[str, list[tuple[Any, ...]]]) -> None:
    assert [(row[2], row[4], row[5]) for row in answer(answers, 5)] == [("fedcba9", 1, 39.0), ("fedcba9", 1, 45.0)]
    assert [row[1] for row in answer(answers, 5)] == [0.0, 20.0]


def test_samples_are_read_across_runs(answers: dict[str, list[tuple[Any, ...]]]) -> None:
    assert answer(answers, 6) == [("SN1", "kinematic_error", 9, 18, 0.6, 50.0)]


def test_samples_are_read_where_no_run_has_what_the_drive_was_given(tmp_path: Path) -> None:
    table = pa.table({"t": [0.0, 0.1], "tau_m": [0.4, -0.5]})
    pq.write_table(table, run(tmp_path, "2026-11-16") / "samples.parquet")
    connection = duckdb.connect()
    *_, last = [connection.execute(sql).fetchall() for sql in queries(tmp_path).values()]
    assert last == [("SN1", "kinematic_error", 1, 2, 0.499, 100.0)]
