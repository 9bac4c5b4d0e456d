"""Hardware in the loop: `hdrig twin` in one process, the drivers of real devices in another, real time, every byte.

A shared machine stalls for tens of ms: a run the guard ends for that alone is made again, a few times. Counts and
figures are looked at, never wall-clock times.
"""

from __future__ import annotations

import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from rig.bench import BENCHES

pytestmark = [
    pytest.mark.slow,
    pytest.mark.long,
    pytest.mark.xdist_group("real time"),
]  # one at a time: they share two processors
HDRIG = [sys.executable, "-m", "rig.cli"]
SHOWN = "[!.]*"  # hdrig tries a folder by one that is hidden and gone again, maybe while it is listed here
STALLED = re.compile(
    r"no new .* sample for|did not answer|does not answer|sent no PDOs|did not become|watchdog|heartbeat"
)
SAME_SYNC = ("twin-can", "twin-canopen", "twin-slcan", "twin-socketcand")  # drive and encoder latch at one SYNC
TRUE_C2 = 39.6  # arcsec, C_2 of the twin's pure kinematic error (0.01100°)
SHORT = ["--with", "amplitude_deg=720", "--with", "frequency=0.04", "--with", "cycles=0.5"]  # 19.2 rpm, 13 s


@dataclass
class Twin:
    """A running twin and the folder of its doors."""

    doors: Path
    process: subprocess.Popen[str]

    def bench(self, name: str) -> Path:
        """A bench that ships, led to this twin's doors."""
        text = (BENCHES / f"{name}.toml").read_text(encoding="utf-8")
        path = self.doors / f"{name}.toml"
        port = (self.doors / "port").read_text()
        path.write_text(text.replace("/tmp/hdrig-twin", str(self.doors)).replace("29536", port), encoding="utf-8")
        return path

    def ask(self, **verb: object) -> dict[str, object]:
        """The command channel."""
        with socket.socket(socket.AF_UNIX) as line:
            line.connect(str(self.doors / "control"))
            line.sendall(json.dumps(verb).encode() + b"\n")
            answer: dict[str, object] = json.loads(line.makefile().readline())
        return answer


