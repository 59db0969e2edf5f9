"""The planner's feed beside the source's product of factors: landing=scale and limiter=threshold|smooth, in two tables.

The planner keeps every limit; the source's forms pass them, which is found, told and makes the run fail (status 1).
At 100 % every block ends with a cycle in all forms; under an override blocks of the product end between two.
"""

import takt_test as t

CYCLE_S = 0.001
VELOCITY, JERK = 100.0, 50000.0

# X runs near its limit, and beyond it from 106 % on.
FAST = "G21 G61 F5700\nG1 X60 Y8\nG1 X160 Y8\nG1 X0 Y0\nM2\n"
# One axis after the other.
BOTH = "G21 G61 F5700\nG1 X100\nG1 Y100\nG1 X0 Y0\nM2\n"
# Tangent blocks of different feeds and lengths: each is a number of cycles and a part of one.
JOINTS = "G21 G61 F3000\nG1 X10.01\nG1 X20.02 F6000\nG1 X30.37 F2000\nG2 X30.37 Y0 I0 J-5\nG1 X40.005\nG0 X0\nM2\n"


def run(text, key, value, *options):
    t.write("part.ngc", text)
    status, _, err = t.run("run", "part.ngc", "--quiet", "--json", "run.json", "--trace", "trace.csv",
                           "--set", f"machine.{key}={value}", *options)
    summary = t.load_json("run.json")
    t.check(summary["outcome"] == "completed", f"{key}={value}: completed", err)
    if not options:
        error = summary["landing_error_max_mm"]
        t.check(error <= 1e-9, f"{key}={value}: ends are hit", error)
    t.check(summary["path_error_max_mm"] <= 1e-9, f"{key}={value}: stays on the path", summary["path_error_max_mm"])
    return status, summary


def ratio(summary, what):
    return max(c["value"] / c["limit"] for c in summary["checks"] if c["name"].startswith(what))


def limiter(form):
    """Status, how far X is above its velocity, and the largest step of its acceleration, by differences."""
    status, summary = run(FAST, "limiter", form, "--override", "fast.txt")
    trace = t.read_trace("trace.csv")
    velocity, _, jerk = t.peaks(trace["set_X_mm"], CYCLE_S)
    print(f"{form:12} {velocity:12.4f} {velocity - VELOCITY:9.4f} {jerk * CYCLE_S:14.1f} {min(trace['limiter']):8.4f}"
          f" {summary['program_time_s']:9.3f} {status:7}", flush=True)
    return status, velocity - VELOCITY, jerk * CYCLE_S


def factor(velocity, most, band):
    """K of seed 003 (15), (16) for one axis, its S-curve written as a Bezier curve: ends 0 and 1/2, in between 0, 1/6, 3/8."""
    part = min(max((velocity - (most - band)) / (2 * band), 0), 1) if band > 0 else float(velocity > most)
    weights = (1 - part) ** 4, 4 * part * (1 - part) ** 3, 6 * (part * (1 - part)) ** 2, 4 * part**3 * (1 - part), part**4
    kappa = sum(weight * height for weight, height in zip(weights, (0, 0, 1 / 6, 3 / 8, 1 / 2)))
    if part == 0:
        return 1.0
    return most / velocity if part == 1 else (most - band + (1 - kappa) * 2 * band * part) / velocity


def bands(percent):
    """K of a run from the positions of its trace, two axes with a band of their own, beside the K that it used a cycle later."""
    sets = [f"axis.{axis}.limiter_band_percent={value}" for axis, value in percent.items()]
    run(BOTH, "limiter", "smooth", "--override", "fast.txt", *(word for text in sets for word in ("--set", text)))
    trace = t.read_trace("trace.csv")
    used = trace["limiter"]
    off, governs = 0.0, dict.fromkeys(percent, 0)
    for n in range(2, len(used)):
        steps = {axis: abs(trace[f"cmd_{axis}_mm"][n - 1] - trace[f"cmd_{axis}_mm"][n - 2]) for axis in percent}
        if max(steps.values()) == 0 or all(trace[f"cmd_{axis}_mm"][n] == trace[f"cmd_{axis}_mm"][n - 1] for axis in percent):
            continue
        found = {axis: factor(step / (CYCLE_S * used[n - 1]), VELOCITY, percent[axis] / 100 * VELOCITY) for axis, step in steps.items()}
        least = min(found, key=found.get)
        governs[least] += found[least] < 1
        off = max(off, abs(min(found.values()) - used[n]))
    t.check(off < 3e-6, f"K in the bands {percent} is that of the source's formula", off)
    t.check(all(governs.values()), "each axis is limited by its own band", governs)
    return min(used)


