"""A procedure's parameters: as somebody wrote them, and in words."""
