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
