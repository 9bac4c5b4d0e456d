"""hdrig import FILE: a file of another logger and a small mapping file become a run folder."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from rig.commands.targets import refuse_unwritable

MAPPINGS = Path(__file__).parents[1] / "runfile" / "importing" / "mappings"
EXAMPLE = """
a mapping file says which column is what, for example:

  schema = "hdrig.import/1"
  procedure = "kinematic_error"
  [gear]
  ratio = 50
  serial = "SN0042"
  [channels.t]
  column = "Time"
  unit = "ms"
  [channels.theta_m]
  column = "motor"
  unit = "counts"
  counts_per_turn = 10000
  [channels.theta_l]
  column = "load"
  unit = "deg"
  sign = -1

all keys:
"""
SHIPPED = "\n\nmappings that ship, to use by name or to copy from:\n"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig import`."""
    from rig.runfile.importing.channel import QUANTITY
    from rig.runfile.importing.keys import KEYS

    keys = [f"  {names}\n        {meaning}" for names, meaning in KEYS]
    keys.append(f"  NAME of a channel: {', '.join(QUANTITY)}, or one of your own")
    ships = [f"  {path.stem:16s} {path}" for path in sorted(MAPPINGS.glob("*.toml"))]
    parser.epilog = EXAMPLE + "\n".join(keys) + SHIPPED + "\n".join(ships)
    parser.add_argument("file", type=Path, metavar="FILE", help="CSV, Parquet, MAT, HDF5, MDF4 or TDMS")
    parser.add_argument(
        "--map", required=True, metavar="MAPPING", help="mapping file (TOML), or the name of one that ships"
    )
    parser.add_argument(
        "-o", "--out", type=Path, default=Path("runs"), metavar="FOLDER", help="where the run folder goes"
    )
    parser.add_argument("--again", action="store_true", help="also where the same file was imported there before")


def run(args: argparse.Namespace) -> int:
    """Prints the run folder; on stderr, so that a script gets the folder alone, what was found on the way."""
    from rig.process.software import software
    from rig.runfile.importing import import_file
    from rig.runfile.manifest import read

    refuse_unwritable(args.out)
    folder = import_file(args.file, args.map, args.out, software(), args.again)
    about = read(folder)
    simulated = "SIMULATED " if about["backend"] == "sim" else ""
    over = f", {about['duration']:.4g} s" if about.get("duration") else ""
    print(f"{simulated}{args.file.name}: {about['rows']} rows{over}", file=sys.stderr)
    for note in about.get("notes", ()):
        print(f"  {note}", file=sys.stderr)
    print(folder)
    return 0
