"""
Planned ahead, a machine with a higher limit is never slower, nor is a larger tolerance: every limit of random machines is
doubled, one after the other, and the tolerance of random programs, over decades of their dimensionless ratios.

compiled_monotone.py NUMBER FIRST: so many programs from a seed on.
"""

import math
import random
import sys

import takt_test as t

PROGRAMS = int(sys.argv[1]) if len(sys.argv) > 1 else 2
FIRST = int(sys.argv[2]) if len(sys.argv) > 2 else 1
ROOM_PART = 1.01
KNOTS = 2  # to which times are rounded up at both ends of a section

LIMITS = ("max_velocity_mm_s", "max_acceleration_mm_s2", "max_jerk_mm_s3")


def log_uniform(r, low, high):
    return math.exp(r.uniform(math.log(low), math.log(high)))


def random_machine(r):
    """V, and the times V/A and A/J, which say how a machine feels."""
    velocity = log_uniform(r, 20, 300)
    acceleration = velocity / log_uniform(r, 0.02, 0.5)
    jerk = acceleration / log_uniform(r, 0.002, 0.2)
    return [velocity, acceleration, jerk]


def random_chords(r):
    """A curve in chords: turns of a random bend, corners now and then."""
    length = log_uniform(r, 0.2, 5)
    heading = r.uniform(0, 6)
    bend = r.uniform(-0.5, 0.5)
    corner = r.uniform(0, 0.5)
    x = y = 0.0
    lines = []
    for _ in range(r.randint(10, 60)):
        heading += r.uniform(-3, 3) if r.random() < corner else bend
        x += length * math.cos(heading)
        y += length * math.sin(heading)
        lines.append(f"G1 X{x:.4f} Y{y:.4f}")
    return lines


def options_of(machine):
    options = []
    for axis in "XYZ":
        for key, value in zip(LIMITS, machine):
            options += ["--set", f"axis.{axis}.{key}={value:.8g}"]
        options += ["--set", f"axis.{axis}.travel_min_mm=-1000", "--set", f"axis.{axis}.travel_max_mm=1000"]
    return options


def time_s(name, machine, tolerance_mm, feed, lines):
    head = f"G21 G90 G64 P{tolerance_mm:.6f} F{feed:.4f}"
    path = t.write("monotone.ngc", "\n".join([head, *lines, "M2", ""]))
    status, _, err = t.run("run", path, "--plan", "ahead", "--json", "run.json", "--quiet", *options_of(machine))
    ran = t.load_json("run.json") if status == 0 else {}
    broken = [check["name"] for check in ran.get("checks", []) if not check["held"]]
    t.check(status == 0 and not broken, f"{name} runs within every limit", err, broken, machine)
    return ran.get("program_time_s", math.nan)


def try_program(seed):
    r = random.Random(seed)
    machine = random_machine(r)
    tolerance_mm = log_uniform(r, 0.003, 0.2)
    feed = 60 * machine[0] * log_uniform(r, 0.1, 2)
    lines = random_chords(r)
    here_s = time_s(f"program {seed}", machine, tolerance_mm, feed, lines)
    most_s = ROOM_PART * here_s + KNOTS * 0.002
    cases = {key: ([v * (1 + (i == k)) for i, v in enumerate(machine)], tolerance_mm) for k, key in enumerate(LIMITS)}
    cases["P"] = (machine, 2 * tolerance_mm)
    for what, (better, wider_mm) in cases.items():
        then_s = time_s(f"program {seed}, {what} doubled,", better, wider_mm, feed, lines)
        t.check(then_s <= most_s, f"program {seed} is no slower when {what} is doubled", f"{here_s} s, then {then_s} s",
                machine, tolerance_mm, feed)


for seed in range(FIRST, FIRST + PROGRAMS):
    try_program(seed)
t.finish()
