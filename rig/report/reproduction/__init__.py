"""The paper's figures and tables drawn anew, as one page."""

from rig.report.reproduction.page import NAME, write
from rig.report.reproduction.text import told

__all__ = ["NAME", "told", "write"]
