"""A case as the peers see it: rows of features and residuals from the run folders, split by runs. No truth in here."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq

from tests.blind.plans import RunPlan
from tests.blind.residual import Smooth, fit_baseline, left_over, usable
from tests.blind.taken import Taken

LAGS = (0.02, 0.1, 0.5)  # s, history offered to those who want it
ROWS_PER_RUN = 400
CHANNELS = ("t", "theta_m", "theta_l", "tau_l", "tau_m")


def read_runs(campaign: Path) -> list[Taken]:
    """All run folders of a campaign, in order of their start."""
    found = []
    for path in sorted(p for p in campaign.iterdir() if p.is_dir()):
        about = json.loads((path / "manifest.json").read_text(encoding="utf-8"))
        table = pq.read_table(path / "samples.parquet", columns=list(CHANNELS))
        columns = {name: table[name].to_numpy() for name in table.column_names}
        given = about["conditions"]
        plan = RunPlan(
            path.name, about["procedure"], 0.0, round(float(np.median(np.diff(columns["t"]))), 6), 0.0,
            tau_ext=given["tau_ext"], locked=given["output_locked"], speed_rpm=float(given.get("speed_rpm", 0)),
        )  # fmt: skip
        found.append((about["started_utc"], Taken(plan, columns)))
    return [run for _, run in sorted(found, key=lambda pair: pair[0])]


def held_out(names: list[str], trace: Path) -> set[str]:
    """The tracer's own split where its trace is there; else second repeats, one load and one speed."""
    if trace.exists():
        return set(json.loads(trace.read_text(encoding="utf-8"))["runs"]["held_out"])
    return {n for n in names if n.endswith("_2") or n.startswith(("load_10nm", "speed_200rpm"))}


@dataclass(frozen=True)
class Rows:
    """Features (n, k) by name, residual (n,) and the run of each row, of one channel."""

    names: tuple[str, ...]
    x: np.ndarray
    y: np.ndarray
    run: np.ndarray

    def of(self, *wanted: str) -> np.ndarray:
        return self.x[:, [self.names.index(name) for name in wanted]]


@dataclass(frozen=True)
class Split:
    """Rows of the fitted and of the held-out runs of one channel."""

    train: Rows
    held: Rows


def before(x: np.ndarray, rows: int) -> np.ndarray:
    """The column `rows` rows earlier; its first value where there is none."""
    return np.concatenate([np.full(min(rows, len(x)), x[0]), x[:-rows]]) if rows else x


def features(s: Smooth, order: int) -> dict[str, np.ndarray]:
    """What a black box may look at, history included; `order` is the run's place in the campaign."""
    a, b, step = s.theta_m, s.theta_m / 50.0, s.run.plan.dt * 3
    out = {"w": s.w, "dw": s.dw, "T": s.torque, "side": np.sign(s.w), "place": np.full(len(a), float(order))}
    for k in (1, 2, 4):
        out |= {f"cos{k}": np.cos(k * a), f"sin{k}": np.sin(k * a)}
    out |= {"cos_l": np.cos(b), "sin_l": np.sin(b)}
    for lag in LAGS:
        rows = max(round(lag / step), 1)
        out |= {f"w_{lag}": before(s.w, rows), f"T_{lag}": before(s.torque, rows)}
    return out


def angle_rows(s: Smooth) -> np.ndarray:
    return np.ones(len(s.w), dtype=bool)


def torque_rows(s: Smooth) -> np.ndarray:
    return s.moving


SEEN: dict[str, Callable[[Smooth], np.ndarray]] = {"theta_l": angle_rows, "tau_l": torque_rows, "tau_m": torque_rows}


def splits(campaign: Path, trace: Path) -> dict[str, Split]:
    """Per channel: baseline fitted to the fitted runs, its residual on both, with features."""
    done = usable(read_runs(campaign))
    apart = held_out([s.name for s in done], trace)
    fitted = [s for s in done if s.name not in apart]
    residuals = left_over(done, fit_baseline(fitted))
    place = {s.name: i for i, s in enumerate(done)}
    out = {}
    for channel, by_run in residuals.items():
        pieces = {True: [], False: []}
        for s in done:
            if s.name in by_run:
                keep = SEEN[channel](s)
                columns = {name: x[keep] for name, x in features(s, place[s.name]).items()}
                pieces[s.name in apart].append(thinned(s.name, columns, by_run[s.name]))
        out[channel] = Split(joined(pieces[False]), joined(pieces[True]))
    return out


def thinned(run: str, columns: dict[str, np.ndarray], y: np.ndarray) -> Rows:
    """At most ROWS_PER_RUN rows, evenly."""
    rows = np.linspace(0, len(y) - 1, min(ROWS_PER_RUN, len(y))).astype(int)
    x = np.column_stack([column[rows] for column in columns.values()])
    return Rows(tuple(columns), x, y[rows], np.full(len(rows), run))


def joined(parts: list[Rows]) -> Rows:
    return Rows(
        parts[0].names,
        np.concatenate([p.x for p in parts]),
        np.concatenate([p.y for p in parts]),
        np.concatenate([p.run for p in parts]),
    )
