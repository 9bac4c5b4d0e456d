"""What the recorder's process does, one `step` at a time: rows from the ring to the journal. Time is passed in."""

from __future__ import annotations

from rig.core.ring import Ring
from rig.runfile.columns import columns_of_rows
from rig.runfile.journal import JournalWriter

POLL = 0.02  # s between looks at the ring; with FLUSH 0.22 s, for which rows are in shared memory alone
FLUSH = 0.2  # s between batches handed to the operating system
SYNC = 0.8  # s between syncs to disk; with POLL and the sync itself it stays within the 1 s a power cut may cost
SHARE = 4  # a faster producer is followed by ring fill: a batch, and a sync, for each quarter of the ring


class Service:
    """Moves rows on when they are due. `written` and `acked` in the ring say how far it has come."""

    def __init__(self, ring: Ring, journal: JournalWriter, now: float) -> None:
        self._ring = ring
        self._journal = journal
        self._flushed = self._synced = now  # s, on the caller's clock
        ring.tell_written(journal.rows)

    @property
    def pressed(self) -> bool:
        """True when the ring fills faster than the clock asks for: then there is no time to sleep."""
        return bool(self._ring.head - self._ring.acked >= self._ring.capacity // SHARE)

    def step(self, now: float) -> None:
        """Do what is due at `now` [s]. Raises OSError when the journal cannot take it."""
        sync = now - self._synced >= SYNC or self.pressed
        if sync or now - self._flushed >= FLUSH:
            self._write()
            self._flushed = now
        if sync:
            self._sync()
            self._synced = now

    def finish(self) -> None:
        """Everything that is in the ring, to disk; then the journal's end. Raises OSError."""
        self._write()
        self._journal.close()
        self._ring.tell_acked(self._journal.rows)

    def _write(self) -> None:
        rows = self._ring.read(self._journal.rows, self._ring.head)
        if len(rows):
            self._journal.append(columns_of_rows(rows))
            self._ring.tell_written(self._journal.rows)

    def _sync(self) -> None:
        if self._journal.rows > self._ring.acked:
            self._journal.sync()
            self._ring.tell_acked(self._journal.rows)
