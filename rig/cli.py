"""The command line: finds the verb, runs it, turns errors into one sentence and an exit code."""

from __future__ import annotations

import argparse
import importlib
import os
import signal
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any, TextIO, cast

from rig import __version__
from rig.commands import CATALOGUE
from rig.core.errors import Exit
from rig.core.way_out import ending_in_a_sentence
from rig.process.ctrl_c import Ears, after_imports, leave
from rig.process.streams import Tolerant, show_what_fits, standard

DESCRIPTION = "Data acquisition and control for a strain-wave gear test rig."
EPILOG = (
    "exit codes: 0 pass, 1 out of limits, 2 usage, or a place that cannot be read or written, 3 not ready, 4 stopped,\n"
    "5 tripped, 6 incomplete or damaged samples, inconclusive, ambiguous, unknown, or a parameter left open,\n"
    "70 internal error, 130 halted, or interrupted"
)
MEANT = 0.75  # of the letters of an option, in their order: with less, --format was taken for --sort


class Parser(argparse.ArgumentParser):
    """A wrong command line is one sentence on stderr and exit code 2."""

    hints: Mapping[str, str] = MappingProxyType({})  # of options that are looked for here, where they are
    events = False  # a program reads them, and is told of a wrong command line in one

    def __init__(self, **words: Any) -> None:
        super().__init__(**words)
        self.register("type", Path, _place)  # of every option and argument that takes a folder or a file
        self.register("type", int, _whole)
        self.register("type", float, _number)

    def error(self, message: str) -> None:  # type: ignore[override]
        hint = next((f"; {hint}" for option, hint in self.hints.items() if option in message), self._meant(message))
        sentence = f"{message}{hint}{' See' if hint.endswith('?') else '; see'} {self.prog} --help"
        if self.events:
            from rig.commands.show.beforehand import refuse

            refuse(sentence)
        print(f"hdrig: {sentence}", file=sys.stderr)
        raise SystemExit(Exit.USAGE)

    def _meant(self, message: str) -> str:
        """The option that one there is not is nearest to, for a message that begins with such."""
        unknown = message.removeprefix("unrecognized arguments: ").split(" ", 1)[0].partition("=")[0]
        if unknown == message or not unknown.startswith("--"):
            return ""
        import difflib

        close = difflib.get_close_matches(unknown, list(self._option_string_actions), n=1, cutoff=MEANT)
        return f"; did you mean {close[0]}?" if close else ""


def _whole(said: str) -> int:
    try:
        return int(said)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{said!r}: expected a whole number") from None


def _number(said: str) -> float:
    try:
        return float(said)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{said!r}: expected a number") from None


def _place(said: str) -> Path:
    """A path as given, but none of no characters, which Path takes for the folder one is in, and no -: a file of that
    name is in everybody's way."""
    if not said:
        raise argparse.ArgumentTypeError("an empty path, as of a shell variable that is not set; expected a name")
    if said == "-":
        raise argparse.ArgumentTypeError("- is standard input or output to other programs, not here; expected a name")
    return Path(said)


def overview() -> str:
    """The list of verbs for --help, from the catalogue alone."""
    return "\n".join(f"  {name:10s} {summary}" for name, (_, summary) in CATALOGUE.items())


def main(argv: Sequence[str] | None = None) -> int:
    """Run one verb; the exit code. Output that vanishes stops nothing; where what went to stdout could not be written,
    a sentence says so at the end, and a code of 0 becomes 2."""
    # our matrices are small: a second BLAS thread only spins beside the loop and the recorder
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    before = sys.stdout, sys.stderr
    streams = standard(sys.stdout, 1), standard(sys.stderr, 2)
    for stream in streams:
        show_what_fits(stream)
    out, err = (Tolerant(stream) for stream in streams)
    sys.stdout, sys.stderr = cast(TextIO, out), cast(TextIO, err)
    # of a process of its own nothing is left to interrupt after that; who calls this function goes on
    then = leave if argv is None else signal.default_int_handler
    try:
        with after_imports(_verb, then) as ears:
            return _to_the_end(ears, list(sys.argv[1:] if argv is None else argv), out, err)
    finally:
        sys.stdout, sys.stderr = before


def _to_the_end(ears: Ears, args: list[str], out: Tolerant, err: Tolerant) -> int:
    """The exit code once everything is said and written: Ctrl-C is heard in the verb alone, and ends nothing else."""
    try:
        return _after_output(ending_in_a_sentence(lambda: _interruptible(ears, args)), out)
    except SystemExit as end:  # --help, --version and a wrong command line end so
        if isinstance(end.code, int) and (code := _after_output(end.code, out)) != end.code:
            raise SystemExit(code) from None
        raise
    finally:
        out.flush()
        err.flush()


def _after_output(code: int, out: Tolerant) -> int:
    """The exit code once everything is written; USAGE in place of PASS where it could not be."""
    out.flush()
    if not out.lost:
        return code
    print(f"hdrig: what was to be printed could not be written: {out.lost}", file=sys.stderr)
    return code or int(Exit.USAGE)


def _interruptible(ears: Ears, args: list[str]) -> int:
    with ears.kept():
        return _verb(args)


def _verb(args: list[str]) -> int:
    top = Parser(
        prog="hdrig",
        usage="hdrig VERB …",
        description=f"{DESCRIPTION}\n\nverbs:\n{overview()}\n\n`hdrig VERB --help` tells more.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    top.add_argument("--version", action="version", version=f"hdrig {__version__}")
    top.add_argument("verb", metavar="VERB", choices=list(CATALOGUE), help=argparse.SUPPRESS)
    verb = top.parse_args(args[:1] or ["--help"]).verb
    module = importlib.import_module(CATALOGUE[verb][0])
    raw = argparse.RawDescriptionHelpFormatter
    parser = Parser(prog=f"hdrig {verb}", description=CATALOGUE[verb][1], formatter_class=raw)
    parser.hints = getattr(module, "HINTS", parser.hints)
    module.arguments(parser)
    parser.events = bool(parser.get_default("events")) and "--json" in args
    return int(module.run(parser.parse_args(args[1:])))


if __name__ == "__main__":
    raise SystemExit(main())
