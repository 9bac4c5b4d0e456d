"""What is left, and the coordinate it lives in."""
