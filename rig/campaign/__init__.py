"""Many procedures, one campaign: planned, ordered, run, written down, resumed."""
