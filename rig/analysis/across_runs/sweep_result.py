"""What a whole sweep says, as one Result: peak to peak by load and depth, the law through it, the band about it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rig.analysis.across_runs.assembly_band import AssemblyRun, Cell, Repeat, cells, repeat
from rig.analysis.across_runs.load_law import LoadLaw, LoadRun, down_less_up, load_law
from rig.analysis.findings.collected import Findings, conclude
from rig.analysis.findings.intervals import Ranged
from rig.analysis.findings.result import Array, Estimate, Result

BY_DEPTH = (
    "Mean over the assemblies at that depth; the interval is of a mean of as many, by the scatter of re-assemblies."
)
ONCE = "Mean over the runs at that depth, by their own intervals alone: what fitting anew does is not in them."
HEAD = "kinematic_error_peak_to_peak"


def assembly_sweep(runs: Sequence[AssemblyRun]) -> Result:
    """Peak to peak by depth with the reproducibility band      [ghorbel2001, Fig. 10]"""
    found = Findings(curves=_points(runs))
    again = repeat(runs)
    every = cells(runs, again)
    least = min((c.load for c in every), key=abs)
    reference = min((c.depth_mm for c in every), key=abs)
    bare = [c for c in every if c.load == least]
    under = "without load" if least == 0.0 else f"under {least:g} N·m"
    _by_depth(found, bare, reference, under, again)
    _reproducibility(found, again, next(c for c in bare if c.depth_mm == reference), under)
    found.tables["assembly"] = [_row(c) for c in every]
    with_band = [c for c in every if c.depth_mm == reference and c.band is not None]
    if with_band:
        found.curve(band__load=np.abs([c.load for c in with_band]))
        found.curve(band__low=np.array([c.band.low for c in with_band if c.band]))
        found.curve(band__high=np.array([c.band.high for c in with_band if c.band]))
    found.sentence = _sentence(bare, reference, under, again)
    return conclude(found, "assembly_sweep", {})


def _by_depth(found: Findings, bare: Sequence[Cell], reference: float, under: str, again: Repeat | None) -> None:
    how = ONCE if again is None else BY_DEPTH
    for cell in sorted(bare, key=lambda c: c.depth_mm != reference):
        at = "reference depth" if cell.depth_mm == reference else f"{cell.depth_mm:+g} mm"
        name = HEAD if cell.depth_mm == reference else f"peak_to_peak_at_{cell.depth_mm:g}_mm"
        fitted = f"{cell.assemblies} {'assembly' if cell.assemblies == 1 else 'assemblies'}"
        _add(found, name, f"Peak to peak {under}, {at}", cell.peak_to_peak, "arcsec", f"{how} Here {fitted}.")
    for cell in bare:
        if cell.change is not None:
            label, name = f"Change {under}, {cell.depth_mm:+g} mm", f"change_at_{cell.depth_mm:g}_mm"
            told = "Less the reference depth's; where the interval holds 0, fitting anew could have done it."
            _add(found, name, label, cell.change, "arcsec", told)


def _reproducibility(found: Findings, again: Repeat | None, base: Cell, under: str) -> None:
    if again is None or base.band is None:
        found.cannot.append(
            "Reproducibility: the wave generator was fitted once at each depth, so what the depth does and what "
            "fitting it anew does cannot be told apart; take `reference` = 3 or more fittings at the reference depth."
        )
        return
    low, high = again.interval
    how = (
        "Scatter of the peak to peak from fitting to fitting at one depth, as a share of it, all loads of an assembly "
        f"taken together; {again.dof} degrees of freedom."
    )
    sigma = Ranged(100.0 * again.sigma, 100.0 * low, 100.0 * high)
    _add(found, "reproducibility", "Re-assembly at one depth, 1 σ", sigma, "%", how)
    half = 0.5 * (base.band.high - base.band.low)
    told = (
        f"Half of the band about the reference depth in which 95 of 100 single fittings lie, {under}; Student's factor."
    )
    found.exact("reproducibility_band", "Re-assembly at one depth, half of the 95 % band", half, "arcsec", told)
    if again.dof < 4:
        found.cannot.append(
            f"Reproducibility: {again.dof} degrees of freedom only, its 1 σ may be {low / again.sigma:.2f} to "
            f"{high / again.sigma:.1f} times what was found; Student's factor makes the band wide for it, "
            "more fittings at the reference depth (`reference`) make it narrower."
        )


def _sentence(bare: Sequence[Cell], reference: float, under: str, again: Repeat | None) -> str:
    base = next(c for c in bare if c.depth_mm == reference)
    text = f"Peak to peak {under} {base.peak_to_peak.value:.1f} arcsec at the reference depth"
    if again is not None and base.band is not None:
        half = 0.5 * (base.band.high - base.band.low)
        text += f"; fitting the wave generator anew moves it by ±{half:.1f} arcsec (95 % of single fittings)"
    for cell in bare:
        if cell.change is not None:
            change = f"{cell.change.value:+.1f} ± {0.5 * (cell.change.high - cell.change.low):.1f} arcsec"
            verdict = (
                "" if again is None else ", beyond what fitting does" if cell.beyond else ", within what fitting does"
            )
            text += f"; {cell.depth_mm:+g} mm: {change}{verdict}"
    return text + "."


def _row(cell: Cell) -> dict[str, float | str]:
    nothing = Ranged(float("nan"), float("nan"), float("nan"))
    change, band = cell.change or nothing, cell.band or nothing
    return {
        "depth_mm": cell.depth_mm,
        "load_nm": cell.load,
        "assemblies": float(cell.assemblies),
        "peak_to_peak_arcsec": cell.peak_to_peak.value,
        "low_arcsec": cell.peak_to_peak.low,
        "high_arcsec": cell.peak_to_peak.high,
        "change_arcsec": change.value,
        "change_low_arcsec": change.low,
        "change_high_arcsec": change.high,
        "band_low_arcsec": band.low,
        "band_high_arcsec": band.high,
    }


def load_sweep(runs: Sequence[AssemblyRun], ways: Sequence[LoadRun]) -> Result:
    """Peak to peak by load, its law, up against down      [ghorbel2001, Fig. 9]

    `ways` are the same runs with their way.
    """
    found, apart = Findings(curves=_points(runs)), down_less_up(ways)
    every = cells(runs, None)
    least, most = min(every, key=lambda c: abs(c.load)), max(every, key=lambda c: abs(c.load))
    _add(
        found,
        HEAD,
        f"Peak to peak under {least.load:g} N·m",
        least.peak_to_peak,
        "arcsec",
        "Mean over the runs with this load.",
    )
    if most.load != least.load:
        how = "Mean over the runs with the largest load."
        _add(found, "peak_to_peak_loaded", f"Peak to peak under {most.load:g} N·m", most.peak_to_peak, "arcsec", how)
    _add_law(found, load_law(ways))
    if apart is not None:
        how = "Mean over the loads that were run both ways: hysteresis of the load."
        _add(found, "down_less_up", "Down less up", apart, "arcsec", how)
    found.tables["loads"] = [{k: v for k, v in _row(c).items() if not k.startswith(("change", "band"))} for c in every]
    found.sentence = (
        f"Peak to peak {least.peak_to_peak.value:.1f} arcsec under {least.load:g} N·m, "
        f"{most.peak_to_peak.value:.1f} arcsec under {most.load:g} N·m."
    )
    return conclude(found, "load_sweep", {})


def _add_law(found: Findings, law: LoadLaw | None) -> None:
    if law is None:
        found.cannot.append("The law of the load: it takes five runs at four loads or more.")
        return
    if not law.falls:
        found.cannot.append(
            f"The law of the load: the load makes no difference that is told from none; the runs scatter by "
            f"{law.rms:.2g} arcsec."
        )
        return
    how = (
        "P(T) = P_∞ + (P_0 − P_∞)·exp(−|T|/T_c) by least squares over all runs, profile intervals. |T| is the "
        "weight's: friction of the load adds to it one way and takes from it the other. It leaves "
        f"{law.rms:.2g} arcsec RMS."
    )
    _add(found, "load_law_P_0", "P_0, without load", law.P_0, "arcsec", how)
    _add(found, "load_law_P_inf", "P_∞, under a heavy load", law.P_inf, "arcsec", how)
    _add(found, "load_law_T_c", "T_c, load over which it falls", law.T_c, "N·m", how)


def _add(found: Findings, name: str, label: str, value: Ranged, unit: str, how: str) -> None:
    found.estimates.append(Estimate(name, label, value.value, unit, (value.low, value.high), how))


def _points(runs: Sequence[AssemblyRun]) -> dict[str, Array]:
    """One entry a run, for the drawing."""
    ordered = sorted(runs, key=lambda r: (r.assembly, abs(r.load)))
    columns = {
        "load": [abs(r.load) for r in ordered],
        "depth_mm": [r.depth_mm for r in ordered],
        "assembly": [float(r.assembly) for r in ordered],
        "value": [r.peak_to_peak.value for r in ordered],
        "low": [r.peak_to_peak.low for r in ordered],
        "high": [r.peak_to_peak.high for r in ordered],
    }
    return {f"load.{name}": np.array(values) for name, values in columns.items()}
