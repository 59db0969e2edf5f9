"""What a run comes to."""

from __future__ import annotations

import html
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np
import numpy.typing as npt

from ._job import Job
from ._library import ffi
from .errors import ChecksFailed, Message

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Check:
    """A limit, and what the run did of it."""

    name: str
    held: bool  #: ``value <= limit``
    value: float
    limit: float


@dataclass(frozen=True)
class AxisSummary:
    """Peaks of an axis over all setpoints sent, by differences. mm; of rotary axes degrees."""

    name: str
    max_velocity: float  #: mm/s
    max_acceleration: float  #: mm/s^2
    max_jerk: float  #: mm/s^3
    limit_velocity: float
    limit_acceleration: float
    limit_jerk: float
    max_following_error: float  #: mm


def _axis(json_axis: Mapping[str, Any]) -> AxisSummary:
    values = {}
    for key, value in json_axis.items():
        for f in fields(AxisSummary):
            if key == f.name or key.startswith((f.name + "_mm", f.name + "_deg")):
                values[f.name] = value
    return AxisSummary(**values)


@dataclass(frozen=True)
class Summary:
    """The summary of ``takt run --json``; ``raw`` is all of it, as ``host/results/summary.schema.json`` describes."""

    program: str
    machine: str
    outcome: str  #: ``completed``, ``stopped``, ``faulted`` or ``interrupted``
    fault: str | None
    exit_status: int
    blocks: int
    cycles: int
    cycle_time_s: float
    program_time_s: float
    wall_time_s: float = field(compare=False)
    realtime_ratio: float = field(compare=False)
    path_length_mm: float
    chord_error_max_mm: float
    path_error_max_mm: float
    landing_error_max_mm: float
    setpoint_digest: str
    axes: tuple[AxisSummary, ...] = field(repr=False)
    raw: Mapping[str, Any] = field(repr=False, compare=False)

    @classmethod
    def of(cls, raw: Mapping[str, Any]) -> Summary:
        taken = {f.name: raw[f.name] for f in fields(cls) if f.name not in ("axes", "raw")}
        return cls(axes=tuple(_axis(a) for a in raw["axes"]), raw=raw, **taken)


class Trace(Mapping[str, Array]):
    """
    The columns of ``takt run --trace``: each an array of float64, shape ``(cycles,)``, one value per control cycle.

    ``cycle`` counts from 0; ``time_s``; ``block`` and ``line`` of the program; ``feed_mm_min``; ``override_percent``;
    ``limiter`` (1: not acting); of every axis ``cmd_X_mm`` (before correction), ``set_X_mm`` (sent to the drives) and
    ``act_X_mm`` (last reported), of rotary axes ``..._deg``; ``spindle_rev``. The arrays are the library's own memory:
    nothing is copied.
    """

    def __init__(self, columns: dict[str, Array], cycle_s: float) -> None:
        self._columns = columns
        self.cycle_s = cycle_s  #: length of a control cycle, s

    def __getitem__(self, name: str) -> Array:
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __repr__(self) -> str:
        return f"<takt.Trace {len(self['cycle'])} cycles of {self.cycle_s * 1e3:g} ms: {', '.join(self)}>"

    def axis(self, letter: str, kind: str = "set") -> Array:
        """``set``, ``cmd`` or ``act`` of an axis, mm or degrees, shape ``(cycles,)``."""
        return self[f"{kind}_{letter}_{'mm' if letter in 'XYZ' else 'deg'}"]

    def differences(self, letter: str, order: int) -> Array:
        """
        Velocity (``order`` 1), acceleration (2) or jerk (3) of the setpoints of an axis, as the judge takes them: by
        differences over one cycle from rest, shape ``(cycles,)``, mm or degrees per s, s^2, s^3.
        """
        x = self.axis(letter)
        if order < 1:
            raise ValueError(f"order {order}: 1 is velocity, 2 acceleration, 3 jerk")
        for i in range(order):
            first = x[:1] if i == 0 else np.zeros(1)
            x = np.diff(x, prepend=first) / self.cycle_s
        return x


