"""The gear: the paper's equations, and the gear file that holds what was measured. Knows no run and no device."""
