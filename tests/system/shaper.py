"""Shaped setpoints: a machine that swings rests when its setpoints rest, and its tool keeps the way, within all limits.

What is left of a swing is found here from the setpoints that were sent, by an oscillator of this file. With an argument: the
real programs that it names, in a table (`shaper.py f6000/tort.ngc`).
"""

import math
import sys

import takt_test as t

CYCLE_S = 0.001
FORMS = ("none", "zv", "neutral", "mzv", "ei")

# Lines and arcs, long and short, along one axis and several, each to rest.
REST = ("G1 X0.5", "G1 X3", "G1 X30 Y10", "G1 X80 Y30", "G2 X60 Y30 I-10 J0", "G1 X59.9", "G1 X0 Y0 Z-5", "G3 X0 Y4 I0 J2")
# A winding smoothed path with arcs.
WAY = "G64 P0.01 F6000\n" + "".join(
    f"G1 X{4 * k} Y{3 * (k % 2)}\nG2 X{4 * k + 2} Y{3 * (k % 2)} I1 J0\n" for k in range(12)) + "M2\n"


def modes(x, y=None, z=None):
    """Options: the modes of X, Y and Z, each (Hz, damping, part) or two of them in a row."""
    numbers = {"x": x, "y": y or x, "z": z or x}
    return [word for axis, mode in numbers.items() for word in
            ("--set", f"geometry.mode_{axis}=" + " ".join(str(n) for n in (*mode, 0, 0, 0)[:6]))]


def run(program, form, *options):
    """The summary; the run holds its checks, limits and way among them."""
    status, out, err = t.run("run", program, "--json", "run.json", "--set", f"machine.shaper={form}", *options)
    t.check(status == 0, f"{form}: all checks hold", program, options, out, err)
    return t.load_json("run.json")


def trace_of(program, form, *options):
    run(program, form, "--trace", "trace.csv", *options)
    return t.read_trace("trace.csv")


def advance(hz, damping):
    """(away, rate) after a cycle of free swing, by their values before."""
    w = 2 * math.pi * hz
    d, turn = damping * w, w * math.sqrt(1 - damping * damping)
    shrink, cosine, sine = math.exp(-d * CYCLE_S), math.cos(turn * CYCLE_S), math.sin(turn * CYCLE_S) / turn
    return (shrink * (cosine + d * sine), shrink * sine), (-shrink * w * w * sine, shrink * (cosine - d * sine))


def swing(at, mode, rests):
    """Amplitude of the mode of an axis that is sent there, in the cycles of rests."""
    (aa, ar), (ra, rr) = advance(*mode)
    away = rate = velocity = 0.0
    left = []
    for n in range(1, len(at)):
        now = (at[n] - at[n - 1]) / CYCLE_S
        away, rate = aa * away + ar * (rate - now + velocity), ra * away + rr * (rate - now + velocity)
        velocity = now
        if n in rests:
            left.append(math.hypot(away, rate / (2 * math.pi * mode[0])))
    return left


def rests_of(trace):
    """Where setpoints have just come to rest for a while: two cycles in, so that their velocity is 0."""
    places = list(zip(trace["set_X_mm"], trace["set_Y_mm"], trace["set_Z_mm"]))
    return [n for n in range(3, len(places) - 100)
            if places[n - 3] != places[n - 2] and all(p == places[n - 2] for p in places[n - 2:n + 100])]


def left_of(form, x, y):
    """Root of the sum of squares of what swings after each move, mm."""
    trace = trace_of("rest.ngc", form, *modes((*x, 1), (*y, 1)))
    rests = rests_of(trace)
    t.check(len(rests) == len(REST), f"{form}: rests after each move", rests)
    t.check(all(trace[f"set_{axis}_mm"][n] == trace[f"cmd_{axis}_mm"][n] for n in rests for axis in "XYZ"),
            f"{form}: and exactly there")
    return math.hypot(*(a for axis, mode in (("X", x), ("Y", y)) for a in swing(trace[f"set_{axis}_mm"], mode, set(rests))))


def figures(program, form, *options):
    """Time s, rms and largest distance of the tool from its way, um."""
    summary = run(program, form, *options)
    point = summary["tool_point"]
    return summary["program_time_s"], 1e3 * point["way_error_rms_mm"], 1e3 * point["way_error_max_mm"]