def take_trace(job: Job, cycle_s: float) -> Trace:
    """The columns become Python's."""
    columns = {}
    with job as (lib, c):
        rows = lib.takt_count_rows(c)
        for i in range(lib.takt_count_columns(c)):
            name = ffi.string(lib.takt_get_column_name(c, i)).decode()
            memory = lib.takt_take_column(c, i)
            if memory == ffi.NULL:
                columns[name] = np.empty(0)
                continue
            owned = ffi.gc(memory, lib.takt_free)
            columns[name] = np.frombuffer(ffi.buffer(owned, rows * 8), dtype=np.float64)
    return Trace(columns, cycle_s)


@dataclass(frozen=True)
class Result:
    """
    What a run comes to. ``trace`` is ``None`` if none was asked for, ``report`` likewise (HTML, complete in itself). Results
    are equal if they say the same but for wall time.

    In a notebook it shows the report where there is one, else the summary as a table.
    """

    summary: Summary
    checks: tuple[Check, ...]
    messages: tuple[Message, ...]
    trace: Trace | None = field(default=None, repr=False, compare=False)
    report: str | None = field(default=None, repr=False, compare=False)

    @property
    def digest(self) -> str:
        """Of all setpoints: the same as the command prints."""
        return self.summary.setpoint_digest

    @property
    def status(self) -> int:
        """Exit status of the command: 0 every check held, 1 not, 4 ``until`` came before the end."""
        return self.summary.exit_status

    @property
    def held(self) -> bool:
        """Every check held, and the program has come to its end or to ``until``."""
        return self.status in (0, 4)

    def failed(self) -> list[str]:
        """Names of the checks that failed."""
        return [c.name for c in self.checks if not c.held]

    def verify(self) -> Result:
        """Itself, or :class:`ChecksFailed` with every limit that is broken."""
        if self.held:
            return self
        lines = [f"{c.name}: {c.value:.9g} exceeds {c.limit:.9g}" for c in self.checks if not c.held]
        fault = [self.summary.fault] if self.summary.fault else []
        raise ChecksFailed(f"{self.summary.program}: {self.summary.outcome}\n" + "\n".join(fault + lines))

    def _repr_html_(self) -> str:
        if self.report is not None:
            inside = html.escape(self.report, quote=True)
            return f'<iframe srcdoc="{inside}" style="width:100%;height:48em;border:0"></iframe>'
        return _table(self)


def _table(result: Result) -> str:
    s = result.summary
    rows = "".join(
        f"<tr><td>{html.escape(a.name)}</td>"
        + "".join(
            f"<td>{done:.3f} / {limit:g}</td>"
            for done, limit in (
                (a.max_velocity, a.limit_velocity),
                (a.max_acceleration, a.limit_acceleration),
                (a.max_jerk, a.limit_jerk),
            )
        )
        + f"<td>{a.max_following_error:.6f}</td></tr>"
        for a in s.axes
    )
    held = sum(c.held for c in result.checks)
    fault = f"<p>{html.escape(s.fault)}</p>" if s.fault else ""
    return (
        f"<p><b>{html.escape(s.program)}</b> on {html.escape(s.machine)}: {s.outcome}, {s.program_time_s:.3f} s, "
        f"{s.path_length_mm:.3f} mm, {held} of {len(result.checks)} checks held, digest {s.setpoint_digest}</p>{fault}"
        "<table><tr><th>axis</th><th>velocity / limit [1/s]</th><th>acceleration [1/s²]</th><th>jerk [1/s³]</th>"
        f"<th>lag</th></tr>{rows}</table>"
    )


def make_result(job: Job, status: int, keeps_trace: bool, keeps_report: bool) -> Result:
    """Of a run that has been finished."""
    text = job.text
    if status == 3 or not text.strip():
        job.require(3)
    raw = json.loads(text)
    report = None
    if keeps_report:
        with job as (lib, c):
            job.require(lib.takt_write_report(c))
            report = job.text.decode()
    return Result(
        summary=Summary.of(raw),
        checks=tuple(Check(**c) for c in raw["checks"]),
        messages=job.messages,
        trace=take_trace(job, raw["cycle_time_s"]) if keeps_trace else None,
        report=report,
    )
