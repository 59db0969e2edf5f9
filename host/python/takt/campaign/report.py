"""One HTML page of a campaign, or of the comparison of two: complete in itself, drawn with the library of the run reports."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from .. import load, run
from .._library import ffi
from .compare import Change
from .scenario import Scenario, is_bad

BINS = 60
WORST = 5
TABLE_MAX = 200

Rows = Sequence[Mapping[str, Any]]


def _plotting() -> str:
    length = ffi.new("size_t *")
    script = load().functions.takt_get_plotting(length)
    return bytes(ffi.buffer(script, length[0])).decode()


def _page(data: Mapping[str, Any]) -> str:
    page = (Path(__file__).parent / "page.html").read_text(encoding="utf-8")
    head, rest = page.split("{{PLOTLY}}")
    middle, end = rest.split("{{DATA}}")
    return head + _plotting() + middle + json.dumps(data).replace("<", "\\u003c") + end


def _bars(values: Sequence[float], name: str) -> dict[str, Any]:
    """A histogram, counted here: the page has no need of every value."""
    low, high = min(values), max(values)
    width = (high - low) / BINS or 1.0
    counts = Counter(min(BINS - 1, int((v - low) / width)) for v in values)
    places = sorted(counts)
    return {
        "type": "bar", "name": name, "x": [low + (i + 0.5) * width for i in places], "width": width,
        "y": [counts[i] for i in places], "opacity": 0.75,
    }  # fmt: skip


def _histogram(title: str, x: str, columns: Mapping[str, Sequence[float]]) -> dict[str, Any]:
    traces = [_bars(values, name) for name, values in columns.items() if values]
    return {"title": title, "x": x, "y": "scenarios", "traces": traces}


def _plots(rows: Rows) -> list[dict[str, Any]]:
    ran = [r for r in rows if r["outcome"] not in ("refused", "crashed")]

    def column(name: str, scale: float = 1.0) -> list[float]:
        return [scale * r[name] for r in ran]

    programs = sorted({r["program"] for r in ran})
    times = {p: [r["program_time_s"] for r in ran if r["program"] == p] for p in programs[:8]}
    limits = {kind: column(f"{kind}_ratio", 100) for kind in ("velocity", "acceleration", "jerk")}
    return [
        _histogram("Time of the program", "s", times),
        _histogram("Limits used: the axis nearest to its own", "% of the limit", limits),
        _histogram("Following error, largest", "mm", {"following error": column("following_error_mm")}),
        _histogram("Bus response, nearest to its bound", "% of the predicted", {"response": column("bus_response_percent")}),
        _histogram("Bus load", "%", {"load": column("bus_load_percent")}),
    ]


def _named(row: Mapping[str, Any]) -> list[Any]:
    return [row[name] for name in ("number", "program", "machine", "overrides", "faults", "plan", "seed", "variables")]


COLUMNS = ["scenario", "program", "machine", "overrides", "faults", "plan", "seed", "variables"]


def worst(rows: Rows) -> list[Mapping[str, Any]]:
    """The longest, those nearest to a limit, with the largest following error and bus response."""
    ran = [r for r in rows if r["outcome"] not in ("refused", "crashed")]
    names = ("program_time_s", "velocity_ratio", "acceleration_ratio", "jerk_ratio", "following_error_mm", "bus_response_percent")
    found = {r["key"]: r for name in names for r in sorted(ran, key=lambda r, n=name: -r[n])[:1]}  # type: ignore[misc]
    bad = [r for r in ran if is_bad(r, r["has_faults"])][:WORST]
    return [*bad, *(r for key, r in found.items() if key not in {b["key"] for b in bad})]


def write_runs(folder: Path, chosen: Rows, scenarios: Mapping[str, Scenario]) -> None:
    """Their reports, made by running them once more."""
    (folder / "reports").mkdir(exist_ok=True)
    for row in chosen:
        path = folder / "reports" / f"{row['key'][:16]}.html"
        if not path.exists():
            options = scenarios[row["identity"]].options()
            path.write_text(str(run(trace=False, report=True, **options).report), encoding="utf-8")


def campaign_page(rows: Rows, chosen: Rows, lines: Mapping[str, str], name: str) -> str:
    """chosen: those with a report; lines: of failed ones, by key, what repeats them."""
    bad = [r for r in rows if is_bad(r, r["has_faults"])]
    outcomes = Counter((r["faults"], r["outcome"]) for r in rows)
    tables = [
        {
            "title": "Outcomes by faults",
            "columns": ["faults", "outcome", "scenarios"],
            "rows": [[f, o, n] for (f, o), n in sorted(outcomes.items())],
        },
        {
            "title": "Failed",
            "columns": [*COLUMNS, "why", "repeated by"],
            "rows": [
                [*_named(r), r["failed"] or r["text"], {"code": lines.get(r["key"], "")}] for r in bad[:TABLE_MAX]
            ],
        },
        {
            "title": "Worst",
            "columns": [*COLUMNS, "time [s]", "v / a / j [% of limit]", "following error [mm]", "report"],
            "rows": [
                [
                    *_named(r), round(r["program_time_s"], 3),
                    " / ".join(f"{100 * r[f'{k}_ratio']:.2f}" for k in ("velocity", "acceleration", "jerk")),
                    round(r["following_error_mm"], 6), {"text": "report", "href": f"reports/{r['key'][:16]}.html"},
                ]
                for r in chosen
            ],
        },
    ]  # fmt: skip
    lead = f"{len(rows)} scenarios, {len(bad)} failed"
    return _page({"title": f"Campaign {name}", "lead": lead, "good": not bad, "tables": tables, "plots": _plots(rows)})


def comparison_page(changes: Sequence[Change], common: int, name: str) -> str:
    worse = [c for c in changes if c.worse]
    times = [(c.before["program_time_s"], c.after["program_time_s"]) for c in changes]
    scatter = {
        "title": "Time of the scenarios that differ", "x": "before [s]", "y": "after [s]",
        "traces": [{"type": "scatter", "mode": "markers", "x": [t[0] for t in times], "y": [t[1] for t in times]}],
    }  # fmt: skip
    rows = [[*_named(c.after), "; ".join(c.worse)] for c in worse[:TABLE_MAX]]
    lead = f"{common} scenarios in both, {len(changes)} differ, {len(worse)} became worse"
    table = {"title": "Became worse", "columns": [*COLUMNS, "what"], "rows": rows}
    return _page({"title": f"Comparison {name}", "lead": lead, "good": not worse, "tables": [table], "plots": [scatter]})
