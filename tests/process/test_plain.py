"""What decides something is told in letters where a terminal has no mark for it."""

from __future__ import annotations

import io

import pytest

from rig.process.streams import show_what_fits


@pytest.mark.parametrize(
    ("encoding", "shown"),
    [
        ("utf-8", "✓ ✗ – 3.0 ± 0.1 N·m θ̃ ☃"),
        ("latin-1", "[yes] [no] - 3.0 ± 0.1 N·m theta~ ?"),
        ("ascii", "[yes] [no] - 3.0 +/- 0.1 N*m theta~ ?"),
    ],
)
def test_marks_are_written_in_the_letters_there_are(encoding: str, shown: str) -> None:
    raw = io.BytesIO()
    stream = io.TextIOWrapper(raw, encoding=encoding)
    show_what_fits(stream)
    stream.write("✓ ✗ – 3.0 ± 0.1 N·m θ̃ ☃")
    stream.flush()
    assert raw.getvalue().decode(encoding) == shown
