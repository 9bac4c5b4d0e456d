"""What a spring beyond the gear's own does, where it is: columns of the torsional mode; and what shakes a second mode,
and how it swings, of a housing as well."""
