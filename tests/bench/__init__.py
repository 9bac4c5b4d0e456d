"""How fast hdrig is: beside the limit (C floors) and beside what a user would otherwise run (peers), in one run.

`make bench`, or `python -m tests.bench --row 7 --quick` for one row. Only ratios of sides that took turns are judged:
the machine's own speed falls on both. Floors and peers are built and installed here, into build/bench, and by nothing
that a user runs.
"""
