"""What only several runs say together: sweeps of load and depth, sentinels, encoder zeros, compensation."""
