"""Whether the motor turned evenly enough for a slow run to mean what it says: sticking, speed scatter, hunting."""
