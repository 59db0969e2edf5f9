"""Runs, whole and in steps."""

from __future__ import annotations

import enum
import numbers
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Union

import numpy as np

from ._job import DONE, INPUT, Job, Source, Words, encoded, written
from ._library import Library, ffi
from .machine import MachineLike, machine_source
from .result import Array, Result, Trace, make_result

if TYPE_CHECKING:
    from typing import TypeGuard

#: Rows of time from the first program cycle (s) and override (%), or the text or path of such a file.
Overrides = Union[Source, float, Iterable[tuple[float, float]]]
#: Faults, as a text, its path, or a list of lines.
Faults = Union[Source, Sequence[str]]

FAULTS = "<faults>"
KEEPS_TRACE = 1
KEEPS_REPORT = 2
#: Cycles between two looks at Ctrl-C: some tenths of a second.
CYCLES_AT_ONCE = 200_000
INTERRUPTED = 130

OPTIONS = {
    "tools", "parameters", "dialect", "subroutines", "drive_type", "interpolator", "from_line", "lines_max",
    "exact_path", "block_delete", "until", "override_method", "set",
}  # fmt: skip


class State(enum.IntEnum):
    """What a controller is at."""

    STARTING = 0  #: drives are being enabled; no program cycle yet
    RUNNING = 1
    STOPPING = 2  #: after a fault of a drive: the drives brake
    COMPLETED = 3
    FAULTED = 4


def _is_source(given: object) -> TypeGuard[Source]:
    return isinstance(given, (str, bytes, bytearray, memoryview, os.PathLike))


def _override_text(rows: Overrides) -> Source:
    if _is_source(rows):
        return rows
    if isinstance(rows, numbers.Real):
        return f"0 {float(rows)!r}\n"
    if not isinstance(rows, Iterable):
        raise TypeError(f"overrides: rows of (seconds, per cent) are expected, not {type(rows).__name__}")
    pairs: Any = rows
    return "".join(f"{float(time_s)!r} {float(percent)!r}\n" for time_s, percent in pairs) or "\n"


def _fault_text(given: Faults) -> Source:
    if _is_source(given):
        return given
    if not isinstance(given, Iterable):
        raise TypeError(f"inject: a path, a text or a list of lines is expected, not {type(given).__name__}")
    return "".join(f"{line}\n" for line in given) or "\n"


def _plan(words: Words, plan: Source) -> None:
    if plan == "exact":
        words.option("exact-path", True)
    elif plan == "ahead":
        words.option("plan", plan)
    elif plan != "board":
        words.option("plan", words.source(plan, "<plan>"))


def _option(words: Words, key: str, value: Any) -> Any:
    """The value as a word of the command line."""
    if key == "set" and value is not None:
        return [f"{name}={written(v)}" for name, v in dict(value).items()]
    if key in ("tools", "parameters") and value is not None and not (key == "tools" and value == "auto"):
        return words.source(value, f"<{key}>")
    return value


def command_words(
    command: str,
    program: Source,
    *,
    machine: MachineLike = None,
    name: str = "<program>",
    options: Mapping[str, Any],
) -> Words:
    """The words of a command on a program, and the texts they name."""
    words = Words(command)
    words.operand(words.source(program, name))
    given = machine_source(machine)
    if given is not None:
        words.option("machine", words.source(given, "<machine>"))
    for key, value in options.items():
        if key not in OPTIONS and key not in ("ceiling", "to"):
            raise TypeError(f"{key}: options are {', '.join(sorted(OPTIONS))}")
        words.option(key.replace("_", "-"), _option(words, key, value))
    return words


