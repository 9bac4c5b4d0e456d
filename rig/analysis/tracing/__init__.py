"""From measured runs to the effect the paper's model lacks."""
