"""Makes a failing scenario small: the fewest lines of program, of faults and of overrides that still fail."""

from __future__ import annotations

from collections.abc import Callable

from .scenario import Scenario, without_lines

Fails = Callable[[Scenario], bool]

#: Runs that shrinking may take.
RUNS_MAX = 2000


class _Budget:
    def __init__(self, fails: Fails, runs: int) -> None:
        self.fails, self.left = fails, runs

    def __call__(self, scenario: Scenario) -> bool:
        if self.left <= 0:
            return False
        self.left -= 1
        return self.fails(scenario)


def _fewest(lines: list[str], fails: Callable[[list[str]], bool]) -> list[str]:
    """Delta debugging: leaves out ever smaller pieces as long as it still fails (Zeller and Hildebrandt 2002)."""
    size = max(1, len(lines) // 2)
    while True:
        i, left_out = 0, False
        while i < len(lines):
            fewer = lines[:i] + lines[i + size :]
            if fails(fewer):
                lines, left_out = fewer, True
            else:
                i += size
        if size == 1 and not left_out:
            return lines
        size = max(1, size // 2) if not left_out or size > 1 else 1


def shrink(scenario: Scenario, fails: Fails, runs: int = RUNS_MAX, moves: Scenario | None = None) -> Scenario:
    """
    The smallest found that ``fails``; the given one if it does not. moves: the same in plain moves, each of which can be
    left out: where it fails too, it is what is made small.
    """
    asked = _Budget(fails, runs)
    if not asked(scenario):
        return scenario
    if moves is not None and asked(moves):
        scenario = moves
    before = None
    while before != scenario and asked.left > 0:
        before = scenario
        for part in ("faults", "overrides", "program"):
            current = scenario
            lines = [line for line in getattr(current, part).splitlines()]
            if lines:
                kept = _fewest(lines, lambda some, p=part, c=current: asked(without_lines(c, p, some)))  # type: ignore[misc]
                scenario = without_lines(scenario, part, kept)
    return scenario
