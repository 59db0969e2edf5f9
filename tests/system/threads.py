"""Threads, taps and feeds per revolution in whole runs: phase of the drives' positions, limits, alarms, one digest."""

import os

import takt_test as t

# The position reported in a cycle is of the moment in which the angle of the cycle before was read.
REPORTED_LATER = 1


def traced(name, program, *options):
    path = t.write(name + ".ngc", program)
    status, out, err = t.run("run", path, "--trace", name + ".csv", "--json", name + ".json", "--quiet", *options)
    return status, err, t.load_json(name + ".json"), t.read_trace(name + ".csv")


def off_the_thread(trace, block, pitch, start, sign, least, most):
    """Largest distance of the drive's position from the thread that begins at a whole revolution, in a part of a block."""
    worst, rows = 0.0, 0
    for row in range(REPORTED_LATER, len(trace["cycle"])):
        depth = sign * (trace["act_Z_mm"][row] - start)
        if trace["block"][row] == block and least < depth < most:
            turns = depth / pitch - abs(trace["spindle_rev"][row - REPORTED_LATER])
            worst, rows = max(worst, abs(turns - round(turns)) * pitch), rows + 1
    t.check(rows > 100, "the thread is in the trace", block, rows)
    return worst


THREAD = """G21 G90
M3 S600
G0 X10 Z5
G33 Z-20 K1.5
G0 X20
G0 Z5
G0 X10
S350
G33 Z-20 K1.5
G0 X20
M2
"""
status, err, summary, trace = traced("thread", THREAD)
t.check(status == 0 and err == "", "a thread is cut", status, err)
for block in (2, 6):
    off = off_the_thread(trace, block, 1.5, 5, -1, 1.5, 24)
    t.check(off < 0.002, "each pass is on the same thread, whatever its speed", block, off)
digest = summary["setpoint_digest"]
t.check(traced("again", THREAD)[2]["setpoint_digest"] == digest, "and again in the next run")
slow = t.write("hold.override", "0 30\n")
t.check(traced("slow", THREAD, "--override", slow)[2]["setpoint_digest"] == digest, "the feed override changes no thread")

TAP = """G21 G90
M3 S500
G0 X10 Z5
G33.1 Z-15 K1.25 I1.5
G0 X20
M2
"""
status, err, summary, trace = traced("tap", TAP)
t.check(status == 0 and err == "", "a hole is tapped", status, err)
way_in = off_the_thread(trace, 2, 1.25, 5, -1, 1.5, 19)
way_out = off_the_thread(trace, 3, 1.25, 5, -1, 1, 18)
t.check(max(way_in, way_out) < 0.002, "out in the groove of the way in", way_in, way_out)
deepest = min(trace["set_Z_mm"])
t.check(-15 <= deepest < -14.9, "it turns back just above the bottom", deepest)
last = max(row for row, block in enumerate(trace["block"]) if block == 3)
t.check(trace["set_Z_mm"][last] == 5, "and comes back to its start", trace["set_Z_mm"][last])

RIPPLE = "--set", "spindle.ripple_percent=10", "--set", "spindle.encoder_noise_counts=2"
status, err, summary, trace = traced("rough", THREAD, *RIPPLE)
t.check(status == 0, "a rough spindle is followed", err)
t.check(summary["setpoint_digest"] != digest, "and it is another one")
t.check(traced("rough2", THREAD, *RIPPLE)[2]["setpoint_digest"] == summary["setpoint_digest"], "the same in every run")

# 0.2 mm in a revolution: 2 mm/s at 600, and what it is on the way from 600 to 300.
FEED = "G21 G90\nM3 S600\nG4 P1\nG95 F0.2\nG1 X20\nS300\nX21\nX40\nM2\n"
status, err, summary, trace = traced("feed", FEED)
t.check(status == 0 and err == "", "feeds per revolution run", status, err)
feeds = {block: [f / 60 for f, b in zip(trace["feed_mm_min"], trace["block"]) if b == block] for block in (1, 2, 3)}
middle = feeds[1][len(feeds[1]) // 2], feeds[3][len(feeds[3]) // 2]
t.check(abs(middle[0] - 2) < 0.01 and abs(middle[1] - 1) < 0.01, "at F times the measured speed", middle)

for name, options, text in (
    ("fast", ("--set", "axis.Z.max_velocity_mm_s=10"), "pitch times speed of the spindle is"),
    ("short", ("--set", "axis.Z.max_acceleration_mm_s2=5"), "the lead-in and stopping take"),
    ("lag", ("--set", "spindle.ripple_percent=100", "--set", "spindle.ripple_per_revolution=1", "--set",
             "spindle.thread_tolerance_mm=0.001"), "off the spindle's angle, more than the allowed"),
    ("waits", ("--set", "spindle.torque_limit_percent=1", "--set", "spindle.inertia_kg_m2=1"), "it has not turned as commanded"),
    ("deep", ("--set", "spindle.inertia_kg_m2=0.03"), "does not turn back in time"),
):
    status, err, summary, _ = traced("alarm_" + name, TAP, *options)
    t.check(status == 1 and "alarm_" + name + ".ngc:4:" in err and text in err, "alarm: " + name, status, err)
    t.check(summary["outcome"] == "faulted", "it is a fault", summary["outcome"])
    limits = [c for c in summary["checks"] if c["name"].split(".")[0] in ("velocity", "acceleration", "jerk")]
    t.check(limits and all(c["held"] for c in limits), "and the axes stop within their limits", name)

status, _, err = t.run("run", "tap.ngc", "--set", "spindle.encoder_counts_per_revolution=0")
t.check(status == 2 and "tap.ngc:4:1: error: 'G33.1' needs a spindle with an encoder" in err, "no encoder: nothing moves", err)

folder = os.environ.get("TAKT_PROGRAMS") or os.path.join(t.SOURCE, "..", "shared", "programs")
for program in t.real_programs("g33_blend.ngc") if os.path.isdir(folder) else ():
    status, _, err = t.run("run", program, "--quiet", "--exact-path")
    t.check(status == 0 and err == "", "a real lathe program", status, err)
t.finish()
