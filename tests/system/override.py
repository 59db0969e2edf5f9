"""takt run --override, --rapid-override, --override-method: files, errors, and what they do to a run."""

import takt_test as t

PROGRAM = "G21 G61 F3000\nG1 X50\nG1 X100 F6000\nG0 X0\nM2\n"
# Circles of 1 to 5 mm radius run slower than their programmed feed by geometry.
CIRCLES = "G21 G61 F5000\n" + "".join(f"G2 X0 Y0 I{1 + n % 5} J0\n" for n in range(10)) + "M2\n"


def run(program, *options):
    t.write("part.ngc", program)
    status, _, err = t.run("run", "part.ngc", "--quiet", "--json", "s.json", *options)
    t.check(status == 0, "every check is held under any override", options, status, err)
    return t.load_json("s.json")


def feed(text):
    t.write("feed.txt", text)
    return "--override", "feed.txt"


plain = run(PROGRAM)
half = run(PROGRAM, *feed("0 50\n"))
t.check(half["program_time_s"] > 1.4 * plain["program_time_s"], "half the feed takes longer", half["program_time_s"])
for schedule in ("# half, then a stop, then on\n0 50\n0.5 0\n1.5 120\n", "0.3 10\n\n0.6 120 # all there is\n"):
    changed = run(PROGRAM, *feed(schedule))
    t.check(changed["outcome"] == "completed", "a program is completed under a schedule", changed["outcome"])
    t.check(changed["setpoint_digest"] != plain["setpoint_digest"], "a schedule changes the run", schedule)
t.check(run(PROGRAM, *feed("0 100\n"))["setpoint_digest"] == plain["setpoint_digest"], "100 % changes nothing")

t.write("rapid.txt", "0 25\n")
slow = run(PROGRAM, "--rapid-override", "rapid.txt")
t.check(slow["program_time_s"] > plain["program_time_s"] + 2, "rapids have an override of their own", slow["program_time_s"])

adaptive = run(CIRCLES, *feed("0 50\n"))["program_time_s"]
proportional = run(CIRCLES, *feed("0 50\n"), "--override-method", "proportional")["program_time_s"]
t.check(adaptive <= 0.8 * proportional, "adaptive is faster by a fifth where geometry limits", adaptive, proportional)

# Adaptive, (6): min(F_geo, %F F); proportional: %F min(F_geo, F). The planner takes 0.9 of the acceleration and 0.5 of the jerk.
for radius in 1, 2, 5:
    geometric = min((0.9 * 1000 * radius) ** 0.5, (0.5 * 50000 * radius**2) ** (1 / 3))
    for method, percent in (("adaptive", 100), ("adaptive", 50), ("adaptive", 30), ("proportional", 50)):
        run(f"G21 G61 F5000\nG2 X0 Y0 I{radius} P9\nM2\n", *feed(f"0 {percent}\n"), "--override-method", method, "--trace", "t.csv")
        trace = t.read_trace("t.csv")
        middle = len(trace["cmd_X_mm"]) // 2
        places = [complex(trace["cmd_X_mm"][i], trace["cmd_Y_mm"][i]) for i in (middle, middle + 1)]
        by_law = min(geometric, percent / 100 * 5000 / 60) if method == "adaptive" else percent / 100 * min(geometric, 5000 / 60)
        t.check(abs(abs(places[1] - places[0]) / 0.001 / by_law - 1) < 2e-3, f"{method}, {percent} % on a circle of {radius} mm", places, by_law)

# An override that changes while a block brakes waits for the next one: up to there nothing differs from the run without it.
STOPS = "G21 G61.1 F6000\nG1 X50\nG1 X100\nM2\n"


def speeds(schedule):
    run(STOPS, *feed(schedule), "--trace", "t.csv")
    trace = t.read_trace("t.csv")
    x = trace["cmd_X_mm"]
    return trace, [b - a for a, b in zip(x, x[1:])]


whole, steps = speeds("0 100\n")
ends = next(i for i, x in enumerate(whole["cmd_X_mm"]) if x >= 50)
top = max(steps)
brakes = max(i for i in range(ends) if steps[i] > 0.7 * top) + 1
changed, slower = speeds(f"0 100\n{whole['time_s'][brakes]} 30\n")
t.check(brakes < ends - 20 and changed["cmd_X_mm"][: ends + 1] == whole["cmd_X_mm"][: ends + 1], "a block that brakes keeps its override", brakes, ends)
t.check(abs(max(slower[ends + 1 :]) / top - 0.3) < 1e-6, "the next has the new one", max(slower[ends + 1 :]), top)

for option, text, place, words in (
    ("--override", "0 50\n1 x\n", ":2:3", "not a number"),
    ("--override", "0 121\n", ":1:", "0 ... 120"),
    ("--rapid-override", "0 101\n", ":1:", "0 ... 100"),
    ("--override", "1 50\n0.5 60\n", ":2:", "before that of the line above"),
    ("--override", "1\n", ":1:2", "per cent are missing"),
    ("--override", "1 50 7\n", ":1:6", "nothing may follow"),
):
    t.write("wrong.txt", text)
    status, _, err = t.run("run", "part.ngc", option, "wrong.txt")
    t.check(status == 2 and "wrong.txt" + place in err and words in err, "a wrong schedule is told with its place", text, status, err)
status, _, err = t.run("run", "part.ngc", "--override", "missing.txt")
t.check(status != 0 and "missing.txt" in err, "a schedule that is not there is told", status, err)
status, _, err = t.run("run", "part.ngc", "--override-method", "sometimes")
t.check(status == 2 and "sometimes" in err, "an unknown method is told", status, err)

t.finish()
