"""Where a browser is that Playwright can drive: for tests of pages."""

import os
import shutil
import subprocess

import takt_test as t

BROWSERS = "chromium", "chromium-browser", "google-chrome", "google-chrome-stable"


def find_playwright():
    """A file beside the folder node_modules that has it; None: nowhere."""
    npm = shutil.which("npm")
    everybody = subprocess.run([npm, "root", "-g"], capture_output=True, text=True, check=False).stdout.strip() if npm else ""
    for folder in (os.environ.get("TAKT_PLAYWRIGHT"), os.path.join(t.SOURCE, "build", "peers", "node_modules"), everybody):
        if folder and os.path.isdir(os.path.join(folder, "playwright-core")):
            return os.path.join(os.path.dirname(folder), "here.js")
    return None


def find():
    """What a script of node needs in its environment, or why there is no browser."""
    chromium = next(filter(None, map(shutil.which, BROWSERS)), None)
    if not shutil.which("node") or not chromium:
        return "no node" if not shutil.which("node") else "no Chromium"
    playwright = find_playwright()
    if not playwright:
        return "no playwright-core: npm install playwright-core, and TAKT_PLAYWRIGHT is its node_modules"
    return {"PLAYWRIGHT": playwright, "CHROMIUM": chromium, "HOME": os.getcwd()}