def compare(program, *options):
    """Every form; and drives: a machine so stiff that only they err."""
    found = {form: figures(program, form, *options) for form in FORMS}
    found["drives"] = figures(program, "none", *modes((3000, 0.1, 1)))
    print(program, *options)
    for form, (time_s, rms, most) in found.items():
        print(f"  {form:8} {time_s:9.3f} s   rms {rms:7.2f} um   max {most:7.1f} um")
    return found.values()


def check_forms(program, *options):
    """With one mode an axis zv is enough, in no more time than mzv; with two it is nearer than that, and neutral is enough."""
    none, zv, neutral, mzv, _, drives = compare(program, *options)
    two = any(option.split()[-1] != "0" for option in options if option.startswith("geometry."))
    quarter = none[1] / 4 + drives[1]
    t.check(two or zv[1] <= quarter, "zv: a quarter of the error, beside that of the drives", program, options, zv, none, drives)
    t.check(zv[1] < mzv[1] and zv[0] <= mzv[0], "zv: nearer than mzv, and not later", program, options, zv, mzv)
    t.check(neutral[1] <= quarter, "neutral: likewise, whatever the modes", program, options, neutral, none, drives)
    t.check(neutral[0] < 1.12 * none[0] + 1, "neutral: some part of the limits, and its stops", program, options, neutral, none)


if len(sys.argv) > 1:
    for path in t.real_programs(*sys.argv[1:]):
        for mode in ((10, 0.05, 1), (25, 0.03, 1), (60, 0.1, 1)):
            check_forms(path, *modes(mode))
    t.finish()

t.write("rest.ngc", "G61 F6000\n" + "".join(line + "\nG4 P0.3\n" for line in REST) + "M2\n")
for x, y in (((10, 0.1), (13, 0.02)), ((25, 0.03), (32.4, 0.05)), ((37.3, 0.02), (60, 0.1)), ((60, 0.02), (10, 0.05))):
    unshaped = left_of("none", x, y)
    for form in ("zv", "neutral"):
        left = left_of(form, x, y)
        t.check(left <= 0.01 * unshaped, "at most 1 % of a swing is left", form, x, y, left, unshaped)

t.write("way.ngc", WAY)
check_forms("way.ngc", *modes((25, 0.03, 1), (31, 0.05, 1)))
check_forms("way.ngc", *modes((20, 0.03, 0.7, 55, 0.05, 0.3)))

plain, shaped, again = (run("way.ngc", form, *modes((25, 0.03, 1))) for form in ("none", "zv", "zv"))
t.check(shaped["setpoint_digest"] == again["setpoint_digest"] != plain["setpoint_digest"], "the same setpoints in every run")

# Nothing is left out where the axes are held, slowed and led from block to block.
t.write("slow.txt", "0 100\n0.4 30\n0.9 120\n")
run("way.ngc", "neutral", *modes((25, 0.03, 1)), "--override", "slow.txt")
t.write("square.ngc", "G61 F6000\nM3 S1000\nG1 X10\nY10\nX0\nY0\nM5\nG0 Z1\nM2\n")
trace = trace_of("square.ngc", "neutral", *modes((12, 0.05, 1), (40, 0.05, 1)))
for corner in ((10, 0), (10, 10), (0, 10), (0, 0)):
    t.check(any(abs(x - corner[0]) < 1e-9 and abs(y - corner[1]) < 1e-9 for x, y in zip(trace["set_X_mm"], trace["set_Y_mm"])),
            "corners of the exact path are come to", corner)

for options, says in ((("--set", "machine.shaper=zv"), "no axis has a mode"),
                      (("--set", "machine.shaper=zwei", *modes((25, 0.03, 1))), "none, neutral, zv, mzv or ei"),
                      (("--set", "machine.shaper=zv", *modes((400, 0.03, 1))), "too quick"),
                      (("--set", "machine.shaper=zv", *modes((0.5, 0.03, 1))), "too slow")):
    status, _, err = t.run("run", "way.ngc", *options)
    t.check(status == 2 and "machine.shaper" in err and says in err, "what cannot be shaped is refused", options, err)
t.finish()
