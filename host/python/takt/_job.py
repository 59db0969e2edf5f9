"""A call of the library: words as on the command line, texts in memory, messages back."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ._library import Library, ffi, load
from .errors import Message, error_of

DONE = 0
INPUT = 2
ENVIRONMENT = 3


def _text(cdata: Any) -> str:
    return str(ffi.string(cdata).decode("utf-8", "replace"))


class Job:
    """One ``struct takt_job``. Closed when it is collected."""

    def __init__(
        self, words: Iterable[str], texts: Mapping[str, bytes], library: Library | None = None
    ) -> None:
        self.library = library or load()
        self.lib = self.library.functions
        argv = [ffi.new("char[]", word.encode()) for word in words]
        names = {name: (ffi.new("char[]", name.encode()), text) for name, text in texts.items()}
        held = [(name, ffi.from_buffer(text), len(text)) for name, text in names.values()]
        opened = self.lib.takt_open(
            len(argv), ffi.new("char *[]", argv), ffi.new("struct takt_text[]", held), len(held)
        )
        if opened == ffi.NULL:
            raise MemoryError("takt")
        self.c = ffi.gc(opened, self.lib.takt_close)

    @property
    def messages(self) -> tuple[Message, ...]:
        count = ffi.new("unsigned *")
        found = self.lib.takt_get_messages(self.c, count)
        return tuple(
            Message(
                _text(m.kind), _text(m.file), m.line, m.column, _text(m.text), _text(m.cure)
            )
            for m in (found[i] for i in range(count[0]))
        )

    @property
    def text(self) -> bytes:
        length = ffi.new("size_t *")
        found = self.lib.takt_get_text(self.c, length)
        return bytes(ffi.buffer(found, length[0]))

    def require(self, status: int) -> None:
        """Raises unless the status is that of success."""
        if status != DONE:
            raise error_of(status, self.messages)

    def write(self) -> bytes:
        """The output of a command that writes a text."""
        self.require(self.lib.takt_write(self.c))
        return self.text


class Words:
    """Collects the words of a command line and the texts that stand in memory."""

    def __init__(self, command: str) -> None:
        self.words = [command]
        self.texts: dict[str, bytes] = {}

    def hold(self, name: str, text: str | bytes) -> str:
        self.texts[name] = text.encode() if isinstance(text, str) else bytes(text)
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
            self.words += [f"--{name}", repr(value) if isinstance(value, float) else str(value)]

    def source(self, given: str | bytes | Path, name: str) -> str:
        """
        A path, or the text itself: text is what has a line end in it, or is given as bytes.
        """
        if isinstance(given, Path):
            return str(given)
        if isinstance(given, bytes):
            return self.hold(name, given)
        return self.hold(name, given) if "\n" in given else given

    def job(self, library: Library | None = None) -> Job:
        return Job(self.words, self.texts, library)
