"""Simple programs compile at any feed on any machine, keep every limit, and take no longer than the exact path.

compiled_any.py NUMBER FIRST: so many programs from a seed on; compiled_any.py NUMBER FIRST wide: of machines whose axes are
up to 100 apart, of any cycle, of arcs and lines in space, of tolerances up to the size of the part, of G93."""

import math
import random
import sys

import takt_test as t

PROGRAMS = int(sys.argv[1]) if len(sys.argv) > 1 else 12
FIRST = int(sys.argv[2]) if len(sys.argv) > 2 else 0
WIDE = len(sys.argv) > 3 and sys.argv[3] == "wide"
RADIUS_MM = 0.01  # of arcs, at least
JERK_MM = 1e-9  # in a cycle, at least: less is refused
PATH_MM = 0.002  # tolerance, at least: two increments
SECONDS = 3  # of a move at its feed, at most
KNOTS = 4  # that rest at both ends of a section may take


def log_uniform(r, low, high):
    return math.exp(r.uniform(math.log(low), math.log(high)))


def machine(r):
    values = {"max_velocity_mm_s": log_uniform(r, 5, 500), "max_acceleration_mm_s2": log_uniform(r, 50, 20000),
              "max_jerk_mm_s3": log_uniform(r, 500, 2e6)}
    cycle_us = r.choice((1000, 2000, 4000))
    options = ["--set", f"machine.cycle_us={cycle_us}"]
    for axis in "XYZ":
        for key, value in values.items():
            options += ["--set", f"axis.{axis}.{key}={value:.6g}"]
    return options, values["max_velocity_mm_s"], 1e-6 * max(cycle_us, 2000)


def wide_machine(r):
    """V, the times V/A and A/J, and each axis apart from that."""
    velocity = log_uniform(r, 5, 500)
    acceleration = velocity / log_uniform(r, 0.01, 1)
    jerk = acceleration / log_uniform(r, 0.002, 0.5)
    cycle_us = r.choice((250, 500, 1000, 2000, 4000))
    options, slowest = ["--set", f"machine.cycle_us={cycle_us}"], velocity
    for axis in "XYZ":
        for key, value in (("max_velocity_mm_s", velocity), ("max_acceleration_mm_s2", acceleration), ("max_jerk_mm_s3", jerk)):
            own = value * log_uniform(r, 0.1, 10)
            if key == "max_jerk_mm_s3":
                own = max(own, JERK_MM / (1e-6 * cycle_us) ** 3)
            slowest = min(slowest, own) if key == "max_velocity_mm_s" else slowest
            options += ["--set", f"axis.{axis}.{key}={own:.6g}"]
        for setting in ("drive_type=step", "steps_per_mm=1", "following_error_max_mm=0"):
            options += ["--set", f"axis.{axis}.{setting}"]
    return options, slowest, 1e-6 * max(cycle_us, 2000)


def program(r, velocity_mm_s):
    feed = log_uniform(r, 0.1, 60 * velocity_mm_s)
    length = min(log_uniform(r, 0.01, 20), SECONDS / 60 * feed)
    lines = [r.choice(("G61", f"G64 P{log_uniform(r, 0.002, 0.1):.4f}")), f"F{feed:.4f}"]
    for _ in range(r.randint(1, 4)):
        lines.append(f"G1 X{r.uniform(-length, length):.5f} Y{r.uniform(-length, length):.5f}")
    return "\n".join(lines) + "\nM2\n"


def wide_move(r, at, length):
    """To a random place, straight or by an arc through a centre beside."""
    size = length * log_uniform(r, 0.01, 1)
    to = [a + r.uniform(-size, size) for a in at]
    turn, i, j = r.uniform(-6, 6), r.uniform(-size, size), r.uniform(-size, size)
    if r.random() < 0.7 or math.hypot(i, j) < RADIUS_MM:
        return to, "G1 X%.6f Y%.6f Z%.6f" % tuple(to)
    x, y = at[0] + i, at[1] + j
    to = [x - i * math.cos(turn) + j * math.sin(turn), y - i * math.sin(turn) - j * math.cos(turn), at[2]]
    return to, "G%d X%.7f Y%.7f I%.7f J%.7f" % (3 if turn > 0 else 2, to[0], to[1], i, j)


