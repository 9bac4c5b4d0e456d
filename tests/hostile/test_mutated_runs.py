"""Every key of a good run's manifest and every column of its samples, spoilt in every way: a sentence, or figures."""

from __future__ import annotations

import copy
import hashlib
import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from rig.analysis import Verdict, analyse
from rig.cli import main
from rig.core.errors import Exit, HdrigError
from rig.runfile.run import Run
from tests.commands.made_run import made_run, rows
from tests.some import some

VALUES: dict[str, Any] = {
    "null": None, "text": "abc", "negative": -1.5, "zero": 0, "nan": float("nan"), "inf": float("inf"),
    "huge": 1e308, "more digits than a float has": 10**400, "list": [1, "a"], "object": {"x": 1}, "true": True,
    "number with its unit": "50 N·m",
}  # fmt: skip
READ = ("gear", "declared", "conditions", "encoders", "loop", "limits")  # what an analysis looks into
NONE = object()  # the key is taken out


def with_type(values: Any, name: str, unit: bytes | None = None) -> pa.Table:
    """The good table with column `name` replaced."""
    table, made = rows(), pa.array(values)
    place = table.column_names.index(name)
    metadata = table.schema.field(place).metadata if unit is None else {b"unit": unit}
    return table.set_column(place, pa.field(name, made.type, metadata=metadata), made)


def column(name: str) -> np.ndarray:
    return np.asarray(rows()[name].to_numpy())


SPOILT: dict[str, Callable[[str], pa.Table]] = {
    "missing": lambda c: rows().drop_columns([c]),
    "null": lambda c: with_type(pa.nulls(6000, pa.float64()), c),
    "null without a type": lambda c: with_type(pa.nulls(6000), c),
    "null here and there": lambda c: with_type(pa.array(column(c), mask=np.arange(6000) % 7 == 0), c),
    "text": lambda c: with_type([f"{x:.3f}" for x in column(c)], c),
    "whole numbers": lambda c: with_type(np.round(column(c)).astype(np.int64), c),
    "yes or no": lambda c: with_type(column(c) > 0, c),
    "lists": lambda c: with_type([[x] for x in column(c)], c),
    "half the digits": lambda c: with_type(column(c).astype(np.float32), c),
    "negative": lambda c: with_type(-column(c), c),
    "nan": lambda c: with_type(np.full(6000, np.nan), c),
    "nan here and there": lambda c: with_type(np.where(np.arange(6000) % 11 == 0, np.nan, column(c)), c),
    "one inf": lambda c: with_type(np.where(np.arange(6000) == 100, np.inf, column(c)), c),
    "huge": lambda c: with_type(column(c) * 1e300, c),
    "one spike": lambda c: with_type(np.where(np.arange(6000) == 100, 1e300, column(c)), c),
    "zero": lambda c: with_type(np.zeros(6000), c),
    "in degrees": lambda c: with_type(column(c), c, b"deg"),
    "in no words": lambda c: with_type(column(c), c, b"\xff\xfe"),
    "shuffled": lambda c: with_type(np.random.default_rng(0).permutation(column(c)), c),
    "times of day": lambda c: with_type(pa.array((column(c) * 1e6).astype(np.int64), pa.timestamp("us")), c),
    "twice": lambda c: rows().append_column(rows().schema.field(c), rows()[c]),
}  # fmt: skip
COLUMNS = rows().column_names


