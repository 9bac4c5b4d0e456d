"""Rows to disk off the loop's thread: the loop puts them in a ring, a process of its own writes the journal."""

from rig.recorder.recorder import Recorder

__all__ = ["Recorder"]
