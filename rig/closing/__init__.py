"""The loop closed: campaign, trace, the run it asks for, trace again, until nothing is missing or nobody can say."""
