"""G5 to G6.2 from text to setpoints: exact, smoothed, planned ahead, with a small window, from a line, out of the travel."""

import os

import takt_test as t
from judged_run import judged_run

GOLDENS = os.path.join(t.SOURCE, "tests", "golden")
TEXT = open(os.path.join(GOLDENS, "splines.ngc"), encoding="ascii").read()

for name in ("splines.ngc", "splines_planes.ngc"):
    judged_run(os.path.join(GOLDENS, name))
judged_run(os.path.join(GOLDENS, "splines.ngc"), "--set", "machine.look_ahead_blocks=2")
blended = t.write("blended.ngc", "G64 P0.02\n" + TEXT)
status, _, err = t.run("run", blended, "--quiet")
t.check(status == 0, "a spline is smoothed", status, err)

# Planned ahead, exact and blended: `takt compile` replays and judges what it writes.
for program in (os.path.join(GOLDENS, "splines.ngc"), blended):
    status, out, err = t.run("compile", program, "-o", "splines.takt")
    t.check(status == 0, "a spline is planned ahead", status, out, err)

# The points of a spline count for the travel, and not its control points: this one's top is at Y 10.
arch = t.write("arch.ngc", "G21 G17 G90 F600\nG0 X0 Y0\nG5.1 X40 Y0 I20 J20\nM2\n")
for most, wanted in (("10.001", 0), ("9.999", 2)):
    status, _, err = t.run("check", arch, "--set", f"axis.Y.travel_max_mm={most}")
    t.check(status == wanted, f"travel up to Y {most}", status, err)

# Starting behind a spline.
status, out, _ = t.run("canon", arch, "--from-line", "4")
t.check(status == 0 and "spline" not in out, "from line 4", out)

# Corrected while it runs, but not in the text.
t.write("table.csv", "X_mm,KX_um\n0,0\n100,10\n")
status, _, err = t.run("correct", arch, "--table", "table.csv", "-o", "corrected.ngc")
t.check(status != 0 and "spline" in err, "a spline cannot be corrected in the program", status, err)
t.finish()
