"""Numbers of a CiA 402 drive that mean something else than the bench file says: refused with both, or remarked on."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rig.core.errors import NotReady
from tests.drivers.virtual import wired


@pytest.mark.parametrize(
    ("index", "sub", "value", "told"),
    [
        (
            0x6076,
            0,
            3_000_000,
            r"is 3000 N·m \(6076h\).* is 3 N·m: .* of 1000; where its manual .*: devices\.drive\.rated_step = 1e-6$",
        ),
        (0x6076, 0, 2100, r"factor of 0.7$"),
        (0x608F, 1, 4096, r"counts 4096 per turn \(608Fh\).*is 10000"),
        (0x6091, 1, 50, r"has a gear of 50:1 of its own"),
        (0x60A8, 0, 0x00410000, r"60A8h = 00410000h\), expected increments"),
        (0x6075, 0, 8485, r"0\.3536 N·m of an ampere .* is 0\.5 N·m/A: off by a factor of 0\.707.* peak and effective"),
    ],
)
def test_a_scale_that_is_another_is_refused_with_both_numbers(index: int, sub: int, value: int, told: str) -> None:
    w = wired()
    w.instruments.drive.place.options["torque_constant"] = 0.5  # N·m/A
    w.twin.drive.objects.find(index, sub).value = value
    with pytest.raises(NotReady, match=told):
        w.instruments.connect()


def test_a_rated_torque_that_the_file_gives_in_millinewton_metres_is_told_so() -> None:
    w = wired()
    place = w.instruments.drive.place
    w.instruments.drive.place = replace(place, torque_rated=1e3 * place.torque_rated)
    with pytest.raises(NotReady, match=r"the file's number is in N·m: 3000 mN·m would be torque_rated = 3$"):
        w.instruments.connect()


def test_a_rated_torque_in_another_unit_is_taken_by_the_unit_the_bench_file_gives_it() -> None:
    w = wired()
    w.instruments.drive.place.options.update(torque_constant=0.5, rated_step=1e-6)
    w.twin.drive.objects.find(0x6076, 0).value = 3_000_000  # µN·m
    w.instruments.connect()
    assert w.instruments.drive.remarks == []


def test_a_drive_nobody_has_commissioned_is_remarked_on() -> None:
    w = wired()
    w.twin.drive.objects.find(0x6075, 0).value = 3000  # 3 A beside 3 N·m
    w.instruments.connect()
    assert any("has anybody entered the motor's data?" in remark for remark in w.instruments.drive.remarks)


def test_numbers_that_agree_are_not_remarked_on() -> None:
    w = wired()
    w.instruments.connect()
    assert w.instruments.drive.remarks == []
