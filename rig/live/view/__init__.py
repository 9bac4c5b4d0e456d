"""The live view: a run drawn with Rerun while it goes on, or from its folder afterwards.

Rows come from `feed` (a ring) or `recording` (a folder), as `block`s; `picture` draws all of one run, each `drawing` on
a `canvas`; `rerun_canvas` is the only module that knows rerun; `bridge` is the process between the ring and the viewer,
and `viewer` the handle of it for whoever runs the rig. Each module says at its top what it is for.

The view is for looking: what an operator decides by stands in the console, the terminal and the report.
"""
