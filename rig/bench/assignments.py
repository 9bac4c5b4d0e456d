"""`key=value` assignments made in the text of a bench file."""

from __future__ import annotations

import tomllib
from typing import Any

from rig.core.errors import UsageError
from rig.core.nearest import nearest

OF_MANIFESTS = {
    "gear.ratio": "manifests and mappings write gear.ratio, a bench file gear.N: did you mean 'gear.N'?"
}  # keys of run folders that people know, and what a bench file has for them


def override(text: str, assignments: list[str], source: str, origin: str = "declared") -> str:
    """The TOML `text` with `a.b=value` assignments made, said to be from `origin`; comments and the rest stay."""
    if not assignments:
        return text
    import tomlkit

    document = tomlkit.parse(text)

    def keys(at: Any) -> list[str]:
        return [str(key) for key in at] if isinstance(at, dict) else []

    made: dict[str, str] = {}
    for assignment in assignments:
        key, equals, value = assignment.partition("=")
        if not equals:
            raise UsageError(f"--set {assignment}: expected key=value, for example control.Kp=5")
        if made.setdefault(key.strip(), value.strip()) != value.strip():
            raise UsageError(f"--set {assignment}: {key.strip()} was set to {made[key.strip()]} before; expected once")
        at: Any = document
        *path, last = key.strip().split(".")
        for part in path:
            if not isinstance(at, dict) or part not in at:
                raise UsageError(f"--set {assignment}: no section '{part}' in {source}; {nearest(part, keys(at))}")
            at = at[part]
        if not isinstance(at, dict) or last not in at:
            hint = OF_MANIFESTS.get(key.strip()) or nearest(last, keys(at))
            raise UsageError(f"--set {assignment}: no key '{key.strip()}' in {source}; {hint}")
        parsed = toml_value(value)
        if isinstance(at[last], dict) and "value" in at[last]:
            at[last]["value"], at[last]["from"] = parsed, origin
        else:
            at[last] = parsed
    return tomlkit.dumps(document)


def toml_value(text: str) -> Any:
    """A value as TOML writes it; what is no TOML value is taken as a string."""
    try:
        return tomllib.loads(f"x = {text}")["x"]
    except (ValueError, RecursionError):
        return text.strip()
