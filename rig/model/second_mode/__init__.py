"""What a spring beyond the gear's own does, where it is: columns of the torsional mode."""
