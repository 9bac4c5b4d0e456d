"""What `hdrig twin` refuses, in a sentence."""

from __future__ import annotations

from pathlib import Path

import pytest

from rig.cli import main


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        (["--bitrate", "0"], 2, "more than 0 bit/s"),
        (["--rate", "5000"], 2, "expected 0 to 900 lines/s"),
        (["--bench", "nothing"], 2, "no bench called 'nothing'"),
        (["--set", "twin.sede=3"], 2, "twin.sede"),
    ],
)
def test_options_that_cannot_be_meant(
    options: list[str], code: int, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    doors = ["--bus", str(tmp_path / "can"), "--control", str(tmp_path / "control")]
    assert main(["twin", *doors, *options]) == code
    assert words in capsys.readouterr().err


def test_a_bench_without_a_twin_has_nothing_to_simulate(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shipped = Path("rig/benches/twin.toml").read_text(encoding="utf-8")
    real = shipped[: shipped.index("[twin]")].replace("twin.drive", "can.cia402")
    real = real.replace('type = "can.cia402"', 'type = "can.cia402"\nbus = "rig"\nnode = 1')
    real = real.replace('[devices.load_encoder]\ntype = "twin.load_encoder"\n', "")
    real = real.replace('[devices.torque_sensor]\ntype = "twin.torque_sensor"\n', "")
    bench = tmp_path / "real.toml"
    bench.write_text(real + '\n[bus.rig]\ninterface = "virtual"\nchannel = "x"\n', encoding="utf-8")
    assert main(["twin", "--bench", str(bench), "--bus", str(tmp_path / "can")]) == 2
    assert "no [twin] section" in capsys.readouterr().err


def test_a_path_that_is_too_long_for_a_socket_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["twin", "--bus", str(tmp_path / ("x" * 120)), "--control", str(tmp_path / "control")]) == 3
    assert "cannot listen at" in capsys.readouterr().err


def test_a_port_that_is_taken_is_said_and_nothing_stays_behind(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    import socket

    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        options = ["--bus", str(tmp_path / "can"), "--control", str(tmp_path / "control"), "--socketcand", port]
        assert main(["twin", *options]) == 3
    assert f"port {port}" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
