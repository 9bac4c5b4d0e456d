"""What `hdrig twin` says while it starts."""

from __future__ import annotations

import threading
import time

import pytest

from rig.commands import twin


def test_only_a_slow_start_is_explained(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    with twin.told_if_slow():
        pass
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(twin, "USUAL", 0.01)
    with twin.told_if_slow():
        time.sleep(0.2)
    assert "the plant is being compiled" in capsys.readouterr().err
    assert not any(isinstance(thread, threading.Timer) for thread in threading.enumerate())
