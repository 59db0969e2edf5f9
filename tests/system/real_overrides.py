"""Every real program under random schedules of feed and rapid override: limits, landings, no stop nobody asked for.

With the argument --long: five schedules for each program, and the trace's own differences beside the command's checks.
"""

import os
import random
import sys

import takt_test as t

LIMITS = 100.0, 1000.0, 50000.0
RATIOS = 1.0001, 1.0001, 1.001
CYCLE_S = 0.001

# Some time after a hold everything that it has begun is over.
HOLD_IS_OVER_S = 1.2

LONG = "--long" in sys.argv
SCHEDULES = 5 if LONG else 1


def programs():
    folder = os.path.dirname(t.real_programs(".")[0])
    found = [os.path.join(at, name) for at, _, names in os.walk(folder) for name in names]
    return sorted(path for path in found if path.endswith(".ngc"))


def schedule(chance, most, seconds):
    """Steps, ramps and holds: pairs of time and percent."""
    rows, time, percent = [(0.0, 100.0)], 0.0, 100.0
    while time < seconds:
        time += 10 ** chance.uniform(-2, 1)
        kind = chance.random()
        if kind < 0.15:
            rows.append((time, 0.0))
            time += 10 ** chance.uniform(-2, 0)
            rows.append((time, percent))
        elif kind < 0.4:
            target, steps = chance.uniform(1, most), chance.randint(5, 50)
            for step in range(1, steps + 1):
                rows.append((time + 0.01 * step, percent + (target - percent) * step / steps))
            time, percent = rows[-1]
        else:
            percent = chance.uniform(1, most)
            rows.append((time, percent))
    return rows


def write_schedule(path, rows):
    return t.write(path, "".join(f"{time:.4f} {percent:.3f}\n" for time, percent in rows))


def held(rows):
    """From when to when nothing is said of stops: while held, and until that is over."""
    spans = []
    for (time, percent), (until, _) in zip(rows, rows[1:] + [(float("inf"), 0)]):
        if round(percent, 3) == 0:
            spans.append((time, until + HOLD_IS_OVER_S))
    return spans


def rests(path):
    """Times at which motion has come to rest, the block it was in, and whether it went on in that one."""
    moving, rest = None, None
    with open(path) as trace:
        next(trace)
        for row in trace:
            _, time, block, _, feed, _ = row.split(",", 5)
            if float(feed) > 0:
                moving = int(block)
                if rest:
                    yield (*rest, moving == rest[1])
                    rest = None
            elif moving is not None and not rest:
                rest, moving = (float(time), moving), None


def ends(program):
    """Blocks that end at a stop, and those that end where the feed is reduced, and the program's time."""
    status, _, err = t.run("plan", program, "--exact-path", "--json", "plan.json", "--quiet")
    t.check(status == 0, f"{program} can be planned", err)
    plan = t.load_json("plan.json")
    stop, reduced = ({b["block"] for b in plan["blocks"] if b.get("end") == end} for end in ("stop", "reduced"))
    return stop, reduced, plan["totals"]["time_s"]


def judge_trace(name):
    trace = t.read_trace("trace.csv")
    for axis in "XYZ":
        found = t.peaks(trace[f"set_{axis}_mm"], CYCLE_S)
        for what, value, limit, ratio in zip(("velocity", "acceleration", "jerk"), found, LIMITS, RATIOS):
            t.check(value <= limit * ratio, f"{name}: {what} of {axis} within its limit", value)


def run_under(program, seed, stop, reduced, seconds):
    """Returns cycles, and rests at joints that might have been passed at a reduced feed."""
    name = f"{os.path.basename(program)}, schedule {seed}"
    chance = random.Random(seed)
    feed, rapid = schedule(chance, 120, 4 * seconds), schedule(chance, 100, 4 * seconds)
    status, _, err = t.run("run", program, "--exact-path", "--quiet", "--json", "run.json", "--trace", "trace.csv",
                           "--override", write_schedule("feed.txt", feed),
                           "--rapid-override", write_schedule("rapid.txt", rapid))
    summary = t.load_json("run.json")
    t.check(status == 0, f"{name}: every check held", err, [c for c in summary["checks"] if not c["held"]])
    t.check(summary["outcome"] == "completed", f"{name}: completed")
    t.check(summary["landing_error_max_mm"] <= 1e-9, f"{name}: landed ends", summary["landing_error_max_mm"])
    spans = held(feed) + held(rapid)
    free = [rest for rest in rests("trace.csv") if not any(start <= rest[0] <= end for start, end in spans)]
    stray = [(time, block) for time, block, inside in free if inside or block not in stop | reduced]
    t.check(not stray, f"{name}: no stop that nobody asked for", stray[:3])
    if LONG:
        judge_trace(name)
    return summary["cycles"], sum(block in reduced for _, block, _ in free)


cycles = landed = 0
for program in programs():
    stop, reduced, seconds = ends(program)
    for seed in range(1, SCHEDULES + 1):
        more_cycles, more_landed = run_under(program, seed, stop, reduced, seconds)
        cycles += more_cycles
        landed += more_landed
print(f"{len(programs())} programs, {SCHEDULES} schedules each: {cycles} cycles, {landed} rests at landed joints")
t.finish()