def wide_program(r, velocity_mm_s):
    feed = log_uniform(r, 0.1, 120 * velocity_mm_s)
    length = min(log_uniform(r, 0.01, 50), SECONDS / 60 * min(feed, 60 * velocity_mm_s))
    lines = ["G90 G17", r.choice(("G61", f"G64 P{max(PATH_MM, length * log_uniform(r, 1e-4, 1)):.6f}")), f"F{feed:.4f}"]
    if r.random() < 0.2:
        lines.append("G93")
    at = [0.0, 0.0, 0.0]
    for _ in range(r.randint(1, 12)):
        at, move = wide_move(r, at, length)
        lines.append(move + (f" F{log_uniform(r, 0.3, 100) * 60:.4f}" if "G93" in lines else ""))
    return "\n".join(lines) + "\nM2\n"


def run(path, *options):
    t.run("run", path, "--json", "run.json", "--quiet", *options)
    return t.load_json("run.json")


def try_program(seed):
    r = random.Random(seed)
    options, velocity_mm_s, knot_s = (wide_machine if WIDE else machine)(r)
    text = (wide_program if WIDE else program)(r, velocity_mm_s)
    path = t.write("any.ngc", text)
    status, _, err = t.run("compile", path, "-o", "any.plan", "--quiet", *options)
    if not t.check(status == 0, f"program {seed} compiles", err, text, options):
        return
    exact = run(path, "--exact-path", *options)
    ahead = run(path, "--plan", "any.plan", *options)
    broken = [check["name"] for check in ahead["checks"] if not check["held"]]
    t.check(ahead["outcome"] == "completed" and broken == [], f"program {seed} keeps every limit", broken, text, options)
    most_s = 1.01 * exact["program_time_s"] + KNOTS * knot_s * ahead["blocks"]
    t.check(ahead["program_time_s"] <= most_s, f"program {seed} is no slower than the exact path",
            ahead["program_time_s"], exact["program_time_s"], text, options)


def many_short_blocks_are_planned_ahead():
    """In 34 ms 200 blocks are passed, more than the look-ahead has: that was told to stray, and driven on the exact path."""
    places = [(2.5e-4 * i * math.cos(i / 8), 2.5e-4 * i * math.sin(i / 8)) for i in range(200)]
    lines = "".join(f"G1 X{x:.5f} Y{y:.5f}\n" for x, y in places)
    path = t.write("short.ngc", "G21 G90 G17 G64 P0.1 F600\n" + lines + "M2\n")
    few = ("--set", "machine.look_ahead_blocks=2")
    exact_s, ahead_s = (run(path, *options, *few)["program_time_s"] for options in (("--exact-path",), ("--plan", "ahead")))
    t.check(ahead_s < 0.05 * exact_s, "a path of short blocks within a wide tolerance is optimised", ahead_s, exact_s)


def quanta_fit_the_axis_of_least_jerk():
    """48 times less than another's: a setpoint put on a section's end took 1.006 of it, and the exact path was driven."""
    limits = {"X": (92.4474, 2255.68, 10054.9), "Y": (13.0807, 436.735, 138201.0), "Z": (494.842, 950.206, 479702.0)}
    options = ["--set", "machine.cycle_us=403"]
    for axis, values in limits.items():
        for key, value in zip(("velocity_mm_s", "acceleration_mm_s2", "jerk_mm_s3"), values):
            options += ["--set", f"axis.{axis}.max_{key}={value}"]
        for setting in ("drive_type=step", "steps_per_mm=1", "following_error_max_mm=0"):
            options += ["--set", f"axis.{axis}.{setting}"]
    path = t.write("quanta.ngc", "G21 G90 G64 P0.288606 F8.22\nG0 X0.16709 Y-0.20214\nG1 X1.00043 Y1.22023\nM2\n")
    exact_s, ahead_s = (run(path, *way, *options)["program_time_s"] for way in (("--exact-path",), ("--plan", "ahead")))
    t.check(ahead_s < 0.9 * exact_s, "axes of unequal jerk are optimised", ahead_s, exact_s)


for number in range(FIRST, FIRST + PROGRAMS):
    try_program(number)
if len(sys.argv) == 1:
    many_short_blocks_are_planned_ahead()
    quanta_fit_the_axis_of_least_jerk()
    try_program(280)  # a quantum of 2e-6 mm: the end of a section was not taken for that of its block
t.finish()
