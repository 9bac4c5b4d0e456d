"""The page on wiring: its examples are bench files that can be read, its keys are those there are."""

from __future__ import annotations

import re

import pytest

from rig.bench import BENCHES, ROLES, device_class
from rig.config.bench_file import BenchFile, read_bench
from rig.config.sections import (
    BusSection,
    ConsoleSection,
    ControlSection,
    DeviceSection,
    LimitsSection,
    LoopSection,
)

PAGE = (BENCHES / "WIRING.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"```toml\n(.*?)```", PAGE, re.S)
SECTIONS = (BusSection, DeviceSection, LoopSection, LimitsSection, ControlSection, ConsoleSection)


@pytest.mark.parametrize(
    ("number", "kinds"),
    [
        (0, ["can.cia402", "can.cia406", "can.cia404"]),
        (1, ["can.odrive", "serial.qsb", "serial.ascii_torque"]),
    ],
)
def test_each_example_is_a_whole_bench_file_with_the_devices_it_is_about(number: int, kinds: list[str]) -> None:
    bench: BenchFile = read_bench(EXAMPLES[number], "WIRING.md")
    assert [getattr(bench.devices, role).type for role in ROLES] == kinds
    assert all(
        issubclass(device_class(kind, "WIRING.md"), ROLES[role]) for kind, role in zip(kinds, ROLES, strict=True)
    )


def test_every_key_of_bus_devices_loop_limits_control_and_console_is_explained() -> None:
    told = set(re.findall(r"`(\w+)`", PAGE)) | set(re.findall(r"\] (\w+)`", PAGE))
    keys = {k for s in SECTIONS for k in s.model_fields}
    assert keys <= told, keys - told
