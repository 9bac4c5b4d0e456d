"""The gear: the paper's equations, numpy only, no input or output."""
