"""The hand of a twin in another process: it does what is asked, tells refusals as sentences, and is a twin's alone."""

from __future__ import annotations

import socket
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from rig.bench import read
from rig.config.sections import HandSection
from rig.core.errors import NotReady
from rig.core.operator import (
    Change,
    ClearFault,
    FreeOutput,
    HangWeight,
    LockOutput,
    Operator,
    Reassemble,
    Rigging,
)
from rig.twin_hand import TwinHand
from sim.wire.assembly import Assembly
from sim.wire.control import perform
from sim.wire.reactor import Reactor
from sim.wire.verbs import plant_verbs
from tests.drivers.virtual import wired

Serve = Callable[[Callable[[bytes], bytes]], TwinHand]


@pytest.fixture
def serve(tmp_path: Path) -> Iterator[Serve]:
    """A command channel that answers each line by a function, until the test ends."""
    doors: list[socket.socket] = []

    def start(answer: Callable[[bytes], bytes]) -> TwinHand:
        path, door = tmp_path / "control", socket.socket(socket.AF_UNIX)
        door.bind(str(path))
        door.listen()
        doors.append(door)

        def listen() -> None:
            while True:
                try:
                    line, _ = door.accept()
                except OSError:
                    return
                with line:
                    line.sendall(answer(line.makefile("rb").readline()))

        threading.Thread(target=listen, daemon=True).start()
        return TwinHand(str(path))

    yield start
    for door in doors:
        door.shutdown(socket.SHUT_RDWR)
        door.close()


def twin_of(assembly: Assembly) -> Callable[[bytes], bytes]:
    import json

    verbs = plant_verbs(assembly, Reactor(assembly.agenda))
    return lambda line: json.dumps(perform(verbs, line)).encode() + b"\n"


def test_it_hangs_weights_fits_and_removes_the_pin_and_reassembles(serve: Serve) -> None:
    assembly = wired().twin
    hand = serve(twin_of(assembly))
    hand.make(LockOutput())
    assert assembly.world.plant.locked
    hand.make(FreeOutput())
    assert not assembly.world.plant.locked
    hand.make(HangWeight(2.0))
    assembly.world.advance_to(assembly.agenda.now + 0.2)
    assert hand.ask({"do": "truth"})["theta_l"] > 0
    hand.make(HangWeight(0.0))
    hand.make(ClearFault("why"))


def test_what_the_twin_refuses_is_said_in_its_own_words(serve: Serve) -> None:
    assembly = wired().twin
    hand = serve(twin_of(assembly))
    hand.make(HangWeight(20.0))
    assembly.agenda.run_until(assembly.agenda.now + 0.05)
    assembly.world.advance_to(assembly.agenda.now)
    with pytest.raises(NotReady, match="the twin refused reassemble: the motor turns at"):
        hand.make(Reassemble(0.1))


@pytest.mark.parametrize("answer", [b"hello\n", b"[1]\n", b""])
def test_a_socket_of_somebody_else_is_no_command_channel(serve: Serve, answer: bytes) -> None:
    with pytest.raises(NotReady, match="no twin's command channel"):
        serve(lambda line: answer).make(LockOutput())


def test_a_twin_that_is_not_there_is_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(NotReady, match=r"does not answer \(No such file or directory\): is `hdrig twin` running"):
        TwinHand(str(tmp_path / "nowhere")).make(LockOutput())


class Paint(Change):
    def words(self) -> str:
        return "paint it"

    def applied(self, rigging: Rigging) -> Rigging:
        return rigging


def test_a_change_it_does_not_know_is_refused() -> None:
    with pytest.raises(NotReady, match="cannot do this: paint it"):
        TwinHand("nowhere").make(Paint())


def test_a_bench_with_real_devices_has_no_such_hand() -> None:
    w = wired()
    w.instruments.operator = TwinHand("nowhere")
    for node in w.twin.nodes:
        node.objects.find(0x1008, 0).value = b"EPOS4"
    with pytest.raises(NotReady, match="no device here says that it is simulated"):
        w.instruments.connect()


def test_the_shipped_benches_of_the_twin_over_a_wire_name_its_command_channel() -> None:
    for name in ("twin-can", "twin-canopen", "twin-slcan", "twin-socketcand", "twin-odrive"):
        assert read(name).file.hand == HandSection(control="/tmp/hdrig-twin/control")


def test_only_a_twin_within_the_process_is_made_anew_each_time() -> None:
    assert not Operator.begins_anew
    assert not TwinHand.begins_anew
    rig = read("twin").open("virtual")
    assert rig.operator is not None
    assert rig.operator.begins_anew
