"""takt run --pulse-log: the pulses of step drives as VCD and CSV, read again and compared with setpoints and with the motors."""

import os
import signal
import subprocess

import takt_test as t

PROGRAM = t.write(
    "part.ngc",
    "G21 G17 G90 F3000\nG0 X10.0004 Y0\nG3 X10.0004 Y0 I-10 J0\nG1 X20.1 Y5 Z-3.017\nG4 P0.05\nG1 X0 Y0.3 Z0\nG0 X-3.3333 Y1.7\nM2\n")
STEPPED = "--drive-type", "step"
CYCLE_NS = 1000000


def read_csv(path):
    """Times in nanoseconds, and the step of each axis by name."""
    with open(path) as file:
        names, *rows = (line.rstrip("\n").split(",") for line in file)
    times = [int(row[0].replace(".", "")) for row in rows]
    t.check(all(len(row[0].split(".")[1]) == 9 for row in rows), "times have nine places")
    return times, {name: [int(row[i]) for row in rows] for i, name in enumerate(names) if i > 0}


def read_vcd(path):
    """Rising edges of each step line, (time, direction) by axis, and how long lines were high; by the grammar of IEEE 1364-2005, 18.2."""
    with open(path) as file:
        head, body = file.read().split("$enddefinitions $end")
    words = head.split()
    t.check(words[words.index("$timescale") + 1 : words.index("$timescale") + 3] == ["1", "ns"], "its unit is a nanosecond", head)
    names = {words[i + 3]: words[i + 4] for i, word in enumerate(words) if word == "$var"}
    level, since, edges, high = {}, {}, {name[0]: [] for name in names.values()}, []
    now, order = -1, True
    changes = []
    for word in body.split() + ["#end"]:
        if word[0] == "#":
            for name in changes:
                if name.endswith("_step") and level[name] == "1" and now > 0:
                    edges[name[0]].append((now, 1 if level[name[0] + "_dir"] == "1" else -1))
                    since[name] = now
                elif name.endswith("_step") and name in since:
                    high.append(now - since[name])
            changes = []
            order, now = order and (word == "#end" or int(word[1:]) > now), 0 if word == "#end" else int(word[1:])
        elif word[0] in "01":
            name = names[word[1:]]
            t.check(now == 0 or level[name] != word[0], "a change is one", name, now)
            level[name] = word[0]
            changes.append(name)
    t.check(order, "times rise")
    t.check(all(level[name] == "0" for name in names.values() if name.endswith("_step")), "step lines are low in the end", level)
    return edges, high


def boundaries(times, steps, cycles):
    """Position of an axis at the end of each cycle since power-on."""
    found, at, n = [], 0, 0
    for end in range(CYCLE_NS, (cycles + 1) * CYCLE_NS, CYCLE_NS):
        while n < len(times) and times[n] < end:
            at += steps[n]
            n += 1
        found.append(at)
    return found


def check_positions(times, pulses, trace):
    """In the even form every cycle ends on the step nearest to its setpoint, the same number of cycles later for all axes."""
    length = len(trace["set_X_mm"])
    cycles = times[-1] // CYCLE_NS + 10
    wanted = {axis: [1000 * x for x in trace[f"set_{axis}_mm"]] for axis in pulses}
    found = {axis: boundaries(times, steps, cycles) for axis, steps in pulses.items()}
    off = {late: max(abs(found[axis][n + late] - wanted[axis][n]) for axis in pulses for n in range(length)) for late in range(cycles - length + 1)}
    best = min(off, key=off.get)
    t.check(off[best] <= 0.5 + 1e-5, "positions by pulses are the steps nearest to the setpoints of the trace", best, off)


def run(form, *options):
    summaries = []
    for path in "a.csv", "a.vcd":
        status, out, err = t.run("run", PROGRAM, "--pulse-log", path, "--json", "a.json", "--trace", "trace.csv", "--set", f"machine.step_form={form}", *options)
        t.check(status == 0 and f"pulse log     {path}" in out, f"{form}: a log is written and told", out, err)
        summaries.append(t.load_json("a.json"))
    times, pulses = read_csv("a.csv")
    edges, high = read_vcd("a.vcd")
    t.check(list(pulses) == [motor["name"] for motor in summaries[0]["step_drives"]], f"{form}: a column for each step drive", list(pulses))
    for motor in summaries[0]["step_drives"]:
        steps = pulses[motor["name"]]
        mine = [(time, step) for time, step in zip(times, steps) if step != 0]
        t.check(edges[motor["name"]] == mine, f"{form}: both forms tell the same pulses", motor["name"], len(mine))
        t.check(sum(steps) == motor["position_steps"] and len(mine) == motor["steps"], f"{form}: as many as the motor has counted", motor)
        shortest = min((b[0] - a[0] for a, b in zip(mine, mine[1:])), default=CYCLE_NS)
        t.check(abs(1e9 / shortest - motor["rate_peak_hz"]) < 1, f"{form}: as fast as it says", shortest, motor)
    t.check(set(high) == {2500}, f"{form}: high for half of the 5 us that 200 kHz leave", set(high))
    return times, pulses


