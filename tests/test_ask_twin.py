"""`hdrig twin free` and its like: the hand of a twin that runs already, for an operator."""

from __future__ import annotations

import math
import re
import socket
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from rig.cli import main
from rig.commands.ask_twin import told, understood
from rig.core.errors import UsageError
from sim.wire.assembly import Assembly
from sim.wire.control import describe, perform
from sim.wire.faults import fault_verbs
from sim.wire.reactor import Reactor
from sim.wire.verbs import plant_verbs
from tests.drivers.virtual import wired

CARRIES = 45.0  # N·m


@pytest.fixture
def twin(tmp_path: Path) -> Iterator[Assembly]:
    """A twin whose command channel is `control` in the test's folder; one line a client."""
    assembly = wired().twin
    faults = fault_verbs(assembly, Reactor(assembly.agenda), {}, {})
    own = plant_verbs(assembly, Reactor(assembly.agenda), faults["faults"], CARRIES)
    verbs = {**own, **faults, "help": lambda: describe(verbs)}
    door = socket.socket(socket.AF_UNIX)
    door.bind(str(tmp_path / "control"))
    door.listen()

    def listen() -> None:
        import json

        while True:
            try:
                client, _ = door.accept()
            except OSError:
                return
            with client:
                client.sendall(json.dumps(perform(verbs, client.makefile("rb").readline())).encode() + b"\n")

    threading.Thread(target=listen, daemon=True).start()
    yield assembly
    door.shutdown(socket.SHUT_RDWR)
    door.close()


def ask(tmp_path: Path, *words: str) -> int:
    return main(["twin", "--control", str(tmp_path / "control"), *words])


