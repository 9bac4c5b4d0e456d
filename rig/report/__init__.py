"""Numbers to pages for people."""