times, pulses = run("even", *STEPPED)
check_positions(times, pulses, t.read_trace("trace.csv"))
run("improved", *STEPPED)
times, pulses = run("plain", *STEPPED)
run("even", "--drive-type", "Y=step")

# By evaluation functions one axis steps at a tick in the plain form, on the line and on the circle alike.
together = sum(1 for n in range(len(times)) if sum(abs(steps[n]) for steps in pulses.values()) > 1)
t.check(together == 0, "plain: no two axes step together", together)

# A helix of two turns about (3, 4) mm, at every single pulse: how far off its circle, and off the rise that belongs to the angle.
for form in "improved", "plain":
    for rise in 2, 50, -100:
        name = t.write("helix.ngc", f"G21 G17 G61 F600\nG2 X0 Y0 I3 J4 Z{rise} P2\nM2\n")
        status, _, err = t.run("run", name, *STEPPED, "--quiet", "--pulse-log", "helix.csv", "--set", f"machine.step_form={form}")
        t.check(status == 0, f"{form}: a helix is driven", err)
        _, pulses = read_csv("helix.csv")
        x = y = z = 0
        last, turned, radial, along, moved = t.cmath.phase(complex(-3, -4)), 0.0, 0.0, 0.0, 0
        for dx, dy, dz in zip(pulses["X"], pulses["Y"], pulses["Z"]):
            x, y, z = x + dx, y + dy, z + dz
            moved = max(moved, abs(dx) + abs(dy) + abs(dz))
            angle = t.cmath.phase(complex(x - 3000, y - 4000))
            turned -= t.math.remainder(angle - last, t.math.tau)
            last = angle
            radial = max(radial, abs(t.math.hypot(x - 3000, y - 4000) - 5000))
            # In steps along the helix: those of the rise and of the arc, on either side of the place between them.
            lag = abs(z / (1000 * rise) - turned / (2 * t.math.tau))
            along = max(along, lag / (1 / abs(1000 * rise) + 1 / (5000 * 2 * t.math.tau)))
        t.check((x, y, z) == (0, 0, 1000 * rise), f"{form}, Z{rise}: it ends exactly", x, y, z)
        t.check(radial < 1, f"{form}, Z{rise}: within a step of its circle at every pulse", radial)
        t.check(along < 1, f"{form}, Z{rise}: and of its place along it", along)
        t.check(moved == (1 if form == "plain" else 3), f"{form}, Z{rise}: axes that step at once", moved)

# Standard output takes it, too; a full disk, a wrong name and a machine without step drives do not.
status, out, err = t.run("run", PROGRAM, *STEPPED, "--pulse-log", "-", "--set", "machine.step_form=plain")
t.check(status == 0 and out.startswith("time_s,X,Y,Z\n") and out.count("\n") == len(times) + 1, "on standard output: CSV", err)
before = sorted(os.listdir("."))
for options, status, said in (
    (["--pulse-log", "b.vcd"], 2, "--pulse-log needs a step drive"),
    ([*STEPPED, "--pulse-log", "b.txt"], 2, "--pulse-log b.txt: a name that ends in .vcd or .csv is expected"),
    ([*STEPPED, "--pulse-log", "b.csv", "--trace", "b.csv"], 2, "same file"),
    ([*STEPPED, "--pulse-log", "nowhere/b.csv"], 3, "nowhere/b.csv"),
):
    found, _, err = t.run("run", PROGRAM, *options)
    t.check(found == status and said in err, f"{' '.join(options)}: refused", found, err)
t.check(sorted(os.listdir(".")) == before, "and nothing is left of it", sorted(os.listdir(".")))
if os.path.exists("/dev/full"):
    os.symlink("/dev/full", "full.vcd")
    found, _, err = t.run("run", PROGRAM, *STEPPED, "--pulse-log", "full.vcd", "--json", "none.json")
    t.check(found == 3 and not os.path.exists("none.json"), "a full disk ends the run, and leaves no file", found, err)

# Interrupted: the log is whole up to the rest.
long_program = t.write("long.ngc", "G21 G90 F100\n" + "".join(f"G1 X{i % 2 * 400}\n" for i in range(1, 3000)))
process = subprocess.Popen([t.TAKT, "run", long_program, *STEPPED, "--quiet", "--pulse-log", "cut.vcd"], stderr=subprocess.DEVNULL)
while process.poll() is None and not any(".part-" in name for name in os.listdir(".")):
    pass
process.send_signal(signal.SIGINT)
t.check(process.wait() == 130, "interrupted: status 130", process.returncode)
read_vcd("cut.vcd")
t.finish()
