"""What an analysis says: figures with uncertainty, checks in words, curves to draw. `result.json` is this on disk."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


class Verdict(StrEnum):
    """PASS and FAIL are against a limit, outside its guard band; INCONCLUSIVE is inside it, or a run that must not be
    believed; MEASURED had no limit."""

    PASS = "PASS"
    FAIL = "FAIL"
    INCONCLUSIVE = "INCONCLUSIVE"
    MEASURED = "MEASURED"


@dataclass(frozen=True)
class Part:
    """A contribution to the interval of an estimate      [gum]"""

    what: str  # a noun: "the scatter of 27 revolutions"
    half: float  # of the 95 % interval by this contribution alone, in the estimate's unit
    remedy: str  # what makes it smaller


@dataclass(frozen=True)
class Estimate:
    """A figure shown to a person: value, unit, uncertainty and how both were found      [gum]"""

    name: str  # machine name, e.g. "kinematic_error_peak_to_peak"
    label: str  # for people, e.g. "Kinematic error, peak to peak"
    value: float
    unit: str  # as shown: arcsec, rpm, N·m …
    ci95: tuple[float, float]  # 95 % interval, same unit; NaN where the run could not show one
    how: str  # one sentence: from what, over how many, by which estimator
    parts: tuple[Part, ...] = ()  # of the interval, where they are known one by one
    counts: bool = True  # False: of a rejected run, shown and not to be used
    over: tuple[float, float] | None = None  # N·m, of a part of the torques alone: from and to


@dataclass(frozen=True)
class Check:
    """A condition the run had to meet for its figures to mean what they say."""

    name: str
    passed: bool
    sentence: str  # with the number, its unit and the limit


@dataclass(frozen=True)
class Former:
    """A verdict that the same run had before it was judged again."""

    verdict: str
    limits: Mapping[str, str]  # as in Result; empty where there was none


@dataclass(frozen=True)
class Result:
    """All that one analysis of one run found.

    `curves` holds the arrays the figures are drawn from, by dotted name ("ke.theta_deg", "mse.k" …); the unit is in
    the name or in the drawing function. `cannot` says what this run cannot tell, and why, one sentence each. `limits`
    is what the verdict is by: name of the figure to words ("Stiffness at least 7000 N·m/rad"). `former` are the
    verdicts the run had by other limits, oldest first. `rejected`: the run must not be believed; its estimates say
    which of them count all the same.
    """

    procedure: str
    verdict: Verdict
    sentence: str
    estimates: tuple[Estimate, ...]
    checks: tuple[Check, ...] = ()
    cannot: tuple[str, ...] = ()
    tables: dict[str, list[dict[str, float | str]]] = field(default_factory=dict)
    curves: dict[str, Array] = field(default_factory=dict)
    limits: Mapping[str, str] = field(default_factory=dict)
    asked: Mapping[str, Any] = field(default_factory=dict)  # limits as they were set, for the next analysis
    former: tuple[Former, ...] = ()
    rejected: bool = False
    broke_off: str = ""  # the traceback of an analysis that broke off, "" of one that came to its end
    defect: bool = False  # it broke off on an error of ours, not on what the run holds
