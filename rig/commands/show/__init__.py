"""What is shown while a verb works on a rig: events made in the loop's process, drawn in one of their own.

`show` tells what happens, as events, and holds their table; `outlet` hands them over without ever waiting; `painter` is
the process that draws them, with one of the `screens`; `keys` asks for hold, stop and halt.
"""
