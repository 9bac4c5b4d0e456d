"""A peer in a process of its own, with its own environment: asked over stdin, answers one line of JSON."""

from __future__ import annotations

import json
import os
import subprocess
from typing import Any

from tests.bench.built import HERE, Unavailable, peers


class Worker:
    """`peers/<script>.py`, which reads one JSON line a question. Use as a context manager. Raises Unavailable."""

    def __init__(self, script: str, *args: str) -> None:
        python, words = peers()
        environment = os.environ | {
            "OPENBLAS_NUM_THREADS": "1",
            "PYTHONPATH": str(HERE.parents[1]),
            "JAX_PLATFORMS": "cpu",
        }
        self.script = script
        if not python.exists():
            raise Unavailable(f"{script}: {words}")
        self._process = subprocess.Popen(
            [str(python), str(HERE / "peers" / f"{script}.py"), *args],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env=environment,
        )

    def __enter__(self) -> Worker:
        return self

    def __exit__(self, *error: object) -> None:
        assert self._process.stdin is not None
        self._process.stdin.close()
        self._process.wait()

    def ask(self, **question: Any) -> dict[str, Any]:
        """One question, one answer. Raises Unavailable with the peer's last words when it died."""
        process = self._process
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stderr is not None
        try:
            process.stdin.write(json.dumps(question) + "\n")
            process.stdin.flush()
        except BrokenPipeError:
            pass
        line = process.stdout.readline()
        if not line:
            last = (process.stderr.read().strip().splitlines() or ["no word"])[-1]
            raise Unavailable(f"{self.script}: {last}")
        answer: dict[str, Any] = json.loads(line)
        return answer
