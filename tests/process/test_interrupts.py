"""What each signal of a session counts as."""

from __future__ import annotations

import signal

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