def run_words(
    program: Source,
    *,
    machine: MachineLike = None,
    plan: Source = "board",
    overrides: Overrides | None = None,
    rapid_overrides: Overrides | None = None,
    inject: Faults | None = None,
    probe: Source | None = None,
    name: str = "<program>",
    **options: Any,
) -> Words:
    words = command_words("run", program, machine=machine, name=name, options=options)
    _plan(words, plan)
    if overrides is not None:
        words.option("override", words.source(_override_text(overrides), "<overrides>"))
    if rapid_overrides is not None:
        words.option("rapid-override", words.source(_override_text(rapid_overrides), "<rapid overrides>"))
    if inject is not None:
        words.option("inject", words.source(_fault_text(inject), FAULTS))
    if probe is not None:
        words.option("probe", words.source(probe, "<probe>"))
    return words


def run(
    program: Source,
    *,
    machine: MachineLike = None,
    plan: Source = "board",
    overrides: Overrides | None = None,
    inject: Faults | None = None,
    trace: bool = True,
    report: bool = False,
    library: Library | None = None,
    **options: Any,
) -> Result:
    """
    Runs the firmware on a part program against the virtual machine: ``takt run``, with the same setpoints and digest.

    :param program: path of a part program; or its text, which has a line end in it or is ``bytes``
    :param machine: path or text of a machine file, a :class:`Machine`, or a dictionary of what differs from the built-in mill
    :param plan: ``"board"``: planned while it runs; ``"ahead"``: compiled first; ``"exact"``: every G64 as G61; a path or
        the ``bytes`` of :func:`compile`
    :param overrides: feed override over time: rows of (seconds, per cent), a number, a text or a path
    :param inject: scripted faults (``takt help inject``): a text, a list of lines, or a path
    :param trace: keep every cycle: :class:`Trace`, float64 arrays of shape ``(cycles,)``
    :param report: keep the HTML report
    :param options: those of the command with ``_`` for ``-``: ``rapid_overrides``, ``probe``, ``tools``, ``parameters``,
        ``dialect``, ``until`` (s), ``from_line``, ``exact_path``, ``block_delete``, ``set`` (a dictionary of keys), ...

    A broken limit or a drive's fault is a result (:meth:`Result.verify` raises); wrong input raises :class:`InputError`.
    Without the GIL, so that threads run side by side.
    """
    inputs = {"machine": machine, "plan": plan, "overrides": overrides, "inject": inject, **options}
    with Simulation(program, trace=trace, report=report, library=library, **inputs) as sim:
        while sim.step(CYCLES_AT_ONCE):
            pass
        return sim.finish()


@dataclass(frozen=True)
class Snapshot:
    """The controller between two cycles. Axes by letter; mm, of rotary axes degrees."""

    state: State
    cycles: int  #: of the program
    cycles_since_power: int
    time_s: float  #: of the program
    block: int
    line: int  #: of the part program
    feed_mm_min: float
    override_percent: float
    cmd: dict[str, float]
    set: dict[str, float]
    act: dict[str, float]
    digest: str  #: of the setpoints so far


class Drive:
    """A virtual drive or I/O node: ``drive[0x6041]``, ``drive[0x1018, 1]``."""

    def __init__(self, job: Job, place: int) -> None:
        self._job = job
        self._place = place
        with job as (lib, c):
            self.node: int = lib.takt_get_node(c, place)  #: CANopen node id

    @property
    def position_mm(self) -> float:
        """True position of its axis, unrounded; rad of a rotary axis."""
        with self._job as (lib, c):
            return float(lib.takt_get_position_mm(c, self._place))

    def _read(self, index: int, sub: int) -> tuple[int, int]:
        """Bits, 0: there is no such number; and what they are."""
        value = ffi.new("uint32_t *")
        with self._job as (lib, c):
            return int(lib.takt_read_object(c, self._place, index, sub, value)), int(value[0])

    def read(self, index: int, sub: int = 0, signed: bool = False) -> int:
        """A number of the object dictionary, as raw bits or in two's complement."""
        bits, found = self._read(index, sub)
        if bits == 0:
            raise KeyError(f"drive {self.node} has no number {index:04X}:{sub:02X}")
        return found - (1 << bits) if signed and found >> (bits - 1) else found

    def write(self, index: int, value: int, sub: int = 0) -> None:
        """As an SDO download would; a number below 0 in two's complement."""
        bits = self._read(index, sub)[0] or 32
        fits = -(1 << (bits - 1)) <= value < 1 << bits
        with self._job as (lib, c):
            if not fits or not lib.takt_write_object(c, self._place, index, sub, value & ((1 << bits) - 1)):
                raise KeyError(f"drive {self.node} does not take {value} for {index:04X}:{sub:02X}")

    def __getitem__(self, key: int | tuple[int, int]) -> int:
        return self.read(*key) if isinstance(key, tuple) else self.read(key)

    def __setitem__(self, key: int | tuple[int, int], value: int) -> None:
        index, sub = key if isinstance(key, tuple) else (key, 0)
        self.write(index, value, sub)

    def __repr__(self) -> str:
        return f"<takt.Drive {self.node} at {self.position_mm:.6f}>"


