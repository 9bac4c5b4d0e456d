"""All runs of one gear to the parameters of equations 6-8, what was measured beside them, and its gear file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rig.core.errors import DataError, Exit
from rig.core.units import RPM
from rig.evaluation.to_identify import Say, open_runs

if TYPE_CHECKING:
    from rig.analysis.findings.result import Result
    from rig.analysis.friction.coasting import Coasting
    from rig.analysis.identify.identified import Identified
    from rig.analysis.identify.predictions import Prediction
    from rig.analysis.identify.recording import Recording
    from rig.model.gearfile import Covered, GearFile, Parameter
    from rig.runfile.run import Run


@dataclass(frozen=True)
class Identification:
    """What the runs of one gear say of it."""

    found: Identified
    file: GearFile  # as `found`, with what lock tests, friction runs and coast-downs say beside the model
    predictions: Sequence[Prediction]  # θ̃ at speed as recorded and as the gear file gives it
    coasts: Sequence[Coasting]
    used: int  # runs the fit could read
    of: int  # runs there were, completed or not
    simulated: bool
    said: tuple[str, ...] = ()  # of runs that were left out, and of what their manifests cannot mean
    misfit: str = ""  # of θ̃ at speed, where it is not as predicted

    @property
    def exit(self) -> Exit:
        """INCOMPLETE where a parameter is left open, two sensors contradict each other, or the model does not fit."""
        doubtful = self.found.undetermined or self.found.doubtful or self.misfit
        return Exit.INCOMPLETE if doubtful else Exit.PASS

    def lines(self) -> list[str]:
        """All of it for people."""
        from rig.analysis.identify.undetermined import said_open
        from rig.report.text import gear as text

        found = self.found
        lines = text.report(found, self.simulated, self.used, self.of)
        if found.undetermined:
            lines.append(f"  {said_open(found.undetermined, found.parameters)}")
        return [
            *lines,
            *text.comparison(self.predictions),
            *([f"  {self.misfit}"] if self.misfit else []),
            *text.coasting(self.coasts),
            *text.characteristic_lines(self.file.characteristics),
            *text.breakaway_beside(self.file),
            *(f"  note: {sentence}" for sentence in (*self.said, *found.cannot)),
        ]


def identify(folders: Sequence[Path], terms: int, say: Say) -> Identification:
    """The gear of the runs in `folders`, its θ̃_p with `terms` orders. Raises UsageError: two gears; DataError: no run,
    or nothing that can be determined."""
    from rig.analysis.identify.predictions import misfit, predictions

    runs, recordings, said = open_runs(folders, say)
    found, file = _fitted(runs, recordings, terms, say)
    compared = predictions(recordings, file, terms)
    doubt = misfit(compared)
    characteristics = beside(runs, say)
    if not characteristics:
        refuse_nothing(found, recordings)
    return Identification(
        found=found,
        file=replace(
            file,
            characteristics=characteristics,
            covered=covered(found),
            cannot=(*([doubt] if doubt else []), *said, *file.cannot),
        ),
        predictions=compared,
        coasts=coasts(runs, found, say),
        used=len(recordings),
        of=len(folders),
        simulated=file.simulated,
        said=said,
        misfit=doubt,
    )


def gear_of(folders: Sequence[Path], terms: int, say: Say) -> GearFile:
    """The gear file alone, without what is measured beside the model. Raises DataError as `identify`."""
    runs, recordings, _ = open_runs(folders, say)
    found, file = _fitted(runs, recordings, terms, say)
    refuse_nothing(found, recordings)
    return file


def _fitted(runs: list[Run], recordings: list[Recording], terms: int, say: Say) -> tuple[Identified, GearFile]:
    from rig.analysis.identify.fit import fit
    from rig.analysis.identify.identified import identified

    found = identified(fit(recordings, terms, say), runs[0].manifest)
    gear = runs[0].manifest.get("gear") or {}
    simulated = any(r.simulated for r in runs)
    lacking = [name for name in ("tau_m", "tau_l") if all(getattr(r, name) is None for r in recordings)]
    return found, found.gear_file(str(gear.get("serial") or ""), simulated, made_with(runs), lacking)


def refuse_nothing(found: Identified, recordings: list[Recording]) -> None:
    """Raises DataError where not one number is measured: a gear file of what was declared says nothing new."""
    if any(p.origin == "measured" for p in found.parameters.values()) or found.series.origin == "measured":
        return
    kinds = ", ".join(sorted({r.source.procedure.replace("_", "-") for r in recordings}))
    raise DataError(
        f"nothing of the gear can be determined from what is here ({kinds}): it takes runs in which the motor turns "
        "at constant speed, or a lock test beside a slow run"
    )


def coasts(runs: list[Run], found: Identified, say: Say) -> list[Coasting]:
    """What coast-downs among `runs` say of the inertia at the motor, which no fit here has used."""
    from rig.analysis import analyse
    from rig.analysis.friction.coasting import coastings

    told = [r for r in runs if r.procedure == "coast_down"]
    return [one for r in told for one in coastings(r.name, seen(r, analyse(r), say), found.parameters)]


def beside(runs: list[Run], say: Say) -> dict[str, Parameter]:
    """What lock tests and friction runs say that the model has no parameter for, each analysed as by itself."""
    from rig.analysis import analyse
    from rig.analysis.friction.characteristics import characteristics
    from rig.evaluation.reference import reference_of_one_zero

    told = [r for r in runs if r.procedure in ("stiffness_lock", "friction")]
    if told:
        say("lock tests and breakaway")
    return characteristics([(r.name, seen(r, analyse(r, reference_of_one_zero(r)), say)) for r in told])


def seen(run: Run, result: Result, say: Say) -> Result:
    """`result`, after a word where its analysis broke off."""
    if result.broke_off:
        say(f"{run.name}: {result.sentence} hdrig analyse {run.name} keeps where it did.")
    return result


def covered(found: Identified) -> Covered | None:
    """Speeds and loads of the stretches of constant speed the numbers come from; None without any."""
    from rig.model.gearfile import Covered

    speeds = [abs(m.omega) / RPM for m in found.fits.means]
    loads = [m.tau_ext for m in found.fits.means]
    return Covered((min(speeds), max(speeds)), (min(loads), max(loads))) if speeds else None


def made_with(runs: list[Run]) -> str:
    """When and with what."""
    from rig.process.software import software

    said = software()
    return f"hdrig {said.get('version')} {said.get('commit') or ''}, {_dated([r.manifest for r in runs])}"


def _dated(manifests: Sequence[Mapping[str, Any]]) -> str:
    """The first and the last day of runs that have one, and how many have none."""
    days = sorted(started[:10] for m in manifests if (started := str(m.get("started_utc") or "")))
    bare = len(manifests) - len(days)
    undated = f"{bare} undated run{'' if bare == 1 else 's'}" if bare else ""
    return ", ".join(filter(None, [f"runs of {days[0]} to {days[-1]}" if days else "", undated]))
