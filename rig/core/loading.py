"""Modules of a command that has much to import."""

from __future__ import annotations

import gc
import importlib
import sys


def load(*names: str) -> None:
    """Import modules that stay to the end: Python looks for no garbage in them, now or later, which was a tenth of the
    time of one run's analysis, and a copy of the process shares their memory untouched."""
    if all(name in sys.modules for name in names):
        return
    gc.disable()
    for name in names:
        importlib.import_module(name)
    gc.freeze()
    gc.enable()
