"""Blind test of the tracer."""
