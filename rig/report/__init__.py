"""Numbers to pages for people."""

import logging

logging.getLogger("matplotlib").setLevel(logging.ERROR)  # where it caches its fonts is no operator's business
