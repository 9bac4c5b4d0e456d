"""Whether the processor may fall asleep between ticks."""

from __future__ import annotations

from pathlib import Path

from rig.bench import Bench
from rig.doctor.finding import Finding, Health

CPUS = Path("/sys/devices/system/cpu")
WANTED = "performance"


def check_governor(bench: Bench) -> list[Finding]:
    """Frequency governors of all processors, where the system shows them."""
    return [judge({path.read_text().strip() for path in CPUS.glob("cpu*/cpufreq/scaling_governor")})]


def judge(governors: set[str]) -> Finding:
    """From the set of governors in use."""
    if not governors:
        return Finding(
            "processor", Health.GOOD, "no frequency governor is shown (a virtual machine, or fixed frequency)"
        )
    if governors == {WANTED}:
        return Finding("processor", Health.GOOD, f"governor '{WANTED}'")
    named = ", ".join(sorted(governors))
    return Finding(
        "processor",
        Health.DOUBTFUL,
        f"governor '{named}' changes the clock between ticks; expected '{WANTED}' "
        f"(`cpupower frequency-set -g {WANTED}`)",
    )
