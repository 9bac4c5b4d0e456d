"""The verbs of the command line: one per file, each with `arguments(parser)` and `run(args) -> int`.

The catalogue keeps name and summary here, so that `hdrig --help` imports none of them.
"""

from __future__ import annotations

CATALOGUE: dict[str, tuple[str, str]] = {
    "demo": ("rig.commands.demo", "the main job on the twin: proof, slow run, analysis, report"),
    "run": ("rig.commands.run", "run one procedure on a bench, analyse it, write its report"),
    "campaign": ("rig.commands.campaign", "many runs by one plan, in order, with changes by hand; resumable"),
    "tune": ("rig.commands.tune", "find gains that turn the motor smoothly at the slow speed"),
    "analyse": ("rig.commands.analyse", "figures and report of recorded runs, again and again, no hardware"),
    "import": ("rig.commands.import_", "turn a file of another logger into a run folder"),
    "twin": ("rig.commands.twin", "the simulated rig in real time, reached over CAN and serial lines"),
    "devices": ("rig.commands.devices", "who is on the CAN bus and the serial ports; writes a first bench file"),
    "doctor": ("rig.commands.doctor", "is this machine, this bus and this bench fit for a run"),
    "serve": ("rig.commands.serve", "the console: a page to connect, run, stop, annotate; loopback by default"),
    "view": ("rig.commands.view", "a run in the Rerun viewer, also while it goes on; or as a recording for it"),
    "reset": ("rig.commands.reset", "clear a fault of the drive, once somebody has seen that the rig is whole"),
    "drill": ("rig.commands.drill", "every fault of bus and devices in every phase of a run, on virtual time"),
    "list": ("rig.commands.list_", "the runs in a folder, by date, gear, procedure, verdict"),
    "compare": ("rig.commands.compare", "runs side by side, and what changed by more than repeats scatter"),
    "trend": ("rig.commands.trend", "one figure across days and assemblies, changes marked"),
    "recover": ("rig.commands.recover", "make a readable run of what a dead program left"),
    "verify": ("rig.commands.verify", "check hashes, row counts, time order and gaps of runs"),
    "trace": ("rig.commands.trace", "the physical effect the model lacks, found in a campaign of measured runs"),
    "export": ("rig.commands.export", "write a run as CSV, MDF4, MCAP or HDF5"),
    "identify": ("rig.commands.identify", "all runs of a gear to its parameters with intervals, and a gear file"),
    "simulate": ("rig.commands.simulate", "the kinematic error at speed that the model predicts for a gear"),
    "reproduce": ("rig.commands.reproduce", "the paper's figures and tables, its claims ruled by the data"),
    "close-loop": ("rig.commands.close_loop", "campaign, trace, the run it asks for, until nothing is missing"),
    "compensate": ("rig.commands.compensate", "the kinematic error fed forward, and how much better the load follows"),
}
