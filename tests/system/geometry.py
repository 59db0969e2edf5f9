"""Errors of units on random machines of two chains: measured by takt calibrate, corrected live and offline.

    geometry.py [POINTS]

Corrected programs are judged by a model of its own: rigid bodies with whole rotation matrices (below).
"""

import math
import random
import re
import sys

import takt_test as t

POINTS = int(sys.argv[1]) if len(sys.argv) > 1 and sys.argv[1].isdigit() else 20
TRAVEL = {"X": 200.0, "Y": 150.0, "Z": 120.0, "B": 170.0}
LETTERS = "xyzabc"


# ---- the machines

def curve(rng, travel):
    size = [rng.choice((-1, 1)) * 0.3 * 60 ** rng.random() for _ in range(3)]
    return [round(number, 4) for number in (size[0] * 500 / travel, size[1] / 2, size[2] / 2, travel * rng.uniform(0.8, 2), rng.uniform(0, 360))]


class Machine:
    """chain: as the machine file has it. Errors are curves as in [geometry]."""

    def __init__(self, seed, chain):
        rng = random.Random(seed)
        self.chain = chain
        self.axes = [axis for axis in "XYZB" if axis in chain]
        self.error = {axis: [curve(rng, TRAVEL[axis]) for _ in range(6)] for axis in self.axes}
        self.square = [round(rng.uniform(-80, 80), 3) for _ in range(3)]
        self.tool = [round(rng.uniform(-90, 90), 3) for _ in range(3)]
        self.centre = [round(rng.uniform(-50, 50), 3) for _ in range(3)]

    def write(self, path):
        lines = ["[machine]", f"chain = {self.chain}"]
        for axis in self.axes:
            unit = "deg" if axis == "B" else "mm"
            lines += [f"[axis {axis}]", f"travel_min_{unit} = {-TRAVEL[axis]}", f"travel_max_{unit} = {TRAVEL[axis]}"]
        lines += ["[geometry]", "squareness_urad = " + words(self.square), "tool_mm = " + words(self.tool)]
        if "B" in self.axes:
            lines += ["table_centre_mm = " + words(self.centre)]
        for axis in self.axes:
            name = "_table" if axis == "B" else axis.lower()
            lines += [f"e{LETTERS[i]}{name} = {words(self.error[axis][i])}" for i in range(6)]
        lines += ["[correction]", "tool_mm = " + words(self.tool), "turn_centre_mm = " + words(self.centre), "steepest_ratio = 0.05"]
        return t.write(path, "\n".join(lines) + "\n")


def words(numbers):
    return " ".join(str(number) for number in numbers)


# ---- the model: p -> m p + t

def times(a, b):
    m = [[sum(a[0][i][k] * b[0][k][j] for k in range(3)) for j in range(3)] for i in range(3)]
    return m, [a[1][i] + sum(a[0][i][k] * b[1][k] for k in range(3)) for i in range(3)]


def shifted(x, y, z):
    return [[1, 0, 0], [0, 1, 0], [0, 0, 1]], [x, y, z]


def turned(about, angle):
    m, at = shifted(0, 0, 0)
    j, k = (about + 1) % 3, (about + 2) % 3
    m[j][j] = m[k][k] = math.cos(angle)
    m[j][k], m[k][j] = -math.sin(angle), math.sin(angle)
    return m, at


def product(*bodies):
    whole = shifted(0, 0, 0)
    for body in bodies:
        whole = times(whole, body)
    return whole


def error_at(machine, axis, i, x):
    def raw(at):
        linear, bow, sine, wave, phase = machine.error[axis][i]
        return linear * at / 1000 + bow * (at / TRAVEL[axis]) ** 2 + sine * math.sin(2 * math.pi * at / wave + math.radians(phase))
    return (raw(x) - raw(0)) * (1e-3 if i < 3 else 1e-6)


def pose(machine, axis, x, carries_tool, perfect):
    e = [0.0 if perfect else error_at(machine, axis, i, x) for i in range(6)]
    square = [0.0 if perfect else 1e-6 * number for number in machine.square]
    if axis == "B":
        to = [c + l for c, l in zip(machine.centre, machine.tool)]
        own, e[4] = e[4], 0.0
        off = product(shifted(*e[:3]), turned(0, e[3]), turned(2, e[5]))
        return product(shifted(*to), off, turned(1, math.radians(x) + own), shifted(*(-number for number in to)))
    way = x if carries_tool else -x
    lean = {"X": (way, 0, 0), "Y": (-square[0] * way, way, 0), "Z": (square[1] * way, -square[2] * way, way)}[axis]
    return product(shifted(*lean), shifted(*e[:3]), turned(0, e[3]), turned(1, e[4]), turned(2, e[5]))


def tool_on_part(machine, at, perfect):
    part, tool = (side.split() for side in machine.chain.strip("wt ").split("b"))
    tip = product(*(pose(machine, axis, at[axis], True, perfect) for axis in tool), shifted(*machine.tool))[1]
    body = product(*(pose(machine, axis, at[axis], False, perfect) for axis in reversed(part)))
    way = [a - b for a, b in zip(tip, body[1])]
    return [sum(body[0][k][i] * way[k] for k in range(3)) for i in range(3)]


def off_um(machine, wanted, sent):
    return 1e3 * math.dist(tool_on_part(machine, wanted, True), tool_on_part(machine, sent, False))


# ---- measured, live and offline

def program_of(points):
    lines = ["G21 G90 G4 P4"]
    for point in points:
        lines += ["G0 " + " ".join(f"{axis}{value:.4f}" for axis, value in point.items()), "G4 P0.3"]
    return t.write("points.ngc", "\n".join(lines) + "\nM2\n")


