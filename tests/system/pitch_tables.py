"""Drives that take their own error of pitch and backlash back, by tables of their own (objects 2010 and 2011), set up by a DCF."""

import math
import random
import re

import takt_test as t
from drive_tables import concise, pitch_table

PITCH_MM, PERIOD_MM, PLAY_MM = 0.010, 60, 0.020
AXES = "XYZ"
# Drives that do not overshoot: what they overshoot by, the play keeps.
STIFF = [f"drive.{node}.{key}" for node in (1, 2, 3)
         for key in ("velocity_feed_forward_ratio=0", "velocity_integral_time_s=0", "viscous_friction_nm_s_per_rad=0")]
STIFF += [f"axis.{axis}.max_velocity_mm_s=20" for axis in AXES]
SCREWS = [f"drive.{node}.{key}" for node in (1, 2, 3)
          for key in (f"pitch_error_mm={PITCH_MM}", f"pitch_error_period_mm={PERIOD_MM}", f"backlash_mm={PLAY_MM}")] + STIFF


def visit(count):
    """A program that stands at random points, which it comes to from either side."""
    rng = random.Random(7)
    lines = ["G21 G90"]
    for _ in range(count):
        lines += ["G1 F1200 " + " ".join(f"{axis}{rng.uniform(-40, 40):.3f}" for axis in AXES), "G4 P0.5"]
    return t.write("visit.ngc", "\n".join(lines) + "\nM2\n")


def run(*settings):
    status, _, err = t.run("run", PROGRAM, "--quiet", "--json", "run.json", "--bus-log", "bus.log",
                           *[word for setting in settings for word in ("--set", setting)])
    t.check(status == 0, "the program runs", err)
    return t.load_json("run.json")


PROGRAM = visit(12)
table = pitch_table(-90, 3, [PITCH_MM * math.sin(2 * math.pi * (-90 + 3 * i) / PERIOD_MM) for i in range(61)], PLAY_MM)
FILES = [f"drive.{node}.dcf={concise(f'{node}.bin', node, table)}" for node in (1, 2, 3)]
perfect = run(*STIFF)
before = run(*SCREWS)
after = run(*SCREWS, *FILES)
off = {name: 1e3 * summary["tool_point"]["rest_error_max_mm"] for name, summary in (("before", before), ("after", after))}
print(f"the tool's point where it rests: off by {off['before']:.3f} um at most, with the drives' tables by {off['after']:.3f} um")
t.check(perfect["tool_point"] is None, "a machine without errors is not measured")
t.check(off["before"] > 20, "screws are off by tens of micrometres", off)
t.check(off["after"] < 0.1, "and not with the drives' own tables", off)
t.check(before["setpoint_digest"] == after["setpoint_digest"] == perfect["setpoint_digest"], "the controller knows nothing of it")

log = open("bus.log").read()
t.check(len(re.findall(r" 601#23112004", log)) == 1, "the master has written the points")

wrong = pitch_table(0, 0.001, [0, 1e-3], 0)
status, _, err = t.run("run", PROGRAM, "--quiet", "--set", "drive.1.dcf=" + concise("steep.bin", 1, wrong))
t.check(status == 1 and "axis X (node 1), object 2010:01, refuses" in err, "a table that is too steep is refused by its drive", err)
t.finish()
