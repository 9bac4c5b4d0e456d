"""Blind test of `hdrig trace`: campaigns with hidden effects from a plant the tracer has never seen, and a scorer.

Nothing here imports `rig` or `sim`; only run folders go across. The one exception is a test that asks the program's own
reader whether it takes a folder. What is here, in the order it is used:

- `rig.py` draws a drive (±30 % around size 40), `plans.py` lists the runs, `forms/` holds one file per effect with two
  to four functional shapes each (one is the textbook's, the others are what a library need not hold), `forms/outside/`
  holds effects without a name in the library.
- `builder.py` collects what forms change; `kernel.py` and `integrate.py` are the compiled plant: midpoint rule with
  set-valued dry friction, so that stiction is true; `sensors.py` makes counts, noise, zeros that jump and clocks that
  jitter of the motion; `campaign.py` runs a plan through them; `folder.py` writes run folders with pyarrow.
- `residual.py` and `strength.py` size an effect: residual RMS with it over residual RMS without it, at the same noise
  seed, after a baseline fit of their own. Strengths are drawn from 1.3 to 20 times the floor of the channel that
  shows most; where a form reaches its physical bound first, the truth states what was reached.
- `cases.py`, `suite.py`, `generate.py` make cases; truth lies apart, its sha256 in HASHES before anything is traced.
- `score.py` runs the tracer on each case and compares; `peers/` gives other methods the same splits.

    python -m tests.blind.generate --kind single --effect stribeck_friction --form lorentzian --seed 7 --out DIR
    python -m tests.blind.generate --suite 30 --seed 1 --out DIR
    python -m tests.blind.score DIR

Kinds: single (textbook form), single_other (another form), crowded (one main effect among eight at 1.01 to 1.12 times
the floor), pair, clean, outside, ambiguous (the paper's own runs, which cannot decide). Plans: complete, paper,
paper_once, paper_one_way, paper_no_torque_sensor, noreps, one_direction, no_torque_sensor, no_motor_torque,
slow_and_locks, weights_at_one_speed, speeds_alone. A suite has complete ones, of one single in five noreps,
one_direction or no_torque_sensor, and paper where it cannot be decided.

Limits of this test: rig, noise and effects are simulated by people who had read the same notes as the tracer's authors;
the declared inertias are exact; every run starts from the same home position; one effect at a time claims the extra
body, the friction memory or the hysteresis.
"""

import os

for threads in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):  # before numpy: matrices are small and the cores shared
    os.environ.setdefault(threads, "1")
