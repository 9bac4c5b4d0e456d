"""How long it takes to list 5 000 runs, and to query 100 000 with DuckDB as they lie. Not a test: minutes, a gigabyte.

    .venv/bin/python -m tests.studies.catalogue FOLDER RUN [--runs 100000]

RUN is a real run folder, analysed: its manifest and result are written again and again under FOLDER with other dates,
gears and values; every 500th folder gets its samples too. FOLDER is made, or taken as it is when it is there.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import time
from datetime import UTC, datetime, timedelta
from pathlib import Path

FEW = 5000
SAMPLED = 500
KEPT = 12  # estimates of a result: of a slow run those that people ask for


def make(root: Path, run: Path, count: int) -> None:
    """`count` run folders by date."""
    manifest, result = (json.loads((run / name).read_bytes()) for name in ("manifest.json", "result.json"))
    draw, start = random.Random(1), datetime(2024, 1, 1, tzinfo=UTC)
    for k in range(count):
        when, serial = start + timedelta(minutes=13 * k), f"SN{k % 40:04d}"
        uid = f"{draw.getrandbits(128):032x}"
        folder = root / f"{when:%Y-%m-%d}" / f"{when:%H%M}-{run.name[5:-5]}-{serial}-{uid[:4]}"
        folder.mkdir(parents=True)  # called by its uid, as ours are: others may be copies, of which more is remembered
        about = {**manifest, "uid": uid, "started_utc": when.isoformat()}
        about["gear"] = {**manifest["gear"], "serial": serial}
        estimates = dict(list(result["estimates"].items())[:KEPT])
        first = next(iter(estimates))
        estimates[first] = {**estimates[first], "value": estimates[first]["value"] + draw.gauss(0.0, 0.5)}
        (folder / "manifest.json").write_text(json.dumps(about, indent=1))
        (folder / "result.json").write_text(json.dumps({**result, "estimates": estimates, "tables": {}}, indent=1))
        if k % SAMPLED == 0:
            os.link(run / "samples.parquet", folder / "samples.parquet")


def timed(what: str, work: object) -> None:
    """Wall and CPU time of one call."""
    wall, cpu = time.perf_counter(), time.process_time()
    rows = work()  # type: ignore[operator]
    print(f"| {what} | {rows} | {time.perf_counter() - wall:.2f} | {time.process_time() - cpu:.2f} |", flush=True)


def main() -> None:
    """The table on stdout."""
    import duckdb

    from rig.catalogue import runs, trend
    from tests.catalogue.queries import queries

    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path)
    parser.add_argument("run", type=Path)
    parser.add_argument("--runs", type=int, default=100_000)
    args = parser.parse_args()
    few, many = args.folder / "few", args.folder / "many"
    for root, count in ((few, FEW), (many, args.runs)):
        if not root.exists():
            make(root, args.run, count)
    print("| what | rows | wall, s | CPU, s |\n|---|---|---|---|")
    timed(f"`hdrig list`, {FEW} runs, first time", lambda: len(runs(few)))
    timed(f"the same again in one process, {FEW} runs", lambda: len(runs(few)))
    timed(f"`hdrig trend C_2`, {FEW} runs, first time", lambda: len(trend(few, "C_2").series))
    connection = duckdb.connect()
    for heading, sql in queries(many).items():
        timed(f"query {heading}", lambda sql=sql: len(connection.execute(sql).fetchall()))


if __name__ == "__main__":
    main()
