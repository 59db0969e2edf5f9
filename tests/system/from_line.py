"""--from-line: all modes of the beginning, a safe way to the line, and the rest as it was."""

import math

import takt_test as t

PROGRAM = t.write(
    "part.ngc",
    """G21 G90 F600
T1 M6
S900 M3 M8
G0 Z10
X20 Y5
G1 Z-2
G91 G20 X1
G21 X5
G90 Y15
G0 Z10
M2
""",
)

full = t.canon(PROGRAM)
status, out, err = t.run("canon", PROGRAM, "--from-line", "8")
lines = out.splitlines()
t.check(status == 0, "canon --from-line", err)
t.check(
    [line.split(" ", 1)[1] for line in lines[:7]]
    == [
        "rapid X0.000000 Y0.000000 Z10.000000",
        "tool_prepare T1",
        "tool_change T1",
        "rapid X45.400000 Y5.000000 Z10.000000",
        "spindle_cw S900.000000",
        "coolant_flood_on",
        "feed X45.400000 Y5.000000 Z-2.000000 F600.000000",
    ],
    "up, tool, across, spindle, coolant, down",
    *lines[:7],
)
t.check(all(line.startswith("8 ") for line in lines[:7]), "the way belongs to the line")
rest = [move for move in full if move.line >= 8]
mine = t.canon(PROGRAM, "--from-line", "8")[3:]
t.check([(m.line, m.kind, m.end) for m in mine] == [(m.line, m.kind, m.end) for m in rest], "the rest is the same")

# The run holds every check and ends where the whole program ends.
status, out, err = t.run("run", PROGRAM, "--from-line", "8", "--json", "s.json", "--trace", "t.csv", "--quiet")
t.check(status == 0, "run --from-line", out, err)
summary = t.load_json("s.json")
t.check(summary["outcome"] == "completed", "the run completes", summary)
trace = t.read_trace("t.csv")
t.check(abs(trace["cmd_X_mm"][-1] - 50.4) < 1e-6 and abs(trace["cmd_Z_mm"][-1] - 10) < 1e-6, "where it ends")
across = [z for x, z in zip(trace["cmd_X_mm"], trace["cmd_Z_mm"]) if 1e-6 < x < 45.4 - 1e-6]
t.check(across and all(abs(z - 10) < 1e-9 for z in across), "nothing moves across below the height")
t.check(min(trace["line"]) >= 8, "no cycle belongs to an earlier line")

# The part is set up as the lines before have it, once the tool is up and before it goes across.
SET_UP = t.write("set_up.ngc", "G10 L13 X0.9\nG0 Z5\nX1\nG10 L13 X0.5 Z-0.2\nG1 X20 Z-2 F600\nX30\nM2\n")
status, out, err = t.run("run", SET_UP, "--from-line", "6", "--set", "correction.reserve_ratio=0.2", "--trace", "t.csv", "--quiet")
t.check(status == 0, "a program that sets up the part is run from a line", err)
trace = t.read_trace("t.csv")
k = [tuple(trace[f"set_{axis}_mm"][i] - trace[f"cmd_{axis}_mm"][i] for axis in "XZ") for i in range(len(trace["cmd_X_mm"]))]
t.check(math.dist(k[-1], (0.5, -0.2)) < 1e-6, "with the set-up of the lines before", k[-1])
moving = [place for place, x in zip(k, trace["cmd_X_mm"]) if x > 1e-6]
t.check(moving and all(math.dist(place, (0.5, -0.2)) < 1e-6 for place in moving), "which is in force before it goes across", moving[:1])

# A line inside a subroutine: the first time it is executed.
LOOP = t.write("loop.ngc", "F600\no1 sub\nG1 X#1\no1 endsub\no2 repeat [3]\n#2=[#2+1]\no1 call [#2]\no2 endrepeat\nM2\n")
t.check([m.end[0] for m in t.canon(LOOP, "--from-line", "3")] == [1, 2, 3], "the first time")

for line, said in (
    ("0", "number of a line"),
    ("1.5", "number of a line"),
    ("x", "number of a line"),
    ("99", "never reaches line 99"),
):
    status, out, err = t.run("run", PROGRAM, "--from-line", line)
    t.check(status == 2 and out == "" and said in err, "--from-line " + line, status, err)
status, out, err = t.run("check", LOOP, "--from-line", "5")
t.check(status == 0 and "no errors" in out, "check --from-line", out, err)
t.finish()
