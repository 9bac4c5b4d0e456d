"""The paper's figures and tables drawn anew, as one page."""

from rig.report.reproduction.page import NAME, About, write
from rig.report.reproduction.text import told

__all__ = ["NAME", "About", "told", "write"]
