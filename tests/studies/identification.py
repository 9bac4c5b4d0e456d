"""Does identification find what is true? Random rigs on the twin: bias, scatter, coverage of every 95 % interval.

    .venv/bin/python -m tests.studies.identification --rigs 100 --plan complete --workers 2 --store /tmp/study

prints the table and writes it to tests/studies/identification.md (`--out` for another place). Rigs are numbered and
each makes its own random numbers, so the table does not depend on the workers. What each rig's runs were and what came
of them is kept in the store: a study that was stopped goes on where it was, and when only identification has changed
`--again` takes the runs from there. A tree that is edited meanwhile ends a study: let it run on a copy.
"""

from __future__ import annotations

import argparse
import os
import pickle
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import cast

import numpy as np
import numpy.typing as npt

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from rig.analysis.identify.fit import fit
from rig.analysis.identify.identified import identified, order_amplitudes
from rig.analysis.identify.recording import recording
from rig.bench import Bench, twin_parameters
from rig.process.software import software
from tests.studies.campaign import PLANS, MemoryRun, random_bench, take

Array = npt.NDArray[np.float64]
ARCSEC = 180.0 / np.pi * 3600.0
TERMS = 15
NAMES = ("J_m", "J_l", "K", "B_sp", "B_sum", "B_l", "tau_c", "F_cl", "omega_n", "zeta", "lag")


@dataclass(frozen=True)
class Outcome:
    """One rig: for every parameter (value, half width, truth); the series' errors and half widths, arcsec."""

    rig: int
    figures: dict[str, tuple[float, float, float]]
    series_error: Array  # (2·TERMS,)
    series_half: Array
    amplitude_error: Array  # (TERMS,)
    amplitude_half: Array
    failed: tuple[str, ...]
    named: tuple[str, ...]  # what it said it cannot tell apart


def truth(bench: Bench) -> dict[str, float]:
    """What the plant was made of."""
    gear = twin_parameters(bench.file).gear
    reflected = gear.ratio**2 * gear.J_m
    inertia = gear.J_l * reflected / (gear.J_l + reflected)
    omega_n = float(np.sqrt(gear.K / inertia))
    twin = bench.file.twin
    assert twin is not None
    return {
        **{name: getattr(gear, name) for name in ("J_m", "J_l", "K", "B_sp", "B_l", "tau_c", "F_cl")},
        "B_sum": gear.B_m + gear.B_ml * (1.0 + gear.sigma / gear.ratio) ** 2,
        "omega_n": omega_n,
        "zeta": gear.B_sp / (2.0 * omega_n * inertia),
        "lag": 1.0 / (2.0 * np.pi * twin.sensor_lowpass_hz) - (twin.latch_tau - twin.latch_l),  # read later is newer
    }


def one(number: int, plan: str, store: Path | None = None, again: bool = False) -> Outcome:
    """One rig from its numbers to its errors; what `store` holds of it is not made again, the outcome unless asked."""
    if store is None:
        return judged(number, take(random_bench(number), PLANS[plan]))
    store.mkdir(parents=True, exist_ok=True)
    outcome = store / f"{plan}-{number:03d}.outcome.pickle"
    if outcome.exists() and not again:
        return cast(Outcome, pickle.loads(outcome.read_bytes()))
    runs = store / f"{plan}-{number:03d}.pickle"
    taken = pickle.loads(runs.read_bytes()) if runs.exists() else take(random_bench(number), PLANS[plan])
    keep(runs, taken)
    found = judged(number, taken)
    keep(outcome, found)
    return found


def keep(path: Path, what: object) -> None:
    """Whole or not at all."""
    part = path.with_suffix(".part")
    part.write_bytes(pickle.dumps(what, protocol=5))
    part.replace(path)


def judged(number: int, taken: tuple[list[MemoryRun], float, list[str]]) -> Outcome:
    """What identification makes of one rig's runs, against what is true of it."""
    bench, (runs, zero, failed) = random_bench(number), taken
    recordings = [r for run in runs if (r := recording(run)) is not None]
    found = identified(fit(recordings, TERMS), runs[0].manifest)
    true, p = truth(bench), found.parameters
    figures = {name: (p[name].value, p[name].half, true[name]) for name in NAMES if name in p}
    c = twin_parameters(bench.file).gear.kinematic_error
    n = np.arange(1, TERMS + 1)
    phasor = (np.asarray(c.a) - 1j * np.asarray(c.b)) * np.exp(1j * n * zero)  # as the motor encoder counts
    real = np.concatenate((phasor.real, -phasor.imag))
    s = found.series
    made = np.array([*s.series.a, *s.series.b])
    half = 1.96 * np.sqrt(np.diag(s.covariance))
    sizes = order_amplitudes(s)
    return Outcome(
        number, figures, (made - real) * ARCSEC, half * ARCSEC,
        np.array([size for _, size, _ in sizes]) * ARCSEC - np.abs(phasor) * ARCSEC,
        np.array([1.96 * u for _, _, u in sizes]) * ARCSEC, tuple(failed), found.cannot,
    )  # fmt: skip


