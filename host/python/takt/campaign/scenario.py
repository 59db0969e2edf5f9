"""A scenario: everything a run is made of, as plain texts, so that any worker anywhere repeats it."""

from __future__ import annotations

import functools
import hashlib
import json
import shlex
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

from .. import run
from .._library import Library
from ..errors import Error
from ..simulation import command_words


@functools.lru_cache(maxsize=1024)
def _digest(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "surrogateescape")).hexdigest()


@dataclass(frozen=True)
class Scenario:
    """
    The inputs of a run. ``program``, ``machine``, ``overrides`` and ``faults`` are texts; ``machine`` ``""`` is the
    built-in mill, ``sets`` assigns keys of it as ``--set`` does.
    """

    program: str
    machine: str = ""
    sets: tuple[str, ...] = ()
    overrides: str = ""
    faults: str = ""
    plan: str = "board"
    until: float = 0.0  #: s; 0: to the end
    tools: str = ""  #: a tool table, or ``auto``
    dialect: str = ""

    @functools.cached_property
    def identity(self) -> str:
        """SHA-256 of the inputs: the same scenario for every takt."""
        texts = [_digest(text) for text in (self.program, self.machine, self.overrides, self.faults, self.tools)]
        return _digest(json.dumps([*texts, self.sets, self.plan, self.until, self.dialect]))

    def key(self, takt_digest: str) -> str:
        """SHA-256 of the inputs and of takt: what a result is kept under."""
        return _digest(self.identity + takt_digest)

    def __reduce__(self) -> tuple[type[Scenario], tuple[Any, ...]]:
        return Scenario, tuple(getattr(self, f.name) for f in fields(self))

    def options(self) -> dict[str, Any]:
        """The arguments of :func:`takt.run`."""
        return {
            "program": self.program.encode("utf-8", "surrogateescape"),
            "machine": self.machine or None,
            "set": dict(s.split("=", 1) for s in self.sets),
            "overrides": self.overrides or None,
            "inject": self.faults or None,
            "plan": self.plan,
            "until": self.until or None,
            "tools": (self.tools if self.tools == "auto" else self.tools.encode("utf-8", "surrogateescape")) or None,
            "dialect": self.dialect or None,
        }

    def write(self, folder: Path, library: Library) -> str:
        """Its files; returns the one line of ``takt run`` that repeats it with this library."""
        folder.mkdir(parents=True, exist_ok=True)
        tables = "" if self.tools == "auto" else self.tools
        files = {
            "program.ngc": self.program, "machine.ini": self.machine, "override": self.overrides, "inject": self.faults,
            "tools.tbl": tables,
        }  # fmt: skip
        for name, text in files.items():
            if text:
                (folder / name).write_text(text, encoding="utf-8", errors="surrogateescape")
        here = [] if library.is_own else ["env", f"TAKT_LIBRARY={library.path}"]
        words = [*here, sys.executable, "-m", "takt", "run", str(folder / "program.ngc")]
        named = {"--machine": "machine.ini", "--override": "override", "--inject": "inject", "--tools": "tools.tbl"}
        for option, name in named.items():
            if files[name]:
                words += [option, str(folder / name)]
        for s in self.sets:
            words += ["--set", s]
        if self.plan == "exact":
            words.append("--exact-path")
        elif self.plan != "board":
            words += ["--plan", self.plan]
        if self.until:
            words += ["--until", repr(self.until)]
        if self.tools == "auto":
            words += ["--tools", "auto"]
        if self.dialect:
            words += ["--dialect", self.dialect]
        return shlex.join(words)


#: What a row says of a run: columns of results.parquet, with the type of each.
FIGURES: dict[str, type] = {
    "outcome": str,  # of the summary, or refused, crashed
    "status": int,
    "digest": str,
    "text": str,  # of the fault or the error
    "failed": str,  # names of checks, separated by blanks
    "program_time_s": float,
    "path_length_mm": float,
    "velocity_ratio": float,  # largest of all axes over the limit
    "acceleration_ratio": float,
    "jerk_ratio": float,
    "following_error_mm": float,
    "path_error_mm": float,
    "landing_error_mm": float,
    "bus_load_percent": float,
    "bus_response_percent": float,  # nearest to the predicted bound
}

