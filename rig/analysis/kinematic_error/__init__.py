"""The kinematic error of one run: profile over a turn of the wave generator, its trend, and both in words."""
