"""Machines as dictionaries of the keys of machine files."""

from __future__ import annotations

import configparser
from collections.abc import Iterator, Mapping, MutableMapping
from pathlib import Path
from typing import Union

from ._job import Source, Words, written

Value = Union[int, float, str]

NAME = "<machine>"
#: Assignments of one call: the command takes so many --set.
SETS_MAX = 64


def _value(text: str) -> Value:
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text


def _key(section: str, name: str) -> str:
    return ".".join([*section.split(" ", 1), name])


class Machine(MutableMapping[str, Value]):
    """
    A machine: the documented keys of a machine file, as ``takt machine`` prints them and ``--set`` names them.

    >>> mill = Machine()                                    # the built-in mill
    >>> mill["axis.X.max_jerk_mm_s3"] = 20000
    >>> mill = Machine("mill.ini", {"machine.look_ahead_blocks": 32})
    >>> mill = Machine({"axis.X.max_jerk_mm_s3": 20000})    # the built-in mill with other limits

    Keys are ``section.key`` or ``section.instance.key``, values numbers or words, in the units that the names end with
    (mm, mm/s, mm/s^2, mm/s^3; deg for rotary axes). Every assignment is checked at once, alone and together with all
    others: :class:`takt.InputError` names the key and what is wrong. A new axis comes into being by being named.
    """

    def __init__(
        self,
        base: Source | Machine | Mapping[str, Value] | None = None,
        changes: Mapping[str, Value] | None = None,
    ) -> None:
        self._text: str
        if isinstance(base, Machine):
            self._text = base._text
        else:
            words = Words("machine")
            if isinstance(base, Mapping):
                changes = {**base, **(changes or {})}
            elif base is not None:
                words.operand(words.source(base, NAME))
            self._text = words.job().write().decode()
        self._read()
        self.update(changes or {})

    def _made(self, sets: list[str]) -> str:
        words = Words("machine")
        words.operand(words.hold(NAME, self._text))
        words.option("set", sets)
        return words.job().write().decode()

    def _read(self) -> None:
        parser = configparser.RawConfigParser(delimiters=("=",), comment_prefixes=("#",), strict=True)
        parser.optionxform = str  # type: ignore[assignment,method-assign]
        parser.read_string(self._text)
        self._values = {
            _key(section, name): _value(value) for section in parser for name, value in parser[section].items()
        }

    def update(self, *args: Mapping[str, Value], **named: Value) -> None:  # type: ignore[override]
        """Several keys at once: what only fits together is checked together."""
        changes = [f"{key}={written(value)}" for key, value in dict(*args, **named).items()]
        if changes:
            for i in range(0, len(changes), SETS_MAX):
                self._text = self._made(changes[i : i + SETS_MAX])
            self._read()

    def __setitem__(self, key: str, value: Value) -> None:
        self.update({key: value})

    def __getitem__(self, key: str) -> Value:
        return self._values[key]

    def __delitem__(self, key: str) -> None:
        raise TypeError(f"{key}: a machine has all of its keys")

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __repr__(self) -> str:
        return f"<takt.Machine {self['machine.name']!r}, axes {' '.join(self.axes)}>"

    def __reduce__(self) -> tuple[type[Machine], tuple[str]]:
        return Machine, (self._text,)

    @property
    def axes(self) -> list[str]:
        """Letters of the axes it has."""
        return [letter for letter in "XYZABC" if f"axis.{letter}.drive_node" in self]

    @property
    def text(self) -> str:
        """The complete machine file, with a comment for every key. It reads as the same bits."""
        return self._text


MachineLike = Union[Source, Machine, Mapping[str, Value], None]


def machine_source(machine: MachineLike) -> Source | None:
    """What a run is given: a path stays one."""
    return (machine if isinstance(machine, Machine) else Machine(machine)).text if isinstance(machine, Mapping) else machine
