"""What each signal of a session counts as."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable
from types import FrameType
from typing import Any

import pytest

from rig.core.errors import Exit
from rig.process.interrupts import Interrupts


@pytest.mark.parametrize(
    ("numbers", "exit"),
    [
        ([signal.SIGINT], Exit.STOPPED),
        ([signal.SIGINT, signal.SIGTERM], Exit.HALTED),
        ([signal.SIGQUIT], Exit.HALTED),
    ],
)
def test_one_signal_is_a_stop_two_are_a_halt_and_ctrl_backslash_is_one(
    numbers: list[signal.Signals], exit: Exit
) -> None:
    with Interrupts() as interrupts:
        for number in numbers:
            signal.raise_signal(number)
    assert interrupts.exit is exit


def test_handlers_of_signals_are_given_back() -> None:
    before = [signal.getsignal(number) for number in Interrupts.SIGNALS]
    with Interrupts():
        assert [signal.getsignal(number) for number in Interrupts.SIGNALS] != before
    assert [signal.getsignal(number) for number in Interrupts.SIGNALS] == before


def with_between(act: Callable[[Interrupts], None], between: Callable[[Interrupts], None], step: int) -> int | None:
    """What comes of `act` with `between` before its `step`; None when it has no such step."""
    interrupts, left = Interrupts(), step

    def trace(frame: FrameType, event: str, arg: Any) -> Any:
        nonlocal left
        if frame.f_code.co_filename != sys.modules[Interrupts.__module__].__file__:
            return None
        frame.f_trace_opcodes = True
        if event == "opcode":
            left -= 1
            if left == -1:
                between(interrupts)
        return trace

    sys.settrace(trace)
    try:
        act(interrupts)
    finally:
        sys.settrace(None)
    return interrupts.count if left < 0 else None


def quit_signal(interrupts: Interrupts) -> None:
    interrupts.request(signal.SIGQUIT)


@pytest.mark.parametrize(
    ("act", "between"),
    [
        (Interrupts.stop, Interrupts.halt),
        (Interrupts.halt, Interrupts.stop),
        (Interrupts.request, Interrupts.request),  # twice Ctrl-C
        (Interrupts.request, quit_signal),
        (quit_signal, Interrupts.request),
    ],
)
def test_no_halt_is_lost_whatever_comes_between(
    act: Callable[[Interrupts], None], between: Callable[[Interrupts], None]
) -> None:
    """Ctrl-Z asks in the main thread, keys in theirs, and a handler may come between the steps of another."""
    counts = [count for step in range(50) if (count := with_between(act, between, step)) is not None]
    assert len(counts) > 3
    assert min(counts) >= 2