def study(
    rigs: int, plan: str, workers: int, first: int = 0, store: Path | None = None, again: bool = False
) -> list[Outcome]:
    """All rigs, in their own order."""
    numbers, work = range(first, first + rigs), partial(one, plan=plan, store=store, again=again)
    if workers == 1:
        return [work(n) for n in numbers]
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        return list(pool.map(work, numbers))


def table(outcomes: Sequence[Outcome]) -> list[str]:
    """Markdown: a line for every parameter, then the series."""
    lines = [
        "| parameter | rigs | bias, % | RMSE, % | worst, % | mean half width, % | error over its σ, rms | covered, % |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for name in NAMES:
        rows = np.array([o.figures[name] for o in outcomes if name in o.figures])
        if rows.size == 0:
            lines.append(f"| {name} | 0 | | | | | | |")
            continue
        error, half = (rows[:, 0] - rows[:, 2]) / rows[:, 2], rows[:, 1] / rows[:, 2]
        covered = np.abs(rows[:, 0] - rows[:, 2]) <= rows[:, 1]
        lines.append(
            f"| {name} | {len(rows)} | {100 * error.mean():+.4f} | {100 * np.sqrt(np.mean(error**2)):.4f} "
            f"| {100 * np.max(np.abs(error)):.3f} | {100 * half.mean():.4f} "
            f"| {1.96 * np.sqrt(np.mean((error / half) ** 2)):.2f} | {100 * covered.mean():.1f} |"
        )
    series, half = np.array([o.series_error for o in outcomes]), np.array([o.series_half for o in outcomes])
    sizes, wide = np.array([o.amplitude_error for o in outcomes]), np.array([o.amplitude_half for o in outcomes])
    lines += [
        "",
        "| kinematic error | bias, arcsec | RMSE, arcsec | worst, arcsec | covered, % |",
        "|---|---|---|---|---|",
    ]
    for label, error, width in (
        ("all a_n, b_n", series, half),
        ("C_2", sizes[:, 1], wide[:, 1]),
        ("C_4", sizes[:, 3], wide[:, 3]),
        ("all C_n", sizes, wide),
    ):
        lines.append(
            f"| {label} | {error.mean():+.5f} | {np.sqrt(np.mean(error**2)):.5f} | {np.max(np.abs(error)):.4f} "
            f"| {100 * np.mean(np.abs(error) <= width):.1f} |"
        )
    return lines


def document(outcomes: Sequence[Outcome], plan: str) -> str:
    """The whole file."""
    said = software()
    failed = [f"rig {o.rig}: {text}" for o in outcomes for text in o.failed]
    pairs = sorted({text.partition(":")[0] for o in outcomes for text in o.named})
    names = ", ".join(p.title() for p in PLANS[plan])
    head = [
        f"# Identification on random rigs, plan `{plan}`",
        "",
        f"{datetime.now(UTC):%Y-%m-%d}, commit {said.get('commit')}{' with changes' if said.get('dirty') else ''}. "
        f"SIMULATED: {len(outcomes)} rigs (numbers {outcomes[0].rig} to {outcomes[-1].rig}), every parameter, order "
        "and friction drawn within ±30 % of `rig/benches/twin.toml`, all phases anew.",
        "",
        f"Runs of each rig: {names}. Shortened against the full recipes: slow run 1 cycle, lock test 1 cycle at one "
        "rate of 1.5 N·m/s, friction from 20 rpm for 2 s a speed with one breakaway each way, 2 s of settling at "
        "constant torque. No recorder; loop, guard, procedures and devices are the program's.",
        "",
        "Half widths are those of the 95 % intervals; 93 to 97 % covered is what they promise, within the ±4 % that "
        "100 rigs can tell. Error over its σ (half width/1.96) is 1 where intervals are as wide as they should be, and "
        "100 rigs tell it to ±0.07. The drag is the sum B_sum = B_m + B_ml·(1 + σ/N)².",
        "",
        "One figure of twenty strays from what it should be by two of these ±, and a table has some eight independent "
        "ones: what strays in one draw of rigs is looked for in another (`--first`) before anything is mended.",
        "",
    ]
    tail = ["", "Named as not to be told apart: " + "; ".join(pairs) + ".", ""]
    if failed:
        tail += [f"Runs that did not complete, left out of their rigs ({len(failed)}):", ""]
        tail += [f"- {text}" for text in failed] + [""]
    return "\n".join([*head, *table(outcomes), *tail])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rigs", type=int, default=100)
    parser.add_argument("--first", type=int, default=0, help="number of the first rig")
    parser.add_argument("--plan", choices=list(PLANS), default="complete")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--out", type=Path, default=None, help="default: beside this file")
    parser.add_argument("--store", type=Path, default=None, help="folder for runs (25 to 40 MB a rig) and outcomes")
    parser.add_argument("--again", action="store_true", help="identify again from the runs in the store")
    args = parser.parse_args()
    outcomes = study(args.rigs, args.plan, args.workers, args.first, args.store, args.again)
    text = document(outcomes, args.plan)
    print(text)
    name = "identification.md" if args.plan == "complete" else f"identification-{args.plan}.md"
    (args.out or Path(__file__).parent / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
