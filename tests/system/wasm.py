#!/usr/bin/env python3
"""takt in WebAssembly: the npm package by node, and the try-it page in a headless Chromium.

Figures are printed: sizes, and how long 3d_chips (if it is there) takes natively, by node and in the
page. Skipped without what host/wasm/build needs, or node; the page alone without Chromium or playwright-core.
"""

import os
import shutil
import subprocess
import time

import browser
import takt_test as t

HANGS_AFTER_S = 900
SIZE_MAX = 2_000_000
RATIO_MAX = 2.0


def build(folder):
    """A first build takes a minute of two processors, later ones bring it up to date."""
    done = subprocess.run([os.path.join(t.SOURCE, "host", "wasm", "build"), folder], capture_output=True, text=True, check=False)
    if done.returncode == 77:
        t.skip(done.stdout.strip().splitlines()[-1])
    t.check(done.returncode == 0, "the module is built", (done.stdout + done.stderr)[-2000:])
    for name in ("package/takt.wasm", "takt.html"):
        size = os.path.getsize(os.path.join(folder, name))
        print(f"{name}: {size} bytes")
        t.check(size < SIZE_MAX, f"{name} is below 2 MB")


def check_package(node, folder):
    """What npm would publish, unpacked elsewhere."""
    shutil.copytree(os.path.join(folder, "package"), "node_modules/takt-wasm")
    test = os.path.join(t.SOURCE, "host", "wasm", "package", "test.mjs")
    shutil.copy(test, "node_modules/takt-wasm/test.mjs")
    done = subprocess.run([node, "--test", "node_modules/takt-wasm/test.mjs"], env={**os.environ, "TAKT": t.TAKT}, capture_output=True, text=True, check=False)
    t.check(done.returncode == 0, "the tests of the package pass", done.stdout[-3000:])


def seconds(*command):
    start = time.monotonic()
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    t.check(done.returncode == 0, f"{command[0]} runs", done.stderr)
    return time.monotonic() - start, t.json.loads(done.stdout)


def find_program():
    real = os.path.join(os.environ.get("TAKT_PROGRAMS") or os.path.join(t.SOURCE, "..", "shared", "programs"), "3d_chips.ngc")
    return real if os.path.exists(real) else os.path.join(t.EXAMPLES, "pocket.ngc")


def main():
    folder = os.path.join(t.SOURCE, "build", "wasm")
    node = shutil.which("node")
    if not node:
        t.skip("no node")
    build(folder)
    check_package(node, folder)
    program = find_program()
    native_s, there = seconds(t.TAKT, "run", program, "--json", "-", "--quiet", "--report", "native.html")
    node_s, here = seconds(node, os.path.join(folder, "package", "cli.mjs"), "run", program)
    t.check(here["setpoint_digest"] == there["setpoint_digest"], "by node the digest is the command's")
    print(f"{os.path.basename(program)}: native {native_s:.2f} s, node {node_s:.2f} s ({node_s / native_s:.2f})")
    found = browser.find()
    if isinstance(found, str):
        t.skip(found)
    script = os.path.join(t.SOURCE, "tests", "system", "wasm_in_browser.mjs")
    done = subprocess.run([node, script, "file://" + os.path.join(folder, "takt.html"), program, there["setpoint_digest"]],
                          env={**os.environ, **found}, timeout=HANGS_AFTER_S, capture_output=True, text=True, check=False)
    t.check(done.returncode == 0, "every step on the page holds", done.stderr[-2000:])
    page_s = float(done.stdout.split()[0]) if done.stdout.split() else 0.0
    print(f"page: {page_s:.2f} s ({page_s / native_s:.2f} of native); at most {RATIO_MAX:.0f} where nothing else runs")
    t.finish()


main()
