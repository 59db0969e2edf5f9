#!/usr/bin/env python3
"""The pages of this repository, and what its public headers declare, as a site with search: make_site.py FOLDER [--try WASM]

FOLDER must be new or a site that this made. WASM: the folder of host/wasm/build; its page becomes try/. Needs mkdocs
(requirements.txt). A link that leads nowhere, or to a heading that is not there, is an error.
"""

import argparse
import fnmatch
import html
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", ".."))
HEADERS = "api/README.md"
STYLE = "site.css"
WIDE = ".wy-nav-content { max-width: 70em; } .wy-table-responsive table td, .wy-table-responsive table th { white-space: normal; }\n"
MARK = "takt.site"  # stands in a site that this made, which may be replaced
# Code keeps its brackets: it is found first.
LINK = re.compile(r"^```[\s\S]*?^```|^ {4}.*$|`[^`\n]*`|\]\((?P<target>[^)\s#]+)(?P<anchor>#[^)\s]*)?\)", re.MULTILINE)
INDEX = "README.md"
PARTS = ("Firmware", "firmware"), ("Board support", "hal"), ("Host", "host"), ("Tests", "tests")

CONFIG = {
    "site_name": "takt",
    "site_description": "CNC motion control that runs the same on a desk and on a machine",
    "docs_dir": "pages",
    "use_directory_urls": False,
    "theme": {"name": "readthedocs", "highlightjs": False, "navigation_depth": 2},  # nothing is fetched by those who read
    "plugins": ["search"],
    "markdown_extensions": ["tables", "fenced_code", "sane_lists"],
    "extra_css": [STYLE],
    "validation": {"nav": {"omitted_files": "ignore"}, "links": {"not_found": "warn", "anchors": "warn", "unrecognized_links": "warn"}},
}


def listed(*patterns):
    """Files of the repository; of a copy of it without git, all."""
    done = subprocess.run(["git", "-C", ROOT, "ls-files", "--cached", "--others", "--exclude-standard", *patterns], capture_output=True, text=True, check=False)
    if done.returncode == 0 and done.stdout:
        return done.stdout.split("\n")[:-1]
    found = [os.path.relpath(os.path.join(folder, file), ROOT) for folder, _, files in os.walk(ROOT) for file in files]
    return sorted(path for path in found if not path.startswith(("build", ".")) and any(fnmatch.fnmatch(path, pattern) for pattern in patterns))


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


# ---- what a header declares

COMMENT = re.compile(r"\s*/\*(.*?)\*/", re.DOTALL)
NAME = re.compile(r"^(?:typedef\s+)?(struct|union|enum)\s+(\w+)\s*\{|(\w+)\s*\(|^#define\s+(\w+)|^typedef\s.*?(\w+);", re.MULTILINE)


def prose(comment):
    """A comment without its stars; what is set in or drawn stays as it is."""
    lines = [re.sub(r"^\s*\* ?", "", line).rstrip() for line in comment.strip().split("\n")]
    escaped = [line if line.startswith("    ") else html.escape(line, quote=False).replace("*", "\\*").replace("_", "\\_") for line in lines]
    return "\n".join(escaped).strip("\n")


def pieces(code):
    """The declarations of a header with the comments above them: parts between blank lines that are not within braces."""
    piece = []
    for line in code.split("\n"):
        if line.strip() or (text := "\n".join(piece)).count("{") > text.count("}"):
            piece.append(line)
        elif piece:
            yield text
            piece = []
    if piece:
        yield "\n".join(piece)


def header_page(path):
    """What a header says and declares, a heading for each name."""
    text = re.sub(r"^#ifndef \w+\n#define \w+\n|^#endif.*\n?\Z|^#include.*\n", "", read(path), flags=re.MULTILINE)
    first = COMMENT.match(text)
    lines = [f"# {path}", "", prose(first.group(1)) if first else ""]
    for piece in pieces(text[first.end():] if first else text):
        comment = COMMENT.match(piece)
        code = piece[comment.end():].strip("\n") if comment else piece
        name = NAME.search(code)
        if name:
            lines += ["", "## " + next(word for word in reversed(name.groups()) if word)]
        lines += ["", prose(comment.group(1)) if comment else ""]
        if code.strip():
            lines += ["", "```c", code, "```"]
    return "\n".join(lines) + "\n"


# ---- pages

def shown(path):
    """Where a file of the repository stands in the site: headers are pages, other sources are shown as text."""
    if path.endswith(".h"):
        return f"api/{path}.md"
    if path.endswith((".md", ".png", ".svg")):
        return path
    return f"source/{path}.txt"


