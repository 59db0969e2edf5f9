"""Probing and inputs, end to end: contact in mid-move, the program's way after it, errors, and the judge's verdict."""

import json

import takt_test as t

PROGRAM = """\
G21 G90 G94 F600
G0 X5 Y5 Z-1
G38.2 Z-20
#1=#5063
G91 G0 Z1
G90 G38.2 Z-20 F60
#2=#5063
G91 G0 Z1
G90
"""


def run(program, probe, *options):
    """Status, the ends of the blocks by the trace, and the summary."""
    t.write("part.ngc", program)
    t.write("world.probe", probe)
    status, _, err = t.run("run", "part.ngc", "--probe", "world.probe", "--trace", "t.csv", "--json", "s.json", *options)
    trace = t.read_trace("t.csv")
    ends = {}
    for block, *at in zip(trace["block"], trace["cmd_X_mm"], trace["cmd_Y_mm"], trace["cmd_Z_mm"]):
        ends[int(block)] = at
    with open("s.json") as file:
        return status, ends, json.load(file), err


def failed(summary):
    return [check["name"] for check in summary["checks"] if not check["held"]]


# The table is at Z -4; the coarse and the fine contact are told apart by their feeds.
status, ends, summary, err = run(PROGRAM + "G0 X[#1*10] Y[#2*10]\nM2\n", "box Z * -4\n")
t.check(status == 0 and failed(summary) == [], "probing keeps every limit and the path", status, failed(summary), err)
coarse, fine = ends[6][0] / 10, ends[6][1] / 10
t.check(-4.05 < coarse < -4, "contact is seen within some cycles at 10 mm/s", coarse)
t.check(-4.005 < fine < -4, "and ten times as exactly at 1 mm/s", fine)
t.check(-20 < ends[2][2] < coarse, "the axes brake behind the contact", ends[2])
t.check(abs(ends[3][2] - ends[2][2] - 1) < 1e-9, "what is relative begins where they rest", ends)

# The same inputs give the same setpoints.
again = run(PROGRAM + "G0 X[#1*10] Y[#2*10]\nM2\n", "box Z * -4\n")[2]
t.check(again["setpoint_digest"] == summary["setpoint_digest"], "the same run twice")

# Which way a program goes is decided by the contact, also by its absence.
BRANCH = "G21 F600\nG38.3 X10\nO1 if [#5070 EQ 1]\nG0 Y1\nO1 else\nG0 Y2\nO1 endif\nM2\n"
for probe, y in (("box X 5 *\n", 1), ("box X 50 *\n", 2)):
    status, ends, summary, err = run(BRANCH, probe)
    t.check(status == 0 and ends[2][1] == y, "the contact decides", status, ends, failed(summary), err)

# Away from contact.
status, ends, summary, err = run("G21 F600\nG38.4 X10\nG0 Y[#5061]\nM2\n", "box X * 3\n")
t.check(status == 0 and 3 < ends[2][1] < 3.05, "G38.4 ends when contact is lost", status, ends, err)

# Errors name the line and stop the machine within its limits.
for program, probe, message in (
    ("G21 F600\nG38.2 X10\nG0 Y5\n", "", "part.ngc:2:1: error: the probing move ended without contact"),
    ("G21 F600\nG38.4 X2\nG0 Y5\n", "box X * 3\n", "part.ngc:2:1: error: the probing move ended without losing contact"),
    ("G21 F600\nG38.2 X10\n", "box X -1 *\n", "part.ngc:2:1: error: the probe is in contact already"),
    ("G21 F600\nG38.4 X10\n", "", "part.ngc:2:1: error: the probe has no contact"),
):
    status, ends, summary, err = run(program, probe)
    t.check(status == 1 and message in err, message, status, err)
    t.check(failed(summary) == ["fault"] and max(ends) == 1, "nothing else is wrong, nothing else moves", failed(summary), ends)

# Inputs: waited for, timed out, read.
WAITS = "G21\nM66 P3 L3 Q5\nG0 X#5399\nM66 P3 L4 Q0.1\nG0 Y#5399\nM66 E0 L0\nG0 Z#5399\nM2\n"
status, ends, summary, err = run(WAITS, "input P3 1 at 1.5\ninput E0 2.5 at 0\n")
t.check(status == 0 and failed(summary) == [], "a program that waits completes", status, err)
t.check(ends[max(ends)] == [1, -1, 2.5], "an input, a time-out, a value", ends)

# A wrong file is refused before anything moves.
t.write("world.probe", "box X 1\n")
status, _, err = t.run("run", "part.ngc", "--probe", "world.probe")
t.check(status == 2 and "world.probe:1:8: error: a number is missing" in err, "a wrong file is refused", status, err)

t.finish()
