"""Programs that an adversarial hunt found broken, each as short as it still was: what they broke holds now.

More of their kinds: test_single_block, test_rotary_moves, test_threads (random ones), service_single_block, ahead_solver,
program_flow, takt_tube_judge, commands, outputs, hunt_short.
"""

import csv
import math

import takt_test as t

SOFT = {"velocity_mm_s": 50, "acceleration_mm_s2": 500, "jerk_mm_s3": 10000}
FAST = {"velocity_mm_s": 500, "acceleration_mm_s2": 500, "jerk_mm_s3": 5000}
JERKY = {"velocity_mm_s": 100, "acceleration_mm_s2": 1000, "jerk_mm_s3": 400}
NEVER_ENDS = """G21 G90 G17 G64 P0.2
F1090.629
G1 X-0.56 Y0.04
G2 X-0.40 Y2.25 I0.08 J1.11
G1 X0.14 Y2.21
G2 X0.11 Y1.81 I-0.01 J-0.20
G1 X-2.93 Y2.04
M2
"""
SQUARE = "G21 G90 G64 P1\nF6000\nG1 X10\nY10\nX0\nY0\nM2\n"
TURNS = "G21 G90 G17 G64 P1\nF600\nG1 X2\nG2 X2 Y0 I0.6 P3\nG1 X4\nM2\n"
SLOW_FEED = "G21 G90 G64 P0.01\nF600\nG1 X30\nM2\n"


def run(name, text, limits, *options):
    """Summary and trace; every check must hold."""
    words = [f"axis.{axis}.max_{key}={value}" for axis in "XYZ" for key, value in limits.items()]
    words = [word for pair in words for word in ("--set", pair)]
    status, out, err = t.run("run", t.write(name + ".ngc", text), "--json", "s.json", "--trace", "t.csv", "--quiet", "--until", "300", *words, *options)
    summary = t.load_json("s.json")
    broken = [check["name"] for check in summary["checks"] if not check["held"]]
    t.check(status == 0 and summary["outcome"] == "completed", name + ": comes to its end, and holds", status, broken, out, err)
    with open("t.csv", encoding="utf-8") as file:
        return summary, list(csv.DictReader(file))


def travelled_mm(rows):
    places = [[float(row[f"set_{axis}_mm"]) for axis in "XYZ"] for row in rows]
    return sum(math.dist(a, b) for a, b in zip(places, places[1:]))


def never_slower(name, text, limits):
    """Within a tolerance than in exact path, but for the cycles in which a chain begins and ends."""
    exact, _ = run(name + ", exact", text, limits, "--exact-path")
    smooth, rows = run(name, text, limits)
    t.check(smooth["program_time_s"] <= 1.01 * exact["program_time_s"] + 0.003, name + ": not slower than exact", smooth["program_time_s"], exact["program_time_s"])
    return rows


run("a chain that never ended", NEVER_ENDS, SOFT)
t.check(travelled_mm(never_slower("a square within 1 mm", SQUARE, {})) <= 40, "it does not wander")
never_slower("one straight line", "G21 G90 G64 P0.01\nF600\nG1 X400\nM2\n", FAST)
never_slower("a short one", "G21 G90 G64 P0.0005\nF6000\nG1 X10\nM2\n", {})
run("turns hardly wider than the tolerance", TURNS, JERKY)
for law in ("jerk", "smooth"):
    run("turns, law " + law, TURNS.replace("P1", "P0.1"), {}, "--set", "machine.cycle_us=250", "--set", "machine.law=" + law, "--drive-type", "step")
_, trace = run("a slow feed", SLOW_FEED, {})
t.check(max(float(row["feed_mm_min"]) for row in trace) <= 600.001, "the trace tells the feed of a smoothed path", max(float(row["feed_mm_min"]) for row in trace))
for name, program in (("hardly any way at a low feed", "F1.7\nG1 X0.06 Y-0.01\nM2\n"), ("a low feed", "F1\nG1 X10 Y-3\nM2\n")):
    status, out, err = t.run("compile", t.write("slow.ngc", "G21 G90 G64 P0.01\n" + program), "--output", "slow.plan")
    t.check(status == 0, name + ": is compiled", out, err)
t.finish()
