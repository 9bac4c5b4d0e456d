"""What is shown of a run while it goes on: read from its ring, never in its way."""
