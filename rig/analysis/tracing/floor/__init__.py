"""What no model has to explain: how repeats differ, a line beside the motion, what every run has to itself."""
