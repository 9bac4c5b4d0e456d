"""`campaign.json`: what was planned, what became of it, what was changed by hand. Replaced as a whole at every step."""

from __future__ import annotations

import contextlib
import json
import re
import uuid
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rig.bench import BENCHES
from rig.campaign.plan import PLANS, digest
from rig.campaign.planner import Campaign
from rig.core.errors import HdrigError, NotReady, RecorderError, UsageError
from rig.core.operator import Change, FreeOutput, HangWeight, LockOutput, Reassemble, Rigging
from rig.runfile.manifest import contents, parse, sync_folder, told, utc_now, write_atomic
from rig.runfile.process import is_being_made, sole_writer, this_process

NAME = "campaign.json"
SCHEMA = "hdrig.campaign/1"
PATIENCE = 5.0  # s for another one that is about to go on with the same campaign to say so
LOST = "lost"  # status of a run that was done and is no more: it is open again
SETTLED = ("done", "skipped")  # statuses a resumed campaign leaves alone
KINDS: dict[str, type[Change]] = {k.__name__: k for k in (HangWeight, LockOutput, FreeOutput, Reassemble)}


class Journal:
    """One campaign's book. Every method that changes it has it safe on disk when it returns. Raises RecorderError: a
    disk that takes no more ends a campaign as it ends a run.
    """

    def __init__(self, folder: Path, book: dict[str, Any]) -> None:
        self.folder = folder
        self.book = book
        self._before: float = book["rig_time_s"]  # s of earlier sessions

    @property
    def rigging(self) -> Rigging:
        """The rig as it was last shown to be."""
        return Rigging(**self.book["rigging"])

    @property
    def pending(self) -> Change | None:
        """A change that was asked for and not shown."""
        return None if self.book["pending"] is None else change_of(self.book["pending"])

    @property
    def made(self) -> list[Change]:
        """Every change so far, in order."""
        return [change_of(entry["change"]) for entry in self.book["changes"]]

    def open_runs(self) -> list[int]:
        """Numbers of the runs still to be made, in order, from 0."""
        return [k for k, entry in enumerate(self.book["runs"]) if entry["status"] not in SETTLED]

    def count(self) -> dict[str, int]:
        """How many runs are in which status."""
        return dict(Counter(entry["status"] for entry in self.book["runs"]))

    def begin(self, index: int, t: float) -> float:
        """A run is about to be started, `t` s on the clock of this session. Returns the rig's time in the campaign [s].

        In virtual time the clock on the wall says little of how long the rig has run, and so of how warm it is.
        """
        rig_time: float = self._before + t
        self.book["runs"][index]["status"], self.book["rig_time_s"] = "running", rig_time
        self._save()
        return rig_time

    def end(self, index: int, status: str, sentence: str, folder: Path | None = None) -> None:
        """`status` done, failed, stopped or interrupted; `folder` is the run's, if it got one. Attempts are kept."""
        entry, run = self.book["runs"][index], "" if folder is None else str(folder.relative_to(self.folder))
        entry["attempts"].append({"utc": utc_now(), "status": status, "sentence": sentence, "run": run})
        entry |= {"status": status, "sentence": sentence, "run": run}
        self._save()

    def lose(self, index: int, sentence: str) -> None:
        """A run that was done is gone, or cannot be read: it counts as not made, and its figure goes with it."""
        self.book["runs"][index].pop("figure", None)
        self.end(index, LOST, sentence)

    def moved(self, index: int, name: str) -> None:
        """The folder of a run is called `name` now."""
        self.book["runs"][index]["run"] = name
        self._save()

    def figure(self, index: int, sentence: str) -> None:
        """What the analysis says of a run."""
        self.book["runs"][index]["figure"] = sentence
        self._save()

    def skip(self, index: int, by: str) -> None:
        """A run that will not be made, and who said so."""
        self.book["runs"][index] |= {"status": "skipped", "by": by, "sentence": f"skipped by {by}"}
        self._save()

    def ask(self, change: Change) -> dict[str, Any] | None:
        """A change is about to be asked for. Returns the record of what was asked for before and not shown."""
        former: dict[str, Any] | None = self.book["pending"]
        self.book["pending"] = record_of(change)
        self._save()
        return former

    def take_back(self, former: dict[str, Any] | None) -> None:
        """It was refused before anybody touched the rig: what is pending is what was before."""
        self.book["pending"] = former
        self._save()

    def show(self, change: Change, rigging: Rigging, sentence: str) -> None:
        """The sensors have shown it."""
        self.book["changes"].append({"utc": utc_now(), "change": record_of(change), "shown": sentence})
        self.book |= {"pending": None, "rigging": rigging.conditions()}
        self._save()

    def note(self, text: str) -> str:
        """Something for every run from now on; returns what that is: `text`, or where that is empty what was said
        before.
        """
        if text:
            self.book["note"] = text
            self._save()
        return str(self.book.get("note") or "")

    def of_the_twin(self) -> None:
        """Its runs are simulated, whatever wire they came over."""
        if self.book["backend"] != "sim":
            self.book["backend"] = "sim"
            self._save()

    def tell(self, text: str) -> None:
        """Something worth keeping: proof, tare, a trip, an end."""
        self.book["notes"].append({"utc": utc_now(), "text": text})
        self._save()

    def close(self, status: str, sentence: str) -> None:
        """The campaign has come to an end for now: completed, stopped or failed."""
        self.book |= {"status": status, "sentence": sentence, "ended_utc": utc_now(), "process": None}
        self._save()

    def fail(self, status: str, sentence: str) -> None:
        """As `close`, after an error: that is what is told then, also where the disk takes no more."""
        with contextlib.suppress(RecorderError):
            self.close(status, sentence)

    def reopen(self) -> None:
        """Go on with it in this process, from where it stands by now. Raises NotReady while another one does, and when
        it cannot be written."""
        with told(NotReady, f"{self.folder} cannot be opened"), sole_writer(self.folder, PATIENCE):
            now = read_journal(self.folder).book  # two may have read it before either went on
            if is_being_made(now):
                raise NotReady(f"{self.folder} is being made by process {now['process']['pid']}; stop that first")
            self.book |= now | {"status": "running", "sentence": "", "process": this_process()}
            self._before = self.book["rig_time_s"]
            self.book["sessions"].append(utc_now())
            self._save(NotReady)

    def _save(self, kind: type[HdrigError] = RecorderError) -> None:
        data = json.dumps(self.book, indent=1, ensure_ascii=False).encode(errors="replace") + b"\n"
        with told(kind, f"{self.folder / NAME} cannot be written"):
            write_atomic(self.folder / NAME, data)


