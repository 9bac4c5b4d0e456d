"""What the page says in words: origin, verdict, names of procedures and conditions, definitions of figures."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from rig.analysis.findings.result import Verdict
from rig.core.kinds import KINDS


class Origin(NamedTuple):
    """Where the samples came from, said so that nobody can miss it."""

    word: str
    sentence: str
    run: str  # the run, by its origin
    tone: str
    mark: str = ""  # across every figure


class Ruling(NamedTuple):
    """A verdict as shown: never by colour alone."""

    sign: str
    word: str
    tone: str


TWIN = "Computed by the digital twin of the rig. No gear was measured."
IN_PART = (
    "Some of its runs were computed by the digital twin of the rig and others were not: no figure here is a gear’s."
)
ELSEWHERE = "Recorded by other software and read in. What its files do not say is unknown here."


def origin(backend: str | None) -> Origin:
    """The origin by the manifest's `backend`; one that is absent or unheard of is said to be unknown."""
    match backend:
        case "sim":
            return Origin("SIMULATED", TWIN, "Simulated run", "mark", mark="SIMULATED")
        case "can":
            return Origin("MEASURED", "Recorded from the devices of the rig over CAN.", "Measured run", "good")
        case "serial":
            return Origin("MEASURED", "Recorded from the devices of the rig over serial lines.", "Measured run", "good")
        case "imported":
            return Origin("IMPORTED", ELSEWHERE, "Imported run", "warn")
    said = f"The manifest names the backend “{backend}”" if backend else "The manifest names no backend"
    sentence = f"{said}: it cannot be told whether this was measured or simulated."
    return Origin("ORIGIN UNKNOWN", sentence, "Run of unknown origin", "warn")


def heading(procedure: str, manifest: Mapping[str, Any]) -> str:
    """Title of the page; a run of no known procedure by its own label."""
    label = manifest.get("label")
    if procedure == "other" and isinstance(label, str) and label.strip():
        return humanise(label.strip().replace("-", " "))
    return kind(procedure)


def kind(procedure: str) -> str:
    """What people call a run of this procedure; of one unheard of its own name."""
    return KINDS[procedure].title if procedure in KINDS else humanise(procedure)


RULINGS = {
    Verdict.PASS: Ruling("✓", "Pass", "good"),
    Verdict.FAIL: Ruling("✗", "Fail", "bad"),
    Verdict.INCONCLUSIVE: Ruling("?", "Inconclusive", "warn"),
    Verdict.MEASURED: Ruling("–", "No limit set", "plain"),  # "measured" would contradict SIMULATED above it
}

STATUS = {
    "completed": "Completed",
    "stopped": "Stopped by the operator",
    "tripped": "Tripped by the guard",
    "interrupted": "Interrupted: found without an end",
    "running": "Still running when this was written",
    "imported": "Imported",
}

UNITS = {  # of rows of the provenance, by their dotted key
    "proof.breakaway": "N·m",
    "proof.shaft_torque_difference": "N·m",
    "proof.shaft_torque_error": "N·m",
    "loop.rate": "Hz",
}

ENTRIES = {  # conditions and declared values by key: name for people, unit
    "tau_ext": ("External torque on the load", "N·m"),
    "output_locked": ("Output locked", ""),
    "depth_mm": ("Assembly depth", "mm"),
    "speed_rpm": ("Motor speed", "rpm"),
    "speeds_rpm": ("Motor speeds, rpm", ""),
    "tau_max": ("Shaft torque, greatest", "N·m"),
    "torque_rates": ("Torque rates, N·m/s", ""),
    "settle_s": ("Time to settle, left out", "s"),
    "tolerance": ("Tolerance, share of the waveform’s rms", ""),
    "output_turns": ("Output turns", ""),
    "J_m": ("Inertia, motor side J_m", "kg·m²"),
    "J_l": ("Inertia, load side J_l", "kg·m²"),
    "K": ("Torsional stiffness K", "N·m/rad"),
    "B_m": ("Damping B_m", "N·m·s/rad"),
    "B_l": ("Damping B_l", "N·m·s/rad"),
    "B_ml": ("Damping B_ml", "N·m·s/rad"),
    "B_sp": ("Damping B_sp", "N·m·s/rad"),
    "fourier_terms": ("Fourier terms", ""),
    "motor_counts_per_rev": ("Motor encoder", "counts per turn"),
    "load_counts_per_rev": ("Load encoder", "counts per turn"),
}

SUFFIXES = {
    "rpm": "rpm",
    "deg": "°",
    "arcsec": "arcsec",
    "arcmin": "arcmin",
    "mm": "mm",
    "nm": "N·m",
    "s": "s",
    "ms": "ms",
    "hz": "Hz",
    "c": "°C",
    "turns": "turns",
}

DEFINITIONS = (  # by the beginning of the estimate's name, first match
    (
        "latch_skew_error",
        "How far reading the two encoders at different times moves θ̃, forward one way, reverse the other",
    ),
    (
        "latch_skew_",
        "How much later one channel of a row was read than another",
    ),
    (
        "kinematic_error_peak_to_peak",
        "Per wave-generator turn, as in the paper. The maker’s transmission accuracy is over one output turn "
        "and is not the same.",
    ),
    (
        "transmission_accuracy",
        "As makers define it: greatest less least over one output turn in one direction. The paper’s kinematic error "
        "is peak to peak per turn of the wave generator.",
    ),
    (
        "flexible_",
        "θ̃ at speed less the pure kinematic error of a slow run, angle on angle.",
    ),
    (
        "torsional_stiffness",
        "Of the whole path between the two encoders: gear, torque sensor, couplings and fixture together.",
    ),
    ("hysteresis_loss", "Torsion between the two branches of the loop at zero torque."),
    ("lost_motion", "Torsion at ±4 % of rated torque, as makers define it."),
)


HEADLINES = (
    "speed_limit",
    "transmission_accuracy",
    "kinematic_error_peak_to_peak",
    "torsional_stiffness",
    "torsional_stiffness_apparent",
    "coulomb",
    "noise_tau_l",
)  # the first there is


def definition(name: str) -> str:
    """What a figure of this machine name means, "" where the label says it all."""
    return next((text for part, text in DEFINITIONS if name.startswith(part)), "")


def humanise(key: str) -> str:
    """`some_key` as "Some key"."""
    text = key.replace("_", " ").strip()
    return text[:1].upper() + text[1:]


def named(key: str) -> tuple[str, str]:
    """Name for people and unit of a key of conditions or declared values; an unknown key speaks by its suffix."""
    if key in ENTRIES:
        return ENTRIES[key]
    stem, _, suffix = key.rpartition("_")
    return (humanise(stem), SUFFIXES[suffix]) if stem and suffix in SUFFIXES else (humanise(key), "")


def status(manifest: Mapping[str, Any]) -> str:
    """How the run ended, with the reason when it did not simply come to its end; "" when the manifest does not say."""
    word = manifest.get("status")
    if not word:
        return ""
    said = STATUS.get(str(word), humanise(str(word)))
    reason = str(manifest.get("exit_reason") or "")
    return said if word == "completed" or not reason else f"{said}: {reason}"


def ended_early(manifest: Mapping[str, Any]) -> str:
    """How the run ended when that was not its own end; "" when it was, or nothing is said."""
    return "" if manifest.get("status") in (None, "completed", "imported") else status(manifest)
