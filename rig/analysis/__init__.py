"""Runs to numbers. Knows the model and the run folder, never a device."""

from rig.analysis.analyse import analyse
from rig.analysis.findings.result import Check, Estimate, Result, Verdict

__all__ = ["Check", "Estimate", "Result", "Verdict", "analyse"]
