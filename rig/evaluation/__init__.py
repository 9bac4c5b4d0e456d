"""From run folders to what they say, kept beside them: one run, a sweep, the gear of a campaign. Prints nothing.

| module | one idea |
|---|---|
| run | one run: figures, verdict, result.json, report.html |
| reference | the slow run that a run is analysed with |
| identification | all runs of one gear to a gear file |
| sweep | a campaign of loads or depths as one result |
| afterwards | which of these follows the last run of a campaign |
| trace | what the model lacks by the runs of a campaign |
| step_test | inertia and friction from recorded torque steps |
| traceback_file | where an analysis broke off |

`python -m rig.evaluation run|campaign FOLDER` makes them in a process of its own.
"""
