"""What may be said: every effect weighed on runs the fit has not seen, rivals, and the run that would decide."""
