"""What may be said: every effect scored on runs the fit has not seen, rivals, and the run that would decide."""
