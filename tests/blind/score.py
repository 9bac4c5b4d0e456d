"""Trace every case of one or more suites and mark it: `python -m tests.blind.score DIR…`.

Runs `hdrig trace DIR/case-001 --json DIR/traces/case-001.json` for every case that has no trace yet, after a check that
truth and campaigns are still those of HASHES; prints the table, and writes it where --table says.
"""

from __future__ import annotations

import argparse
import datetime
import hashlib
import json
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

from tests.blind.folder import digest
from tests.blind.marks import Mark, mark
from tests.blind.table import markdown

ANSWERS = (0, 6)  # exit codes of `hdrig trace` with a complete report
HDRIG = Path(sys.executable).with_name("hdrig")


class Tampered(Exception):
    """Truth or campaign is not what HASHES says was made."""


def check_hashes(suite: Path) -> None:
    """Raise Tampered when a truth or a campaign has changed since it was made."""
    for line in (suite / "HASHES").read_text(encoding="utf-8").splitlines():
        wanted, name = line.split()
        path = suite / name
        found = hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else digest(path)
        if found != wanted:
            raise Tampered(f"{path} has sha256 {found[:12]}…, HASHES says {wanted[:12]}…: make the suite anew")


def trace(campaign: Path, answer: Path, limit_s: float) -> None:
    """Run the tracer; without an answer in time, what it said lies beside the place of the answer."""
    answer.parent.mkdir(exist_ok=True)
    began = time.perf_counter()
    try:
        done = subprocess.run(
            [HDRIG, "trace", campaign, "--json", answer, "--out", answer.with_suffix("")],
            capture_output=True,
            text=True,
            timeout=limit_s,
            check=False,
        )
        said, code = done.stderr[-2000:], done.returncode
    except subprocess.TimeoutExpired:
        said, code = f"no answer within {limit_s:g} s", -1
    about = {"seconds": time.perf_counter() - began, "exit": code, "stderr": said}
    answer.with_suffix(".about").write_text(json.dumps(about), encoding="utf-8")


def read_answer(answer: Path) -> tuple[dict[str, Any], float]:
    """trace.json and the seconds it took; empty when the tracer gave none."""
    about_file = answer.with_suffix(".about")
    about = json.loads(about_file.read_text(encoding="utf-8")) if about_file.exists() else {"seconds": 0.0, "exit": 0}
    if not answer.exists() or about["exit"] not in ANSWERS:
        return {}, about["seconds"]
    return json.loads(answer.read_text(encoding="utf-8")), about["seconds"]


def trace_all(suite: Path, limit_s: float, jobs: int) -> None:
    """Trace every case that has no answer yet, `jobs` at a time."""
    answers = {
        path.stem: suite / "traces" / f"{path.stem}.json" for path in sorted((suite / "truth").glob("case-*.json"))
    }
    missing = {case: a for case, a in answers.items() if not a.exists() and not a.with_suffix(".about").exists()}

    def one(case: str) -> None:
        trace(suite / case, missing[case], limit_s)
        print(f"{case} traced", file=sys.stderr, flush=True)

    with ThreadPoolExecutor(jobs) as pool:
        list(pool.map(one, missing))


def marks(suite: Path) -> list[Mark]:
    """Every case of the suite by its truth."""
    out = []
    for truth_file in sorted((suite / "truth").glob("case-*.json")):
        said, seconds = read_answer(suite / "traces" / truth_file.name)
        out.append(mark(truth_file.stem, json.loads(truth_file.read_text(encoding="utf-8")), said, seconds))
    return out


def marks_of_all(suites: list[Path]) -> list[Mark]:
    """Every case of several suites; a case has its suite's name before its own where there is more than one."""
    if len(suites) == 1:
        return marks(suites[0])
    return [replace(one, case=f"{suite.name}/{one.case}") for suite in suites for one in marks(suite)]


def head_commit() -> str:
    """Commit of the tree this file lies in, in short."""
    asked = ["git", "-C", str(Path(__file__).parent), "rev-parse", "--short", "HEAD"]
    done = subprocess.run(asked, capture_output=True, text=True, check=False)
    return done.stdout.strip() or "unknown"


def main(arguments: list[str]) -> int:
    """Exit code 0 when every case was marked, 2 with a sentence when the suite cannot be trusted."""
    parser = argparse.ArgumentParser(prog="tests.blind.score", description=__doc__)
    parser.add_argument("suites", type=Path, nargs="+", metavar="suite", help="several make one table")
    parser.add_argument("--table", type=Path, help="also write the table to this file")
    parser.add_argument("--commit", default="", help="commit that was traced, where it is not this tree's")
    parser.add_argument("--limit", type=float, default=900.0, help="seconds a trace may take")
    parser.add_argument("--jobs", type=int, default=1, help="traces at a time")
    options = parser.parse_args(arguments)
    try:
        for suite in options.suites:
            check_hashes(suite)
        for suite in options.suites:
            trace_all(suite, options.limit, options.jobs)
        today = f"{datetime.datetime.now(datetime.UTC):%Y-%m-%d}"
        page = markdown(marks_of_all(options.suites), f"{today}, commit {options.commit or head_commit()}")
    except (Tampered, FileNotFoundError) as refusal:
        print(refusal, file=sys.stderr)
        return 2
    print(page)
    if options.table:
        options.table.write_text(page, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
