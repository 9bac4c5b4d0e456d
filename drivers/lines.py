"""Lines out of a byte stream: torn ones wait for their rest, what cannot be a line is counted and dropped."""

from __future__ import annotations


class Lines:
    """Splits at `ends`. A line longer than `longest` bytes is no line: everything up to the next end is dropped."""

    def __init__(self, longest: int, ends: bytes = b"\r\n") -> None:
        self.longest = longest
        self.dropped = 0  # pieces that were no lines
        self._ends = ends
        self._rest = b""
        self._synchronised = False  # the first piece may be the tail of a line: it is not believed

    def feed(self, data: bytes) -> list[bytes]:
        """The complete lines in what came before and `data`, without their ends, empty ones left out."""
        text = self._rest + data
        for end in self._ends[1:]:
            text = text.replace(bytes((end,)), self._ends[:1])
        *lines, self._rest = text.split(self._ends[:1])
        if len(self._rest) > self.longest:
            self._rest, self._synchronised = b"", False
            self.dropped += 1
        if lines and not self._synchronised:
            self.dropped += bool(lines[0])
            lines, self._synchronised = lines[1:], True
        good = [line for line in lines if 0 < len(line) <= self.longest]
        self.dropped += sum(len(line) > self.longest for line in lines)
        return good
