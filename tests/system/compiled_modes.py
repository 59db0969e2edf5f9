"""Programs planned ahead with the machine's modes: the tool keeps the tolerance, whatever the motors do for it.

compiled_modes.py PROGRAMS FIRST runs more random programs than the test does, from seed FIRST on."""

import csv
import math
import random
import sys

import takt_test as t

PROGRAMS = int(sys.argv[1]) if len(sys.argv) > 1 else 1
FIRST = int(sys.argv[2]) if len(sys.argv) > 2 else 1
TOLERANCE_MM = 0.01
CYCLE_S = 0.001
PARTS = 10  # of a cycle, in which the oscillator is followed


class Oscillator:
    """e'' + 2 d w e' + w^2 e = -q'': q'' goes straight from sample to sample; Heun's steps are far below the tolerance."""

    def __init__(self, hz, damping):
        self.w, self.damping, self.e, self.v = 2 * math.pi * hz, damping, 0.0, 0.0

    def slope(self, e, v, a):
        return v, -a - 2 * self.damping * self.w * v - self.w**2 * e

    def follow(self, a0, a1):
        h = CYCLE_S / PARTS
        for k in range(PARTS):
            a, b = (a0 + (a1 - a0) * (k + i) / PARTS for i in (0, 1))
            e1, v1 = self.slope(self.e, self.v, a)
            e2, v2 = self.slope(self.e + h * e1, self.v + h * v1, b)
            self.e += h * (e1 + e2) / 2
            self.v += h * (v1 + v2) / 2
        return self.e


def tool_of(way, modes):
    """Where the tool is when the motors are on this way, cycle by cycle; the last one stays."""
    axes = []
    for axis, (hz, damping) in enumerate(modes):
        q = [0.0] + [point[axis] for point in way] + [way[-1][axis]]
        bend = [(q[k + 1] - 2 * q[k] + q[k - 1]) / CYCLE_S**2 for k in range(1, len(q) - 1)]
        mode, axes_off = Oscillator(hz, damping), []
        for k in range(len(way)):
            axes_off.append(mode.follow(bend[max(k - 1, 0)], bend[k]))
        axes.append([way[k][axis] + axes_off[k] for k in range(len(way))])
    return list(zip(*axes))


def off_segment(p, a, b):
    way = [y - x for x, y in zip(a, b)]
    square = sum(w * w for w in way)
    part = max(0.0, min(1.0, sum((x - y) * w for x, y, w in zip(p, a, way)) / square))
    return math.dist(p, [x + part * w for x, w in zip(a, way)])


def off_path(points, blocks, path):
    """The largest distance of points from the lines before, at and behind those they are said to be on."""
    last, most = len(path) - 2, 0.0
    for p, block in zip(points, blocks):
        near = range(max(min(block - 2, last), 0), min(block, last) + 1)
        most = max(most, min(off_segment(p, path[k], path[k + 1]) for k in near))
    return most


def make(seed):
    """A path of lines of a millimetre to two centimetres, with and against its own direction."""
    rng = random.Random(seed)
    path = [(0.0, 0.0, 0.0)]
    for _ in range(25):
        length, angle = 10 ** rng.uniform(0, 1.3), rng.uniform(0, 2 * math.pi)
        x, y = (min(80, max(0, v + length * d)) for v, d in zip(path[-1], (math.cos(angle), math.sin(angle))))
        path.append((round(x, 4), round(y, 4), round(rng.uniform(0, 2), 4)))
    lines = ["G1 X%.4f Y%.4f Z%.4f" % p for p in path[1:]]
    t.write("part.ngc", "\n".join(["G21 G90 G64 P%g" % TOLERANCE_MM, "F6000", *lines, "G4 P0.5", "M2"]) + "\n")
    return path, [(round(rng.uniform(10, 60), 1), round(rng.uniform(0.02, 0.1), 3)) for _ in range(3)]


def options(modes):
    return [w for axis, (hz, d) in zip("xyz", modes) for w in ("--set", f"geometry.mode_{axis}={hz} {d} 1 0 0 0")]


