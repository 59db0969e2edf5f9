"""What goes wrong, as exceptions; and what takt says without going wrong."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Message:
    """What the command would print on standard error."""

    kind: str  #: ``error``, ``warning``, ``message`` (of the program itself) or ``note``
    file: str  #: ``""``: about the call or the environment
    line: int  #: from 1; 0: the file as a whole
    column: int  #: from 1; 0: the line as a whole
    text: str
    cure: str  #: what to do about it; ``""``: nothing is known

    def __str__(self) -> str:
        place = f"{self.file}:{self.line}:{self.column}: " if self.file else ""
        cure = "\n" + self.cure.rstrip() if self.cure else ""
        return f"{place}{self.kind}: {self.text}{cure}"


class Error(Exception):
    """The base of all errors of takt. ``file``, ``line`` and ``column`` are those of the first error."""

    def __init__(self, messages: tuple[Message, ...], status: int) -> None:
        errors = [m for m in messages if m.kind == "error"]
        first = errors[0] if errors else Message("error", "", 0, 0, f"status {status}", "")
        super().__init__("\n".join(str(m) for m in errors) or str(first))
        self.messages = messages
        self.status = status  #: exit status of the command
        self.text = first.text
        self.file = first.file
        self.line = first.line
        self.column = first.column

    def __reduce__(self) -> tuple[type[Error], tuple[tuple[Message, ...], int]]:
        return type(self), (self.messages, self.status)


class InputError(Error):
    """Program, machine, table, script or option is wrong (exit status 2)."""


class EnvironmentRefused(Error):
    """The computer refuses something: memory, a file (exit status 3)."""


class PlanFailed(Error):
    """A plan cannot be made, or breaks a limit (exit status 1)."""


class ChecksFailed(AssertionError):
    """A check of a run has failed, or the run has not come to its end."""


def error_of(status: int, messages: tuple[Message, ...]) -> Error:
    kinds = {1: PlanFailed, 2: InputError, 3: EnvironmentRefused}
    return kinds.get(status, Error)(messages, status)
