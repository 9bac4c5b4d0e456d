"""python-can and canopen, without what python-can brings along to read logs of its own.

Where asammdf is installed, for its file format, `import can` imports it with pandas and a dozen others: 1.6 s before a
bus is opened, in every process that opens one. It is hidden while they are imported, and there again for who wants it.
"""

from __future__ import annotations

import sys

__all__ = ["can", "canopen"]

_HIDDEN = "asammdf"

_hide = _HIDDEN not in sys.modules
if _hide:
    sys.modules[_HIDDEN] = None  # type: ignore[assignment]  # what the import system takes for "not installed"
try:
    import can
    import canopen
finally:
    if _hide:
        del sys.modules[_HIDDEN]
