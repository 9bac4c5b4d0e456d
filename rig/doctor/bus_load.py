"""Whether the frames of one tick fit on the wire: a simulated bus carries ten times what a real one does."""

from __future__ import annotations

from rig.bench import Bench
from rig.doctor.finding import Finding, Health

MOST = 0.7  # of the bus: beyond it one error frame makes a cycle late
SYNC = 0  # bytes


def check_bus_load(bench: Bench) -> list[Finding]:
    """Every bus that devices of the bench are on, by the PDOs their drivers map."""
    traffic = bench.traffic()
    out = []
    for name, frames in traffic.items():
        bitrate = bench.file.bus[name].bitrate
        if bitrate is None:
            out.append(Finding(f"bus '{name}'", Health.DOUBTFUL, "no bitrate in the bench file: its load is unknown"))
        else:
            lead = bench.file.loop.latch_lead
            out.append(judge(name, [SYNC, *frames[0]], frames[1], bitrate, bench.file.loop.rate, lead))
    return out


def judge(name: str, up: list[int], down: list[int], bitrate: float, rate: float, lead: float) -> Finding:
    """`up`: data bytes of SYNC and the frames that answer it, `down`: of the commands; one of each a tick."""
    answered = sum(bits(n) for n in up) / bitrate
    load = (answered + sum(bits(n) for n in down) / bitrate) * rate
    told = (
        f"{len(up) + len(down)} frames a tick at {rate:g} Hz load {bitrate / 1e3:g} kbit/s by {100 * load:.0f} % "
        f"at worst; readings are in {answered * 1e6:.0f} µs after SYNC"
    )
    fits = int(MOST / load * rate)
    if load > 1.0:
        return Finding(f"bus '{name}'", Health.BAD, f"{told}: it does not fit; {fits} Hz would")
    if lead and answered > lead:
        return Finding(f"bus '{name}'", Health.BAD, f"{told}, loop.latch_lead leaves only {lead * 1e6:.0f} µs")
    if load > MOST:
        return Finding(f"bus '{name}'", Health.DOUBTFUL, f"{told}; expected {100 * MOST:.0f} % at most ({fits} Hz)")
    return Finding(f"bus '{name}'", Health.GOOD, told)


def bits(count: int) -> int:
    """Most bits of a classical frame: 11-bit identifier, `count` data bytes, stuffing, intermission      [cia301]"""
    return 47 + 8 * count + (34 + 8 * count - 1) // 4
