"""G2.2 and G3.2 from text to setpoints: all planes, outward and inward, with a third axis, under compensation."""

import os

import takt_test as t
from judged_run import judged_run

# Out of the centre of the page's hole, where the curvature is infinite, round it, and in again, going down meanwhile.
HOLE = """G21 G17 G90 F6000
G3.2 X0 Y-79 I-0.628662025 J0 R0.628662025
G3 X0 Y-79 I0 J79
G3.2 X0 Y0 I0.628662025 J79 R0.628662025 Z-50
M2
"""

GOLDENS = os.path.join(t.SOURCE, "tests", "golden")

summary = judged_run(t.write("hole.ngc", HOLE))
t.check(summary["blocks"] == 3, "three moves", summary["blocks"])
length = 4963.71639 + 496.371639 + (4963.71639**2 + 50**2) ** 0.5
t.check(abs(summary["path_length_mm"] - length) < 2e-5, "as long as the page says", summary["path_length_mm"], length)
plan = t.load_json("plan.json")
t.check(plan["totals"]["moves"] == 3, "planned as three moves", plan["totals"])
joint = [b for b in plan["blocks"] if b["block"] == 2][0]
t.check(joint["feed_start_mm_min"] > 5999, "the circle is entered at full feed", joint)

for name in ("involutes.ngc", "cutter_involutes.ngc"):
    judged_run(os.path.join(GOLDENS, name))

# A small window: pieces of the involute that have no room yet wait.
judged_run(os.path.join(GOLDENS, "involutes.ngc"), "--set", "machine.look_ahead_blocks=2")

# Starting behind an involute, and travel that only the curve between the ends leaves.
status, out, _ = t.run("canon", "hole.ngc", "--from-line", "3")
t.check(status == 0 and "3 arc_ccw" in out and "involute_ccw X0.000000 Y0.000000" in out, "from line 3", out)
narrow = "--set", "axis.X.travel_max_mm=70"
status, _, err = t.run("check", "hole.ngc", *narrow)
t.check(status == 2 and "hole.ngc:2:6: error: " in err, "the curve leaves the travel between its ends", err)
t.finish()
