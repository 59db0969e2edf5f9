"""takt compile and takt run --plan: the file and what it is refused for; random programs on random machines, under random
schedules of overrides and holds.

compiled.py PROGRAMS SCHEDULES FIRST runs more random programs than the test does, from seed FIRST on."""

import math
import os
import pty
import random
import re
import resource
import signal
import subprocess
import sys

import takt_test as t

PROGRAMS = int(sys.argv[1]) if len(sys.argv) > 1 else 4
SCHEDULES = int(sys.argv[2]) if len(sys.argv) > 2 else 2
FIRST = int(sys.argv[3]) if len(sys.argv) > 3 else 1


class Chain:
    """Moves of one family after the other, from the origin."""

    def __init__(self, rng):
        self.rng, self.at, self.heading = rng, [0.0, 0.0, 0.0], 0.0
        self.lines = []

    def decades(self, low, high):
        return 10 ** self.rng.uniform(low, high)

    def go(self, x, y, z, rapid=False):
        if max(abs(x), abs(y), abs(z)) > 200:  # back into the machine
            x, y, z = (0.3 * value for value in (x, y, z))
        self.at = [round(x, 5), round(y, 5), round(z, 5)]
        self.lines.append("G%d X%.5f Y%.5f Z%.5f" % (0 if rapid else 1, *self.at))

    def line(self, length, rise=0.0, rapid=False):
        self.go(self.at[0] + length * math.cos(self.heading), self.at[1] + length * math.sin(self.heading), self.at[2] + rise, rapid)

    def corners(self):
        self.heading = self.rng.uniform(0, 2 * math.pi)
        length = self.decades(-2, 1.5)
        self.line(length, self.rng.uniform(-length, length), self.rng.random() < 0.2)

    def retrace(self):
        self.heading += math.pi
        self.line(self.decades(-1, 1))

    def polygon(self):
        self.heading += 0.05
        self.line(self.decades(-1.5, 0))

    def tiny(self):
        self.heading += self.rng.uniform(-0.3, 0.3)
        self.line(self.decades(-3.5, -1))

    def zigzag(self):
        self.heading += self.rng.choice((-1, 1)) * self.decades(-3, 0.3)
        self.line(self.rng.uniform(0.05, 2))

    def arc(self):
        radius, sign = self.decades(-0.7, 1.3), self.rng.choice((-1, 1))
        sweep = sign * min(6.0, self.decades(-1, 0.8))
        i, j = -sign * radius * math.sin(self.heading), sign * radius * math.cos(self.heading)
        angle = self.heading - sign * math.pi / 2 + sweep
        x = self.at[0] + i + radius * math.cos(angle)
        y = self.at[1] + j + radius * math.sin(angle)
        if max(abs(x), abs(y)) > 200:
            return self.go(0, 0, 0, True)
        rise = self.rng.choice((0, 0, self.rng.uniform(-3, 3)))
        centre = self.at[0] + i, self.at[1] + j
        self.at = [round(x, 5), round(y, 5), round(self.at[2] + rise, 5)]
        self.lines.append("G90.1 G%d X%.5f Y%.5f Z%.5f I%.5f J%.5f" % (2 if sign < 0 else 3, *self.at, *centre))
        self.heading += sweep
        return None

    def involute(self):
        """Unrolled outward from any place on it; the curve is along the radius to where its string leaves the base circle."""
        radius, sign = self.decades(-1, 0.7), self.rng.choice((-1, 1))
        first = self.rng.choice((0, self.rng.uniform(0.1, 3)))
        last, base = first + self.rng.uniform(0.5, 8), self.heading - sign * first

        def at(phi):
            c, s = math.cos(base + sign * phi), math.sin(base + sign * phi)
            return radius * (c + sign * phi * s), radius * (s - sign * phi * c)

        begin, end = at(first), at(last)
        i, j = -begin[0], -begin[1]
        x, y = self.at[0] + end[0] - begin[0], self.at[1] + end[1] - begin[1]
        if max(abs(x), abs(y)) > 200:
            return self.go(0, 0, 0, True)
        self.at = [round(x, 6), round(y, 6), self.at[2]]
        self.lines.append("G91.1 G%s X%.6f Y%.6f I%.7f J%.7f R%.7f" % ("2.2" if sign < 0 else "3.2", self.at[0], self.at[1], i, j, radius))
        self.heading = base + sign * last
        return None

    def rotary(self):
        """On and off the planner on board; the rotary axis alone, or with others."""
        self.heading += self.rng.uniform(-1, 1)
        if self.rng.random() < 0.6:
            self.line(self.decades(-1, 1.3))
        if self.rng.random() < 0.6:
            self.lines.append("G1 A%.4f" % self.rng.uniform(-90, 90))

    def event(self):
        self.lines.append(self.rng.choice(("G4 P0.05", "M3 S1000", "M8", "M9", "G61", "G64 P%.4f" % self.decades(-2.5, -1), "F%d" % self.decades(2.5, 4))))


