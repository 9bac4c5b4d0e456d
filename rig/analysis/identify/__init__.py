"""Identification: runs of a campaign to the parameters of equations 6-8, with intervals, and what stays undecided.

Nothing is imported here: an analysis that needs only the friction of one run would pay for the simulation too.
"""
