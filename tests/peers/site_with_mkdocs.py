"""MkDocs makes a site of all pages and public headers; a link that leads nowhere is told, and the site that was there stays."""

import glob
import json
import os
import shutil
import subprocess
import sys

import packages

packages.require("mkdocs")

# pylint: disable=wrong-import-position
sys.path.insert(0, os.path.join(os.environ["TAKT_SOURCE"], "tests", "system"))

import takt_test as t


def make(root, *options):
    command = [sys.executable, os.path.join(root, "host", "docs", "site", "make_site.py"), "site", *options]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.returncode, done.stderr


def found(word):
    """Where the search of the site finds a word, in titles."""
    with open("site/search/search_index.json", encoding="utf-8") as file:
        return [entry["location"] for entry in json.load(file)["docs"] if word in entry["title"]]


def pages(folder, pattern):
    return glob.glob(os.path.join(folder, "**", pattern), recursive=True)


def copy_sources():
    folders = [name for name in os.listdir(t.SOURCE) if not name.startswith((".", "build"))]
    for name in folders:
        path = os.path.join(t.SOURCE, name)
        (shutil.copytree if os.path.isdir(path) else shutil.copyfile)(path, os.path.join("sources", name))


def try_links(page):
    """Each of three kinds of mistakes in a page of a copy."""
    with open(page, encoding="utf-8") as file:
        text = file.read()
    for link in ("ramp_profiles.md#no-such-heading", "no_such_page.md", "no_such_source.c"):
        with open(page, "w", encoding="utf-8") as file:
            file.write(f"{text}\n[wrong]({link})\n")
        status, err = make("sources")
        t.check(status != 0 and "firmware/plan/README.md" in err and link in err and "Traceback" not in err, link, err[-1000:])
        t.check(os.path.exists("site/index.html"), "the site that was there is still there")
    with open(page, "w", encoding="utf-8") as file:
        file.write(text)


shutil.rmtree("site", ignore_errors=True)
os.makedirs("page", exist_ok=True)
t.write("page/takt.html", "<p>try it")
t.write("page/README.md", "[what else a build leaves](nowhere.md)\n")
status, err = make(t.SOURCE, "--try", "page")
t.check(status == 0 and not err, "a site is made", err[-2000:])
t.check(os.listdir("site/try") == ["index.html"] and "try/index.html" in open("site/index.html", encoding="utf-8").read(), "the page to try programs is in it")
t.check(any("motion/hold.h" in place for place in found("hold_piece")), "search finds what headers declare", found("hold_piece"))
t.check(found("Glossary"), "and pages")
fetched = [page for page in pages("site", "*.html") if 'src="http' in open(page, encoding="utf-8").read()]
t.check(not fetched, "those who read fetch nothing from elsewhere", fetched[:3])

shutil.rmtree("sources", ignore_errors=True)
os.makedirs("sources")
copy_sources()
status, err = make("sources")
t.check(status == 0 and not os.path.exists("site/try"), "a site is made again, of a copy without git", err[-2000:])
t.check(len(pages("site", "README.html") + pages("site", "index.html")) >= len(pages("sources", "README.md")), "every page is in it")
try_links("sources/firmware/plan/README.md")
os.makedirs("others", exist_ok=True)
t.write("others/letter", "kept")
command = [sys.executable, os.path.join(t.SOURCE, "host/docs/site/make_site.py"), "others"]
t.check(subprocess.run(command, capture_output=True, check=False).returncode != 0 and os.path.exists("others/letter"), "a folder of others is not replaced")
t.finish()
