"""For tests in real time, on machines that stall."""

from __future__ import annotations

import pytest
from canopen.sdo import SdoClient

ANSWERS = 1.5  # s an answer may take; the library's 0.3 s is what a shared machine stalls for


@pytest.fixture
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """A machine that stalls is no node that does not answer."""
    monkeypatch.setattr(SdoClient, "RESPONSE_TIMEOUT", ANSWERS)