def program(rng):
    chain = Chain(rng)
    families = [Chain.corners, Chain.retrace, Chain.polygon, Chain.tiny, Chain.zigzag, Chain.arc, Chain.involute, Chain.rotary]
    family = rng.choice(families)
    for _ in range(rng.randint(3, 60)):
        if rng.random() < 0.1:
            family = rng.choice(families)
        (Chain.event if rng.random() < 0.03 else family)(chain)
    head = "G21 G90 G94 G17 G64 P%.4f F%d\n" % (10 ** rng.uniform(-2.5, -0.7), rng.choice((600, 3000, 6000, 10000)))
    return head + "\n".join(chain.lines) + "\nM2\n"


ROTARY = ["--set", "axis.A.drive_node=4", "--set", "axis.A.max_velocity_deg_s=90"]


def machine(rng):
    words = []
    for axis in "XYZ":
        for key, low, high in (("max_velocity_mm_s", 1.3, 2.5), ("max_acceleration_mm_s2", 2.5, 3.8), ("max_jerk_mm_s3", 3.9, 5.5)):
            words += ["--set", "axis.%s.%s=%.3f" % (axis, key, 10 ** rng.uniform(low, high))]
        words += ["--set", "axis.%s.following_error_max_mm=0" % axis]
    return words


def schedule(rng, path):
    rows, time = [], 0.0
    while time < 40:
        rows.append("%.3f %d" % (time, rng.choice((0, 0, 5, 30, 60, 90, 100, 100, 100))))
        time += 10 ** rng.uniform(-2, 0.3)
    return t.write(path, "\n".join(rows) + "\n40 100\n")


def judge(seed):
    rng = random.Random(seed)
    t.write("part.ngc", program(rng))
    options = ROTARY + (machine(rng) if seed % 3 else [])
    status, _, err = t.run("compile", "part.ngc", "-o", "part.plan", "--quiet", *options)
    if not t.check(status == 0, "a random program is compiled", "seed", seed, status, err):
        return
    status, _, err = t.run("run", "part.ngc", "--plan", "part.plan", "--quiet", *options)
    t.check(status == 0, "a compiled program keeps limits and tolerance", "seed", seed, status, err)
    for number in range(SCHEDULES):
        feed, rapid = schedule(rng, "feed.txt"), schedule(rng, "rapid.txt")
        status, _, err = t.run("run", "part.ngc", "--plan", "part.plan", "--quiet", "--json", "s.json", "--override", feed, "--rapid-override", rapid, *options)
        if status == 0:
            t.check(t.load_json("s.json")["outcome"] == "completed", "it is completed under any schedule", seed, number)
        else:
            t.check(False, "every check is held under any schedule", "seed", seed, number, status, err)


PROGRAM = """G21 G90 G17 G64 P0.01 F6000
M3 S1000
G0 X10
G1 X20 Y5
G4 P0.1
G3 X20 Y15 I0 J5
G1 X0 Y15
G61 X0 Y0
M2
"""


def summary(*options):
    status, _, err = t.run("run", "part.ngc", "--quiet", "--json", "s.json", *options)
    t.check(status == 0, "every check is held", options, status, err)
    return t.load_json("s.json")


def refused(claim, words, *arguments, status=2):
    got, _, err = t.run(*arguments)
    t.check(got == status and all(word in err for word in words), claim, got, err)