def rests_of(program, *options):
    status, _, err = t.run("run", program, *options, "--rests", "rests.csv", "--quiet")
    t.check(status == 0, f"{program} runs {options}", err)
    return [1e3 * number for number in t.read_trace("rests.csv")["error_mm"][1:]]


def words_of(path):
    at, rows = {}, []
    with open(path) as file:
        for line in file:
            if line.startswith("G4") and at:
                rows.append(dict(at))
            elif line.startswith("G0"):
                at.update({letter: float(number) for letter, number in re.findall(r"([XYZB])\s*(-?[\d.]+)", line)})
    return rows


for number, chain in enumerate(("w b X Y Z t", "w B X Z b Y t")):
    machine = Machine(number, chain)
    path = machine.write(f"chain{number}.ini")
    options = ["--machine", path]
    for axis in machine.axes:
        table = f"unit{number}_{axis}.csv"
        status, _, err = t.run("calibrate", "--machine", path, "--unit", axis, "--grid", "17", "-o", table)
        t.check(status == 0, f"{chain}: the errors of unit {axis} are measured", err)
        options += ["--set", f"correction.unit_table_{axis.lower()}={table}"]
    rng = random.Random(number)
    points = [{axis: round(rng.uniform(-TRAVEL[axis], TRAVEL[axis]), 4) for axis in machine.axes} for _ in range(POINTS)]
    program = program_of(points)
    before, live = rests_of(program, "--machine", path), rests_of(program, *options)
    t.check(len(live) == POINTS, "every point is measured", len(live))
    t.check(all(abs(off_um(machine, point, point) - um) < 0.05 for point, um in zip(points, before)),
            f"{chain}: the virtual machine is as wrong as the model", max(before))
    t.check(max(before) > 20 and max(live) <= 1, f"{chain}: live within a micrometre", max(before), max(live))
    status, _, err = t.run("correct", program, *options, "--quiet", "-o", "points-corrected.ngc")
    t.check(status == 0, "a program of points is corrected", err)
    sent = words_of("points-corrected.ngc")
    t.check(len(sent) == POINTS, "every point is in the corrected program", len(sent))
    offline = [off_um(machine, point, at) for point, at in zip(points, sent)]
    t.check(max(offline) <= 2, f"{chain}: offline within two micrometres, by the model", max(offline))
    print(f"{chain}: {POINTS} points, um: uncorrected {max(before):.1f}, live {max(live):.3f}, offline {max(offline):.3f}", flush=True)

    if number == 0:
        status, _, err = t.run("calibrate", *options, "--compose", "--grid", "13x11x9", "-o", "composed.csv")
        t.check(status == 0, "a volume table is composed of the errors of units", err)
        composed = rests_of(program, "--machine", path, "--set", "correction.volume_table=composed.csv")
        t.check(max(composed) <= 1, "and holds within a micrometre", max(composed))
        print(f"as a volume table {max(composed):.3f}")
    status, _, err = t.run("machine", path, *options[2:], "--pack", "-o", "board.bin")
    t.check(status == 2 and "--compose" in err, "a board is not handed errors of units, but told what to do", err)

# ---- a volume in psi too corrects psi

t.write("turn.ini", "".join(f"[axis {a}]\n" for a in "XYZC") + "[geometry]\ntable_axis = C\ntable_yaw = 0 0 80 360 30\ntable_centre_mm = 20 10 0\n")
CUBE = "--from=-200,-100,0,-180", "--to=200,100,100,180"
status, _, err = t.run("calibrate", "--machine", "turn.ini", "--grid", "3x3x2x25", *CUBE, "-o", "turn.csv")
t.check(status == 0, "a volume with a turning axis is measured", err)
with open("turn.csv") as file:
    rows = [line.strip().split(",") for line in file if line[0] not in "#c"]
t.check(rows[0][-1] == "KC_urad", "and its table corrects the turning axis", rows[0])
yaw = [(-80 * (math.sin(math.radians(float(row[3]) + 30)) - 0.5), float(row[-1])) for row in rows[1:]]
t.check(max(abs(a - b) for a, b in yaw) < 0.6, "by what its angle is off", max(abs(a - b) for a, b in yaw))
t.check(max(abs(float(cell)) for row in rows[1:] for cell in row[4:7]) < 1, "and nothing else, since nothing else is off")

# ---- chains that cannot be, and tables that the machine would refuse

for chain, what in (("w b X Y t", "axis Z is missing"), ("w X C b Y Z t", "beside w"), ("X b Y", "such as w C X b Y Z t"),
                    ("w b X X Y Z t", "once"), ("w b X Q t", "units are X")):
    status, _, err = t.run("machine", "--set", f"machine.chain={chain}")
    t.check(status == 2 and what in err, f"chain {chain} is refused", err)
status, _, err = t.run("calibrate", "--machine", "chain0.ini", "--unit", "X", "--grid", "9", "--set", "correction.largest_mm=0.001", "-o", "x.csv")
t.check(status == 1 and "would refuse" in err and "EX" in err + "E", "what its own machine would refuse is not written", err)
status, _, err = t.run("calibrate", "--machine", "turn.ini", "--grid", "8x8x8x8", "-o", "x.csv")
t.check(status == 2 and "would refuse" in err, "a grid whose spline finds no room is refused before it is measured", err)
status, _, err = t.run("check", "points.ngc", "--machine", "chain0.ini", "--set", "correction.axis_table_x=unit0_X.csv")
t.check(status == 2 and "unit_table_x" in err, "errors of a unit are no corrections of an axis", err)

t.finish()
