"""
takt-campaign SPEC.toml [-o FOLDER]         runs what is missing, writes results and report
takt-campaign compare BEFORE AFTER          what became worse; the smallest program that shows it
takt-campaign shrink SPEC.toml -o FOLDER NUMBER   a failing scenario, made small

Exit status: 0 nothing failed, or became worse; 1 something did; 2 the specification is wrong.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from .. import Library, load
from . import _needs  # noqa: F401  before what needs them
from .compare import Change, Judge, compare, difference_of, worse_of
from .engine import BATCH, Costs, run_missing
from .report import campaign_page, comparison_page, worst, write_runs
from .scenario import Scenario, execute, in_moves, is_bad
from .shrink import shrink
from .spec import SpecError, read
from .store import LIBRARY, Store, results

#: Failed scenarios whose files are written and whose lines are printed.
SHOWN = 20


def _parser(command: str) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="takt-campaign" if command == "run" else f"takt-campaign {command}",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    if command == "compare":
        parser.add_argument("before", type=Path)
        parser.add_argument("after", type=Path)
        parser.add_argument("--html", type=Path, help="write the comparison as a page")
        parser.add_argument("--same", action="store_true", help="every setpoint is to be as it was: any difference is worse")
        parser.add_argument("--shrink", type=int, default=1, metavar="N", help="shrink the first N (1)")
        return parser
    parser.add_argument("spec", type=Path)
    if command == "shrink":
        parser.add_argument("number", type=int, help="of the scenario in the results")
    parser.add_argument("-o", "--output", type=Path, help="folder (default: that of the specification, without .toml)")
    parser.add_argument("--library", help="another libtakt.so than the package's own; workers find it at this path too")
    if command == "run":
        parser.add_argument("--workers", type=int, default=os.cpu_count() or 1, help="local ones (one per processor)")
        parser.add_argument("--scheduler", help="address of a scheduler of Dask, such as tcp://host:8786")
        parser.add_argument("--batch", type=int, default=BATCH, help=f"scenarios of a task ({BATCH})")
        parser.add_argument("--no-report", action="store_true", help="no page, no reports of the worst")
    return parser


def _scenarios(spec: Path) -> dict[str, Scenario]:
    return {p.scenario.identity: p.scenario for p in read(spec)}


def _scenario_of(spec: Path, row: Mapping[str, Any]) -> Scenario:
    found = _scenarios(spec).get(row["identity"])
    if found is None:
        raise SpecError((), f"{spec} has changed: scenario {row['number']} is in it no more")
    return found


def _show_failed(
    folder: Path, bad: Sequence[Mapping[str, Any]], scenarios: Mapping[str, Scenario], library: Library
) -> dict[str, str]:
    """Prints the lines that repeat them; returns them by key."""
    lines: dict[str, str] = {}
    distinct = list({row["key"]: row for row in bad}.values())
    for row in distinct[:SHOWN]:
        lines[row["key"]] = scenarios[row["identity"]].write(folder / "failed" / row["key"][:16], library)
        print(f"failed: scenario {row['number']}: {row['failed'] or row['text']}\n  {lines[row['key']]}")
    if len(distinct) > SHOWN:
        print(f"{len(distinct) - SHOWN} more failed")
    return lines


def _tell_costs(costs: Costs) -> None:
    if costs.runs_s > 0:
        print(
            f"runs took {costs.runs_s:.1f} s of processor time, the engine {100 * costs.overhead:.1f} % more; "
            f"{costs.wall_s:.1f} s by the clock",
            file=sys.stderr,
        )


def _run(given: argparse.Namespace) -> int:
    planned = read(given.spec)
    folder = given.output or given.spec.with_suffix("")
    store = Store(folder)
    library = load(given.library)
    store.note(given.spec, library)
    costs = run_missing(
        store, [p.scenario for p in planned], scheduler=given.scheduler, workers=given.workers, batch=given.batch,
        library=given.library,
    )  # fmt: skip
    store.finish(planned, library.digest)
    _tell_costs(costs)
    rows = results(folder)
    bad = [r for r in rows if is_bad(r, r["has_faults"])]
    scenarios = {p.scenario.identity: p.scenario for p in planned}
    lines = _show_failed(folder, bad, scenarios, library)
    print(f"{len(rows)} scenarios, {len(bad)} failed: {folder / 'results.parquet'}")
    if not given.no_report:
        chosen = worst(rows)
        write_runs(folder, chosen, scenarios)
        (folder / "report.html").write_text(campaign_page(rows, chosen, lines, given.spec.stem), encoding="utf-8")
        print(folder / "report.html")
    return 1 if bad else 0


def _report_small(small: Scenario, folder: Path, library: Library) -> None:
    line = small.write(folder, library)
    print(f"shrunk to {len(small.program.splitlines())} lines of program:\n{small.program}  {line}")
    if small.faults:
        print(f"faults:\n{small.faults}", end="")


def _shrink(given: argparse.Namespace) -> int:
    folder = given.output or given.spec.with_suffix("")
    library = load(given.library)
    rows = results(folder)
    if not 0 <= given.number < len(rows):
        raise SpecError((), f"there is no scenario {given.number}: the last one is {len(rows) - 1}")
    row = rows[given.number]
    if not is_bad(row, row["has_faults"]):
        raise SpecError((), f"scenario {given.number} has not failed: {row['outcome']}")
    scenario = _scenario_of(given.spec, row)
    failed = set(row["failed"].split())

    def fails(s: Scenario) -> bool:
        found = execute(s, library)
        return found["outcome"] == row["outcome"] and failed <= set(found["failed"].split())

    _report_small(shrink(scenario, fails, moves=in_moves(scenario, library)), folder / "shrunk" / row["key"][:16], library)
    return 0


def _still_worse(change: Change, judge: Judge, libraries: Sequence[Library]) -> Callable[[Scenario], bool]:
    """The same thing as in the change became worse."""
    kind = change.worse[0].split()[0]

    def fails(s: Scenario) -> bool:
        old, new = (execute(s, library) for library in libraries)
        return any(what.startswith(kind) for what in judge(old, new, bool(s.faults)))

    return fails


def _compare(given: argparse.Namespace) -> int:
    judge = difference_of if given.same else worse_of
    changes, common = compare(given.before, given.after, judge)
    worse = [c for c in changes if c.worse]
    for c in worse[:SHOWN]:
        print(f"worse: scenario {c.after['number']} ({c.after['program']}): {'; '.join(c.worse)}")
    print(f"{common} scenarios in both, {len(changes)} differ, {len(worse)} became worse")
    if given.html is not None:
        page = comparison_page(changes, common, f"{given.before.name} and {given.after.name}")
        given.html.write_text(page, encoding="utf-8")
    for c in worse[: given.shrink]:
        libraries = [load(str(folder / LIBRARY)) for folder in (given.before, given.after)]
        spec = Path(json.loads((given.after / "campaign.json").read_text())["spec"])
        scenario = _scenario_of(spec, c.after)
        small = shrink(scenario, _still_worse(c, judge, libraries), moves=in_moves(scenario, libraries[1]))
        _report_small(small, given.after / "shrunk" / c.after["key"][:16], libraries[1])
    return 1 if worse else 0


def main(words: Sequence[str] | None = None) -> int:
    words = list(sys.argv[1:] if words is None else words)
    commands = {"run": _run, "compare": _compare, "shrink": _shrink}
    command = words.pop(0) if words and words[0] in commands else "run"
    try:
        return commands[command](_parser(command).parse_args(words))
    except (SpecError, OSError) as error:
        print(f"takt-campaign: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
