"""takt precision: measured errors beside bounds, for a program and a machine."""

import re

import takt_test as t

PROGRAM = t.write("part.ngc", "G17 F3000\nG2 X0 Y0 I10 P2 Z4\nG1 X30 Y20 Z-5\nG1 X0 Y0\nM2\n")


def rows_of(*arguments):
    status, out, err = t.run("precision", *arguments)
    t.check(status == 0, f"{arguments}: done", status, err)
    found = re.findall(r"^  (\w*) +(\D+?) +(\d[\d.e+-]*) +(\d[\d.e+-]*) (mm|steps)$", out, re.M)
    return {(name or what): (float(measured), float(bound)) for name, what, measured, bound, _ in found}, out


rows, out = rows_of(PROGRAM)
for name in "integrate", "rotate", "contour of arcs", "even", "improved", "plain":
    if t.check(name in rows, f"{name} is there", out):
        t.check(0 < rows[name][0] <= rows[name][1] * 1.001, f"{name}: below its bound", rows[name])
# Two turns of R = 10 mm at 50 mm/s: N R dphi^3 / 6 = R sweep dphi^2 / 6 with dphi = 0.005, a little less in the ramps.
along = 10 * 2 * t.math.tau * 0.005**2 / 6
t.check(0.9 * along < rows["rotate"][0] <= along, "rotate errs along the arc by R sweep dphi^2 / 6", rows["rotate"], along)
t.check("F of lines 16, of arcs 16 bits" in out, "F of a line of 30,000 steps and of a radius of 10,000 steps", out)
t.check(re.search(r"axis X +ramp to full feed 100 cycles", out), "100 mm/s at 1000 mm/s2 and 1 ms", out)

# Coarser steps: the same number of steps, fewer bits.
rows, out = rows_of(PROGRAM, "--set", "axis.X.steps_per_mm=100", "--set", "axis.Y.steps_per_mm=100",
                    "--set", "axis.Z.steps_per_mm=100")
t.check(rows["even"][0] <= 0.5001 and "F of lines 13, of arcs 12 bits" in out, "steps of 0.01 mm", out)
rows, out = rows_of(t.write("line.ngc", "G0 X1\nM2\n"))
t.check("rotate     no arcs" in out, "a program without arcs", out)
rows, out = rows_of(PROGRAM, "--set", "machine.interpolator=rotate")
t.check("contour of arcs" in rows, "the machine's own interpolator does not matter", out)

for words, said in (
    ([], "file name is missing"),
    (["none.ngc"], "none.ngc"),
    ([t.write("bad.ngc", "G1 X1\n")], "error"),
    ([PROGRAM, "--set", "axis.X.steps_per_mm=-1"], "above 0"),
    ([PROGRAM, "--machine", "none.ini"], "none.ini"),
):
    status, out, err = t.run("precision", *words)
    t.check(status == 2 and out == "" and said in err, f"precision {' '.join(words)}: refused", status, err)
t.finish()
