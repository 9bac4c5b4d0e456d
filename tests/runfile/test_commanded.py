"""What was commanded is recorded under the name of what it was."""

import pytest

from rig.runfile.columns import schema, schema_of


@pytest.mark.parametrize(
    ("mode", "names", "unit"),
    [
        ("torque", ["tau_ask", "tau_applied"], "N·m"),
        ("velocity", ["omega_ask", "omega_applied"], "rad/s"),
        ("position", ["theta_ask", "theta_applied"], "rad"),
    ],
)
def test_the_pair_is_named_and_has_the_unit_of_the_drive_s_mode(mode: str, names: list[str], unit: str):
    layout = schema_of({"backend": "can", "loop": {"mode": mode}})
    assert layout.names[6:8] == names
    assert {layout.field(name).metadata[b"unit"].decode() for name in names} == {unit}
    assert len(layout) == len(schema("can"))


def test_a_manifest_that_says_no_mode_is_one_of_torques():
    assert schema_of({"backend": "sim"}) == schema("sim")
