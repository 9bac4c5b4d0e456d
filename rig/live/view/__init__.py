"""The live view: a run drawn with Rerun while it goes on, or from its folder afterwards.

| module | one idea |
|---|---|
| about | what the manifest says of the run that is drawn |
| block | some rows of a run, column by column, wherever they come from |
| lateness | how late each row was against the grid of its period |
| curves | what is drawn over time: one vector a unit |
| ticks, axes | round numbers, and a plane with axes, ticks and units |
| drawing | the abstract `Drawing`; `folded`, `trail`, `orders`, `space` are its members |
| layout | which panes, where, for which kind of procedure |
| canvas | the abstract `Canvas`: what can be drawn at all |
| rerun_canvas | the only module that knows rerun |
| picture | all of it for one run |
| recording | a run folder → `view.rrd` |
| feed | a run that is going on, from its ring and its events |
| server, pages | the viewer's own processes, on loopback, and its files |
| bridge | the process between the ring and the viewer |
| viewer | the handle of that process for whoever runs the rig |

The view is for looking: what an operator decides by stands in the console, the terminal and the report.
"""
