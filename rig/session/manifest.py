"""What the manifest of a run says before its first row."""

from __future__ import annotations

import platform
from typing import TYPE_CHECKING, Any

from rig.core.devices import Drive
from rig.core.procedure import Procedure
from rig.core.sample import Mode
from rig.process.software import operator, software

if TYPE_CHECKING:
    from rig.session.session import Session


def _watchdog(drive: Drive) -> dict[str, Any] | None:
    """What stops the drive when this program dies; None where it dies with it."""
    return None if drive.watchdog is None else drive.watchdog._asdict()


def manifest_of(session: Session, procedure: Procedure, mode: Mode) -> dict[str, Any]:
    """Bench, devices, conditions, proof, software and people, as they are now."""
    manifest = session.bench.manifest()
    conditions = {**procedure.conditions(), **session.rigging.conditions()}
    if session.note:
        conditions["note"] = session.note
    return {
        **manifest,
        # the twin over a real wire is a simulation all the same
        "backend": "sim" if session.simulated else manifest["backend"],
        "transport": manifest["backend"],
        **session.facts,
        "conditions": conditions,
        "label": procedure.label or None,
        "devices": {name: identity._asdict() for name, identity in session.identities.items()},
        "watchdog": _watchdog(session.instruments.drive),
        "proof": session.proof._asdict() if session.proof else None,
        "loop": {"rate": session.bench.file.loop.rate, "clock": session.clock, "mode": str(mode)},
        "software": software(),
        "host": platform.node(),
        "operator": operator(),
    }
