"""What the page of a trace says in words: verdict, sizes, names of parameters and coordinates."""

from __future__ import annotations

from collections.abc import Sequence

from rig.analysis.tracing.answer import Status, Verdict
from rig.analysis.tracing.outcome import told
from rig.analysis.tracing.outcome.each_run import LOADED
from rig.analysis.tracing.outcome.each_run import of_each_run as own_words
from rig.analysis.tracing.outcome.honest import ORDER
from rig.analysis.tracing.outcome.result import Curve, Found, Trace
from rig.analysis.tracing.outcome.told import PARAMETERS, listed
from rig.analysis.tracing.thresholds import EXPLAINED
from rig.model.effect import Parameter
from rig.model.effects import LIBRARY
from rig.report.numbers import counted, plain
from rig.report.trace import sizes as sized
from rig.report.trace.channels import CHANNELS
from rig.report.words import Ruling, humanise

HEADED = 6  # parameters of an effect at the head of the page; more are a table

RULINGS = {
    Status.EXPLAINED: Ruling("✓", "Explained", "good"),
    Status.NOTHING: Ruling("✓", "Nothing is missing", "good"),
    Status.AMBIGUOUS: Ruling("?", "Ambiguous: these runs do not decide", "warn"),
    Status.UNKNOWN: Ruling("!", "Something is missing, and no effect of the library explains it", "bad"),
}

IN_PART = Ruling("!", "Named in part: something more is missing, which no effect of the library explains", "warn")

MEANING = {
    Status.EXPLAINED: "An effect is named when it removes at least 60 % of the excess over the floor in runs the fit "
    "did not see, and no other effect of the library does as well.",
    Status.NOTHING: "On runs the fit did not see the paper’s model is as good as a repeat of the run. That bounds what "
    "these runs can show; it does not say that the gear has no other effect at other speeds, loads or temperatures.",
    Status.AMBIGUOUS: "More than one effect explains these runs equally well. Naming one would be a guess: its "
    "parameters below hold only if it is the right one.",
    Status.UNKNOWN: "What is left is real: it is more than repeats of a run differ by. It is described by where it "
    "lives and is given no name. What is added to the model beside names is a curve without physics, or a law "
    "that no effect of the library stands for.",
}

BEYOND = (
    "The fit was asked for more than it was told: in held-out runs outside the range of speed or load of the fitted "
    "ones an error says nothing of the gear. No effect is named and none is ruled out."
)

PLACES = {
    "motor_angle": "the motor angle",
    "load_angle": "the load angle",
    "speed": "the speed",
    "load": "the torque through the gear",
    "direction": "the direction of motion",
    "time": "the time since the campaign or a run began",
    "time_periodic": "time, at a fixed frequency whatever the speed",
    "temperature": "the temperature",
    "memory": "what the torque has been: memory",
}


def ruled(trace: Trace) -> Ruling:
    """The verdict as a mark, a headline and a tone."""
    v = trace.verdict
    return IN_PART if v.status is Status.UNKNOWN and v.effects else RULINGS[v.status]


def meant(trace: Trace) -> str:
    """What the verdict means, in a sentence or two."""
    v = trace.verdict
    return BEYOND if v.status is Status.AMBIGUOUS and not v.rivals else MEANING[v.status]


def named(effect: str) -> str:
    """Name of an effect for people."""
    return humanise(effect)


def in_short(effect: str) -> str:
    """One line on an effect; "" where nothing is known of it."""
    return LIBRARY[effect].in_short if effect in LIBRARY else ""


def gloss(effect: str, name: str, unit: str) -> str:
    """What the parameter `name` of an effect is, "" of one unheard of; and that it has no unit, where `unit` is "1"."""
    known = LIBRARY.get(effect)
    parts = [known.gloss(name) if known else "", "(no unit)" if unit == "1" else ""]
    return " ".join(part for part in parts if part)


def plainly(text: str) -> str:
    """A sentence of the trace with the effects' machine names as words."""
    for name in LIBRARY:
        text = text.replace(name, name.replace("_", " "))
    return text


def sizes(found: Sequence[Found]) -> list[str]:
    """One sentence for each effect added: its parameters with their intervals, and where the rest of a long list is."""
    out = []
    for effect in found:
        shown = effect.parameters if len(effect.parameters) <= HEADED + 1 else effect.parameters[:HEADED]
        parts = []
        for p in shown:
            what = gloss(effect.effect, p.name, "")
            parts.append(f"{p.name} = {sized.said(p)}" + (f" ({what})" if what else ""))
        more = len(effect.parameters) - len(shown)
        if parts:
            rest = f"; {more} more under 4, What was added" if more else ""
            out.append(f"{named(effect.effect)}: {', '.join(parts)}{rest}.")
    return out


def unmoved(trace: Trace) -> str:
    """Which parameters of the baseline the refit left as they were, and why; "" where all moved."""
    return told.why_unmoved(trace.baseline, trace.baseline_after, [e.effect for e in trace.effects])


def runs_read(trace: Trace) -> str:
    """ "36 runs", or of how many so many were read."""
    read = trace.read or len(trace.fitted) + len(trace.held_out)
    return f"{read} of {read + len(trace.left_out)} runs" if trace.left_out else counted(read, "run")


def not_read(trace: Trace) -> str:
    """Which runs of the campaign were left out, by name; "" where none was."""
    return f"Left out: {listed(trace.left_out)}." if trace.left_out else ""


def heading(trace: Trace) -> str:
    """Title of the page."""
    return f"What the model lacks: {trace.campaign}"


