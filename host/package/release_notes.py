#!/usr/bin/env python3
"""Of CHANGELOG.md: release_notes.py VERSION prints what is new; release_notes.py --debian DATE PACKAGER the changelog of
the package.

DATE is seconds since 1970, of the commit (git log -1 --format=%ct).
"""
import email.utils
import pathlib
import re
import sys
import textwrap

CHANGELOG = pathlib.Path(__file__).resolve().parents[2] / "CHANGELOG.md"


def releases():
    """Version and text, the newest first."""
    parts = re.split(r"^## \[([\d.]+)\].*\n", CHANGELOG.read_text(), flags=re.M)
    return list(zip(parts[1::2], (text.strip() + "\n" for text in parts[2::2])))


def points(text):
    """Without marks, a line each."""
    for point in re.findall(r"^- (.*(?:\n  .*)*)", text, re.M):
        plain = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", re.sub(r"[*`]", "", point))
        yield " ".join(plain.split())


def debian(date, packager):
    for version, text in releases():
        body = "\n".join(textwrap.fill(point, 76, initial_indent="  * ", subsequent_indent="    ") for point in points(text))
        print(f"takt ({version}) unstable; urgency=medium\n\n{body}\n\n -- {packager}  {email.utils.formatdate(date)}\n")


def main():
    if len(sys.argv) == 4 and sys.argv[1] == "--debian":
        debian(int(sys.argv[2]), sys.argv[3])
        return 0
    found = dict(releases())
    if len(sys.argv) != 2 or sys.argv[1] not in found:
        print(f"versions: {', '.join(found)}", file=sys.stderr)
        return 2
    print(found[sys.argv[1]], end="")
    return 0


sys.exit(main())
