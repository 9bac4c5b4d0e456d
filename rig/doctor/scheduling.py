"""What the operating system grants the loop."""

from __future__ import annotations

from rig.bench import Bench
from rig.doctor.finding import Finding, Health
from rig.process.realtime import RealTime

HELP = "allow it with `ulimit -r 99 -l unlimited`, /etc/security/limits.conf, or the capability CAP_SYS_NICE"


def check_scheduling(bench: Bench) -> list[Finding]:
    """Real-time priority and locked memory, asked for and given back."""
    with RealTime() as real_time:
        granted = real_time.granted
    refused = [word for word in ("refused", "not locked") if word in granted]
    if refused:
        return [Finding("scheduling", Health.DOUBTFUL, f"{granted}; {HELP}")]
    return [Finding("scheduling", Health.GOOD, granted)]
