"""Runs to numbers. Knows the model and the run folder, never a device."""
