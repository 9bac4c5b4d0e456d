"""A bench by its name or path, with the changes a person makes to it, read and checked."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from rig.bench.assignments import override
from rig.bench.bench import Bench
from rig.bench.devices import ROLES
from rig.config.bench_file import read_bench
from rig.config.text_file import load_text
from rig.config.together import check_keys, check_together
from rig.core.errors import UsageError
from rig.core.nearest import nearest

BENCHES = Path(__file__).parents[1] / "benches"  # benches that ship with hdrig


def shipped() -> list[str]:
    """Names of the benches that ship."""
    return sorted(path.stem for path in BENCHES.glob("*.toml"))


def read(source: str, overrides: Iterable[str] = ()) -> Bench:
    """The bench called `source` (a file, or the name of one that ships), with `key=value` overrides.

    Raises UsageError: no such bench, an override that fits nothing, a key or value that is wrong.
    """
    path = Path(source) if source.endswith(".toml") or "/" in source else BENCHES / f"{source}.toml"
    if path.parent == BENCHES and source not in (known := shipped()):
        raise UsageError(f"no bench called '{source}'; {nearest(source, known)}; or give the path of a .toml file")
    text = load_text(path)
    assignments, blamed = list(overrides), str(path)
    if assignments:
        read_bench(text, str(path))  # what is wrong in the file itself is said first
        text = override(text, assignments, str(path))
        blamed = f"{' '.join(f'--set {one}' for one in assignments)} in {path}"
    bench = Bench(read_bench(text, blamed), text, str(path))
    check_together(blamed, bench.file)
    for role in ROLES:
        if (made := bench.device(role)) is not None:
            check_keys(bench.source, role, getattr(bench.file.devices, role), getattr(made, "keys", ()))
    return bench
