"""The SDO server, byte for byte after CiA 301. Node 1 is the drive."""

from __future__ import annotations

import pytest

from tests.wire.host import Host, host


@pytest.fixture
def drive() -> Host:
    return host()


def test_an_expedited_upload(drive: Host) -> None:
    assert drive.asks(1, "40 00 10 00 00 00 00 00") == "43 00 10 00 92 01 02 00"  # device type: a servo after 402
    assert drive.asks(1, "40 60 60 00 00 00 00 00") == "4f 60 60 00 00 00 00 00"  # one byte
    assert drive.asks(1, "40 6b 60 00 00 00 00 00") == "80 6b 60 00 00 00 02 06"  # no 606Bh here


def test_an_expedited_download_and_what_it_left(drive: Host) -> None:
    assert drive.asks(1, "2b 17 10 00 e8 03 00 00") == "60 17 10 00 00 00 00 00"
    assert drive.asks(1, "40 17 10 00 00 00 00 00") == "4b 17 10 00 e8 03 00 00"
    assert drive.asks(1, "22 17 10 00 d0 07 00 00") == "60 17 10 00 00 00 00 00"  # size not said
    assert drive.asks(1, "40 17 10 00 00 00 00 00") == "4b 17 10 00 d0 07 00 00"


def test_a_segmented_upload_of_the_name(drive: Host) -> None:
    assert drive.asks(1, "40 08 10 00 00 00 00 00") == "41 08 10 00 16 00 00 00"  # 22 bytes
    assert drive.asks(1, "60 00 00 00 00 00 00 00") == "00 68 64 72 69 67 20 74"  # "hdrig t"
    assert drive.asks(1, "70 00 00 00 00 00 00 00") == "10 77 69 6e 20 73 65 72"  # "win ser"
    assert drive.asks(1, "60 00 00 00 00 00 00 00") == "00 76 6f 20 64 72 69 76"  # "vo driv"
    assert drive.asks(1, "70 00 00 00 00 00 00 00") == "1d 65 00 00 00 00 00 00"  # "e", the last, six bytes unused


def test_a_segmented_download(drive: Host) -> None:
    assert drive.asks(1, "21 17 10 00 02 00 00 00") == "60 17 10 00 00 00 00 00"
    assert drive.asks(1, "0b e8 03 00 00 00 00 00") == "20 00 00 00 00 00 00 00"
    assert drive.asks(1, "40 17 10 00 00 00 00 00") == "4b 17 10 00 e8 03 00 00"


@pytest.mark.parametrize(
    ("request_", "answer"),
    [
        ("40 00 20 00 00 00 00 00", "80 00 20 00 00 00 02 06"),  # no such object
        ("40 18 10 09 00 00 00 00", "80 18 10 09 11 00 09 06"),  # no such sub-index
        ("2b 41 60 00 00 00 00 00", "80 41 60 00 02 00 01 06"),  # read only
        ("23 40 60 00 00 00 00 00", "80 40 60 00 12 00 07 06"),  # too long
        ("2f 40 60 00 00 00 00 00", "80 40 60 00 13 00 07 06"),  # too short
        ("2f 60 60 00 06 00 00 00", "80 60 60 00 30 00 09 06"),  # a mode it has not
        ("a4 08 10 00 20 00 00 00", "80 08 10 00 01 00 04 05"),  # block transfer
        ("60 00 00 00 00 00 00 00", "80 00 00 00 01 00 04 05"),  # a segment of nothing
    ],
)
def test_what_cannot_be_is_aborted_with_its_code(drive: Host, request_: str, answer: str) -> None:
    assert drive.asks(1, request_) == answer


def test_a_write_only_object_cannot_be_read() -> None:
    assert host().asks(3, "40 25 61 01 00 00 00 00") == "80 25 61 01 01 00 01 06"


def test_the_wrong_toggle_bit_ends_a_transfer(drive: Host) -> None:
    drive.asks(1, "40 08 10 00 00 00 00 00")
    assert drive.asks(1, "70 00 00 00 00 00 00 00") == "80 08 10 00 00 00 03 05"
    assert drive.asks(1, "60 00 00 00 00 00 00 00") == "80 08 10 00 01 00 04 05"


def test_a_segmented_download_of_another_length_than_announced_is_aborted(drive: Host) -> None:
    drive.asks(1, "21 17 10 00 04 00 00 00")
    assert drive.asks(1, "0b e8 03 00 00 00 00 00") == "80 17 10 00 10 00 07 06"


def test_an_abort_of_the_client_is_not_answered(drive: Host) -> None:
    drive.asks(1, "40 08 10 00 00 00 00 00")
    assert drive.asks(1, "80 08 10 00 00 00 00 08") == ""


def test_nothing_is_answered_in_a_stopped_node(drive: Host) -> None:
    drive.send(0x000, "02 01")
    assert drive.asks(1, "40 00 10 00 00 00 00 00") == ""
    assert drive.asks(2, "40 00 10 00 00 00 00 00") == "43 00 10 00 96 01 02 00"


def test_an_answer_takes_the_node_its_turnround(drive: Host) -> None:
    drive.twin.drive.sdo_turnround = 0.45
    drive.send(0x601, "40 00 10 00 00 00 00 00")
    assert drive.hears(0x581, 0.44) == []
    assert drive.hears(0x581, 0.02) == ["43 00 10 00 92 01 02 00"]
