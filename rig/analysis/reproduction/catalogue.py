"""Every figure and table that is drawn anew, in the order of the paper."""

from __future__ import annotations

from rig.analysis.reproduction import (
    figure_2,
    figure_3,
    figure_6,
    figure_7,
    figure_9,
    figure_10,
    figure_11,
    figure_13,
    table_1,
    table_2,
)
from rig.analysis.reproduction.campaign import Campaign
from rig.analysis.reproduction.exhibit import Exhibit


def exhibits(campaign: Campaign) -> tuple[Exhibit, ...]:
    """Figures first, then the tables."""
    return (
        figure_2.figure(campaign),
        figure_3.figure(campaign),
        figure_6.figure(campaign),
        figure_7.figure_a(campaign),
        figure_7.figure_b(campaign),
        figure_7.figure_c(campaign),
        figure_9.figure(campaign),
        figure_10.figure(campaign),
        *figure_11.figures(campaign),
        figure_13.figure(campaign),
        table_1.table(campaign),
        table_2.table(campaign),
    )