def run(plan, modes):
    status, out, err = t.run("run", "part.ngc", "--plan", plan, "--trace", "trace.csv", "--json", "run.json", *options(modes))
    with open("trace.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    way = [tuple(float(row[f"cmd_{axis}_mm"]) for axis in "XYZ") for row in rows]
    return status, t.load_json("run.json"), way, [int(row["block"]) for row in rows], out + err


for number in range(FIRST, FIRST + PROGRAMS):
    path_mm, machine = make(number)
    about = (number, machine)
    done, text, why = t.run("compile", "part.ngc", "-o", "soft.plan", *options(machine))
    if not t.check(done == 0, "a program is planned with modes", about, text, why):
        continue
    done, summary, motors, blocks, text = run("soft.plan", machine)
    t.check(done == 0, "every check of the run holds, limits of setpoints included", about, text)
    tool = tool_of(motors, machine)
    off = off_path(tool, blocks, path_mm)
    t.check(off <= 1.01 * TOLERANCE_MM, "the tool is within the tolerance, by another calculation", about, off)
    t.check(off_path(motors, blocks, path_mm) > TOLERANCE_MM, "where the motors alone are not", about)
    rest = max(math.dist(p, path_mm[-1]) for p in tool[-300:])
    t.check(rest < 0.1 * TOLERANCE_MM, "and rests when they do", about, rest)

    if number > FIRST:
        continue
    # The file fits a machine of other modes. There the tool does something else, and the judge says so.
    other = [(1.1 * hz, d) for hz, d in machine]
    done, else_, _, _, text = run("soft.plan", other)
    t.check(done == 1 and else_["setpoint_digest"] == summary["setpoint_digest"], "modes change no setpoint", about, text)
    t.check(else_["path_error_max_mm"] > 0, "the tool of another machine leaves the path", else_["path_error_max_mm"])
    # A stiff machine's plan, on this one.
    done, _, err = t.run("compile", "part.ngc", "-o", "stiff.plan")
    t.check(done == 0, "without modes", err)
    done, stiff, motors, blocks, text = run("stiff.plan", machine)
    t.check(done == 1 and stiff["path_error_max_mm"] > TOLERANCE_MM, "what knows no modes leaves the path", text)
    t.check(off_path(motors, blocks, path_mm) <= TOLERANCE_MM, "though its motors keep it", about)
    # With a shaper the modes are its own.
    shaped = [*options(machine), "--set", "machine.shaper=zv"]
    done, _, err = t.run("compile", "part.ngc", "-o", "shaped.plan", *shaped)
    t.check(done == 0, "with a shaper", err)
    with open("stiff.plan", "rb") as one, open("shaped.plan", "rb") as two:
        t.check(one.read() == two.read(), "the plan is that of a stiff machine", about)
    done, _, err = t.run("run", "part.ngc", "--plan", "shaped.plan", *shaped)
    t.check(done == 0, "and its run is judged by the way it was sent on", about, err)

# Where the frequency is known to a tenth, the tool keeps three tolerances at either end of that.
path_mm, machine = make(FIRST)
unsure = [*options([(25, 0.03)] * 3), "--set", "geometry.mode_uncertainty_percent=10 10 10"]
done, text, why = t.run("compile", "part.ngc", "-o", "unsure.plan", *unsure)
t.check(done == 0 and "where modes are" in text, "a program is planned for uncertain modes", text, why)
for ratio in (0.9, 1, 1.1):
    _, _, motors, blocks, _ = run("unsure.plan", [(25 * ratio, 0.03)] * 3)
    off = off_path(tool_of(motors, [(25 * ratio, 0.03)] * 3), blocks, path_mm)
    t.check(off <= (1.01 if ratio == 1 else 3) * TOLERANCE_MM, "and the tool keeps three tolerances, as known one", ratio, off)
done, _, err = t.run("compile", "part.ngc", "-o", "none.plan", *unsure, "--set", "geometry.mode_x=25 0.03 1 60 0.03 1")
t.check(done == 2 and "mode_uncertainty_percent" in err, "of two modes of an axis this is refused", done, err)

# In exact path a line ends in a rest in which nothing swings: else the next one would not be straight.
swings = options([(25, 0.03)] * 3)
t.write("exact.ngc", "G21 G90 G61\nF6000\nG1 X20\nG1 Y20\nG4 P0.1\nM2\n")
done, _, err = t.run("run", "exact.ngc", "--plan", "ahead", *swings)
t.check(done == 0, "lines in exact path end without swinging", done, err)
t.write("thread.ngc", "G21 G90 G64 P0.01\nF6000\nG1 X20\nG95 F1\nM3 S1000\nG1 Y20\nM2\n")
done, _, err = t.run("compile", "thread.ngc", "-o", "none.plan", *swings)
t.check(done == 2 and "thread.ngc:6" in err, "what cannot be planned ahead is told as ever", done, err)
t.finish()
