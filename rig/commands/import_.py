"""hdrig import FILE: a file of another logger and a small mapping file become a run folder."""

from __future__ import annotations

import argparse
from pathlib import Path


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig import`."""
    parser.add_argument("file", type=Path, metavar="FILE", help="CSV, Parquet, MAT, HDF5, MDF4 or TDMS")
    parser.add_argument(
        "--map", required=True, metavar="MAPPING", help="mapping file (TOML), or the name of one that ships"
    )
    parser.add_argument("--out", type=Path, default=Path("runs"), metavar="FOLDER", help="where the run folder goes")


def run(args: argparse.Namespace) -> int:
    """Prints the run folder."""
    from rig.runfile.importing import import_file
    from rig.software import software

    print(import_file(args.file, args.map, args.out, software()))
    return 0
