"""The page of a closed loop: what each round found, what it asked for, and what that changed."""
