"""Friction and inertia: friction runs, coast-down, torque steps, and what a data sheet lists of them."""
