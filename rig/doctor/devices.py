"""Whether the bench's devices answer, and who they say they are. Nothing is energised."""

from __future__ import annotations

from collections.abc import Mapping

from rig.bench import Bench
from rig.core.devices import UNGUARDED, Identity, Watchdog
from rig.core.errors import HdrigError
from rig.doctor.finding import Finding, Health


def check_devices(bench: Bench) -> list[Finding]:
    """Connect, identify, let go."""
    instruments = bench.open("virtual" if bench.simulated else "wall")
    try:
        identities = instruments.connect()
    except HdrigError as why:
        return [Finding("devices", Health.BAD, "; ".join(filter(None, (str(why), bench.twin_not_there))))]
    try:
        found = identified(identities)
        found += [Finding(one.name, Health.DOUBTFUL, told) for one in instruments.devices for told in one.remarks]
        if instruments.drive.watchdog is not None:
            found.append(_watchdog(instruments.drive.watchdog))
        return found
    finally:
        instruments.close()


def identified(identities: Mapping[str, Identity]) -> list[Finding]:
    """Who the devices of one bench say they are. Where one says that it is the twin's all count as simulated, as they
    do in a run: lines of text from a torque sensor cannot say it."""
    twins = [name for name, who in identities.items() if who.simulated]
    told = f"; it cannot say so itself, {' and '.join(twins)} of this bench say{'s' if len(twins) == 1 else ''} so"
    return [
        Finding(
            name,
            Health.GOOD,
            " ".join(filter(None, (who.model, who.serial, who.firmware)))
            + (told if twins and name not in twins else ""),
            bool(twins),
        )
        for name, who in identities.items()
    ]


def _watchdog(watchdog: Watchdog) -> Finding:
    health = Health.GOOD if watchdog.is_proven else Health.DOUBTFUL
    return Finding("drive's watchdog", health, watchdog.words or UNGUARDED)
