"""
The folder of a campaign:

    parts/*.parquet     rows as they came, written aside and renamed: a kill at any time leaves whole ones
    results.parquet     one row per scenario in the order of the specification: equal bytes however they were computed
    campaign.json       what was run
    libtakt.so          and by which takt: a later one takes its place in the package
    failed/KEY/         the files of scenarios that failed
    reports/KEY.html    the reports of the worst ones
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from .._library import Library
from .scenario import FIGURES, Row
from .spec import Planned

LIBRARY = "libtakt.so"
_TYPES = {str: pa.string(), int: pa.int64(), float: pa.float64()}
PART = pa.schema([("key", pa.string()), *((name, _TYPES[kind]) for name, kind in FIGURES.items())])
LABELS = ("program", "machine", "overrides", "faults", "plan")
RESULTS = pa.schema(
    [
        ("number", pa.int64()),
        *((name, pa.string()) for name in LABELS),
        ("seed", pa.int64()),
        ("variables", pa.string()),
        ("has_faults", pa.bool_()),
        ("identity", pa.string()),
        *PART,
    ]
)


def _write(table: pa.Table, path: Path) -> None:
    aside = path.with_name(f"{path.name}.{os.getpid()}")
    pq.write_table(table, aside, compression="zstd")
    os.replace(aside, path)


class Store:
    """Rows by key, on disk."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.parts = folder / "parts"
        self.parts.mkdir(parents=True, exist_ok=True)
        self.rows: dict[str, Row] = {}
        for path in sorted(self.parts.iterdir()):
            self._read(path)

    def _read(self, path: Path) -> None:
        """What a kill or a power cut has left half is done again."""
        try:
            table = pq.read_table(path, schema=PART) if path.suffix == ".parquet" else None
        except (pa.ArrowException, OSError):
            table = None
        if table is None:
            path.unlink()
            return
        for row in table.to_pylist():
            self.rows[row.pop("key")] = row

    def add(self, rows: Mapping[str, Row]) -> None:
        """Kept from now on."""
        new = {key: row for key, row in rows.items() if key not in self.rows}
        if not new:
            return
        name = hashlib.sha256(" ".join(sorted(new)).encode()).hexdigest()[:32]
        table = pa.Table.from_pylist([{"key": k, **new[k]} for k in sorted(new)], schema=PART)
        _write(table, self.parts / f"{name}.parquet")
        self.rows.update(new)

    def finish(self, planned: Iterable[Planned], takt_digest: str) -> pa.Table:
        """Writes results.parquet."""
        rows = []
        for number, p in enumerate(planned):
            key = p.scenario.key(takt_digest)
            labels = {name: getattr(p.labels, name) for name in LABELS}
            variables = json.dumps(dict(p.labels.variables), sort_keys=True)
            rows.append(
                {
                    "number": number, **labels, "seed": p.labels.seed, "variables": variables,
                    "has_faults": bool(p.scenario.faults),
                    "identity": p.scenario.identity, "key": key, **self.rows[key],
                }
            )  # fmt: skip
        table = pa.Table.from_pylist(rows, schema=RESULTS)
        _write(table, self.folder / "results.parquet")
        return table

    def note(self, spec: Path, library: Library) -> None:
        """Writes campaign.json and libtakt.so."""
        what = {"spec": str(spec.resolve()), "takt": library.digest, "library": str(library.path)}
        aside = self.folder / "campaign.json.new"
        aside.write_text(json.dumps(what, indent=2) + "\n", encoding="utf-8")
        os.replace(aside, self.folder / "campaign.json")
        copy = self.folder / LIBRARY
        if not copy.exists() or copy.resolve() != library.path:
            shutil.copyfile(library.path, aside)
            os.replace(aside, copy)


def results(folder: Path) -> list[dict[str, Any]]:
    """The rows of a finished campaign."""
    path = folder / "results.parquet"
    if not path.exists():
        raise FileNotFoundError(f"{folder} is no folder of a campaign that has ended: {path} is missing")
    return list(pq.read_table(path).to_pylist())