def files():
    t.write("part.ngc", PROGRAM)
    status, out, err = t.run("compile", "part.ngc", "-o", "part.plan")
    t.check(status == 0 and "of the limit" in out, "compiling tells figures", status, out, err)
    ahead, compiled = summary("--plan", "ahead"), summary("--plan", "part.plan")
    t.check(ahead["setpoint_digest"] == compiled["setpoint_digest"], "a file runs as what is planned just before", ahead, compiled)
    t.check(ahead["program_time_s"] < summary("--exact-path")["program_time_s"], "inside the tolerance is faster than on the path")
    t.check(summary("--plan", "board")["setpoint_digest"] == summary()["setpoint_digest"], "planning as it runs is the default")
    with open("part.plan", "rb") as file:
        first = file.read()
    t.run("compile", "part.ngc", "-o", "again.plan", "--quiet")
    with open("again.plan", "rb") as file:
        t.check(file.read() == first, "compiling again writes the same bytes")

    refused("another machine is told", ("part.plan", "another machine", "Y jerk is 50000 there and 40000 here"), "run", "part.ngc", "--plan", "part.plan", "--set", "axis.Y.max_jerk_mm_s3=40000")
    t.write("other.ngc", PROGRAM.replace("X0 Y15", "X1 Y15"))
    refused("another program is told", ("part.plan", "another program"), "run", "other.ngc", "--plan", "part.plan")
    for at in (9, 40, len(first) // 2, len(first) - 2):
        t.write("bad.plan", first[:at] + bytes([first[at] ^ 0x40]) + first[at + 1 :])
        refused("a changed byte is told", ("bad.plan",), "run", "part.ngc", "--plan", "bad.plan")
    t.write("short.plan", first[:-20])
    refused("a file cut short is told", ("short.plan", "damaged"), "run", "part.ngc", "--plan", "short.plan")
    refused("what is no compiled program is told", ("part.ngc", "no compiled program"), "run", "part.ngc", "--plan", "part.ngc")
    refused("a missing file is told", ("none.plan",), "run", "part.ngc", "--plan", "none.plan")


def ceilings():
    t.write("part.ngc", PROGRAM)
    status, _, err = t.run("compile", "part.ngc", "-o", "high.plan", "--quiet", "--ceiling", "120")
    t.check(status == 0, "a ceiling above 100 % is compiled", status, err)
    t.write("high.txt", "0 120\n")
    high, plain = summary("--plan", "high.plan", "--override", "high.txt"), summary("--plan", "high.plan")
    t.check(high["program_time_s"] < plain["program_time_s"], "120 % is faster than 100 %", high["program_time_s"], plain["program_time_s"])
    refused("a ceiling beyond 120 % is told", ("--ceiling 130",), "compile", "part.ngc", "-o", "x.plan", "--ceiling", "130")
    refused("a place for the file is needed", ("-o FILE",), "compile", "part.ngc")


def stretches():
    """What the planner on board drives between two stretches that are compiled, and involutes."""
    t.write("part.ngc", "G21 G90 G17 G64 P0.01 F3000\nG0 X10\nG1 X20 Y5 A0\nX30\nA45\nX40 A90\nX45\nA0 X50 Y5\nX60\nM2\n")
    plan = summary("--plan", "ahead", *ROTARY)
    t.check(plan["outcome"] == "completed" and any(a["name"] == "A" and a["max_velocity_deg_s"] > 0 for a in plan["axes"]), "motions of a rotary axis run between others", plan)
    t.write("part.ngc", "G21 G90 G91.1 G17 G64 P0.01 F3000\nG3.2 X0 Y-10 I-1.591549431 J0 R1.591549431\nG3 X0 Y-10 I0 J10\nG3.2 X0 Y0 I1.591549431 J10 R1.591549431\nM2\n")
    t.check(summary("--plan", "ahead")["program_time_s"] < summary()["program_time_s"], "involutes through the centre are planned ahead")


def long_blocks():
    """The end of a block that takes longer than what is kept of a plan ahead is not known when the block begins."""
    lines = "".join("G1 X%.2f F3000\n" % (30 + 0.5 * k) for k in range(1, 330))
    t.write("part.ngc", "G21 G90 G17 G64 P0.01 F600\nG1 X30\n" + lines + "M2\n")
    status, _, err = t.run("run", "part.ngc", "--plan", "ahead", "--quiet", "--trace", "s.csv", *ROTARY)
    if not t.check(status == 0, "more blocks follow a long one than the path holds", status, err):
        return
    with open("s.csv", encoding="utf-8") as file:
        rows = [(int(row["line"]), float(row["set_X_mm"])) for row in t.csv.DictReader(file)]
    t.check(all(abs(x - (30 + 0.5 * (line - 2.5))) < 0.3 for line, x in rows if line > 3), "each is told while it is driven", rows[-1])


def figure():
    """The report of a compiled run shows both planners."""
    t.write("part.ngc", PROGRAM)
    ahead = summary("--plan", "ahead", "--report", "part.html")
    with open("part.html", encoding="utf-8") as file:
        shares = t.json.loads(re.search(r'id="run-shares">([^<]*)<', file.read()).group(1))
    t.check(abs(shares["ahead"]["time_s"] - ahead["program_time_s"]) < 1e-6, "the figure has the time planned ahead", shares)
    t.check(abs(shares["board"]["time_s"] - summary()["program_time_s"]) < 1e-6, "and that on board", shares)
    t.check(all(0 <= shares[who][what] <= 1 for who in shares for what in ("velocity", "acceleration", "jerk")), "shares are shares", shares)
    t.check(shares["ahead"]["jerk"] > shares["board"]["jerk"], "ahead is at the limits more", shares)
    summary("--report", "part.html")
    with open("part.html", encoding="utf-8") as file:
        t.check('id="run-shares">null<' in file.read(), "a run that is not compiled has no such figure")


def long_program():
    """Long enough that compiling it takes seconds: whoever ends it when the bar first tells the time left is in time."""
    rng, heading, at, lines = random.Random(7), 0.0, [0.0, 0.0], []
    for _ in range(30000):
        heading += rng.uniform(-0.3, 0.3)
        at = [a + 0.08 * d for a, d in zip(at, (math.cos(heading), math.sin(heading)))]
        lines.append("G1 X%.4f Y%.4f" % tuple(at))
    return "G21 G90 G17 G64 P0.01 F6000\n" + "\n".join(lines) + "\nM2\n"


def files_aside():
    """What is being written beside its place."""
    return [name for name in os.listdir(".") if ".plan.part-" in name]


def ended_by(end):
    """Ends a compile as soon as its bar tells the time left."""
    near, far = pty.openpty()
    compiling = subprocess.Popen([t.TAKT, "compile", "long.ngc", "-o", "long.plan"], stderr=far, stdout=subprocess.DEVNULL)
    os.close(far)
    seen = b""
    while b"left" not in seen:
        seen += os.read(near, 1000)
    t.check(len(files_aside()) == 1, "the file is written beside its place", end)
    compiling.send_signal(end)
    compiling.wait()
    os.close(near)


def ended():
    """What ends a compile before its time leaves the file that was there."""
    t.write("long.ngc", long_program())
    t.write("long.plan", b"as before")
    for end in (signal.SIGKILL, signal.SIGINT, signal.SIGTERM):
        ended_by(end)
        with open("long.plan", "rb") as file:
            t.check(file.read() == b"as before", "the file that was there is still there", end)
        t.check(end == signal.SIGKILL or not files_aside(), "and nothing is left beside it", end, os.listdir("."))
        for name in files_aside():
            os.remove(name)


def cut_short():
    """A file that may not grow beyond half of what is written: its writing fails, whatever SIGXFSZ does by default."""
    t.write("part.ngc", PROGRAM)
    t.run("compile", "part.ngc", "-o", "part.plan", "--quiet")
    half = os.path.getsize("part.plan") // 2
    t.write("part.plan", b"as before")

    def limit():
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_FSIZE, (half, half))

    for by_default in (True, False):
        done = subprocess.run([t.TAKT, "compile", "part.ngc", "-o", "part.plan"], preexec_fn=limit, restore_signals=by_default, capture_output=True, check=False)
        t.check(done.returncode == 3 and b"cannot be written" in done.stderr, "a disk that is full is told", done)
        t.check(not files_aside(), "and nothing is left beside the file", os.listdir("."))
        with open("part.plan", "rb") as file:
            t.check(file.read() == b"as before", "the file that was there is still there", by_default)


def unfit():
    for text, words in (("G38.2 X-5 F100", ("probing",)), ("M3 S100\nG95 G1 X5 F0.1", ("revolution",))):
        t.write("unfit.ngc", "G21\nG1 X1 F100\n" + text + "\nM2\n")
        status, _, err = t.run("compile", "unfit.ngc", "-o", "unfit.plan")
        t.check(status == 2 and "unfit.ngc" in err and all(word in err for word in words), "what cannot be compiled is told with its line", text, status, err)
        t.check(not os.path.exists("unfit.plan"), "and nothing is written", text)


def override_methods():
    t.write("method.ngc", "G21 G64 P0.01\nG1 X1 F600\nM2\n")
    for plan, told in (("ahead", True), ("board", False)):
        status, _, err = t.run("run", "method.ngc", "--plan", plan, "--quiet", "--override-method", "proportional")
        t.check(status == 0 and ("--override-method proportional is not used" in err) == told,
                "a method of overriding that the plan does not use is told", plan, status, err)


if len(sys.argv) == 1:
    files()
    override_methods()
    ceilings()
    unfit()
    stretches()
    long_blocks()
    figure()
    ended()
    cut_short()
for seed in range(FIRST, FIRST + PROGRAMS):
    judge(seed)
t.finish()
