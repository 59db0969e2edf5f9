"""The judge of `hunt` against setpoints made by hand: it must accept what is right, and see what is wrong."""

import math
import os
import subprocess
import sys

import takt_test as t

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(t.SOURCE, "tests", "bench", "hunting"))
# pylint: disable=wrong-import-position
import hunt_path
import hunt_programs

JUDGE = sys.argv[1]
P = 0.1
HEAD = f"G21 G90 G17 G94 G64 P{P} F600\n"
# Of a setpoint, a cycle of 1 ms and F600: 10 mm/s.
STEP = 0.01


def to(points, *ends, step=STEP):
    """Goes on straight, in even steps."""
    for end in ends:
        start = points[-1]
        count = math.ceil(math.dist(start, end) / step - 1e-9)
        points += [tuple(a + (b - a) * k / count for a, b in zip(start, end)) for k in range(1, count + 1)]
    return points


def path(*ends, step=STEP):
    return to([(0.0, 0.0, 0.0)], *ends, step=step)


def judge(program, points, end=2, most=(), axes="XYZ"):
    machine = hunt_programs.Machine({a: (1e5, 1e7, 1e10) for a in axes}, 1000)
    rows = ["cycle,act_X_mm," + ",".join(f"set_{a}_{'mm' if a in 'XYZ' else 'deg'}" for a in axes)]
    rows += [f"{k},0," + ",".join(f"{x:.9f}" for x in point) for k, point in enumerate(points[1:])]
    t.write("t.csv", "\n".join(rows) + "\n")
    motions = hunt_path.read(program, machine, False)
    t.write("case", hunt_path.case(machine, motions, 1.0, end))
    done = subprocess.run([JUDGE, "case", "t.csv", *most], capture_output=True, text=True, check=True)
    return {row.split()[0]: float(row.split()[1]) for row in done.stdout.splitlines()}


def near(value, expected, part=2e-3):
    return abs(value - expected) <= part * expected


CORNER = HEAD + "G1 X5\nG1 Y5\n"


def cut(length):
    """Rounds the corner by a line from so far before it to so far behind."""
    return path((5 - length, 0, 0), (5, length, 0), (5, 5, 0))


# The corner is length / sqrt(2) off the cut.
f = judge(CORNER, cut(0.9 * P * math.sqrt(2)))
t.check(f["order"] == 1 and f["back"] == 0 and f["end"] == 0, "a corner rounded by 0.9 P is accepted", f)
f = judge(CORNER, cut(1.1 * P * math.sqrt(2)))
t.check(near(f["order"], 1.1) and near(f["corner"], 1.1, 0.01), "a corner cut by 1.1 P is refused", f)
t.check(f["tube"] <= 1, "of which every setpoint is within P of the path", f)
f = judge(CORNER, path((5, 0, 0), (5, 5, 0)))
t.check(f["order"] == 1 and f["feed"] <= 1.0000001 and f["stops"] == 0, "the path itself is accepted", f)

LINE = HEAD + "G1 X10\n"


def back(by):
    return path((5, 0, 0), (5 - by, 0, 0), (10, 0, 0))


f = judge(LINE, back(0.5 * P))
t.check(f["order"] == 1 and f["back"] <= 0.51, "a way back of 0.5 P is accepted", f)
f = judge(LINE, back(1.95 * P))
t.check(f["order"] == 1 and near(f["back"], 1.95), "one of 2 P goes from P before a place of the path to P behind it", f)
f = judge(LINE, back(2.1 * P))
t.check(near(f["order"], 1.05) and near(f["back"], 2.1), "one of 2.1 P goes farther than any curve in order", f)
f = judge(LINE, back(3 * P))
t.check(near(f["order"], 1.5), "one of 3 P has no match within P, the best is off by half of it", f)
f = judge(LINE, path((5, 1.1 * P, 0), (10, 0, 0)))
t.check(near(f["order"], 1.1) and near(f["tube"], 1.1, 0.01), "1.1 P beside the path is refused", f)


def stroke(by):
    return HEAD + f"G1 X5\nG1 X{5 - by:.6f}\nG1 X10\n"