Row = dict[str, Any]


def _nothing() -> Row:
    return {name: kind() for name, kind in FIGURES.items()}


def _response_percent(bus: Mapping[str, Any]) -> float:
    shares = [
        100.0 * r["observed_us"] / r["predicted_us"]
        for r in bus["responses"]
        if r["observed_us"] is not None and r["predicted_us"]
    ]
    return max(shares, default=0.0)


def execute(scenario: Scenario, library: Library | None = None) -> Row:
    """Runs it. Wrong input is an outcome: ``refused``."""
    try:
        result = run(trace=False, library=library, **scenario.options())
    except Error as error:
        return {**_nothing(), "outcome": "refused", "status": error.status, "text": str(error)}
    s = result.summary
    buses = [s.raw[name] for name in ("bus", "can1") if name in s.raw]
    ratio = {
        kind: max((getattr(a, f"max_{kind}") / getattr(a, f"limit_{kind}") for a in s.axes), default=0.0)
        for kind in ("velocity", "acceleration", "jerk")
    }
    return {
        **_nothing(),
        "outcome": s.outcome,
        "status": s.exit_status,
        "digest": s.setpoint_digest,
        "text": s.fault or "",
        "failed": " ".join(result.failed()),
        "program_time_s": s.program_time_s,
        "path_length_mm": s.path_length_mm,
        **{f"{kind}_ratio": value for kind, value in ratio.items()},
        "following_error_mm": max((a.max_following_error for a in s.axes), default=0.0),
        "path_error_mm": s.path_error_max_mm,
        "landing_error_mm": s.landing_error_max_mm,
        "bus_load_percent": max(bus["load_percent"] for bus in buses),
        "bus_response_percent": max(_response_percent(bus) for bus in buses),
    }


def crashed(text: str) -> Row:
    """Of a scenario that has ended its worker."""
    return {**_nothing(), "outcome": "crashed", "status": 3, "text": text}


#: Checks that may fail where faults are injected: a drive may fault, and be left behind.
OF_FAULTS = ("fault", "following")


def is_bad(row: Mapping[str, Any], has_faults: bool) -> bool:
    """A limit or promise is broken, or nothing could be run."""
    if row["outcome"] in ("refused", "crashed"):
        return True
    failed = row["failed"].split()
    return any(not has_faults or name.split(".")[0] not in OF_FAULTS for name in failed)


@dataclass(frozen=True)
class Timed:
    """Rows of a batch, by the identity of their scenarios, and what they cost."""

    rows: dict[str, Row]
    runs_s: float  #: processor time inside of runs
    worker_s: float  #: processor time of the worker so far
    worker: str


def execute_batch(batch: list[Scenario], takt_digest: str, library_path: str | None) -> Timed:
    """What a worker does."""
    import os
    import socket

    from .. import load

    library = load(library_path)
    if library.digest != takt_digest:
        raise RuntimeError(f"the worker has another takt: {library.digest[:16]}, not {takt_digest[:16]}")
    begin = time.thread_time()
    rows = {s.identity: execute(s, library) for s in batch}
    spent = time.thread_time() - begin
    return Timed(rows, spent, time.process_time(), f"{socket.gethostname()}:{os.getpid()}")


def in_moves(scenario: Scenario, library: Library | None = None) -> Scenario:
    """The same with its program as plain moves, without loops and offsets; itself where it cannot be written so."""
    given = scenario.options()
    options = {key: given[key] for key in ("set", "tools", "dialect")}
    words = command_words("convert", given["program"], machine=given["machine"], options={"to": "linuxcnc", **options})
    try:
        program = words.job(library).write()
    except Error:
        return scenario
    return replace(scenario, program=program.decode("utf-8", "surrogateescape"), dialect="linuxcnc")


def without_lines(scenario: Scenario, part: str, kept: list[str]) -> Scenario:
    """The scenario with other lines in ``program``, ``overrides`` or ``faults``."""
    changed: dict[str, Any] = {part: "".join(line + "\n" for line in kept)}
    return replace(scenario, **changed)
