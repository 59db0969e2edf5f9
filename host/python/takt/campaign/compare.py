"""Two campaigns of the same scenarios, before and after a change: what became worse."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .scenario import is_bad
from .store import results

#: A program takes longer when it does by more than this part.
TIME_PART = 1e-3
#: A limit is used more when it is by more than this part of it, and is nearly reached.
LIMIT_PART = 1e-3
LIMIT_NEAR = 1 - 1e-3
#: Rows before and after, and whether the scenario has faults.
Judge = Callable[[Mapping[str, Any], Mapping[str, Any], bool], tuple[str, ...]]
#: An error is larger when it is by more than this part of it, and by more than a thousandth of a millimetre.
ERROR_PART = 0.1
ERROR_MM = 1e-3
ERRORS = ("following_error_mm", "path_error_mm", "landing_error_mm")
RATIOS = ("velocity_ratio", "acceleration_ratio", "jerk_ratio")


@dataclass(frozen=True)
class Change:
    """A scenario that differs."""

    before: Mapping[str, Any]
    after: Mapping[str, Any]
    worse: tuple[str, ...]  #: what became worse; empty: it is only different


def worse_of(before: Mapping[str, Any], after: Mapping[str, Any], has_faults: bool) -> tuple[str, ...]:
    """What became worse of a scenario. The first word says of which kind it is."""
    if is_bad(after, has_faults) and not is_bad(before, has_faults):
        return (f"fails: {after['failed'] or after['text']}",)
    if is_bad(before, has_faults):
        return ()
    said = []
    if before["outcome"] == "completed" != after["outcome"]:
        said.append(f"{after['outcome']}: {after['text']}")
    elif after["program_time_s"] > before["program_time_s"] * (1 + TIME_PART):
        said.append(f"takes {after['program_time_s']:.3f} s instead of {before['program_time_s']:.3f} s")
    for name in RATIOS:
        if after[name] > max(before[name] + LIMIT_PART, LIMIT_NEAR + LIMIT_PART):
            said.append(f"{name.replace('_ratio', '')} {100 * after[name]:.2f} % of the limit")
    for name in ERRORS:
        if after[name] > before[name] * (1 + ERROR_PART) + ERROR_MM:
            said.append(f"{name[:-3].replace('_', ' ')} {after[name]:.6f} mm instead of {before[name]:.6f} mm")
    return tuple(said)


def difference_of(before: Mapping[str, Any], after: Mapping[str, Any], has_faults: bool) -> tuple[str, ...]:
    """What became worse, else that it is not the same: of a change that is to leave every setpoint as it was."""
    differs = before["digest"] != after["digest"] or before["outcome"] != after["outcome"]
    return worse_of(before, after, has_faults) or (("differs: other setpoints",) if differs else ())


def compare(before: Path, after: Path, judge: Judge = worse_of) -> tuple[list[Change], int]:
    """All scenarios that differ, the worse ones first; and how many both campaigns have."""
    old = {row["identity"]: row for row in results(before)}
    common = [(old[row["identity"]], row) for row in results(after) if row["identity"] in old]
    changes = [
        Change(b, a, judge(b, a, a["has_faults"]))
        for b, a in common
        if b["digest"] != a["digest"] or b["outcome"] != a["outcome"] or b["failed"] != a["failed"]
    ]
    return sorted(changes, key=lambda c: not c.worse), len(common)
