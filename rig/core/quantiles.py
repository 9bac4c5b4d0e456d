"""Quantiles that intervals are made with."""

from __future__ import annotations

from typing import Final

Z95: Final = 1.959964  # of the normal distribution, two-sided 95 %: from one standard uncertainty to the half width
