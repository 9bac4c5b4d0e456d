"""Arrays for the figures of a trace."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.residual.joined import rest
from rig.analysis.tracing.residual.lines import spectrum
from rig.core.units import ARCSEC, RPM, TURN
from rig.model.effect import Array

SHOWN = 3000  # points of a run: more than a page is wide


def curves(p: Prepared, before: Mapping[Key, Array], after: Mapping[Key, Array]) -> dict[str, Array]:
    """See `Trace`."""
    out: dict[str, Array] = {}
    one = dict.fromkeys(p.held_out.floors, ARCSEC)
    pair = [(name, rest(p.eq, e, one, "A", beside=False)) for name, e in (("before", before), ("after", after))]
    orders = np.arange(0.02, 40.0, 0.02)
    for name, r in pair:
        if r is None:
            continue
        out["spectrum.motor_order"] = orders
        out[f"spectrum.{name}_arcsec"] = 2 * np.sqrt(spectrum(r.at["motor_angle"], r.e, orders)) / r.e.size
        for group, angle in (("angle", "motor_angle"), ("load_angle", "load_angle")):
            x = np.mod(np.nan_to_num(r.at[angle]), TURN)
            index = (x / TURN * 360).astype(int) % 360
            count = np.bincount(index, minlength=360)
            out[f"{group}.deg"] = np.arange(360.0) + 0.5
            out[f"{group}.{name}_arcsec"] = np.bincount(index, r.e, minlength=360) / np.where(count > 0, count, np.nan)
    return out | _runs(p, before, after) | _means(p, before, after)


def _runs(p: Prepared, before: Mapping[Key, Array], after: Mapping[Key, Array]) -> dict[str, Array]:
    """Kinematic error along each held-out run; torque against wind-up of those with a locked output."""
    out: dict[str, Array] = {}
    for key in (k for k in before if k[1] == "A"):
        run, r = p.eq.runs[key[0]], p.eq.rows[key]
        thin = slice(None, None, max(1, r.y.size // SHOWN))
        measured = (r.y - r.y.mean()) / ARCSEC
        torque = np.concatenate([q.torque[run.smoother.centres(q.t.size)] for q in run.pieces])[r.keep]
        name = f"loop.{run.name}" if run.locked else f"run.{run.name}"
        first = {"windup_arcsec": measured, "torque_Nm": torque} if run.locked else {}
        shown = {"theta_m_turns": r.theta_m / TURN, "measured_arcsec": measured, **first}
        shown |= {"before_arcsec": measured - before[key] / ARCSEC, "after_arcsec": measured - after[key] / ARCSEC}
        out |= {f"{name}.{column}": values[thin] for column, values in shown.items()}
    return out


def _means(p: Prepared, before: Mapping[Key, Array], after: Mapping[Key, Array]) -> dict[str, Array]:
    """RMS over floor of every held-out run and channel against its speed, load, time."""
    out: dict[str, Array] = {}
    for channel in "AML":
        keys = [k for k in before if k[1] == channel]
        pieces = [p.eq.runs[i].pieces for i, _ in keys]
        out[f"runs.{channel}.speed_rpm"] = np.array([np.mean([q.omega_m.mean() for q in r]) for r in pieces]) / RPM
        out[f"runs.{channel}.load_Nm"] = np.array([-r[0].tau_ext[0] for r in pieces])
        out[f"runs.{channel}.time_s"] = np.array([r[0].t[0] for r in pieces])
        out[f"runs.{channel}.before_over_floor"] = np.array([p.held_out.ratio(before, [k]) for k in keys])
        out[f"runs.{channel}.after_over_floor"] = np.array([p.held_out.ratio(after, [k]) for k in keys])
    return out
