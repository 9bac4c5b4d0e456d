"""The text of a configuration file, whatever lies at its path."""

from __future__ import annotations

from pathlib import Path

from rig.core.errors import UsageError
from rig.core.regular import regular

LONGEST = 2**20  # bytes: the longest bench that ships has under 20 000


def load_text(path: Path) -> str:
    """The text of a configuration file, which is a regular file: a device or a pipe never ends. Raises UsageError."""
    try:
        if regular(path).st_size > LONGEST:
            raise UsageError(f"{path} is no text file of at most {LONGEST // 2**20} MiB; expected a TOML file")
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise UsageError(f"{path} is not UTF-8 text; expected a TOML file") from None
    except OSError as error:
        raise UsageError(f"cannot read {str(path)[:200]}: {error.strerror}") from None
    except ValueError:  # a zero byte, or half a character
        raise UsageError(f"{str(path)[:200]!a} is no name of a file") from None
