"""From measured runs to the effect the paper's model lacks. `trace` leads through it:

runs/     what is read, on one grid, split into fitted and held out
fit/      the rig's equations, baseline and effects fitted together, the search for effects
floor/    what no model has to explain: repeats, lines, what every run has to itself
selection/ what may be said: effects scored on unseen runs, rivals, the next run
looks/    second looks, each at what the first leaves out
nameless/ laws that are no effect of the library, searched for and never named
residual/ what is left, and the coordinate it lives in
free_form/ what has no name, drawn where it acts
outcome/  errors before and after, free simulation, arrays for the page, trace.json
"""
