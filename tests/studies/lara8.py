"""Known effects spiked into measured runs of a robot joint, and what the tracer makes of them.

    python -m tests.studies.lara8 > tests/studies/lara8.md

The run (validate.csv of LARA8, joint 3) is real: 83 motor turns one way at 682 rpm under the arm's weight, no shaft
sensor (its torque is the controller's model of the arm), logged every 4 ms by a host in no hurry.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import shutil
import sys
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt
import pyarrow as pa
import pyarrow.parquet as pq

Array = npt.NDArray[np.float64]
Columns = dict[str, Array]

SHARED: Final = Path(os.environ.get("HDRIG_SHARED", Path(__file__).resolve().parents[3] / "shared"))
SOURCE: Final = SHARED / "data" / "lara8" / "validate.csv"
MAPPING: Final = Path(__file__).parents[2] / "rig/runfile/importing/mappings/lara8-joint3.toml"
MOTOR_TORQUE: Final = """
[channels.tau_m]
sum = [{ column = "joint_torque_current_3", scale = 0.00990099 }]  # 1/101
unit = "N·m"
meaning = "motor current times torque constant, on the motor's side of the gear"
"""
ORDER, LINE_HZ = 3.0, 9.0


def skew(c: Columns, size: float) -> None:
    """The load angle is read `size` s late."""
    c["theta_l"] = np.interp(c["t"] - size, c["t"], c["theta_l"])


def runout(c: Columns, size: float) -> None:
    """`size` rad once per output turn in the load angle."""
    c["theta_l"] = c["theta_l"] + size * np.cos(c["theta_l"])


def friction(c: Columns, size: float) -> None:
    """`size` N·m of friction of the third order of the motor angle; it turns one way, so it is cogging as well."""
    c["tau_m"] = c["tau_m"] + size * np.cos(ORDER * c["theta_m"])


def line(c: Columns, size: float) -> None:
    """`size` N·m at 9 Hz in the shaft torque."""
    c["tau_l"] = c["tau_l"] + size * np.sin(2 * np.pi * LINE_HZ * c["t"])


def steps(c: Columns, size: float) -> None:
    """The load encoder loses `size` rad, three times."""
    t = c["t"] - c["t"][0]
    c["theta_l"] = c["theta_l"] - size * sum((t > at).astype(float) for at in (2.1, 3.4, 5.2))


@dataclass(frozen=True)
class Spike:
    """One effect, the sizes it is given [SI], the names that would be right and the parameter that gives it back."""

    what: str
    put: Callable[[Columns, float], None]
    sizes: tuple[float, ...]
    right: tuple[str, ...]
    parameter: str
    unit: str


SPIKES: Final = (
    Spike("load angle late", skew, (2e-4, 5e-4, 2e-3), ("channel_time_skew",), "skew", "s"),
    Spike("once per output turn", runout, (1e-4, 5e-4, 2e-3), ("output_once_per_rev",), "order_1_amplitude", "rad"),
    Spike("friction of order 3", friction, (0.02, 0.1, 0.3), ("position_dependent_friction", "cogging_torque"),
          "amplitude", "N·m"),
    Spike("line at 9 Hz in τ_l", line, (1.0, 5.0, 20.0), ("external_vibration",), "torque_amplitude", "N·m"),
    Spike("lost counts of θ_l", steps, (1e-4, 5e-4, 2e-3), ("missed_counts",), "step", "rad"),
)  # fmt: skip


def imported(folder: Path) -> Path:
    """The measured run as a campaign of one, with the motor's torque from its current."""
    from rig.cli import main

    mapping = folder / "mapping.toml"
    mapping.write_text(MAPPING.read_text() + MOTOR_TORQUE)
    with contextlib.redirect_stdout(io.StringIO()):
        code = main(["import", str(SOURCE), "--map", str(mapping), "--out", str(folder / "raw")])
    if code:
        raise SystemExit(f"{SOURCE} was not imported; HDRIG_SHARED names the folder that holds data/lara8")
    run = next((folder / "raw").glob("*/*"))
    target = folder / "campaign" / "validate"
    shutil.copytree(run, target)
    return target.parent


def spiked(campaign: Path, to: Path, put: Callable[[Columns, float], None], size: float) -> Path:
    """A copy with the effect in it."""
    shutil.copytree(campaign, to)
    file = to / "validate" / "samples.parquet"
    file.chmod(0o644)
    table = pq.read_table(file)
    columns = {
        n: table[n].to_numpy(zero_copy_only=False).astype(float) for n in ("t", "theta_m", "theta_l", "tau_l", "tau_m")
    }
    put(columns, size)
    for name in columns:
        at = table.schema.get_field_index(name)
        table = table.set_column(at, table.schema.field(name), pa.array(columns[name], table.schema.field(name).type))
    file.unlink()
    pq.write_table(table, file)
    return to


def traced(campaign: Path) -> Mapping[str, Any]:
    """trace.json of a campaign."""
    from rig.analysis.tracing.outcome.record import document
    from rig.analysis.tracing.trace import trace

    return dict(json.loads(json.dumps(document(trace(campaign)))))


def found(d: Mapping[str, Any], spike: Spike) -> str:
    """The size given back."""
    for name in spike.right:
        for p, v in d["effects"].get(name, {}).get("parameters", {}).items():
            if spike.parameter in p:
                return f"{v['value']:.3g} ({v['ci95'][0]:.3g} to {v['ci95'][1]:.3g}) {spike.unit}"
    return "–"


def row(spike: Spike, size: float, d: Mapping[str, Any]) -> str:
    """One line of the table."""
    v = d["verdict"]
    said = [*v["effects"], *(f"rival {r}" for r in v["rivals"])]
    where = v["coordinate"] or ""
    order = f" order {v['order']:.2f}" if v["order"] else ""
    hit = "yes" if set(spike.right) & {*v["effects"], *v["rivals"]} else "no"
    over = d["residual"]["over_floor_before"]
    ratios = ", ".join(f"{k} {over[k]:.1f} → {r:.1f}" for k, r in d["residual"]["over_floor_after"].items())
    return (
        f"| {spike.what} | {size:g} {spike.unit} | {v['status']} | {', '.join(said) or '–'} | {where}{order} | {hit} "
        f"| {found(d, spike)} | {ratios} |"
    )


HEAD: Final = (
    "| spiked | size | verdict | named | lives in | right name | given back | held-out over floor |\n"
    "|---|---|---|---|---|---|---|---|"
)


def study(folder: Path) -> None:
    """Print the table."""
    print(HEAD)
    campaign = imported(folder)
    nothing = Spike("nothing", lambda c, size: None, (0.0,), (), "", "")
    for spike in (nothing, *SPIKES):
        for size in spike.sizes:
            to = folder / f"{spike.put.__name__.strip('<>')}-{size:g}"
            print(row(spike, size, traced(spiked(campaign, to, spike.put, size))), flush=True)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as scratch:
        sys.stdout.reconfigure(line_buffering=True)  # type: ignore[union-attr]
        study(Path(scratch))