def landing(form):
    """Status and the largest step of the feed at a joint."""
    status, summary = run(JOINTS, "landing", form)
    step = summary["joint_feed_step_max_mm_s"]
    print(f"{form:12} {step:12.4f} {ratio(summary, 'acceleration'):14.3f} {ratio(summary, 'jerk'):8.3f}"
          f" {summary['program_time_s']:9.3f} {status:7}", flush=True)
    return status, step


t.write("fast.txt", "0 100\n0.2 120\n")
print(f"{'limiter':12} {'peak X mm/s':>12} {'above':>9} {'step mm/s2':>14} {'least K':>8} {'time s':>9} {'status':>7}")
status, above, step = limiter("ceiling")
kept = above <= 1e-6 and step <= JERK * CYCLE_S * 1.001
t.check(status == 0 and kept, "the planner keeps X's limits at 120 %", above, step)
for form in "threshold", "smooth":
    status, above, step = limiter(form)
    t.check(status == 1 and above > 0.5 and step > 2 * JERK * CYCLE_S, f"{form}: what is passed is told", above, step)

# The width of the band is each axis's own: wider, it bends earlier; without one it is the threshold.
bands({"X": 20, "Y": 3})
bands({"X": 0, "Y": 60})
for wrong, said in ("100", "99"), ("-1", "0"), ("some", "some"):
    status, _, err = t.run("run", "part.ngc", "--set", f"axis.X.limiter_band_percent={wrong}")
    t.check(status == 2 and said in err, f"a band of {wrong} % is refused", status, err)
status, out, err = t.run("machine", "--set", "axis.Y.limiter_band_percent=12")
t.check(out.count("limiter_band_percent = 5") == 2 and "limiter_band_percent = 12" in out, "takt machine shows the bands", out, err)
t.check(t.run("machine", t.write("bands.ini", out), "--pack", "-o", "bands.settings")[0] == 0, "they are packed")
status, again, err = t.run("machine", "bands.settings", "--unpack")
t.check(again.count("limiter_band_percent = 5") == 2 and "limiter_band_percent = 12" in again, "and unpacked", again, err)

print("                             parts of the limits")
print(f"{'landing':12} {'joint mm/s':>12} {'acceleration':>14} {'jerk':>8} {'time s':>9} {'status':>7}")
for form in "span", "block":
    status, step = landing(form)
    t.check(status == 0 and step <= JERK * CYCLE_S**2 * 40, f"{form}: no step at a joint beyond the limits", step)
status, step = landing("scale")
t.check(status == 1 and step > 0.1, "scale: the feed steps at joints", step)

# The operator acts on the product too: half the feed, a hold, and a program that is completed.
status, summary = run(JOINTS, "landing", "scale")
full = summary["program_time_s"]
for schedule, least in ("0 50\n", 1.5 * full), ("0.4 0\n1.4 100\n", full + 0.9), ("0.2 60\n0.5 120\n0.8 20\n", full):
    t.write("schedule.txt", schedule)
    _, summary = run(JOINTS, "landing", "scale", "--override", "schedule.txt")
    t.check(summary["program_time_s"] >= least, "the override reaches the product", schedule, summary["program_time_s"])

for key, wrong in ("landing", "sometimes"), ("limiter", "none"):
    status, _, err = t.run("run", "part.ngc", "--set", f"machine.{key}={wrong}")
    t.check(status == 2 and wrong in err, f"an unknown {key} is told", status, err)
t.finish()