def place(coordinate: str | None) -> str:
    """A coordinate as a phrase."""
    return PLACES.get(coordinate or "", (coordinate or "").replace("_", " "))


def remainder(trace: Trace) -> str:
    """What stays above the floor although effects were named; "" where nothing does or the verdict says it itself."""
    if trace.verdict.status is Status.UNKNOWN:
        return ""
    loud = [(c, r) for c in CHANNELS if (r := trace.by_names.get(c.sensor, 0.0)) > EXPLAINED]
    said = listed([f"the {c.name.lower()} stays at {plain(r, 3)} times its floor" for c, r in loud])
    return f"Not all of it: {said}. What that is, is not known{_beside_names(trace)}." if said else ""


def added(trace: Trace) -> str:
    """What went into the model, in one or two sentences."""
    v = trace.verdict
    names = listed([named(e.effect).lower() for e in trace.effects])
    match v.status:
        case Status.NOTHING:
            return "Nothing was added. The parameters are those of the baseline."
        case Status.UNKNOWN:
            beside = f" beside {names}" if names else ""
            where = f"{place(v.coordinate)}{_pitch(v)}"
            if trace.law:
                law = f"A law that is no effect of the library{beside}. {' '.join(trace.law)}"
                return f"{law} {beside_laws(trace)}".rstrip()
            if not trace.added_curves:
                also = f"{humanise(names)} was added; no" if names else "Nothing was added: no"
                return f"{also} curve in {where} foretells what is left in runs the fit did not see."
            return _curves(trace, beside, where)
        case Status.AMBIGUOUS if not v.rivals:
            return "Nothing was added: the fitted runs do not reach as far as the held-out ones."
        case Status.AMBIGUOUS:
            rivals = listed([named(r).lower() for r in v.rivals])
            return f"For the errors below {names or 'the first candidate'} was added; {rivals} would do as well."
    effects = "effect" if len(trace.effects) == 1 else "effects"
    return f"{humanise(names)}. Baseline and {effects} were then fitted again together."


def of_each_run(trace: Trace) -> str:
    """What was taken from a held-out run itself, "" where nothing was: its error is then not wholly unseen."""
    return own_words(trace.effects)


def under_load(trace: Trace) -> str:
    """At which load the orders after the refit hold, where they shrink with it; "" where they do not."""
    found = next((e for e in trace.effects if e.effect == LOADED), None)
    orders = [p for p in trace.baseline_after if p.name.startswith(ORDER)]
    if found is None or not orders:
        return ""
    p = {q.name: q for q in found.parameters}
    largest = max(orders, key=lambda q: q.value)
    stays = p.get(f"A_inf_{largest.name.removeprefix('theta_p_')}", p.get("A_inf"))
    said = "Amplitudes after are those without load; those before are a mean over the loads run."
    if stays is None or not stays.value > 0:
        return said
    n = largest.name.removeprefix(ORDER)
    return (
        f"{said} Under a load many times T_c A_inf of them is left: of order {n} "
        f"{plain(largest.value * stays.value, 3)} {largest.unit}."
    )


def beside_laws(trace: Trace) -> str:
    """Curves without a name beside laws that have none; "" without any."""
    if not trace.added_curves:
        return ""
    return _curves(trace, " beside it", f"{place(trace.added_curves[0].coordinate)}{_pitch(trace.added_curves[0])}")


def _curves(trace: Trace, beside: str, where: str) -> str:
    """The curves without a name: the first along the verdict's coordinate, and what each of the others leaves."""
    first, *more = trace.added_curves
    where += _as_what(first)
    if not more:
        return f"A curve without a name{beside}, in {where}; no physics is claimed for it."
    others = listed([f"{place(c.coordinate)}{_pitch(c)}{_as_what(c)}" for c in more])
    last = {c.channel: c.over_floor for c in trace.added_curves}
    left = listed([f"{c.name.lower()} {plain(last[c.sensor], 3)} times" for c in CHANNELS if c.sensor in last])
    return (
        f"A curve without a name{beside}, in {where}, and beside it {'another' if len(more) == 1 else 'others'} in "
        f"{others}: {left} its floor with all of them. No physics is claimed for them."
    )


def _as_what(curve: Curve) -> str:
    """Where it acts, of a form that was fitted with everything else."""
    return f" ({curve.acts}; of what unseen runs vouch for there the fitted ones want it most)" if curve.acts else ""


def _beside_names(trace: Trace) -> str:
    """What curves without a name leave where names explain most; "" without any."""
    if not trace.added_curves:
        return ""
    places = listed(list(dict.fromkeys(f"{place(c.coordinate)}{_pitch(c)}" for c in trace.added_curves)))
    last = {c.channel: c.over_floor for c in trace.added_curves}
    left = listed([f"the {c.name.lower()} at {plain(last[c.sensor], 3)} times" for c in CHANNELS if c.sensor in last])
    one = len(trace.added_curves) == 1
    return (
        f"; {'a curve' if one else 'curves'} without a name in {places}, for which no physics is claimed, "
        f"{'leaves' if one else 'leave'} {left} its floor"
    )


def _pitch(of: Verdict | Curve) -> str:
    order = f", order {plain(of.order, 4)} per turn" if of.order is not None else ""
    return order + (f", {plain(of.frequency_hz, 4)} Hz" if of.frequency_hz is not None else "")


def meaning(p: Parameter) -> tuple[str, str]:
    """Symbol and meaning of a parameter of the baseline."""
    if p.name.startswith(ORDER):
        n = p.name.removeprefix(ORDER)
        return f"Order {n}", ""
    return PARAMETERS.get(p.name, (p.name, ""))
