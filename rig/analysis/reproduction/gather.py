"""A campaign's folder read by two processes: the runs one by one, and the gear they identify beside them."""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any, ParamSpec, TypeVar

from rig.analysis.reproduction.campaign import Campaign
from rig.analysis.reproduction.model import Model, identify_gear
from rig.analysis.reproduction.reading import Reading, read
from rig.core.errors import DataError, HdrigError, UsageError, said_of
from rig.core.kinds import Regime, regime_of
from rig.process.ctrl_c import deaf
from rig.runfile import manifest as manifests
from rig.runfile.listing import runs_in
from rig.runfile.misfits import usable

PROCESSES = 2  # the machine beside a rig has two cores to spare
P = ParamSpec("P")
T = TypeVar("T")

SLOW = ("kinematic_error", "full_turn")  # unloaded, at one speed, smooth


@dataclass(frozen=True)
class Entry:
    """A run as its manifest tells it."""

    folder: Path
    manifest: Mapping[str, Any]

    @property
    def procedure(self) -> str:
        """Of the run."""
        return str(self.manifest.get("procedure", ""))

    @property
    def conditions(self) -> Mapping[str, Any]:
        """Of the run."""
        return self.manifest.get("conditions") or {}

    @property
    def locked(self) -> bool:
        """Whether the output was."""
        return bool(self.conditions.get("output_locked"))

    @property
    def bare(self) -> bool:
        """Free and unloaded."""
        return not self.locked and not self.conditions.get("tau_ext")


def entry(folder: Path) -> Entry:
    """The run in `folder`, by what of its manifest can be used. Raises UsageError where there is none."""
    return Entry(folder, usable(manifests.read(folder)))


def entries(campaign: Path, leave_out: Callable[[str], object] = lambda why: None) -> list[Entry]:
    """Every run in the folder that came to its end, in order; checks and warm-up left out, and what is no run of ours,
    of which `leave_out` is told. Raises DataError: none, or runs of several gears.
    """
    found = []
    for folder in runs_in(campaign):
        try:
            found.append(entry(folder))
        except UsageError as error:
            leave_out(f"{folder.name}: {said_of(folder, error)}")
    found = [e for e in found if _counts(e.manifest)]
    if not found:
        raise DataError(f"{campaign} holds no completed run")
    for what in ("ratio", "serial"):
        values = {str((e.manifest.get("gear") or {}).get(what)) for e in found}
        if len(values) > 1:
            raise DataError(
                f"{campaign} holds runs of several gears ({what} {', '.join(sorted(values))}): one page each"
            )
    return sorted(found, key=lambda e: (str(e.manifest.get("started_utc") or ""), _number_of(e.manifest)))


def _counts(manifest: Mapping[str, Any]) -> bool:
    kind = (manifest.get("campaign") or {}).get("kind")
    return manifest.get("status") in ("completed", "imported", None) and kind not in ("check", "warm-up")


def _number_of(manifest: Mapping[str, Any]) -> int:
    return int((manifest.get("campaign") or {}).get("run") or 0)


class Ahead:
    """Reads runs while the campaign goes on, each as it is closed, in a process of its own.

    Use as a context manager. Lock runs wait: which slow run is taken off them is known when all are made.
    """

    def __init__(self) -> None:
        self.begun: dict[Path, Future[Reading]] = {}

    def __enter__(self) -> Ahead:
        self._pool = Pool(1)
        return self

    def __exit__(self, *error: object) -> None:
        self._pool.__exit__(*error)

    def begin(self, folder: Path) -> None:
        """Read the run in `folder`, which is closed. Raises HdrigError when it has no manifest."""
        found = entry(folder)
        if _counts(found.manifest) and not found.locked:
            self.begun[folder.resolve()] = self._pool.submit(read, folder)


class Pool(ProcessPoolExecutor):
    """Processes of their own, to which a Ctrl-C says nothing: they are begun when work is submitted."""

    def __init__(self, processes: int) -> None:
        super().__init__(processes, multiprocessing.get_context("spawn"), _quiet)

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """As of any pool."""
        with deaf():
            return super().submit(fn, *args, **kwargs)

    def __exit__(self, *error: object) -> None:
        """What was not begun is given up; what was is waited for: a process killed in the middle of what it sends would
        leave the pool reading for ever."""
        self.shutdown(cancel_futures=True)


def gather(
    found: Sequence[Entry],
    progress: Callable[[str], None] = lambda text: None,
    processes: int = PROCESSES,
    begun: Mapping[Path, Future[Reading]] = MappingProxyType({}),
) -> Campaign:
    """Read every run and identify the gear; `begun` are those that are being read already, by folder.

    What cannot be read is left out, and the campaign says so. How many processes read does not change what they read.
    """
    reference = slow_reference(found)
    with Pool(processes) as pool:
        model = pool.submit(identify_gear, *to_identify(found))
        readings = [
            begun.get(e.folder.resolve()) or pool.submit(read, e.folder, reference if e.locked else None) for e in found
        ]
        progress(f"{len(found)} runs in {processes} processes")
        read_ones = [_or_why(one) for one in readings]
        gear, why = _model(model)
    unread = [f"{e.folder.name}: {r}" for e, r in zip(found, read_ones, strict=True) if isinstance(r, str)]
    return Campaign([r for r in read_ones if isinstance(r, Reading)], gear, why, tuple(unread))


def slow_reference(found: Sequence[Entry]) -> Path | None:
    """The longest unloaded slow run of the assembly made first: others may show how slow is slow enough, or stick."""
    slow = [e for e in found if e.procedure in SLOW and e.bare]
    first = [e for e in slow if e.conditions.get("assembly", 1) == slow[0].conditions.get("assembly", 1)]
    return max(first, key=lambda e: int(e.manifest.get("rows") or 0)).folder if first else None


def to_identify(found: Sequence[Entry]) -> tuple[list[Path], list[Path]]:
    """(runs that the figures at speed do not show, those they do), of the assembly that was run at speed."""
    fast = next((e for e in found if regime_of(e.procedure) is Regime.AT_SPEED), None)
    assembly = None if fast is None else fast.conditions.get("assembly", 1)
    here = [e for e in found if assembly is None or e.conditions.get("assembly", 1) == assembly]
    slow = slow_reference(here)
    at_speed = [e.folder for e in here if e.bare and regime_of(e.procedure) is Regime.AT_SPEED]
    beside = {e.folder for e in here if e.bare and regime_of(e.procedure) is Regime.LOSSES}
    return [e.folder for e in here if e.locked or e.folder == slow or e.folder in beside], at_speed


def _or_why(one: Future[Reading]) -> Reading | str:
    try:
        return one.result()
    except HdrigError as error:
        return str(error)


def _model(one: Future[Model]) -> tuple[Model | None, str]:
    try:
        return one.result(), ""
    except HdrigError as error:
        return None, str(error)


def _quiet() -> None:
    """A Ctrl-C is the main process's to handle; one thread of linear algebra a process, two fill the machine."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
