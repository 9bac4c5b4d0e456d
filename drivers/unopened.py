"""Why an adapter could not be opened, and what the operator can do: python-can's backends raise what they like."""

from __future__ import annotations

import errno
import os
import re

MISSING = {  # what stands behind words that say nothing to who has not written the backend
    "kvaser": "Kvaser's CANlib is not installed here",
    "ixxat": "the maker's library exists for Windows only",
    "gs_usb": "pip install 'python-can[gs-usb]' brings what it needs",
    "udp_multicast": "pip install 'python-can[multicast]' brings what it needs",
    "canalystii": "pip install 'python-can[canalystii]' brings what it needs",
}
SYSTEM = {errno.EAFNOSUPPORT: "this kernel has no CAN", errno.ENODEV: "`ip link` lists the interfaces there are"}
ARGUMENTS = re.compile(r"missing \d+ required \S+ arguments?: (.*)")


def why_unopened(interface: str, error: BaseException) -> str:
    """What the backend of `interface` said, and where that leads nowhere what it means."""
    told = first_line(error)
    match error:
        case TypeError() if wanted := ARGUMENTS.search(told):
            return f"{interface} needs {wanted[1]} too: options of the bench file's bus, --option of hdrig devices"
        case NameError() | ImportError() | NotImplementedError() if interface in MISSING:
            return f"{told}; {MISSING[interface]}"
        case OSError() if error.errno in SYSTEM:
            return f"{told}; {SYSTEM[error.errno]}"
        case _:
            return told


def first_line(error: BaseException) -> str:
    """What it says, without what follows; its kind where it says nothing; what pyserial says twice, once."""
    told = str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__
    number = getattr(error, "errno", None)
    return os.strerror(number) if number and told.count("[Errno") > 1 else told
