"""The table of figures against the analyses that give them."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

import rig.analysis
from rig.analysis.findings.figure_names import FIGURES, GIVEN_BY, is_run_for, may_be_negative, unit_of

ROOT = Path(rig.analysis.__file__).parent
NOT_JUDGED = {"sweep_result.py"}  # figures of many runs together, which --limit is refused for
GIVEN = {"figure": 3, "exact": 3, "Estimate": 3}  # the calls that make a figure, and where its unit stands


def _text(node: ast.expr) -> str | None:
    """A literal text, {n} where a formatted one has a value; None of anything else."""
    match node:
        case ast.Constant(value=str(text)):
            return text
        case ast.JoinedStr(values=parts):
            return "".join(str(p.value) if isinstance(p, ast.Constant) else "{n}" for p in parts)
    return None


def made() -> Iterator[tuple[str, str, str | None]]:
    """(file, name, unit or None) of every figure that the sources make under a literal name."""
    for file in sorted(ROOT.rglob("*.py")):
        if file.name in NOT_JUDGED or "tracing" in file.parts:
            continue
        for node in ast.walk(ast.parse(file.read_text("utf-8"))):
            called = getattr(node, "func", None)
            word = getattr(called, "attr", getattr(called, "id", ""))
            if word in GIVEN and node.args and (name := _text(node.args[0])):
                unit = _text(node.args[GIVEN[word]]) if len(node.args) > GIVEN[word] else None
                yield file.name, name, unit


@pytest.mark.slow
def test_every_figure_of_an_analysis_stands_in_the_table_in_its_unit() -> None:
    found = list(made())
    assert len(found) > 50
    for file, name, unit in found:
        choices = [name.replace("{n}", by) for by in ("1", "theta_m", "tau_l", "", "motor_", "T1")]
        known = next((c for c in choices if unit_of(c) is not None), None)
        assert known is not None, f"{file} makes {name}, which is in no table"
        if unit is not None and "{n}" not in unit:
            assert unit_of(known) == unit, f"{file}: {name}"


def test_a_name_that_no_analysis_gives_has_no_unit() -> None:
    assert unit_of("kinematic_error_peak_to_peek") is None
    assert unit_of("fourier_amplitude_") is None
    assert unit_of("fourier_amplitude_15") == "arcsec"


def test_a_run_is_made_for_the_figures_of_its_procedure_alone() -> None:
    assert is_run_for("sentinel", "fourier_amplitude_4")
    assert is_run_for("stiffness_lock", "stiffness_K1")
    assert not is_run_for("stiffness_lock", "kinematic_error_peak_to_peak")
    assert not is_run_for("other", "kinematic_error_peak_to_peak")
    assert is_run_for("full_turn", "torsion_span")
    known = {name for names, _ in GIVEN_BY for name in names}
    assert known == set(FIGURES)
    assert sum(len(names) for names, _ in GIVEN_BY) == len(FIGURES)  # none is told twice


@pytest.mark.parametrize("name", ["drift", "zero_tau_l", "trend_slope", "cubic_k3", "mean_speed"])
def test_what_has_a_sign_may_have_a_limit_below_zero(name: str) -> None:
    assert name in FIGURES
    assert may_be_negative(name)


@pytest.mark.parametrize("name", ["kinematic_error_peak_to_peak", "torsional_stiffness", "coulomb", "noise_tau_m"])
def test_sizes_have_none(name: str) -> None:
    assert name in FIGURES
    assert not may_be_negative(name)
