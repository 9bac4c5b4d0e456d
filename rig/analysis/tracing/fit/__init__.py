"""The rig's equations as regressions, baseline and effects fitted together, and the search for which effects."""
