"""From run folders to what they say, kept beside them: one run, a sweep, the gear of a campaign, what its model lacks.
Prints nothing. Each module says at its top what it is for.

`python -m rig.evaluation run|campaign FOLDER` makes them in a process of its own.
"""
