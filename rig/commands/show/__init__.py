"""What is shown while a verb works on a rig: events made in the loop's process, drawn in one of their own.

| file | one idea |
|---|---|
| show | what happens, as events: their table stands there |
| outlet | events to whoever draws them, without ever waiting |
| painter | the process that draws them, with the peak-to-peak read from the run's ring |
| enrich | what the ring says, added to the progress of a run |
| screen | two lines at the foot of a terminal |
| lines | plain lines, for anything else |
| json_lines | every event as a JSON line on stdout |
| keys | hold, stop, halt by a key |
"""
