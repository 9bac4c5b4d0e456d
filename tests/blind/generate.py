"""Make blind cases: `python -m tests.blind.generate --kind single --effect stribeck_friction --seed 7 --out DIR`,
or a whole suite: `--suite 30 --seed 1 --out DIR` writes DIR/case-001/…, DIR/truth/case-001.json and DIR/HASHES.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from tests.blind.cases import KINDS, Request, make
from tests.blind.folder import write_campaign
from tests.blind.plans import PLANS
from tests.blind.suite import requests


def write_case(request: Request, out: Path, name: str) -> str:
    """One case below `out`, its truth apart; returns the line of HASHES."""
    if (out / name).exists():
        raise FileExistsError(f"{out / name} is there already: nothing is overwritten, choose another --out")
    case = make(request)
    campaign = write_campaign(case.runs, out / name, case.stage.plan, case.stage.rig)
    (out / "truth").mkdir(parents=True, exist_ok=True)
    text = json.dumps(case.truth | {"campaign_sha256": campaign}, indent=1)
    path = out / "truth" / f"{name}.json"
    path.write_text(text + "\n", encoding="utf-8")
    return f"{hashlib.sha256(path.read_bytes()).hexdigest()}  truth/{name}.json\n{campaign}  {name}\n"


def told(job: tuple[Request, Path, str]) -> str:
    request, out, name = job
    began = time.perf_counter()
    lines = write_case(request, out, name)
    print(
        f"{name} made in {time.perf_counter() - began:.1f} s", file=sys.stderr, flush=True
    )  # says nothing of the truth
    return lines


def parse(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="tests.blind.generate", description=__doc__)
    parser.add_argument("--kind", choices=KINDS, default="single")
    parser.add_argument("--effect", default="", help="effect to hide; without it one is drawn")
    parser.add_argument("--form", default="", help="functional form of that effect; without it one is drawn")
    parser.add_argument("--plan", choices=sorted(PLANS), default="complete")
    parser.add_argument(
        "--over-floor", type=float, default=0.0, help="strength over the floor; without it 1.3 to 20 is drawn"
    )
    parser.add_argument("--suite", type=int, default=0, help="number of cases of a suite instead of one case")
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument("--out", type=Path, required=True)
    return parser.parse_args(arguments)


def main(arguments: list[str]) -> int:
    """Exit code 0, or 2 with a sentence when the request cannot be met."""
    options = parse(arguments)
    if options.suite:
        asked = requests(options.suite, options.seed)
    else:
        one = Request(options.kind, options.seed, options.plan, options.effect, options.form, options.over_floor)
        asked = [one]
    jobs = [(request, options.out, f"case-{number:03d}") for number, request in enumerate(asked, 1)]
    try:
        with ProcessPoolExecutor(options.jobs) as pool:
            lines = list(pool.map(told, jobs))
    except (ValueError, FileExistsError) as refusal:
        print(refusal, file=sys.stderr)
        return 2
    (options.out / "HASHES").write_text("".join(lines), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