@pytest.fixture(scope="module")
def twin(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Twin]:
    doors = Path("/tmp") / f"hdrig-test-{os.getpid()}"  # a socket's path may have 107 characters at most
    doors.mkdir()
    options = ["--bus", "can", "--control", "control", "--serial", "serial", "--slcan", "slcan", "--odrive", "odrive"]
    process = subprocess.Popen(
        [*HDRIG, "twin", *options, "--socketcand", "0", "--for", "3600"], cwd=doors, stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    lines = []
    for line in process.stdout:
        lines.append(line)
        if line == "ready\n":
            break
    port = re.search(r"port=(\d+)", "".join(lines))
    assert port, lines
    (doors / "port").write_text(port[1])
    yield Twin(doors, process)
    process.terminate()
    process.wait(10)
    process.stdout.close()
    for left in sorted(doors.rglob("*"), reverse=True):
        left.rmdir() if left.is_dir() and not left.is_symlink() else left.unlink()
    doors.rmdir()


def run(twin: Twin, bench: str, procedure: str, out: Path, *options: str) -> subprocess.CompletedProcess[str]:
    """One `hdrig run`, made again when the machine was away."""
    command = [*HDRIG, "run", procedure, "--bench", str(twin.bench(bench)), "--out", str(out), *options]
    for _ in range(4):
        done = subprocess.run(command, capture_output=True, text=True, timeout=240, check=False)
        if not STALLED.search(done.stderr + done.stdout):
            break
    return done


def figures_of(out: Path, procedure: str) -> dict[str, tuple[float, float]]:
    """(value, half width of its interval) of the newest run's figures."""
    folders = sorted(out.glob(f"*/*{procedure}*"), key=lambda p: p.stat().st_mtime)
    result = json.loads((folders[-1] / "result.json").read_text())
    return {f["key"]: (f["value"], f.get("half_width") or 0.0) for f in result["figures"]}


@pytest.mark.parametrize("bench", ["twin-can", "twin-canopen", "twin-slcan", "twin-socketcand", "twin-odrive"])
def test_the_kinematic_error_found_over_the_wire_is_that_of_the_plant(twin: Twin, bench: str, tmp_path: Path) -> None:
    done = run(twin, bench, "kinematic-error", tmp_path, *SHORT)
    assert "completed" in done.stderr, done.stderr
    folder = sorted(tmp_path.glob("*/*kinematic-error*"))[-1]
    manifest = json.loads((folder / "manifest.json").read_text())
    assert (manifest["backend"], manifest["transport"]) == ("sim", "can")
    assert "SIMULATED" in done.stdout
    told = re.search(r"amplitude of order 2\s+([\d.]+)", done.stdout)
    assert told, done.stdout
    assert float(told[1]) == pytest.approx(TRUE_C2, abs=0.8)
    timing = json.loads((folder / "timing.json").read_text())
    if bench in SAME_SYNC:  # else every reading is a period old, and the loop is slow by that
        assert abs(timing["latch_offsets"]["theta_l"]["mean"]) < timing["period"] / 4


PLAN = """
schema = "hdrig.plan/1"
name = "by-hand"
[[step]]
procedure = "constant-torque"
with = { speed_rpm = 120, revolutions = 8 }
weight = 3.0
[[step]]
procedure = "lock-check"
"""


def test_a_campaign_has_its_weight_hung_and_its_pin_fitted_by_the_hand_of_the_twin(twin: Twin, tmp_path: Path) -> None:
    plan = tmp_path / "plan.toml"
    plan.write_text(PLAN, encoding="utf-8")
    patient = [
        "--set",
        "limits.stale_s=0.6",
        "--set",
        "devices.drive.watchdog=0.7",
    ]  # a busy machine is not the subject
    command = [*HDRIG, "campaign", str(plan), "--bench", str(twin.bench("twin-canopen")), "--out", str(tmp_path)]
    done = subprocess.run([*command, *patient], capture_output=True, text=True, timeout=400, check=False)
    assert "completed: 2 done" in done.stdout, done.stderr
    for change in ("hang 3 N·m on the output", "take the weight off", "fit the lock pin", "remove the lock pin"):
        assert f"by hand: {change}" in done.stdout
    weighed = re.search(r"pulling forward: ([+\d.]+) N·m on the output", done.stdout)
    assert weighed
    assert float(weighed[1]) == pytest.approx(3.0, abs=0.1)


def test_latch_skew_over_a_bus_and_a_serial_line_is_told_with_its_interval(twin: Twin, tmp_path: Path) -> None:
    patient = ["--set", "limits.stale_s=0.6", "--set", "devices.drive.watchdog=0.7"]
    done = run(twin, "twin-can", "skew", tmp_path, "--with", "speeds_rpm=60,240", *patient)
    told = re.search(
        r"latched ([−\d.]+) ± ([\d.]+) µs after its motor angle, the shaft torque ([−\d.]+) ±", done.stdout
    )
    assert told, done.stdout + done.stderr
    late, half, torque = (float(x.replace("−", "-")) for x in told.groups())
    assert abs(late - 2.0) < half + 10.0  # µs: both latch at one SYNC, the twin's encoder 2 µs later
    assert half < 60.0
    assert -12_000.0 < torque < -500.0  # lines come a hundred times a second, and are held until the next
    assert "[load_encoder]" in done.stdout


def test_two_programs_at_one_bench_are_refused_by_name_and_the_first_runs_on(twin: Twin, tmp_path: Path) -> None:
    bench = str(twin.bench("twin-can"))
    patient = ["--set", "limits.stale_s=0.6", "--set", "devices.drive.watchdog=0.7"]
    longer = ["--with", "amplitude_deg=720", "--with", "frequency=0.04", "--with", "cycles=1.5"]  # 38 s: others start
    command = [*HDRIG, "run", "kinematic-error", "--bench", bench, "--out", str(tmp_path), *longer, *patient]
    first = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    until = time.monotonic() + 60
    while not list(tmp_path.glob(f"{SHOWN}/*kinematic-error*/journal*")) and time.monotonic() < until:
        time.sleep(0.1)
    at_it = ["--bench", bench]
    verbs = (
        ["run", "standstill", "--out", str(tmp_path), *at_it],
        ["reset", *at_it],
        ["devices", "--interface", "hdrig-unix", "--channel", str(twin.doors / "can")],
    )
    others = [
        subprocess.Popen([*HDRIG, *verb], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) for verb in verbs
    ]
    for other in others:
        _, told = other.communicate(timeout=60)
        assert other.returncode == 3, told
        assert "could not be opened: " in told
        assert "is in use by process " in told
    _, errors = first.communicate(timeout=240)
    assert "completed" in errors, errors


def test_a_program_that_is_killed_leaves_a_drive_without_torque_and_a_run_to_recover(
    twin: Twin, tmp_path: Path
) -> None:
    command = [*HDRIG, "run", "kinematic-error", "--bench", str(twin.bench("twin-canopen")), "--out", str(tmp_path)]
    hdrig = subprocess.Popen([*command, *SHORT], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    running = "OPERATION_ENABLED"
    until = time.monotonic() + 60
    while not list(tmp_path.glob(f"{SHOWN}/*kinematic-error*/journal*")) and time.monotonic() < until:
        time.sleep(0.1)
    while twin.ask(do="status")["drive"] != running and time.monotonic() < until:
        time.sleep(0.05)
    time.sleep(1.0)
    hdrig.send_signal(signal.SIGKILL)
    hdrig.wait()
    while twin.ask(do="status")["drive"] == running and time.monotonic() < until:
        time.sleep(0.05)
    assert twin.ask(do="status")["drive"] in ("FAULT", "SWITCH_ON_DISABLED")
    assert abs(float(str(twin.ask(do="truth")["tau_m"]))) < 1e-3
    folder = sorted(tmp_path.glob("*/*kinematic-error*"))[-1]
    time.sleep(1.0)  # its recorder lives on for a moment and writes what is in the ring
    subprocess.run([*HDRIG, "recover", str(folder)], check=True, capture_output=True)
    assert json.loads((folder / "manifest.json").read_text())["status"] == "interrupted"
