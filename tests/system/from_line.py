"""--from-line: all modes of the beginning, a safe way to the line, and the rest as it was."""

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
