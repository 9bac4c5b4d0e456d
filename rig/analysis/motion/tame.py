"""A run whose manifest and columns may hold anything, made fit to calculate with: what is absurd counts as missing."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.motion.at_the_end import MOST, at_ends, ends
from rig.analysis.motion.lone import lone
from rig.analysis.motion.source import Source, increases
from rig.core.channels import CHANNEL
from rig.core.numbers import number
from rig.core.rows import room, stretches
from rig.core.units import ARCSEC, DEG, TURN
from rig.runfile.misfits import notes, usable

LARGEST = 2.0**53  # of any value: above, float64 skips whole counts
FARTHEST = 1e9  # rad: above, float64 resolves less than 0.02 arcsec
READ = ("theta_m", "theta_l", "tau_m", "tau_l")  # what a sensor reads, and may read wrong once
TORQUES = ("tau_m", "tau_l")
TURNED = 0.05  # rad of the motor: it needed a torque for that, a lock test of 10 N·m turns as far
COASTS = "coast_down"  # the procedure in which a motor turns without torque
TABLES = ("gear", "encoders", "conditions", "declared", "limits", "files")


class Tame:
    """`run` with the face of a Source; `notes` says what was left out."""

    def __init__(self, run: Source) -> None:
        self._run = run
        self.notes: list[str] = []
        self._columns: dict[str, Array | None] = {}
        self._manifest = self._tables(run)
        self.name, self.ratio, self.procedure = run.name, float(run.ratio), run.procedure

    @property
    def manifest(self) -> Mapping[str, Any]:
        return self._manifest

    @property
    def misfits(self) -> Sequence[str]:
        return self._run.misfits

    @property
    def conditions(self) -> Mapping[str, Any]:
        return dict(self._manifest.get("conditions") or {})

    @property
    def declared(self) -> Mapping[str, Any]:
        return dict(self._manifest.get("declared") or {})

    def has(self, name: str) -> bool:
        return self.column(name) is not None

    def column(self, name: str) -> Array | None:
        """The column with NaN for what is infinite or absurd; None when nothing of it can be used."""
        if name not in self._columns:
            self._columns[name] = self._column(name)
        return self._columns[name]

    def _column(self, name: str) -> Array | None:
        try:
            found = self._run.column(name)
            values = None if found is None else np.asarray(found, dtype=np.float64)
        except (ValueError, TypeError, LookupError, NotImplementedError) as why:
            self.notes.append(f"The column {name} could not be read ({why}); it was not used.")
            return None
        if values is None:
            return None
        as_read, most = values, FARTHEST if name.startswith("theta") else LARGEST
        absurd = [some.start + np.flatnonzero(np.abs(values[some]) > most) for some in stretches(values.size)]
        rows = np.concatenate(absurd) if absurd else np.empty(0, np.int64)  # infinite too; NaN compares false
        if rows.size:
            self.notes.append(_absurd(name, values, rows, most))
            values = values.copy()
            values[rows] = np.nan
        if name in READ:
            values = self._without_lone(name, values)
        if name == "tau_l":
            values = self._within_range(name, values)
        if name in TORQUES and self._reads_nothing(name, values):
            self.notes.append(
                f"{name} is exactly 0 in all {values.size} rows: nobody measured it, so it counts as absent."
            )
            return None
        if _any(values) or not values.size:
            return values
        if not rows.size and not _any(as_read):
            self.notes.append(f"{name} has no value in any of its {values.size} rows: it counts as absent.")
        return None

    def _reads_nothing(self, name: str, values: Array) -> bool:
        """Whether a torque is zero in every row, as of a sensor that is not there: one that is has noise, and a motor
        that turns meets friction, but for one that runs down or rests without a torque."""
        if not values.size or any(np.any(values[some]) for some in stretches(values.size)):
            return False
        if name == "tau_l":
            return True
        theta_m = None if self.procedure == COASTS else self.column("theta_m")
        return theta_m is not None and float(np.nanmax(theta_m) - np.nanmin(theta_m)) > TURNED

    def _within_range(self, name: str, values: Array) -> Array:
        """Readings at the end of a sensor's range are missing, and said; all, where they are many."""
        found = ends(values, self.column("theta_m"))
        if not found:
            return values
        count = sum(end.count for end in found)
        where = " and ".join(f"{end.value:.4g}" for end in found)
        whole = count > MOST * values.size
        self.notes.append(
            f"{name} ends at {where} {CHANNEL[name].unit}, in {count} of {values.size} rows, while the motor goes on: "
            f"the end of a range, {'so it was not used' if whole else 'taken as missing'}."
        )
        out = room(values.size)
        out[:] = values
        out[slice(None) if whole else at_ends(values, found)] = np.nan
        return out

    def _without_lone(self, name: str, values: Array) -> Array:
        """Single readings far off their neighbours are missing, and said."""
        t = self.column("t")
        t = t if t is not None and increases(t) else None
        rows, off = lone(values, t, TURN if name.startswith("theta") else np.inf)
        if not rows.size:
            return values
        worst = int(np.argmax(np.abs(off)))
        at = f"row {rows[worst]}" if t is None else f"t = {t[rows[worst]]:.3f} s"
        one = rows.size == 1
        self.notes.append(
            f"{rows.size} reading{'' if one else 's'} of {name} stand{'s' if one else ''} alone, "
            f"{'' if one else 'the farthest '}{_size(name, abs(off[worst]))} off its neighbours at {at}: "
            "taken as missing."
        )
        out = room(values.size)
        out[:] = values
        out[rows] = np.nan
        return out

    def _tables(self, run: Source) -> dict[str, Any]:
        self.notes += notes(run.misfits)
        out = usable(run.manifest)
        for key in TABLES:
            if not isinstance(out.get(key), Mapping):
                if out.get(key) is not None:
                    self.notes.append(f"The manifest's {key} is not a table; it was not used.")
                out[key] = {}
        out["encoders"] = {k: v for k, v in out["encoders"].items() if 0 < number(v) < LARGEST}
        out["limits"] = {k: v if v is None or self._is_limit(k, v) else {} for k, v in out["limits"].items()}
        return out

    def _is_limit(self, name: Any, limit: Any) -> bool:
        if isinstance(limit, Mapping):
            bounds = [limit[k] for k in ("lower", "upper") if limit.get(k) is not None]
            good = bool(bounds) and all(np.isfinite(number(b)) for b in bounds) and bounds == sorted(bounds)
        else:
            good = bool(np.isfinite(number(limit)))
        if not good:
            self.notes.append(f"The limit of {name} is not a number, or its bounds are the wrong way round.")
        return good


def _size(name: str, off: float) -> str:
    """How far a reading is off, for people: small angles in arcsec, as everything that is made of them."""
    unit = CHANNEL[name].unit
    return f"{off / ARCSEC:.4g} arcsec" if unit == "rad" and off < DEG else f"{off:.3g} {unit}"


def _any(values: Array) -> bool:
    """Whether there is a number among them."""
    return any(np.isfinite(values[some]).any() for some in stretches(values.size))


def _absurd(name: str, values: Array, rows: np.ndarray[Any, np.dtype[np.int64]], most: float) -> str:
    """That what stands in those rows of a column is no value, and which of the two it is: infinite, or too large."""
    infinite = int(np.count_nonzero(np.isinf(values[rows])))
    kind = "infinite" if infinite == rows.size else "infinite or absurdly large" if infinite else "absurdly large"
    first = int(rows[0])
    words = f"{rows.size} values of {name} are" if rows.size > 1 else f"One value of {name} is"
    return f"{words} {kind}: taken as missing ({values[first]:.3g} in row {first}; expected up to {most:.0e})."
