"""An adapter that cannot be opened: what its backend says, and where that leads nowhere what it means."""

from __future__ import annotations

import errno

import can
import pytest

from drivers.port import Port
from drivers.unopened import why_unopened
from rig.core.errors import NotReady


@pytest.mark.parametrize(
    ("interface", "error", "told"),
    [
        ("kvaser", NameError("name 'canOpen' is not defined"), "name 'canOpen' is not defined; Kvaser's CANlib is not"),
        ("gs_usb", can.CanInterfaceNotImplementedError("No module named 'usb'"), "pip install 'python-can[gs-usb]'"),
        (
            "socketcand",
            TypeError("SocketCanDaemonBus.__init__() missing 2 required positional arguments: 'host' and 'port'"),
            "socketcand needs 'host' and 'port' too: options of the bench file's bus, --option of hdrig devices",
        ),
        ("socketcan", OSError(errno.EAFNOSUPPORT, "Address family not supported"), "; this kernel has no CAN"),
        ("socketcan", OSError(errno.ENODEV, "No such device"), "No such device; `ip link` lists"),
        ("pcan", OSError("pcanbasic library not found.\nmore"), "pcanbasic library not found."),
        ("anything", RuntimeError(""), "RuntimeError"),
    ],
)
def test_the_reason_leads_to_the_mend(interface: str, error: BaseException, told: str) -> None:
    assert told in why_unopened(interface, error)
    assert "\n" not in why_unopened(interface, error)


def test_words_of_a_backend_that_say_it_themselves_stay_alone() -> None:
    assert why_unopened("slcan", OSError(errno.ENOENT, "no port")) == "[Errno 2] no port"


def test_what_pyserial_says_twice_is_said_once() -> None:
    with pytest.raises(NotReady, match=r"^torque sensor on /dev/none could not be opened: No such file or directory$"):
        Port("/dev/none", 9600, "torque sensor").open()


@pytest.mark.parametrize("interface", ["kvaser", "gs_usb", "socketcand"])
def test_the_library_still_raises_what_is_explained(interface: str) -> None:
    try:
        can.Bus(interface=interface, channel="0").shutdown()
    except Exception as error:  # noqa: BLE001  what each backend raises here is the question
        assert why_unopened(interface, error) != str(error)
    else:
        pytest.skip(f"{interface} is there")
