"""The page in a headless Chromium, by Playwright: every function of it, used as an operator does. page_in_browser.py [FOLDER]

FOLDER: screenshots go there. Skipped without node, Chromium or the npm package playwright-core: it is looked for in
$TAKT_PLAYWRIGHT, in build/peers, and where npm installs for all.
"""

import os
import subprocess
import sys

import browser
import page_client as w
import panel_client as p
import takt_test as t

HANGS_AFTER_S = 540  # each step has a patience of its own
PART = b"G21 G90 G61 F600\nG0 Z1\nG1 Z-0.5\nG1 X6 Y2\nG2 X10 Y-2 I0 J-4\nG1 X8 Y-3\nG1 X0\nG1 Y0\nG0 Z1\nG1 X4 Y4\nG1 X0 Y0\nM2\n"
TOOLS = "T1 P1 Z20 D6 ;end mill\nT2 P2 Z35.5 D3 ;engraver\n"


found = browser.find()
if isinstance(found, str):
    t.skip(found)
service = w.serve("--tools", t.write("tools.tbl", TOOLS))
client = service.client()
client.wait_for("STATE", p.IDLE)
environment = {**os.environ, **found, "TAKT_PART": t.write("part.ngc", PART), "TAKT_SHOWN": os.path.join(t.EXAMPLES, "engraving.ngc")}
script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "page_in_browser.mjs")
done = subprocess.run(["node", script, f"http://127.0.0.1:{service.page_port}/", *sys.argv[1:]], env=environment, timeout=HANGS_AFTER_S,
                      capture_output=True, text=True, check=False)
print(done.stdout, end="")
t.check(done.returncode == 0, "every step on the page holds", done.stderr[-1000:])
service.stop()
t.finish()
