"""Simple programs compile at any feed on any machine, keep every limit, and take no longer than the exact path."""

import math
import random

import takt_test as t

PROGRAMS = 12
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


def program(r, velocity_mm_s):
    feed = log_uniform(r, 0.1, 60 * velocity_mm_s)
    length = min(log_uniform(r, 0.01, 20), SECONDS / 60 * feed)
    lines = [r.choice(("G61", f"G64 P{log_uniform(r, 0.002, 0.1):.4f}")), f"F{feed:.4f}"]
    for _ in range(r.randint(1, 4)):
        lines.append(f"G1 X{r.uniform(-length, length):.5f} Y{r.uniform(-length, length):.5f}")
    return "\n".join(lines) + "\nM2\n"


def run(path, *options):
    t.run("run", path, "--json", "run.json", "--quiet", *options)
    return t.load_json("run.json")


for seed in range(PROGRAMS):
    r = random.Random(seed)
    options, velocity_mm_s, knot_s = machine(r)
    text = program(r, velocity_mm_s)
    path = t.write("any.ngc", text)
    status, _, err = t.run("compile", path, "-o", "any.plan", "--quiet", *options)
    t.check(status == 0, f"program {seed} compiles", err, text, options)
    exact = run(path, "--exact-path", *options)
    ahead = run(path, "--plan", "any.plan", *options)
    broken = [check["name"] for check in ahead["checks"] if not check["held"]]
    t.check(ahead["outcome"] == "completed" and broken == [], f"program {seed} keeps every limit", broken, text, options)
    most_s = 1.01 * exact["program_time_s"] + KNOTS * knot_s * ahead["blocks"]
    t.check(ahead["program_time_s"] <= most_s, f"program {seed} is no slower than the exact path",
            ahead["program_time_s"], exact["program_time_s"], text, options)
t.finish()
