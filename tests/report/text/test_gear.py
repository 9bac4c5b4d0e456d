"""What `hdrig identify` prints: units people read, each thing once, whole names, phases with their intervals."""

from __future__ import annotations

import numpy as np

from rig.analysis.identify.identified import order_phases
from rig.analysis.identify.predictions import Prediction
from rig.model.fourier import FourierSeries
from rig.model.gearfile import MeasuredSeries, Parameter
from rig.report.text.gear import WORDS, comparison, parameter_line, series_lines


def series(spread: float = 2e-7) -> MeasuredSeries:
    """Two orders, 20 and 1 µrad, with errors of cosine and sine that go together."""
    a, b = (2e-5, 1e-6), (1e-5, -5e-7)
    V = spread**2 * (np.eye(4) + 0.5 * (np.eye(4, k=2) + np.eye(4, k=-2)))
    return MeasuredSeries(FourierSeries(a, b), V)


def test_a_delay_is_given_in_microseconds_and_what_is_said_already_is_not_said_again() -> None:
    said = parameter_line("skew", Parameter(-3.4e-5, (-5.1e-5, -1.7e-5), runs=("a", "b")), "s")
    assert "−34 ± 17\u00a0µs" in said
    assert "(measured, 2 runs)" in said
    formula = WORDS["B_sum"].partition(", ")[2]
    twice = parameter_line("B_sum", Parameter(3.1e-3, (3.0e-3, 3.2e-3), note=formula), "N·m·s/rad")
    assert twice.count(formula) == 1
    assert "; none assumed" in parameter_line("tau_s", Parameter(0.3, note="none assumed"), "N·m")


def test_runs_whose_names_begin_alike_are_told_apart() -> None:
    names = [f"1121-2311-constant-torque-TWIN-40-50-{tail}" for tail in ("662f", "d2b2")]
    lines = comparison([Prediction(name, 120.0, 110.0, (107.0, 113.0), 113.0, 0.9, 93.0, 1.6) for name in names])
    *rows, how = lines[1:]
    assert all(name in line for name, line in zip(names, rows, strict=True))
    assert "torque of the motor that is constant" in how
    assert comparison([]) == []


def test_the_interval_of_a_phase_is_what_drawn_series_scatter_by() -> None:
    found = series()
    mean = np.array([*found.series.a, *found.series.b])
    drawn = np.random.default_rng(1).multivariate_normal(mean, found.covariance, 20000)
    phases = np.arctan2(drawn[:, 2:], drawn[:, :2])
    told = order_phases(found)
    np.testing.assert_allclose([psi for psi, _ in told], found.series.phase)
    np.testing.assert_allclose([u for _, u in told], phases.std(0), rtol=0.05)


def test_an_order_that_is_not_told_from_zero_has_no_phase() -> None:
    _, first, second = series_lines(series(spread=8e-7))
    assert "°" in first
    assert "±" in first.partition("at")[2]
    assert "not told from zero" in second
    assert "°" not in second
