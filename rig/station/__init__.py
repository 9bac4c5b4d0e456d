"""The control process: holds one session, takes acts from whoever serves the page, tells what happens. No web in it."""
