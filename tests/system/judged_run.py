"""Runs a program and judges its trace again, without a word of takt's own figures."""

import takt_test as t

LIMITS = 100.0, 1000.0, 50000.0
RATIOS = 1.0001, 1.0001, 1.001
CYCLE_S = 0.001

# Ends and centres of canon have six decimals: a curve made of them lies as far off as their rounding can reach.
CANON_ROUNDING_MM = 2e-6


def judge_limits(name, trace):
    for axis in "XYZ":
        found = t.peaks(trace[f"set_{axis}_mm"], CYCLE_S)
        for what, value, limit, ratio in zip(("velocity", "acceleration", "jerk"), found, LIMITS, RATIOS):
            t.check(value <= limit * ratio, f"{name}: {what} of {axis} within its limit", value)


def judge_path(name, trace, moves, chord_mm):
    worst, block, place = 0.0, 0, 0.0
    points = zip(trace["cmd_X_mm"], trace["cmd_Y_mm"], trace["cmd_Z_mm"])
    for number, point in zip(trace["block"], points):
        if number != block:
            block, place = number, 0.0
        distance, place = moves[int(block) - 1].distance(point, place)
        worst = max(worst, distance)
    t.check(worst <= 1e-6 + chord_mm + CANON_ROUNDING_MM, f"{name}: setpoints on the programmed path", worst)


def judge_landings(name, trace, moves, stops):
    """Where a block ends at rest, its last setpoint is the programmed end."""
    last = {}
    for number, *point in zip(trace["block"], trace["cmd_X_mm"], trace["cmd_Y_mm"], trace["cmd_Z_mm"]):
        last[int(number)] = point
    for number in stops:
        off = max(abs(a - b) for a, b in zip(last[number], moves[number - 1].end))
        t.check(off <= 0.5e-6 + 1e-9, f"{name}: block {number} ends where it should", off)


def planned_stops(path, *options):
    status, _, err = t.run("plan", path, *options, "--json", "plan.json", "--quiet")
    t.check(status == 0, f"{path} can be planned", err)
    return [block["block"] for block in t.load_json("plan.json")["blocks"] if block.get("end") == "stop"]


def judged_run(path, *options):
    """Returns the summary of a run whose trace has been judged."""
    name = t.os.path.basename(path)
    status, _, err = t.run("run", path, *options, "--trace", "trace.csv", "--json", "run.json", "--quiet")
    summary = t.load_json("run.json")
    t.check(status == 0, f"{name}: every check held", err, [c for c in summary["checks"] if not c["held"]])
    t.check(summary["outcome"] == "completed", f"{name}: completed")
    t.check(summary["landing_error_max_mm"] <= 1e-9, f"{name}: lands", summary["landing_error_max_mm"])
    trace = t.read_trace("trace.csv")
    t.check(len(trace["cycle"]) == summary["cycles"], f"{name}: one row per cycle")
    t.check(list(trace["cycle"]) == list(range(summary["cycles"])), f"{name}: cycles without gaps")
    moves = t.canon(path, *options)
    t.check(summary["blocks"] == max(trace["block"]), f"{name}: blocks are those of the trace")
    judge_limits(name, trace)
    judge_path(name, trace, moves, summary["chord_error_max_mm"])
    judge_landings(name, trace, moves, planned_stops(path, *options))
    again_status, _, _ = t.run("run", path, *options, "--json", "again.json", "--quiet")
    again = t.load_json("again.json")
    t.check(again_status == 0 and again["setpoint_digest"] == summary["setpoint_digest"], f"{name}: same digest again")
    return summary
