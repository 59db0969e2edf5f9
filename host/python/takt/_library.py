"""The C library: loaded by cffi in ABI mode, so that one wheel serves every Python. Its header is the only declaration."""

from __future__ import annotations

import functools
import hashlib
import os
import re
from pathlib import Path
from typing import Any, NamedTuple

import cffi

HERE = Path(__file__).resolve().parent

ffi = cffi.FFI()


class Library(NamedTuple):
    """A takt that has been loaded: its functions, and the SHA-256 of its file, which stands for all of its sources."""

    functions: Any
    digest: str
    path: Path

    @property
    def is_own(self) -> bool:
        """That of this package."""
        return self.path == (HERE / "libtakt.so").resolve()


def _declarations(header: Path) -> str:
    kept = [
        line
        for line in header.read_text(encoding="utf-8").splitlines()
        if not line.startswith("#") or re.match(r"#define \w+ +\d+$", line)
    ]
    return "\n".join(kept)


def _header() -> Path:
    installed = HERE / "library.h"
    return installed if installed.exists() else HERE.parents[1] / "library" / "library.h"


ffi.cdef(_declarations(_header()))


@functools.lru_cache(maxsize=None)
def load(path: str | None = None) -> Library:
    """Loads the package's own library, or the one at ``path``; several may be loaded side by side."""
    given = path or os.environ.get("TAKT_LIBRARY") or str(HERE / "libtakt.so")
    file = Path(given).resolve()
    # Never unloaded: at the end of Python what it has made may be freed after it.
    functions = ffi.dlopen(str(file), ffi.RTLD_NOW | getattr(ffi, "RTLD_NODELETE", 0))
    return Library(functions, hashlib.sha256(file.read_bytes()).hexdigest(), file)
