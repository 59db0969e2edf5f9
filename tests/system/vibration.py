"""A machine that swings: the tool's point in trace and summary, and nothing else changes."""

import csv
import math
import os

import takt_test as t

PROGRAM = "G64 P0.01\nF6000\nG1 X20\nY15\nX0 Y0\nG2 X10 Y10 R10\nG4 P0.5\nM2\n"


def swing(hz, damping, second=(0, 0, 0)):
    """Options of a machine all of whose axes have this mode."""
    numbers = " ".join(str(n) for n in (hz, damping, 1 if not second[0] else 1 - second[2], *second))
    return [word for axis in "xyz" for word in ("--set", f"geometry.mode_{axis}={numbers}")]


def run(*options):
    status, out, err = t.run("run", "part.ngc", "--trace", "trace.csv", "--json", "summary.json", *options)
    t.check(status == 0, "the run holds its checks", options, status, out, err)
    with open("trace.csv", encoding="utf-8") as file:
        return t.load_json("summary.json"), list(csv.DictReader(file))


t.write("part.ngc", PROGRAM)
stiff, still = run()
t.check(stiff["tool_point"] is None and "tool_X_mm" not in still[0], "a stiff machine has no tool beside its drives")

soft, rows = run(*swing(25, 0.03))
way = soft["tool_point"]
t.check(soft["setpoint_digest"] == stiff["setpoint_digest"], "setpoints know nothing of it")
t.check([r["act_X_mm"] for r in rows] == [r["act_X_mm"] for r in still], "nor do the drives")
t.check(0 < way["way_error_rms_mm"] < way["way_error_max_mm"] < 1, "the tool is off the way", way)

# The tool swings about where the drive stands with the period and the decay it was given, when nothing moves any more.
last = [row for row in rows if row["set_X_mm"] == rows[-1]["set_X_mm"] and row["set_Y_mm"] == rows[-1]["set_Y_mm"]][-400:]
off = [float(row["tool_X_mm"]) - float(row["set_X_mm"]) for row in last]
peaks = [(k, abs(off[k])) for k in range(1, len(off) - 1) if abs(off[k]) >= max(abs(off[k - 1]), abs(off[k + 1])) and abs(off[k]) > 1e-7]
half = (peaks[-1][0] - peaks[0][0]) / (len(peaks) - 1)
t.check(abs(half - 20) < 0.1, "25 Hz is half a period of 20 cycles", half, peaks)
decay = math.log(peaks[0][1] / peaks[-1][1]) / (len(peaks) - 1)
t.check(abs(decay - math.pi * 0.03) < 0.02 * math.pi * 0.03 + 0.003, "and each is smaller by exp(pi 0.03)", decay, peaks)

# Four times the frequency: about a sixteenth of the way off, since away is a / w^2.
hard, _ = run(*swing(100, 0.03))
ratio = way["way_error_rms_mm"] / hard["tool_point"]["way_error_rms_mm"]
t.check(ratio > 4, "a stiffer machine is nearer", ratio)
both, _ = run(*swing(25, 0.03, (100, 0.03, 0.5)))
t.check(hard["tool_point"]["way_error_rms_mm"] < both["tool_point"]["way_error_rms_mm"] < way["way_error_rms_mm"],
        "half of each mode is between them", both["tool_point"])

# Frequencies by place: the last rest of the program is at Y 10, where the table says twice the frequency.
places = ("--set", "geometry.mode_x_along=Y", "--set", "geometry.mode_x_places_mm=-30 10", "--set", "geometry.mode_x_ratio=1 1.25 1.5 1.75 2")
moved, rows = run(*swing(25, 0.03), *places)
last = [row for row in rows if row["set_X_mm"] == rows[-1]["set_X_mm"] and row["set_Y_mm"] == rows[-1]["set_Y_mm"]][-400:]
off = [float(row["tool_X_mm"]) - float(row["set_X_mm"]) for row in last]
turns = [k for k in range(1, len(off) - 1) if abs(off[k]) >= max(abs(off[k - 1]), abs(off[k + 1])) and abs(off[k]) > 1e-7]
half = (turns[-1] - turns[0]) / (len(turns) - 1)
t.check(abs(half - 10) < 0.1, "at the end of the table it swings with 50 Hz", half, turns)
t.check(moved["setpoint_digest"] == stiff["setpoint_digest"], "setpoints know nothing of that either")

# Across: while X moves alone the tool leaves it by parts of its swing.
_, rows = run("--set", "geometry.mode_x=25 0.03 1 0 0 0", "--set", "geometry.mode_x_across=0 0.5 -0.25")
stretch = [row for row in rows if row["line"] == "3"]
alone = [(float(row["tool_Y_mm"]), float(row["tool_Z_mm"])) for row in stretch
         if all(row[axis] == stretch[0][axis] for axis in ("set_Y_mm", "set_Z_mm"))]
t.check(max(abs(y) for y, _ in alone) > 0.01, "the tool leaves the line", alone[:5])
t.check(all(abs(z + y / 2) < 2e-8 for y, z in alone), "along Y and Z by its parts", alone)

for value, says in (("25 1 1 0 0 0", "damping"), ("25 0.1 0 0 0 0", "part"), ("-5 0 1 0 0 0", "frequency")):
    status, _, err = t.run("run", "part.ngc", "--set", "geometry.mode_y=" + value)
    t.check(status == 2 and "geometry.mode_y" in err and says in err, "a mode without sense is refused with its key", value, err)
for key, value, says in (
    ("mode_x_across", "0 1 0", "_across"),
    ("mode_x_across", "0 11 0", "at most 10"),
    ("mode_x_places_mm", "5 1", "_places_mm"),
    ("mode_x_places_mm", "0 1", "_along"),
    ("mode_x_along", "A", "X, Y, Z or none"),
    ("mode_x_ratio", "1 2 3", "5 numbers"),
):
    status, _, err = t.run("run", "part.ngc", "--set", f"geometry.{key}={value}")
    t.check(status == 2 and "geometry.mode_x" in err and says in err, f"{key} = {value} is refused", err)
t.check(os.path.exists("trace.csv"), "and what was there stays")
t.finish()
