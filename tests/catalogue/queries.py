"""The queries of rig/catalogue/QUERIES.md, as they stand there."""

from __future__ import annotations

import re
from pathlib import Path

PAGE = Path(__file__).parents[2] / "rig" / "catalogue" / "QUERIES.md"


def queries(root: Path) -> dict[str, str]:
    """By the heading each stands under; the views first, under the same one. `root` takes the place of `runs`."""
    found: dict[str, str] = {}
    for part in PAGE.read_text("utf-8").split("\n## ")[1:]:
        heading, _, text = part.partition("\n")
        for k, sql in enumerate(re.findall(r"```sql\n(.*?)```", text, re.DOTALL)):
            found[f"{heading} ({k + 1})"] = sql.replace("'runs/", f"'{root}/")
    return found
