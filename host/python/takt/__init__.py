"""
CNC motion control firmware on the desk: the ``takt`` command as a package.

>>> import takt
>>> result = takt.run("part.ngc", machine={"axis.X.max_jerk_mm_s3": 20000})
>>> result.verify().summary.program_time_s
"""

from ._library import Library, ffi, load
from .errors import ChecksFailed, EnvironmentRefused, Error, InputError, Message, PlanFailed
from .machine import Machine
from .programs import canon, compile, convert, plan
from .result import AxisSummary, Check, Result, Summary, Trace
from .simulation import Drive, Simulation, Snapshot, State, run

__version__: str = ffi.string(load().functions.takt_library_version()).decode()

__all__ = [
    "AxisSummary", "Check", "ChecksFailed", "Drive", "EnvironmentRefused", "Error", "InputError", "Library", "Machine",
    "Message", "PlanFailed", "Result", "Simulation", "Snapshot", "State", "Summary", "Trace", "canon", "compile", "convert", "load",
    "plan", "run",
]  # fmt: skip