def new_journal(root: Path, campaign: Campaign, clock: str, overrides: Sequence[str]) -> Journal:
    """Make the campaign's folder under `root` with its plan and bench in it. Raises NotReady; nothing has moved."""
    uid, now = uuid.uuid4().hex, utc_now()
    bench, plan = campaign.bench, campaign.plan
    serial = re.sub(r"[^A-Za-z0-9._-]+", "-", bench.file.gear.serial)
    folder = root / f"{now[:10]}-{now[11:13]}{now[14:16]}-campaign-{plan.file.name}-{serial}-{uid[:4]}"
    book: dict[str, Any] = {
        "schema": SCHEMA, "uid": uid, "name": plan.file.name, "title": plan.file.title, "status": "running",
        "sentence": "", "started_utc": now, "backend": "sim" if bench.simulated else "rig", "clock": clock,
        "seed": campaign.seed, "plan": {"source": found_again(plan.source), "sha256": plan.sha256},
        "bench": {"source": found_again(bench.source), "sha256": digest(bench.text), "overrides": list(overrides)},
        "process": this_process(), "sessions": [now], "rig_time_s": 0.0,
        "rigging": Rigging().conditions(), "pending": None,
        "runs": [entry_of(item.record()) for item in campaign.items], "changes": [], "notes": [],
    }  # fmt: skip
    with told(NotReady, f"no campaign folder can be made in {root}"):
        folder.mkdir(parents=True)
        write_atomic(folder / "plan.toml", plan.text.encode())
        write_atomic(folder / "bench.toml", bench.text.encode())
        sync_folder(root)
    journal = Journal(folder, book)
    journal._save()
    return journal


def found_again(source: str) -> str:
    """What names a bench or plan from any folder: of those that ship the bare name, of a file the whole path."""
    path = Path(source)
    if path.parent in (BENCHES, PLANS):
        return path.stem
    return str(path.resolve()) if path.exists() else source


def entry_of(record: Mapping[str, Any]) -> dict[str, Any]:
    """A run that was planned."""
    return {**record, "status": "planned", "sentence": "", "run": "", "attempts": []}


def read_journal(folder: Path) -> Journal:
    """The campaign in `folder`. Raises UsageError when there is none."""
    path = folder / NAME
    try:
        book = parse(contents(path))
    except FileNotFoundError:
        why = f"is not a campaign folder: it has no {NAME}" if folder.exists() else "does not exist"
        raise UsageError(f"{folder} {why}") from None
    except OSError as error:
        raise UsageError(f"{path} cannot be read: {error.strerror}") from None
    except ValueError as error:
        raise UsageError(f"{path} is not JSON: {error}") from None
    if not isinstance(book, dict) or book.get("schema") != SCHEMA:
        raise UsageError(f'{path} is not of schema "{SCHEMA}"')
    return Journal(folder, book)


def refuse_other_campaign(journal: Journal, campaign: Campaign) -> None:
    """Raises UsageError when plan, bench or hdrig's own planning are not those the campaign began with."""
    book, folder = journal.book, journal.folder
    for what, now in (("plan", campaign.plan.sha256), ("bench", digest(campaign.bench.text))):
        if book[what]["sha256"] != now:
            raise UsageError(
                f"the {what} is not the one this campaign began with ({book[what]['source']} has changed, or other "
                f"options were given): what it began with is {folder / (what + '.toml')}; or start a new campaign"
            )
    refuse_other_runs(journal, campaign)


def refuse_other_runs(journal: Journal, campaign: Campaign) -> None:
    """Raises UsageError when the book's runs are not those of `campaign`."""
    book, folder = journal.book, journal.folder
    # as JSON has it: a tuple comes back as a list
    planned = json.loads(json.dumps([item.record() for item in campaign.items]))
    begun = [{key: entry[key] for key in record} for entry, record in zip(book["runs"], planned, strict=False)]
    if len(book["runs"]) != len(planned) or begun != planned:
        raise UsageError(f"this hdrig plans other runs than {folder} began with; go on with the version that began it")


def record_of(change: Change) -> dict[str, Any]:
    """A change as campaign.json has it."""
    return {"kind": type(change).__name__, "words": change.words(), **vars(change)}


def change_of(record: Mapping[str, Any]) -> Change:
    """And back. Raises UsageError for one no hdrig writes."""
    kind = KINDS.get(str(record.get("kind")))
    if kind is None:
        raise UsageError(f"campaign.json names a change '{record.get('kind')}' that does not exist")
    return kind(**{key: value for key, value in record.items() if key not in ("kind", "words")})
