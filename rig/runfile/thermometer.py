"""Which channel of a run is the temperature of the gear: loggers call it what they like, its unit says what it is."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Final, NamedTuple

TEMPERATURE: Final = "temperature"  # what it is asked for as
KELVIN, FAHRENHEIT = (1.0, -273.15), (5 / 9, -160 / 9)
TO_CELSIUS: Final = {  # what a reading is multiplied by, and then gains
    **dict.fromkeys(("degc", "°c", "celsius", "cel", "c", "deg c", "grad c", "℃"), (1.0, 0.0)),
    **dict.fromkeys(("k", "kelvin"), KELVIN),
    **dict.fromkeys(("degf", "°f", "fahrenheit", "deg f"), FAHRENHEIT),
}
OF_THE_GEAR: Final = re.compile(r"gear|flex|housing|oil|grease|lubric|reducer|strain", re.IGNORECASE)
OF_ANOTHER: Final = re.compile(r"motor|winding|drive|amplifier|room|ambient|air|encoder|sensor", re.IGNORECASE)


class Thermometer(NamedTuple):
    """A channel, and what makes °C of its readings: times `factor`, plus `more`."""

    channel: str
    factor: float
    more: float


def thermometer(channels: Iterable[tuple[str, str, str]]) -> Thermometer | None:
    """Of (name, unit, meaning) of every channel the one that is the gear's temperature, or may be; None where none has
    a unit of temperature. One called "temperature" is it, and is in °C where it says no unit."""
    found: list[tuple[int, int, Thermometer]] = []
    for name, unit, meaning in channels:
        if name == TEMPERATURE or unit.strip().lower() in TO_CELSIUS:
            said = f"{name} {meaning}"
            fits = 0 if name == TEMPERATURE else 1 if OF_THE_GEAR.search(said) else 3 if OF_ANOTHER.search(said) else 2
            found.append((fits, len(found), Thermometer(name, *TO_CELSIUS.get(unit.strip().lower(), (1.0, 0.0)))))
    return min(found)[2] if found else None
