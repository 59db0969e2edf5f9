#!/usr/bin/env python3
"""Puts the page into one file: make_page.py FOLDER VERSION PLOTLY OUT

FOLDER has takt.wasm and the sources of the package; PLOTLY is the plotting library of reports, or "" for none.
"""
import base64
import gzip
import pathlib
import re
import sys


def packed(path):
    return base64.b64encode(gzip.compress(path.read_bytes(), 9, mtime=0)).decode()


def joined(package, names):
    """Modules as one script: what they import of each other stands before it."""
    text = "".join((package / name).read_text() for name in names)
    return re.sub(r"^export ", "", re.sub(r"^import .*\n", "", text, flags=re.M), flags=re.M)


def main():
    package, version, plotly, out = sys.argv[1:]
    package = pathlib.Path(package)
    page = pathlib.Path(__file__).resolve().parent / "page"
    parts = {
        "STYLE": (page / "page.css").read_text(),
        "SCRIPT": (page / "page.js").read_text(),
        "WORKER": joined(package, ("wasi.mjs", "takt.mjs", "worker.mjs")),
        "MODULE": packed(package / "takt.wasm"),
        "PLOTTING": packed(pathlib.Path(plotly)) if plotly else "",
        "VERSION": version,
    }
    text = re.sub(r"\{\{([A-Z]+)\}\}", lambda place: parts[place.group(1)], (page / "page.html").read_text())
    pathlib.Path(out).write_text(text)


main()
