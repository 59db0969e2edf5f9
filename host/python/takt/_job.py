"""A call of the library: words as on the command line, texts in memory, messages back."""

from __future__ import annotations

import numbers
import os
import threading
from collections.abc import Iterable, Mapping
from typing import Any, Union

from ._library import Library, ffi, load
from .errors import InputError, Message, error_of

#: A path, or the text itself: what has a line end in it, or is given as bytes.
Source = Union[str, bytes, bytearray, memoryview, "os.PathLike[str]"]

DONE = 0
INPUT = 2
ENVIRONMENT = 3


def _text(cdata: Any) -> str:
    return str(ffi.string(cdata).decode("utf-8", "replace"))


def encoded(text: str) -> bytes:
    """As paths are encoded: bytes that are no UTF-8 come through."""
    return text.encode("utf-8", "surrogateescape")


def _word(word: str) -> bytes:
    if "\0" in word:
        raise ValueError(f"{word!r} holds a zero byte")
    return encoded(word)


def written(value: object) -> str:
    """As the command reads it: numbers with all of their bits, those of numpy as Python's."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        return str(value)
    return str(int(value)) if isinstance(value, numbers.Integral) else repr(float(value))


class Job:
    """
    One ``struct takt_job``. ``with job as (functions, c)`` lends it to one thread at a time, as long as it is not closed.
    Closed when it is collected.
    """

    def __init__(
        self, words: Iterable[str], texts: Mapping[str, bytes], library: Library | None = None
    ) -> None:
        self._lib = (library or load()).functions
        self._lock = threading.RLock()
        self._told = 0  # messages that an exception has brought
        argv = [ffi.new("char[]", _word(word)) for word in words]
        names = {name: (ffi.new("char[]", name.encode()), text) for name, text in texts.items()}
        held = [(name, ffi.from_buffer(text), len(text)) for name, text in names.values()]
        opened = self._lib.takt_open(
            len(argv), ffi.new("char *[]", argv), ffi.new("struct takt_text[]", held), len(held)
        )
        if opened == ffi.NULL:
            raise MemoryError("takt")
        self._c = ffi.gc(opened, self._lib.takt_close)

    def __enter__(self) -> tuple[Any, Any]:
        self._lock.acquire()
        if self._c is None:
            self._lock.release()
            raise ValueError("the simulation is closed")
        return self._lib, self._c

    def __exit__(self, *_: object) -> None:
        self._lock.release()

    def __reduce__(self) -> Any:
        raise TypeError("a simulation cannot be copied or pickled: make another one of the same arguments")

    def close(self) -> None:
        with self._lock:
            if self._c is not None:
                ffi.release(self._c)
            self._c = None

    @property
    def messages(self) -> tuple[Message, ...]:
        with self as (lib, c):
            count = ffi.new("unsigned *")
            found = lib.takt_get_messages(c, count)
            return tuple(
                Message(_text(m.kind), _text(m.file), m.line, m.column, _text(m.text), _text(m.cure))
                for m in (found[i] for i in range(count[0]))
            )

    @property
    def text(self) -> bytes:
        with self as (lib, c):
            length = ffi.new("size_t *")
            found = lib.takt_get_text(c, length)
            return bytes(ffi.buffer(found, length[0]))

    def untold(self) -> tuple[Message, ...]:
        """For an exception: messages that no exception before has brought."""
        messages = self.messages
        told, self._told = self._told, len(messages)
        return messages[told:]

    def require(self, status: int) -> None:
        """Raises unless the status is that of success."""
        if status != DONE:
            raise error_of(status, self.untold())

    def write(self) -> bytes:
        """The output of a command that writes a text."""
        with self as (lib, c):
            self.require(lib.takt_write(c))
            return self.text


def _path(path: str) -> str:
    """A path as a word of the command line; what is no file is taken for a text that lacks its line end, which is told."""
    if not os.path.exists(path):
        cure = "    a text, and not a path, is what has a line end in it, or is bytes\n"
        raise InputError((Message("error", path, 0, 0, "there is no such file", cure),), INPUT)
    return os.path.join(".", path) if path.startswith("-") else path


class Words:
    """Collects the words of a command line and the texts that stand in memory."""

    def __init__(self, command: str) -> None:
        self.words = [command]
        self.texts: dict[str, bytes] = {}

    def hold(self, name: str, text: str | bytes | bytearray | memoryview) -> str:
        self.texts[name] = encoded(text) if isinstance(text, str) else bytes(text)
        return name

    def operand(self, name: str) -> None:
        self.words.append(name)

    def option(self, name: str, value: object | None) -> None:
        """``None`` and ``False``: not given; ``True``: a flag; a list: once for each."""
        if value is None or value is False:
            return
        if value is True:
            self.words.append(f"--{name}")
        elif isinstance(value, (list, tuple)):
            for item in value:
                self.option(name, item)
        else:
            self.words += [f"--{name}", written(value)]

    def source(self, given: Source, name: str) -> str:
        """The word for it; a text is held under its name."""
        if isinstance(given, (bytes, bytearray, memoryview)) or isinstance(given, str) and "\n" in given:
            return self.hold(name, given)
        if not isinstance(given, (str, os.PathLike)):
            raise TypeError(f"{name}: a path or a text is expected, not {type(given).__name__}")
        return _path(os.fspath(given))

    def job(self, library: Library | None = None) -> Job:
        return Job(self.words, self.texts, library)