@pytest.fixture(scope="module")
def good(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return made_run(tmp_path_factory.mktemp("good") / "run")


def paths(tree: dict[str, Any], stem: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    for key, value in tree.items():
        yield (*stem, key)
        if isinstance(value, dict):
            yield from paths(value, (*stem, key))


def spoil(tree: dict[str, Any], path: tuple[str, ...], value: Any) -> str:
    """The manifest as text, with one key of it replaced or taken out."""
    made = copy.deepcopy(tree)
    at = made
    for key in path[:-1]:
        at = at[key]
    if value is NONE:
        del at[path[-1]]
    else:
        at[path[-1]] = value
    return json.dumps(made)


def judged(folder: Path) -> str:
    """What an analysis says, in figures or in a sentence. Anything else that is raised fails the test."""
    try:
        result = analyse(Run.open(folder))
    except HdrigError as error:
        assert len(str(error)) > 20
        return str(error)
    assert result.sentence
    assert not result.defect, result.broke_off
    assert all(np.isfinite(e.value) for e in result.estimates if not e.name.startswith("drift"))
    return result.sentence


def test_the_run_these_are_made_from_is_a_good_one(good: Path) -> None:
    result = analyse(Run.open(good))
    assert result.verdict is Verdict.MEASURED
    assert main(["verify", str(good)]) == Exit.PASS


@pytest.mark.slow
def test_every_key_of_a_manifest_may_hold_anything(good: Path, capsys: pytest.CaptureFixture[str]) -> None:
    manifest = good / "manifest.json"
    whole = json.loads(manifest.read_text())
    try:
        for path in paths(whole):
            for name, value in {"missing": NONE, **VALUES}.items():
                manifest.write_text(spoil(whole, path, value))
                code = main(["verify", str(good)])
                assert code in (Exit.PASS, Exit.USAGE, Exit.INCOMPLETE), (path, name)
                said = capsys.readouterr()
                assert "internal error" not in said.err
                assert said.out + said.err
            assert main(["list", str(good.parent)]) == Exit.PASS, path
            assert "internal error" not in capsys.readouterr().err
    finally:
        manifest.write_text(json.dumps(whole))


@pytest.mark.slow
@pytest.mark.long
def test_an_analysis_of_any_such_manifest_ends_in_figures_or_a_sentence(good: Path) -> None:
    manifest = good / "manifest.json"
    whole = json.loads(manifest.read_text())
    try:
        for path in (p for p in paths(whole) if p[0] in READ):
            for value in (NONE, "abc", float("nan"), 10**400):
                manifest.write_text(spoil(whole, path, value))
                assert judged(good)
    finally:
        manifest.write_text(json.dumps(whole))


@pytest.mark.slow
@pytest.mark.parametrize("name", some(COLUMNS, 3))
def test_every_column_may_hold_anything(name: str, tmp_path: Path) -> None:
    for how, made in SPOILT.items():
        assert judged(made_run(tmp_path / f"{name} {how}", table=made(name))), how


@pytest.mark.parametrize(
    ("how", "expected"),
    [
        ("text", "expected"),
        ("in degrees", "expected 'rad'"),
        ("lists", "expected"),
        ("twice", "theta_m"),
    ],
)
def test_a_column_that_cannot_be_meant_is_named_with_what_was_expected(
    how: str, expected: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = made_run(tmp_path / "run", table=SPOILT[how]("theta_m"))
    assert main(["analyse", str(run)]) in (Exit.USAGE, Exit.INCOMPLETE)
    said = capsys.readouterr().err
    assert "theta_m" in said
    assert expected in said


@pytest.mark.parametrize(
    "value", [10**400, float("nan"), "abc", [1, "a"], {"x": 1}, None], ids=lambda v: type(v).__name__
)
@pytest.mark.parametrize("key", ["tau_ext", "output_locked", "speed_rpm", "assembly", "depth_mm"])
def test_a_condition_that_is_none_is_compared_all_the_same(
    key: str, value: Any, good: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made = made_run(tmp_path / "odd", {"conditions": {key: value}})
    assert main(["compare", str(made), str(good)]) in (Exit.PASS, Exit.USAGE)
    assert "internal error" not in capsys.readouterr().err
    assert main(["list", str(tmp_path)]) == Exit.PASS


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "how"), [("t", "huge"), ("theta_m", "huge"), ("theta_m", "one spike"), ("t", "shuffled")]
)
def test_a_recording_for_the_viewer_leaves_out_what_no_rig_reads(name: str, how: str, tmp_path: Path) -> None:
    made = made_run(tmp_path / "odd", table=SPOILT[how](name))
    assert main(["view", str(made), "--out", str(tmp_path / "odd.rrd")]) in (Exit.PASS, Exit.USAGE, Exit.INCOMPLETE)


def test_samples_that_are_not_those_that_were_closed_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = made_run(tmp_path / "run")
    pq.write_table(SPOILT["negative"]("theta_l"), run / "samples.parquet")
    said = json.loads((run / "manifest.json").read_text())["files"]["samples.parquet"]["sha256"]
    assert hashlib.sha256((run / "samples.parquet").read_bytes()).hexdigest() != said
    assert main(["analyse", str(run)]) == Exit.INCOMPLETE
    assert "SHA-256 differs" in capsys.readouterr().err
