"""--view: who looks on while something runs. It is there before anything moves, and cannot hold up what does."""

from __future__ import annotations

import argparse
import sys
from abc import ABC, abstractmethod
from pathlib import Path
from types import TracebackType

from rig.live.view.viewer import Viewer
from rig.loop import Ending
from rig.session.done import Watch, nobody
from rig.session.observer import Begun, Observer

KINDS = ("none", "web", "native", "file")


def view_argument(parser: argparse.ArgumentParser) -> None:
    """--view KIND."""
    parser.add_argument(
        "--view",
        choices=KINDS,
        default="none",
        help="live view: web (a page on this machine), native (a window), file (view.rrd beside the last run's rows)",
    )


class View(Observer, ABC):
    """Open while a command runs; use as a context manager."""

    def __enter__(self) -> View:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @abstractmethod
    def close(self) -> None:
        """In 2 s at most while something is shown live."""


class NoView(View):
    """Nobody looks on."""

    def close(self) -> None:
        pass


class LiveView(View):
    """Every run of the session, the proofs among them, as it goes on."""

    def __init__(self, kind: str) -> None:
        """Raises NotReady when the viewer does not start."""
        self._viewer = Viewer(kind)
        if self._viewer.url:
            print(f"live view: {self._viewer.url}", file=sys.stderr)

    def begun(self, run: Begun) -> Watch:
        self._viewer.follow(run.folder)
        return nobody

    def close(self) -> None:
        self._viewer.close()


class RecordedView(View):
    """The last run that was ended, drawn from its folder once everything else is done."""

    def __init__(self) -> None:
        self._folder: Path | None = None

    def ended(self, folder: Path, ending: Ending) -> None:
        self._folder = folder

    def close(self) -> None:
        from rig.live.view.recording import NAME, record

        if self._folder is not None:
            record(self._folder, self._folder / NAME)
            print(f"view {self._folder / NAME}", file=sys.stderr)


def view(kind: str) -> View:
    """The view of that KIND, ready. Raises NotReady."""
    match kind:
        case "none":
            return NoView()
        case "file":
            return RecordedView()
        case _:
            return LiveView(kind)
