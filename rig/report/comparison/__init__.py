"""Pages of the catalogue: runs side by side with their waveforms, and one figure over time."""
