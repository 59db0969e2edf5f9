"""``python -m takt run ...``: the commands run, canon, convert, plan, compile and machine where ``takt`` itself is not installed."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from ._job import encoded
from ._library import ffi, load


def main(words: Sequence[str] | None = None) -> int:
    argv = [ffi.new("char[]", encoded(word)) for word in (sys.argv[1:] if words is None else words)]
    return int(load().functions.takt_command(len(argv), ffi.new("char *[]", [*argv, ffi.NULL])))


if __name__ == "__main__":
    sys.exit(main())
