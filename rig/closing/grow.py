"""A campaign that grows: runs put behind those it was planned with, in its items and in its book."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from rig.campaign.journal import Journal, entry_of, refuse_other_runs
from rig.campaign.planner import Campaign
from rig.campaign.steps import Item
from rig.closing.advice import from_text
from rig.closing.story import Story


def grown(campaign: Campaign, journal: Journal, items: Sequence[Item], why: str) -> Campaign:
    """With `items` at its end; the book knows them, and why, when this returns. Raises RecorderError."""
    journal.book["runs"] += [entry_of(item.record()) for item in items]
    journal.tell(f"runs {len(campaign.items) + 1} to {len(campaign.items) + len(items)} were added: {why}")
    return replace(campaign, items=(*campaign.items, *items))


def regrown(campaign: Campaign, journal: Journal, story: Story) -> Campaign:
    """The campaign as the rounds of `story` had made it, from the plan it began with; the book is made to know it all.

    Raises UsageError when it knows other runs, RecorderError when it cannot be written.
    """
    for round in story.rounds:
        if round.plan:
            items = from_text(round.plan, campaign).items
            known = len(journal.book["runs"]) > len(campaign.items)
            campaign = (
                replace(campaign, items=(*campaign.items, *items))
                if known
                else grown(campaign, journal, items, "asked for before it was stopped")
            )
    refuse_other_runs(journal, campaign)
    return campaign