class Site:
    def __init__(self, folder):
        self.folder = folder
        self.wanted = set()
        self.wrong = []

    def write(self, place, text):
        path = os.path.join(self.folder, place)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    def link(self, page, target):
        """The same link in the site; a folder is its page, or the list of what is in it."""
        path = os.path.normpath(os.path.join(os.path.dirname(page), target))
        if os.path.isdir(os.path.join(ROOT, path)):
            index = os.path.normpath(os.path.join(path, INDEX))
            if os.path.exists(os.path.join(ROOT, index)):
                path = index
            else:
                self.write(f"source/{path}.txt", "\n".join(listed(f"{path}/*")) + "\n")
                return os.path.relpath(f"source/{path}.txt", os.path.dirname(page))
        elif not os.path.exists(os.path.join(ROOT, path)):
            self.wrong.append(f"{page}: {target} leads nowhere")
        self.wanted.add(path)
        return os.path.relpath(shown(path), os.path.dirname(shown(page)))

    def page(self, path):
        def change(match):
            target = match["target"]
            if not target or re.match(r"[a-z]+:", target):
                return match.group()
            return f"]({self.link(path, target)}{match['anchor'] or ''})"

        self.write(path, LINK.sub(change, read(path)))

    def sources(self):
        for path in sorted(self.wanted):
            if path.endswith(".h"):
                self.write(shown(path), header_page(path))
            elif not path.endswith(".md"):
                target = os.path.join(self.folder, shown(path))
                os.makedirs(os.path.dirname(target), exist_ok=True)
                shutil.copyfile(os.path.join(ROOT, path), target)


def title(path):
    return re.sub(r"[`*]", "", re.search(r"^# (.*)$", read(path), re.MULTILINE).group(1)).split(":")[0]


def navigation(pages, wasm):
    """The start, what is for users, each room, what headers declare, what has changed."""
    guides = re.findall(r"^\| \[[^\]]*\]\((\w[\w-]*\.md)\)", read("host/docs/README.md"), re.MULTILINE)
    guides = ["host/docs/README.md"] + [f"host/docs/{page}" for page in guides]
    menu = [{"Start": INDEX}] + ([{"Try a program": "try/index.html"}] if wasm else []) + [{"Guides": guides}]
    for part, folder in PARTS:
        menu.append({part: [{title(path): path} for path in pages if path.startswith(folder + "/") and path not in guides]})
    menu.append({"Headers": HEADERS})
    menu.append({"More": [path for path in pages if "/" not in path and path != INDEX]})
    return menu


def list_headers(headers):
    """A line each, by room, with what the header says first."""
    lines = ["# Headers", "", "What each room declares for others, and the sources that pages lead to."]
    room = None
    for path in sorted(headers, key=os.path.split):
        if os.path.dirname(path) != room:
            room = os.path.dirname(path)
            lines += ["", f"## {room}", "", "| header | what |", "|---|---|"]
        said = COMMENT.match(read(path))
        first = " ".join(prose(said.group(1)).split("\n\n")[0].split()) if said else ""
        what = first.split(". ")[0].rstrip(":").replace("|", "&#124;")
        lines.append(f"| [{os.path.basename(path)}]({path}.md) | {what} |")
    return "\n".join(lines) + "\n"


def build(work, wasm):
    pages = listed("*.md")
    site = Site(os.path.join(work, "pages"))
    for path in pages:
        site.page(path)
    if site.wrong:
        sys.exit("\n".join(site.wrong))
    headers = {path for path in listed("*.h") if path.startswith("firmware/")} | {path for path in site.wanted if path.endswith(".h")}
    site.wanted.update(headers)
    site.sources()
    site.write(HEADERS, list_headers(headers))
    site.write(STYLE, WIDE)
    if wasm:
        os.mkdir(os.path.join(work, "pages", "try"))
        shutil.copy(os.path.join(wasm, "takt.html"), os.path.join(work, "pages", "try", "index.html"))
    with open(os.path.join(work, "mkdocs.yml"), "w", encoding="utf-8") as file:
        json.dump({**CONFIG, "nav": navigation(pages, wasm)}, file)  # JSON is YAML
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--config-file", os.path.join(work, "mkdocs.yml"), "--site-dir", os.path.join(work, "site")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    said = [line for line in done.stderr.splitlines() if not line.startswith("INFO")]  # --quiet would not count warnings
    print("\n".join(said), file=sys.stderr, end="\n" if said else "")
    return done.returncode


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("folder")
    parser.add_argument("--try", dest="wasm", metavar="WASM", help="the folder of host/wasm/build: its page becomes try/")
    asked = parser.parse_args()
    folder = os.path.abspath(asked.folder)
    if os.path.exists(folder) and os.listdir(folder) and not os.path.exists(os.path.join(folder, MARK)):
        sys.exit(f"make_site.py: {asked.folder} is not empty, and no site that this made")
    with tempfile.TemporaryDirectory() as work:
        if build(work, asked.wasm):
            sys.exit(1)
        with open(os.path.join(work, "site", MARK), "w", encoding="utf-8") as file:
            file.write("made by host/docs/site/make_site.py\n")
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(os.path.join(work, "site"), folder)


if __name__ == "__main__":
    main()