def test_an_output_left_locked_by_a_run_that_died_is_freed(
    twin: Assembly, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    twin.world.lock_output()
    assert ask(tmp_path, "status") == 0
    assert "output         locked" in capsys.readouterr().out
    assert ask(tmp_path, "free") == 0
    assert capsys.readouterr().out.startswith("SIMULATED: ")
    assert not twin.world.plant.locked
    assert ask(tmp_path, "lock") == 0
    assert twin.world.plant.locked


def test_status_says_which_faults_stand(twin: Assembly, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert ask(tmp_path, "status") == 0
    assert "faults         none" in capsys.readouterr().out
    assert ask(tmp_path, "sto", "active=true") == 0
    assert ask(tmp_path, "frozen", 'device="encoder"') == 0
    assert ask(tmp_path, "status") == 0
    assert "faults         sto active=true; frozen device=encoder" in capsys.readouterr().out


def test_values_are_told_with_their_units_and_an_error_code_as_a_run_says_it(
    twin: Assembly, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert ask(tmp_path, "status") == 0
    assert "error_code     none" in capsys.readouterr().out
    twin.drive.fault(0x8130)
    assert ask(tmp_path, "status") == 0
    said = capsys.readouterr().out
    assert "error_code     8130h" in said
    assert re.search(r"^  t +[0-9.e+-]+ s$", said, re.M)
    assert re.search(r"^  late +[0-9.e+-]+ s$", said, re.M)
    assert re.search(r"^  load +[0-9.]+ % of the bus$", said, re.M)
    assert re.search(r"^  tau_ext +0 N·m$", said, re.M)
    assert re.search(r"^  omega_m +[0-9.e+-]+ rad/s$", said, re.M)
    assert ask(tmp_path, "truth") == 0
    said = capsys.readouterr().out
    for key, unit in (("theta_m", "rad"), ("omega_l", "rad/s"), ("tau_m", "N·m"), ("phi", "rad")):
        assert re.search(rf"^  {key} +[0-9.e+-]+ {unit}$", said, re.M), key


def test_a_weight_is_hung_by_its_number_alone_and_told_with_its_unit(
    twin: Assembly, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    twin.world.lock_output()
    assert ask(tmp_path, "hang", "-2.5") == 0
    assert capsys.readouterr().out.endswith(": hang -2.5 N·m\n")
    assert twin.world.plant.tau_ext == -2.5
    assert ask(tmp_path, "hang", "0") == 0
    assert twin.world.plant.tau_ext == 0.0


def test_a_list_of_an_answer_is_told_as_words() -> None:
    assert told("stations", ["node 1", "node 2"]) == "node 1, node 2"
    assert told("stations", []) == "none"


def test_what_there_is_to_ask_for_is_told(twin: Assembly, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert ask(tmp_path, "help") == 0
    said = capsys.readouterr().out
    assert re.search(r"^  free +Let the output turn again$", said, re.M)
    assert re.search(r"^  hang +tau_ext=NUMBER: Hang a weight", said, re.M)
    assert re.search(r"^  jump +device=NAME by=NUMBER: ", said, re.M)
    assert re.search(r"^  sto +\[active=true\|false\] \[fault=true\|false\]: ", said, re.M)
    assert not re.search(r"float|: str|unlock|^  load", said, re.M)


@pytest.mark.parametrize(
    ("words", "code", "told"),
    [
        (["hang"], 2, "expected the torque on the output in N·m"),
        (["free", "3"], 2, "'3' is not understood; expected KEY=VALUE"),
        (["hang", "1", "2"], 2, "'2' is not understood"),
        (["shove"], 2, "a twin cannot be asked for 'shove'; expected one of babble, broken_cable, bus_off, cut, "),
        (["frozen"], 2, "frozen needs device (drive, encoder, torque), as in frozen device=NAME"),
        (["jump", "device=torque"], 2, "jump needs by, as in jump device=NAME by=NUMBER"),
        (["mute"], 2, "mute needs line (there is none), as in mute line=NAME"),
        (["sto", "now=true"], 2, "sto has no 'now'; expected [active=true|false] [fault=true|false]"),
        (["frozen", "device=hand"], 2, "no device 'hand'; expected one of drive, encoder, torque"),
        (["hang", "much"], 2, "tau_ext = much is no finite number; expected the torque on the output in N·m"),
        (["hang", "nan"], 2, "tau_ext = nan is no finite number"),
        (["hang", "inf"], 2, "tau_ext = inf is no finite number"),
        (["reassemble", "nan"], 2, "depth_mm = nan is no finite number; expected the depth in mm"),
        (["load", "tau_ext=nan"], 2, "tau_ext = nan is no finite number"),
        (["hang", "46"], 2, "a weight of 46 N·m is more than the shaft carries; expected a number from -45 to 45 N·m"),
    ],
)
def test_what_cannot_be_meant_is_a_sentence(
    twin: Assembly, tmp_path: Path, capsys: pytest.CaptureFixture[str], words: list[str], code: int, told: str
) -> None:
    assert ask(tmp_path, *words) == code
    assert told in capsys.readouterr().err


def test_where_no_twin_runs_it_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert ask(tmp_path, "free") == 3
    assert "is `hdrig twin` running" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "asked"),
    [
        (["sto", "active=true", "fault=false"], {"do": "sto", "active": True, "fault": False}),
        (["drop", "identifier=0x181", "count=3"], {"do": "drop", "identifier": 0x181, "count": 3}),
        (["frozen", "device=encoder"], {"do": "frozen", "device": "encoder"}),
        (["reassemble", "0.1"], {"do": "reassemble", "depth_mm": 0.1}),
        (["reassemble"], {"do": "reassemble"}),
    ],
)
def test_faults_are_asked_for_by_their_keys(words: list[str], asked: dict[str, Any]) -> None:
    assert understood(words) == asked


@pytest.mark.parametrize(
    ("line", "told"),
    [
        (b'{"do": "load", "tau_ext": NaN}', "tau_ext = nan: expected a finite number"),
        (b'{"do": "load", "tau_ext": 1e999}', "tau_ext = inf: expected a finite number"),
        (b'{"do": "load", "tau_ext": "nan"}', "tau_ext = nan: expected a number"),
        (b'{"do": "reassemble", "depth_mm": "nan"}', "depth_mm = nan: expected a number"),
    ],
)
def test_the_twin_judges_its_numbers_itself_and_lives_on(line: bytes, told: str) -> None:
    assembly = wired().twin
    answer = perform(plant_verbs(assembly, Reactor(assembly.agenda)), line)
    assert answer["ok"] is False
    assert told in answer["error"]
    assembly.world.advance_to(assembly.world.t + 0.01)
    assert assembly.world.truth().theta_m == assembly.world.truth().theta_m
    assert assembly.world.plant.tau_ext == 0.0


def test_an_infinity_stays_where_it_is_the_usual_value() -> None:
    def drop(count: float = math.inf) -> None:
        """Frames"""

    assert perform({"drop": drop}, b'{"do": "drop", "count": Infinity}') == {"ok": True}
    assert perform({"drop": drop}, b'{"do": "drop", "count": NaN}')["ok"] is False


@pytest.mark.parametrize("said", ['"maybe"', "1", '"true"'])
def test_what_is_true_or_false_is_nothing_else(said: str) -> None:
    def sto(active: bool = True) -> None:
        """Safe torque off"""

    answer = perform({"sto": sto}, b'{"do": "sto", "active": %s}' % said.encode())
    assert (answer["ok"], "expected true or false" in answer["error"]) == (False, True)
    assert perform({"sto": sto}, b'{"do": "sto", "active": false}') == {"ok": True}


def test_a_key_given_twice_is_refused() -> None:
    with pytest.raises(UsageError, match="active=false"):
        understood(["sto", "active=true", "active=false"])
