"""The end of a campaign as a page of text: every run with what became of it, every change with what showed it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from rig.campaign import sentinels
from rig.campaign.journal import Journal

MARKS = {"done": "done", "planned": "not made", "running": "running"}


def lines(journal: Journal) -> Iterator[str]:
    """From campaign.json, and what its sentinels were found to show."""
    book = journal.book
    simulated = "SIMULATED " if book["backend"] == "sim" else ""
    yield f"{simulated}campaign {book['name']} {book['status']}: {book['sentence']}"
    if book.get("note"):
        yield f"note: {book['note']}"
    yield f"begun {book['started_utc'][:19]} UTC, {len(book['sessions'])} session(s), order seed {book['seed']}"
    yield ""
    for number, entry in enumerate(book["runs"], 1):
        yield f"{number:4d}  {_mark(entry):11s} {told(entry)}"
        told_of = entry.get("figure") if entry["status"] == "done" else entry["sentence"]
        if told_of:
            yield f"      {told_of}"
        if entry["run"]:
            yield f"      {entry['run']}"
        for attempt in entry["attempts"][:-1]:
            yield f"      before: {attempt['status']}, {attempt['sentence']}"
    yield ""
    for entry in book["changes"]:
        yield f"by hand: {entry['change']['words']}: {entry['shown']}"
    if book["pending"]:
        yield f"by hand, asked for and not shown: {book['pending']['words']}"
    for note in book["notes"]:
        yield note["text"]
    yield from sentinels.lines(journal)


def _mark(entry: Mapping[str, object]) -> str:
    """What became of a run, in a word or two: one that was stopped before its folder was made never began."""
    status = str(entry["status"])
    return "not begun" if status == "stopped" and not entry["run"] else MARKS.get(status, status)


def told(entry: dict[str, object]) -> str:
    """A run as a person calls it, from its entry."""
    given = entry["parameters"]
    conditions = entry["conditions"]
    assert isinstance(given, dict)
    assert isinstance(conditions, dict)
    words = [str(entry["procedure"]), *(f"{name}={value}" for name, value in given.items())]
    kind = str(entry["kind"])
    start = "" if kind in ("step", words[0]) else f"{kind}: "
    rest = [f"{entry['repeat']} of {entry['of']}"] if entry["of"] != 1 else []
    if conditions["tau_ext"]:
        rest.append(f"{conditions['tau_ext']:+g} N·m")
    if conditions["output_locked"]:
        rest.append("locked")
    if conditions["assembly"] != 1:
        rest.append(f"assembly {conditions['assembly']} at {conditions['depth_mm']:+g} mm")
    return ", ".join([start + " ".join(words), *rest])