f = judge(stroke(3 * P), path((10, 0, 0)))
t.check(near(f["order"], 1.5) and f["corner"] <= 1, "a programmed stroke back of 3 P that is left out is refused", f)
f = judge(stroke(3 * P), path((5 - 0.45 * P, 0, 0), (5 - 2.55 * P, 0, 0), (10, 0, 0)))
t.check(f["order"] == 1 and f["back"] == 0, "one rounded by 0.45 P at both ends is accepted", f)
f = judge(stroke(1.8 * P), path((10, 0, 0)))
t.check(f["order"] == 1, "one of 1.8 P may be left out: a place in its middle is within P of all of it", f)

TWO_LOOPS = HEAD + "G3 I-1\nG3 I1\nG1 Y5\n"


def around(points, x, from_rad, radius=1.0, turns=1):
    count = math.ceil(2 * math.pi * turns * radius / STEP)
    for k in range(1, count + 1):
        angle = from_rad + 2 * math.pi * turns * k / count
        points.append((x + radius * math.cos(angle), radius * math.sin(angle), 0.0))
    return points


FIRST, SECOND = (-1, 0), (1, math.pi)
f = judge(TWO_LOOPS, to(around(around(path(), *FIRST), *SECOND), (0, 5, 0)))
t.check(f["order"] == 1 and near(f["programmed_mm"], 5 + 4 * math.pi), "two circles in their order are accepted", f)
f = judge(TWO_LOOPS, to(around(around(path(), *SECOND), *FIRST), (0, 5, 0)))
t.check(f["order"] > 10 and f["tube"] <= 1, "circles in the wrong order are refused", f)
f = judge(TWO_LOOPS, to(around(path(), *FIRST), (0, 5, 0)))
t.check(f["order"] > 10, "a circle that is left out is refused", f)
for turns in (2, 3):
    f = judge(HEAD + "G3 I-1 P3\nG1 Y5\n", to(around(path(), *FIRST, turns=turns), (0, 5, 0)))
    t.check((f["order"] == 1) == (turns == 3), "turns are counted", turns, f)

HELIX = "G21 G90 G18 G94 G61 F600\nG3 X1 Z1 Y3 I1\n"


def helix(off=0.0, sense=1):
    """A quarter of a turn from Z to X about (Z 0, X 1): positive about Y."""
    return [(1 - math.cos(a) * (1 + off), 3 * a / (math.pi / 2), sense * math.sin(a) * (1 + off))
            for a in (math.pi / 2 * k / 400 for k in range(401))]


f = judge(HELIX, helix())
t.check(f["order"] == 1 and f["exact"] <= 2e-9, "a helix in another plane is followed exactly", f)
points = helix()
points[200] = tuple(x + 1e-8 for x in points[200])
f = judge(HELIX, points)
# Of 1e-8 (1 1 1), what is across the tangent (sqrt(1/2), 6 / pi, sqrt(1/2)).
TANGENT = (math.sqrt(0.5), 6 / math.pi, math.sqrt(0.5))
across = 1e-8 * math.sqrt(3 - sum(TANGENT) ** 2 / sum(x * x for x in TANGENT))
t.check(near(f["exact"], across, 0.1), "a setpoint off an exact path by some 1e-8 mm is seen", f, across)
f = judge(HELIX, helix(sense=-1))
t.check(f["order"] > 1e5, "the other way round is refused", f)

EXACT = CORNER.replace(f"G64 P{P}", "G61")
f = judge(EXACT, path((5, 0, 0), (5, 5, 0)))
t.check(f["order"] == 1 and f["exact"] <= 1e-12 and f["feed"] <= 1.0001, "an exact corner is accepted", f)
f = judge(EXACT, path((4.98, 0, 0)) + to([(5, 0.02, 0)], (5, 5, 0)))
t.check(f["order"] > 1000, "one cut by more than a step is refused", f)
f = judge(EXACT.replace("G1 Y5", "G4 P0.1\nG1 Y5"), path((4.996, 0, 0)) + to([(5, 0.006, 0)], (5, 5, 0)))
t.check(f["order"] > 1, "one that is not come to although there is a dwell is refused", f)
f = judge(EXACT, path((5, 0, 0), (5, 5, 0), step=5 / 499))
t.check(near(f["feed"], 500 / 499, 1e-5), "a feed 0.2 % too high is seen in exact path", f)
f = judge(CORNER, path((5, 0, 0), (5, 5, 0), step=5 / 499))
t.check(near(f["feed"], 500 / 499, 1e-5), "and within a tolerance", f)

