"""What was found, as one value: errors before and after, free simulation, ripple, arrays for the page, trace.json."""
