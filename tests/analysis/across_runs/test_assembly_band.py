"""Depth of assembly against what fitting anew does by itself: the band holds what it says."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.across_runs.assembly_band import AssemblyRun, Cell, cells, repeat
from rig.analysis.across_runs.load_law import LoadRun
from rig.analysis.across_runs.sweep_result import HEAD, assembly_sweep, load_sweep
from rig.analysis.findings.intervals import Ranged
from rig.analysis.findings.result import Estimate, Result

LOADS = (0.0, 3.0, 7.5, 15.0)
DEPTHS = (0.0, 0.0, 0.0, 0.15, 0.3)


def swept(
    seed: int, scatter: float = 0.02, per_mm: float = 0.0, depths: tuple[float, ...] = DEPTHS
) -> list[AssemblyRun]:
    """Assemblies whose errors differ by `scatter`, relative, and fall by `per_mm`; runs known to 0.3 arcsec."""
    generator, runs = np.random.default_rng(seed), []
    for number, depth in enumerate(depths, 1):
        own = 1.0 + scatter * generator.standard_normal()
        for load in LOADS:
            size = (
                own * (1.0 - per_mm * depth) * (45.0 + 45.0 * np.exp(-load / 2.5)) + 0.15 * generator.standard_normal()
            )
            runs.append(AssemblyRun(load, depth, number, Ranged(size, size - 0.3, size + 0.3)))
    return runs


def at(found: list[Cell], depth: float, load: float) -> Cell:
    return next(c for c in found if (c.depth_mm, c.load) == (depth, load))


def estimate(result: Result, name: str) -> Estimate:
    return next(e for e in result.estimates if e.name == name)


@pytest.mark.slow
def test_the_band_holds_95_of_100_single_fittings() -> None:
    inside = []
    for seed in range(400):
        runs, new = swept(seed), np.random.default_rng([seed, 1])
        band = at(cells(runs, repeat(runs)), 0.0, 0.0).band
        assert band is not None
        inside.append(band.low <= 90.0 * (1.0 + 0.02 * new.standard_normal()) <= band.high)
    assert np.mean(inside) == pytest.approx(0.95, abs=0.03)


@pytest.mark.slow
def test_fitting_anew_alone_passes_for_an_effect_of_the_depth_in_5_of_100() -> None:
    found = [at(cells(runs := swept(seed), repeat(runs)), 0.3, 0.0).beyond for seed in range(400)]
    assert np.mean(found) == pytest.approx(0.05, abs=0.03)


def test_an_effect_larger_than_the_band_is_told_with_its_size() -> None:
    result = assembly_sweep(swept(3, scatter=0.002, per_mm=0.6))
    change = estimate(result, "change_at_0.3_mm")
    assert change.ci95[0] < -0.18 * 90.0 < change.ci95[1]
    assert "beyond what fitting does" in result.sentence
    assert estimate(result, HEAD).value == pytest.approx(90.0, rel=0.01)
    assert estimate(result, "peak_to_peak_at_0.15_mm").value == pytest.approx(0.91 * 90.0, rel=0.01)


def test_loads_of_one_assembly_are_not_taken_for_as_many_assemblies() -> None:
    found = repeat(swept(0))
    assert found is not None
    assert found.dof == 2
    low, high = found.interval
    assert low / found.sigma == pytest.approx(0.52, abs=0.01)
    assert high / found.sigma == pytest.approx(6.28, abs=0.01)


def test_a_depth_that_was_fitted_twice_counts_beside_the_reference() -> None:
    found = repeat(swept(0, depths=(0.0, 0.0, 0.3, 0.3)))
    assert found is not None
    assert found.dof == 2


def test_without_a_re_assembly_there_is_no_band_and_it_is_said() -> None:
    result = assembly_sweep(swept(0, depths=(0.0, 0.3)))
    assert not any(e.name.startswith("reproducibility") for e in result.estimates)
    assert any("the wave generator was fitted once at each depth" in text for text in result.cannot)
    assert "fitting" not in result.sentence
    assert not any(name.startswith("band.") for name in result.curves)


def test_every_depth_under_every_load_is_a_row_with_interval_change_and_band() -> None:
    rows = assembly_sweep(swept(1)).tables["assembly"]
    assert len(rows) == 3 * len(LOADS)
    for row in rows:
        assert float(row["low_arcsec"]) < float(row["peak_to_peak_arcsec"]) < float(row["high_arcsec"])
        assert bool(np.isfinite(float(row["change_arcsec"]))) is (row["depth_mm"] != 0.0)
        assert float(row["band_low_arcsec"]) < float(row["band_high_arcsec"])


def test_a_load_sweep_as_a_result_has_its_law() -> None:
    runs = [r for r in swept(2, scatter=0.0, depths=(0.0,)) for _ in range(2)]
    ways = [LoadRun(r.load, r.peak_to_peak.value, k % 2 == 1) for k, r in enumerate(runs)]
    result = load_sweep(runs, ways)
    assert estimate(result, "load_law_P_0").value == pytest.approx(90.0, rel=0.02)
    assert estimate(result, "load_law_T_c").value == pytest.approx(2.5, rel=0.2)
    assert result.sentence.startswith("Peak to peak 89.9 arcsec under 0 N·m, ")