TURN = HEAD + "G1 A10\nG1 A10 X1\n"


def turned(points, deg, over_s, x_mm=0.0):
    """Evenly, a cycle of 1 ms each."""
    count, (x, a) = round(over_s * 1000), points[-1]
    return points + [(x + x_mm * k / count, a + (deg - a) * k / count) for k in range(1, count + 1)]


# F600: 10 degrees a second, and behind them 10 mm a second.
f = judge(TURN, turned(turned([(0.0, 0.0)], 10, 1), 10, 0.1, 1), axes="XA")
t.check(f["order"] == 1 and f["feed"] <= 1.0000001, "rotary axes alone at their feed", f)
f = judge(TURN, turned(turned([(0.0, 0.0)], 10, 0.998), 10, 0.1, 1), axes="XA")
t.check(near(f["feed"], 1 / 0.998, 1e-4), "and 0.2 % above it", f)
# Farther from the end than P, a radian for a mm: no place of the next motion is near.
f = judge(TURN, turned(turned(turned([(0.0, 0.0)], 4, 0.4, 0.9 * P), 10, 0.6), 10, 0.1, 1 - 0.9 * P), axes="XA")
t.check(f["order"] == 1 and f["feed"] <= 1.0000001, "what rounding moves other axes by is no feed of rotary axes alone", f)
f = judge(CORNER, path((5, 0, 0), (5, 5 - 1e-6, 0)))
t.check(near(f["end"], 1e-6), "an end that is missed is seen", f)
f = judge(CORNER, path((5, 0, 0), (5, 2, 0)), end=1)
t.check(f["order"] == 1, "a run that is ended may be left anywhere on the path", f)
f = judge(CORNER, path((5, 0, 0), (5, 2, 0)))
t.check(f["order"] > 1, "one that is not, at its end alone", f)
f = judge(CORNER, path((5, 0, 0), (5, 2, 0), (5 + 1.1 * P, 2, 0)), end=1)
t.check(f["order"] > 1, "nor may one that is ended be left beside the path", f)
f = judge(LINE, path((5, 0, 0)), end=1)
t.check(f["acceleration"] * 1e7 > 0.9 * STEP / 1e-6, "and it must come to rest", f)
points = path((5, 0, 0))
f = judge(CORNER, to(points[:200] + 5 * [points[200]] + points[200:], (5, 5, 0)))
t.check(f["stops"] == 1, "a stop on a straight path is seen", f)
f = judge(CORNER, to(points + 5 * [points[-1]], (5, 5, 0)))
t.check(f["stops"] == 0, "one at a corner is not held against it", f)

EIGHT = HEAD + "G1 X0.5\nG1 X0\n" * 20
points = path(*([(0.5, 0, 0), (0, 0, 0)] * 20))
f = judge(EIGHT, points)
t.check(f["order"] == 1 and "unjudged" not in f, "strokes are judged", f)
f = judge(EIGHT, points, most=("1000",))
t.check("order" not in f and f["unjudged"] > 1000, "what takes more work than is allowed is told not to be judged", f)
f = judge(EIGHT, path((0.5, 0, 0), (0, 0, 0)), most=("1000",))
t.check(f["order"] > 1, "less of it, and a broken order is seen all the same", f)

JERK = 12000.0
points = [(JERK * (1e-3 * k) ** 3 / 6, 0, 0) for k in range(100)]
f = judge(LINE, points, end=0)
t.check(near(f["jerk"] * 1e10, JERK, 1e-3), "jerk by differences: x = J t^3 / 6", f)
f = judge(LINE, points)
t.check(near(f["acceleration"] * 1e7 * 1e-3, f["velocity"] * 1e5, 1e-4), "an end at speed is a jump to rest", f)
f = judge(HEAD + "G1 X0.5\n", [(0.25 * (1 - math.cos(math.pi * k / 500)), 0, 0) for k in range(501)])
t.check(near(f["velocity"] * 1e5, 0.25 * math.pi * 2, 1e-4), "velocity by differences", f)
t.check(near(f["acceleration"] * 1e7, 0.25 * (2 * math.pi) ** 2, 1e-3), "acceleration by differences", f)
t.finish()
