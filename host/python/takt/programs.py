"""What becomes of a program before it runs."""

from __future__ import annotations

import json
from typing import Any

from ._job import Source
from .machine import MachineLike
from .simulation import command_words


def canon(program: Source, *, machine: MachineLike = None, **options: Any) -> list[str]:
    """The canonical moves, one a line, as ``takt canon`` prints them: ``LINE KIND X... Y... Z...``, mm and mm/min."""
    return command_words("canon", program, machine=machine, options=options).job().write().decode().splitlines()


def convert(program: Source, *, to: str = "linuxcnc", machine: MachineLike = None, **options: Any) -> str:
    """The canonical moves in the words of another controller, as ``takt convert`` writes them: no loops, no offsets."""
    return command_words("convert", program, machine=machine, options={"to": to, **options}).job().write().decode()


def plan(program: Source, *, machine: MachineLike = None, **options: Any) -> dict[str, Any]:
    """
    The planned blocks, as ``takt plan --json`` writes them: ``plan["blocks"]`` with lengths (mm), feeds (mm/min), what
    governs them and times (s), and ``plan["totals"]``.
    """
    words = command_words("plan", program, machine=machine, options=options)
    return dict(json.loads(words.job().write()))


def compile(program: Source, *, machine: MachineLike = None, ceiling: int | None = None, **options: Any) -> bytes:
    """
    Plans the motion ahead of the run, as ``takt compile`` does. The result goes into a file, or to :func:`run` as
    ``plan``. ceiling: highest feed override for its runs, 100 to 120 %.
    """
    words = command_words("compile", program, machine=machine, options={"ceiling": ceiling, **options})
    return words.job().write()
