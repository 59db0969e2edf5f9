"""A part that stands displaced and turned on a rotary table: probed, then milled with the words of the part that stands right.

The tool is judged at rest, in the frame of the part, by rotation matrices written here.
"""

import math
import os
import random

import takt_test as t
from set_up_machine import MACHINE, PIVOT, RESERVED

OFFSET = [0.82, -0.43, 0.2]
TURNS = [0.2, -0.15, 0.4]
LIMIT_UM = 2.0
REST_CYCLES = 250
CYCLES = os.path.join(t.SOURCE, "host/examples/set_up")


def rotation(about, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    i, j = (about + 1) % 3, (about + 2) % 3
    m = [[float(row == column) for column in range(3)] for row in range(3)]
    m[i][i] = m[j][j] = c
    m[i][j], m[j][i] = -s, s
    return m


def times(a, v):
    return [sum(a[i][j] * v[j] for j in range(3)) for i in range(3)]


def back(a, v):
    return [sum(a[j][i] * v[j] for j in range(3)) for i in range(3)]


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def off_um(wanted, wanted_c, stands, stands_c, offset, turns):
    """How far the tool is from where the words say it is on the part."""
    nominal = back(rotation(2, wanted_c), minus(wanted, PIVOT))
    part = minus(back(rotation(2, stands_c), minus(stands, PIVOT)), offset)
    for about in (2, 1, 0):
        part = back(rotation(about, turns[about]), part)
    return 1000 * math.dist(nominal, part)


def points_of(seed):
    rng = random.Random(seed)
    return [
        (c, [round(rng.uniform(low, high), 3) for low, high in ((0, 90), (-90, 40), (-60, -10))])
        for c in (0, 90, 180, 270) for _ in range(6)
    ]


POINTS = points_of(25)
VISITS = "".join(f"G0 X{x} Y{y} Z{z} C{c}\nG4 P0.3\n" for c, (x, y, z) in POINTS)


def stands(program, *options):
    """Where the drives are at the end of each dwell of VISITS: the last times that nothing is commanded to move."""
    status, out, err = t.run("run", program, "--trace", "run.csv", "--subroutines", CYCLES, "--quiet", *options)
    t.check(status == 0, f"{program}: every check held", out, err)
    trace = t.read_trace("run.csv")
    commanded = list(zip(*(trace[f"cmd_{axis}"] for axis in ("X_mm", "Y_mm", "Z_mm", "C_deg"))))
    actual = list(zip(trace["act_C_deg"], zip(*(trace[f"act_{axis}_mm"] for axis in "XYZ"))))
    rests, since = [], 0
    for i, at in enumerate(commanded):
        if i + 1 == len(commanded) or commanded[i + 1] != at:
            if i - since >= REST_CYCLES:
                rests.append(actual[i])
            since = i + 1
    t.check(len(rests) >= len(POINTS), f"{program}: a rest at each point", len(rests))
    return rests[-len(POINTS) :]


def judge(name, found, offset, turns):
    worst = max(off_um(point, c, at, at_c, offset, turns) for (c, point), (at_c, at) in zip(POINTS, found))
    print(f"{name}: {worst:.3f} um at most at C 0, 90, 180, 270")
    return worst


t.write("m.ini", RESERVED)
part = "part by {} {} {}  turned {} {} {}  about 40 -25 -60  on C\n"
solid = "box X 20 90 Y -50 10 Z * -30\n"
t.write("part.txt", part.format(*OFFSET, *TURNS) + solid)
t.write("right.ngc", VISITS + "M2\n")
probed = "O<set_up_corner> call [20] [-50] [-30] [40] [3] [300] [40] [-25] [-60]\nG0 Z20\n"
t.write("probed.ngc", probed + VISITS + "M2\n")

# Live: a corner is probed, and all points are right, at every angle of the table.
worst = judge("not corrected", stands("right.ngc", "--machine", "m.ini"), OFFSET, TURNS)
t.check(worst > 800, "without a set-up the part is missed", worst)
worst = judge("corner, live", stands("probed.ngc", "--machine", "m.ini", "--probe", "part.txt"), OFFSET, TURNS)
t.check(worst <= LIMIT_UM, "probed at a corner", worst)

# A bore and the top: turns about Z cannot be seen by them.
flat = [0.2, -0.15, 0.0]
t.write("bore.txt", part.format(*OFFSET, *flat) + "hole X 45 Y -20 Z -30 R 9\n")
bored = "O<set_up_plane> call [60] [-50] [-30] [30] [3] [300] [40] [-25] [-60]\nO<set_up_bore> call [45] [-20] [-40] [15] [200]\nG0 Z20\n"
t.write("bored.ngc", bored + VISITS + "M2\n")
worst = judge("top and bore, live", stands("bored.ngc", "--machine", "m.ini", "--probe", "bore.txt"), OFFSET, flat)
t.check(worst <= LIMIT_UM, "probed at the top and in a bore", worst)

# Offline: the same words behind a set-up, corrected for a machine that knows of none.
words = "G10 L13 X{} Y{} Z{} I{} J{} K{}\n".format(*OFFSET, *TURNS)
t.write("told.ngc", words + VISITS + "M2\n")
worst = judge("told, live", stands("told.ngc", "--machine", "m.ini"), OFFSET, TURNS)
t.check(worst <= LIMIT_UM, "told by a word", worst)
status, out, err = t.run("correct", "told.ngc", "--machine", "m.ini", "-o", "corrected.ngc")
t.check(status == 0, "corrected offline", err)
text = open("corrected.ngc").read()
t.check("L13" not in text and text.count("G4 P0.3") == len(POINTS), "the set-up is in the words", text[:400])
t.write("plain.ini", MACHINE)
found = stands("corrected.ngc", "--machine", "plain.ini")
worst = judge("told, offline", found, OFFSET, TURNS)
t.check(worst <= LIMIT_UM, "corrected offline", worst)

# What the word refuses.
for line, said in (
    ("G10 L13 X1 P1", "no code on this line uses the word 'P1'"), ("G10 L13 A1", "the machine has no axis A"),
    ("G10 L2 P1 K1", "no code on this line uses the word 'K1'"), ("G10 L14 P1", "is out of range"),
):
    t.write("bad.ngc", line + "\nM2\n")
    status, out, err = t.run("check", "bad.ngc")
    t.check(status == 2 and said in err, f"{line}: refused", err)
t.write("open.ngc", "G10 L13 X0.1\nG1 F100 X5\nG1 U5\nM2\n")
status, out, err = t.run("check", "open.ngc")
t.check(status == 2 and "open.ngc:3:" in err, "what follows a set-up is checked", err)
for command, program, said in (
    ("compile", "G10 L13 X0.1\nG1 F100 X5\nM2\n", "a set-up of the part (G10 L13) cannot be planned ahead"),
    ("correct", "G10 L12 P1 I5\nG1 F100 X5\nM2\n", "what a tool has worn is counted while it cuts"),
):
    t.write("refused.ngc", program)
    t.write("tools.tbl", "T1 P1 Z0\n")
    status, out, err = t.run(command, "refused.ngc", "--machine", "m.ini", "--tools", "tools.tbl", "-o", "refused.out")
    t.check(status == 2 and said in err and not os.path.exists("refused.out"), f"{command}: refused", err)
t.write("far.ngc", "G10 L13 X80 K20\nG4 P1\nG0 X10\nM2\n")
status, out, err = t.run("run", "far.ngc", "--machine", "m.ini", "--quiet")
t.check(status == 1 and "far.ngc:1:" in err and "more of the axes' limits than correction has reserved" in err, "a set-up beyond the reserve ends the program", err)
status, out, err = t.run("canon", "told.ngc", "--machine", "m.ini")
t.check("1 setup X0.82" in out and "1 setup K0.4" in out, "the set-up among canonical moves", out[:300])
t.finish()