class Simulation:
    """
    A run in steps: controller, bus and drives, cycle by cycle, with the operator's hand on it between two steps.

    >>> with Simulation("part.ngc", inject="enabled+2s drive 1 jam for=1s") as sim:
    ...     while sim.step(1000):                # a second of a machine with cycles of 1 ms
    ...         sim.feed_override = 50
    ...     result = sim.finish()

    Arguments as of :func:`run`. Steps of any length give the same setpoints. Different simulations share nothing; of one,
    calls of several threads wait for each other.
    """

    __slots__ = ("__weakref__", "_job", "_keeps", "_last", "_result", "drives")

    def __init__(
        self, program: Source, *, trace: bool = False, report: bool = False, library: Library | None = None, **options: Any
    ) -> None:
        self._keeps = (bool(trace), bool(report))
        self._job = run_words(program, **options).job(library)
        self._result: Result | None = None
        self._last: Snapshot | None = None
        with self._job as (lib, c):
            self._job.require(lib.takt_start(c, KEEPS_TRACE * self._keeps[0] | KEEPS_REPORT * self._keeps[1]))
            nodes = lib.takt_count_drives(c)
        #: by node id
        self.drives: dict[int, Drive] = {d.node: d for d in (Drive(self._job, i) for i in range(nodes))}

    def __reduce__(self) -> Any:
        return self._job.__reduce__()

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Gives up what is left of it. Results, with their traces, stay; any further call is a ``ValueError``."""
        self._job.close()

    def step(self, cycles: int = 1) -> bool:
        """So many control cycles, drive start included; fewer where the run ends. False: it has ended."""
        if cycles < 0:
            raise ValueError(f"{cycles} cycles: a simulation does not go back")
        for done in range(0, cycles, CYCLES_AT_ONCE):
            with self._job as (lib, c):
                self._job.require(lib.takt_step(c, min(CYCLES_AT_ONCE, cycles - done)))
                if lib.takt_is_over(c):
                    return False
        with self._job as (lib, c):
            return not lib.takt_is_over(c)

    def __iter__(self) -> Iterator[Snapshot]:
        """Every cycle to the end."""
        while self.step(1):
            yield self.state

    def _raw(self) -> Any:
        state = ffi.new("struct takt_state *")
        with self._job as (lib, c):
            lib.takt_get_state(c, state)
        return state

    @property
    def state(self) -> Snapshot:
        """Now; behind :meth:`finish`, as it was before the drives went off."""
        if self._last is not None:
            return self._last
        s = self._raw()
        letters = [(i, letter) for i, letter in enumerate("XYZABC") if s.axes >> i & 1]
        return Snapshot(
            state=State(s.state),
            cycles=s.cycles,
            cycles_since_power=s.cycles_since_power,
            time_s=s.cycles * s.cycle_s,
            block=s.block,
            line=s.line,
            feed_mm_min=s.feed_mm_min,
            override_percent=s.override_percent,
            cmd={letter: s.cmd[i] for i, letter in letters},
            set={letter: s.set[i] for i, letter in letters},
            act={letter: s.act[i] for i, letter in letters},
            digest=f"{s.digest:016x}",
        )

    def _inputs(self) -> Any:
        inputs = ffi.new("struct takt_inputs *")
        with self._job as (lib, c):
            lib.takt_get_inputs(c, inputs)
        return inputs

    def _set(self, **values: Any) -> None:
        with self._job as (lib, c):
            inputs = self._inputs()
            for name, value in values.items():
                setattr(inputs, name, value)
            if lib.takt_set_inputs(c, inputs) == INPUT:
                raise ValueError(self._job.untold()[-1].text)

    @property
    def feed_override(self) -> float:
        """%, 0 ... 120; holds until it is set again or the next row of ``overrides`` comes."""
        return float(self._inputs().feed_override_percent)

    @feed_override.setter
    def feed_override(self, percent: float) -> None:
        self._set(feed_override_percent=percent)

    @property
    def rapid_override(self) -> float:
        """%, 0 ... 100."""
        return float(self._inputs().rapid_override_percent)

    @rapid_override.setter
    def rapid_override(self, percent: float) -> None:
        self._set(rapid_override_percent=percent)

    @property
    def feed_hold(self) -> bool:
        """True: come to rest on the path and stay."""
        return bool(self._inputs().feed_hold)

    @feed_hold.setter
    def feed_hold(self, on: bool) -> None:
        self._set(feed_hold=int(on))

    @property
    def single_block(self) -> bool:
        """True: every motion that can still be brought to rest at its end is."""
        return bool(self._inputs().single_block)

    @single_block.setter
    def single_block(self, on: bool) -> None:
        self._set(single_block=int(on))

    def set_digital(self, number: int, on: bool) -> None:
        """Input P0 ... P31, as M66 reads it."""
        if not 0 <= number < 32:
            raise ValueError(f"digital inputs are P0 to P31, not P{number}")
        digital = self._inputs().digital
        self._set(digital=digital | 1 << number if on else digital & ~(1 << number))

    def set_analogue(self, number: int, value: float) -> None:
        """Input E0 ... E3, as M66 reads it."""
        if not 0 <= number < 4:
            raise ValueError(f"analogue inputs are E0 to E3, not E{number}")
        values = list(self._inputs().analogue)
        values[number] = value
        self._set(analogue=values)

    def inject(self, script: str | bytes | Sequence[str]) -> None:
        """Faults beside those there are: lines (``takt help inject``); times that have gone by begin at once."""
        given = _fault_text(script)
        text = given if isinstance(given, bytes) else encoded(str(given))
        with self._job as (lib, c):
            self._job.require(lib.takt_add_faults(c, ffi.from_buffer(text), len(text)))

    @property
    def messages(self) -> tuple[Any, ...]:
        """So far."""
        return self._job.messages

    @property
    def trace(self) -> Trace:
        """So far, as a copy; behind :meth:`finish` that of the result. Of a simulation that keeps it (``trace=True``)."""
        if not self._keeps[0]:
            raise ValueError("the simulation keeps no trace: Simulation(..., trace=True)")
        if self._result is not None and self._result.trace is not None:
            return self._result.trace
        columns: dict[str, Array] = {}
        with self._job as (lib, c):
            rows = lib.takt_count_rows(c)
            for i in range(lib.takt_count_columns(c)):
                column = lib.takt_get_column(c, i)
                values = np.frombuffer(ffi.buffer(column, rows * 8)).copy() if column != ffi.NULL else np.empty(0)
                columns[ffi.string(lib.takt_get_column_name(c, i)).decode()] = values
            return Trace(columns, self._raw().cycle_s)

    def finish(self) -> Result:
        """
        Runs no further: axes come to rest, drives go off, and the run is summed up. A run that had not ended counts as
        interrupted. The simulation cannot be stepped behind it.
        """
        if self._result is None:
            with self._job as (lib, c):
                self._last = self.state
                over = lib.takt_is_over(c)
                status = lib.takt_finish(c, DONE if over else INTERRUPTED)
                self._result = make_result(self._job, status, *self._keeps)
        return self._result
