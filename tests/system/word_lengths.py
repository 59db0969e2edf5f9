"""Interpolators for comparison in words of few bits: positions, angles and the end rule, found again in the traces they leave."""

import re

import takt_test as t

CYCLE_S = 0.001
VELOCITY, ACCELERATION = 100.0, 1000.0  # of the built-in mill, each axis


def run(program, interpolator, **keys):
    sets = [word for key, value in keys.items() for word in ("--set", f"machine.interpolator_{key}={value}")]
    status, _, err = t.run("run", program, "--interpolator", interpolator, "--quiet", "--json", "run.json", "--trace", "trace.csv", *sets)
    t.check(status in (0, 1), f"{interpolator} {keys}: runs", err)
    summary = t.load_json("run.json")
    errors = summary["interpolator"]
    t.check(errors["along_max_mm"] <= errors["along_bound_mm"] * 1.0001 + 1e-12, f"{interpolator} {keys}: below its bound", errors)
    t.check(errors["contour_max_mm"] <= errors["contour_bound_mm"] * 1.0001 + 1e-12, f"{interpolator} {keys}: and the contour", errors)
    return errors, t.read_trace("trace.csv")


# Two turns of 10 mm: every angle is a whole multiple of the last bit, of a word whose largest angle is sqrt(2) 100 mm/s dt / R.
RADIUS = 10.0
circle = t.write("circle.ngc", "G21 G61 G17 F3000\nG2 X0 Y0 I10 P2\nM2\n")
exact, _ = run(circle, "rotate")
for bits in 6, 7, 8:
    errors, trace = run(circle, "rotate", angle_bits=bits)
    quantum = t.math.hypot(VELOCITY, VELOCITY) * CYCLE_S / RADIUS / 2**bits
    places = [complex(x - RADIUS, y) for x, y in zip(trace["set_X_mm"], trace["set_Y_mm"])][:-1]
    turns = [-t.cmath.phase(b / a) for a, b in zip(places, places[1:])]
    # b/a = 1 - dphi^2/2 - i dphi: the tangent of what has been turned is dphi / (1 - dphi^2/2).
    steps = [2 * t.math.tan(turn) / (1 + t.math.sqrt(1 + 2 * t.math.tan(turn) ** 2)) / quantum for turn in turns]
    off = max(abs(step - round(step)) for step in steps)
    t.check(off < 1e-4, f"{bits} bits: every angle is a whole number of last bits", off)
    middle = {round(step) for step in steps[len(steps) // 3 : len(steps) // 2]}
    t.check(len(middle) <= 2 and max(middle) - min(middle) <= 1, f"{bits} bits: at an even feed angles differ by the last bit", middle)
    t.check(max(round(step) for step in steps) <= 2**bits, f"{bits} bits: none is longer than its word", max(steps))
    worst = max(abs(abs(place) - RADIUS) for place in places)
    t.check(worst < 1.2 * exact["contour_bound_mm"] + 2e-9, f"{bits} bits: the contour is what it is with any angle", worst, exact)
    late = errors["along_max_mm"] - exact["along_max_mm"]
    t.check(0.2 * RADIUS * quantum < late < 0.51 * RADIUS * quantum, f"{bits} bits: half of the last bit along the path", late, quantum)

# A line from rest to rest: whole units of words of m bits, which count 1000 mm. The exact run says how many cycles change the feed.
line = t.write("line.ngc", "G21 G61 F3000\nG1 X24 Y10\nM2\n")
_, trace = run(line, "exact")
feeds = [0.0, *trace["feed_mm_min"]]
up = sum(b > a * (1 + 1e-6) for a, b in zip(feeds, feeds[1:]))
down = sum(b < a * (1 - 1e-6) for a, b in zip(feeds, feeds[1:]))
even = len(feeds) - 1 - up - down
# N_acc (N_acc + 1) / 2 + N_const + N_dec + N_dec (N_dec + 1) / 2
loss = up * (up + 1) / 2 + even + down + down * (down + 1) / 2
worst = []
for bits, unit in (20, 2e-3), (24, 1.25e-4), (28, 7.8125e-6):
    errors, trace = run(line, "integrate", word_bits=bits)
    sets = list(zip(trace["set_X_mm"], trace["set_Y_mm"]))[:-1]
    off = max(abs(value / unit - round(value / unit)) for pair in sets for value in pair)
    t.check(off < 2e-9 / unit + 1e-6, f"{bits} bits: positions are whole units of {unit} mm", off)
    bound = t.math.sqrt(2) * (loss + 1) * unit
    t.check(abs(errors["along_bound_mm"] / bound - 1) < 0.05, f"{bits} bits: its bound is that of the words", errors, bound)
    straight = max(abs(10 * x - 24 * y) / 26 for x, y in sets)
    t.check(straight <= bound, f"{bits} bits: the line is straight within it", straight, bound)
    worst.append(errors["along_max_mm"])
t.check(worst[0] > 3 * worst[1] > 9 * worst[2], "longer words err by less", worst)

# The end rule: a block that is passed at 404.4 units of 1/8 um, 404 whole ones. What acceleration in whole units has lost is shared by the last N cycles.
passed = t.write("passed.ngc", "G21 G61 F3033\nG1 X10\nG1 X30\nM2\n")
for shift in 3, 4, 5:
    _, trace = run(passed, "integrate", word_bits=24, end_shift=shift)
    sets, blocks = trace["set_X_mm"], trace["block"]
    units = [round((b - a) / 1.25e-4) for a, b, block in zip(sets, sets[1:], blocks[1:]) if block == 1]
    shared = len(units) - 1 - max(n for n in range(len(units)) if units[n] == 404)
    t.check(abs(shared - 2**shift) <= 1, f"N = {2**shift}: so many cycles share the rest", shared, units[-40:])
    t.check(len(set(units[-shared:-1])) == 1 and units[-2] > 404, f"N = {2**shift}: evenly", units[-shared:])

# takt precision drives the lines with ramps of their own, too.
def ramps(program, **keys):
    sets = [word for key, value in keys.items() for word in ("--set", f"machine.interpolator_{key}={value}")]
    status, out, err = t.run("precision", program, *sets)
    t.check(status == 0, f"precision {keys}", err)
    row = re.search(r"^  ramps +off lines, with ramps of its own +(\S+) +(\S+) mm$", out, re.M)
    counts = re.search(r"^ +(\d+) lines in (\d+) cycles, the run took (\d+); acceleration changes by (\S+) mm/s2", out, re.M)
    rule = re.search(r"^ +end rule, N = (\d+): (\S+) to (\S+) of V_end$", out, re.M)
    if not t.check(row and counts, "its row is there", out):
        t.finish()
    t.check(float(row[1]) <= float(row[2]), "off the line by less than truncation may take", row[0])
    return [float(word) for word in counts.groups()], rule and [float(word) for word in rule.groups()]


(lines, cycles, taken, step), rule = ramps(line)
acceleration = ACCELERATION / (24 / 26)
least = (26 / 50 + 50 / acceleration) / CYCLE_S
t.check(lines == 1 and abs(step / acceleration - 1) < 0.01, "acceleration sets in at once: there is no jerk limit", step, acceleration)
t.check(least - 1 <= cycles <= least + 50 / (acceleration * CYCLE_S) + 2, "L/V + V/a, and at most a cycle's way of creeping", cycles, least)
t.check(cycles < taken + 50 and rule is None, "a stop knows no end rule", cycles, taken, rule)
for shift in 3, 4, 5:
    (lines, cycles, taken, _), rule = ramps(passed, end_shift=shift)
    parts = 2**shift
    t.check(lines == 2 and rule and rule[0] == parts, "the end rule acts with its N", rule)
    t.check((parts - 1) / parts - 1e-4 <= rule[1] <= rule[2] <= 1 + 1e-4, "V_end (N - 1) / N < V <= V_end", rule)

for key, wrong, said in ("word_bits", 7, "at least 8"), ("word_bits", 63, "at most 62"), ("end_shift", 9, "at most 8"), ("angle_bits", 25, "at most 24"):
    status, _, err = t.run("run", line, "--set", f"machine.interpolator_{key}={wrong}")
    t.check(status == 2 and said in err, f"{key} = {wrong} is refused", status, err)
status, out, err = t.run("machine", "--set", "machine.interpolator_word_bits=24", "--set", "machine.interpolator_angle_bits=7")
shown = "interpolator_word_bits = 24" in out and "interpolator_angle_bits = 7" in out and "interpolator_end_shift = 4" in out
t.check(shown, "takt machine shows them", out, err)
t.check(t.run("machine", t.write("words.ini", out), "--pack", "-o", "words.settings")[0] == 0, "they are packed")
again = t.run("machine", "words.settings", "--unpack")[1]
t.check(all(line in again for line in ("interpolator_word_bits = 24", "interpolator_angle_bits = 7")), "and unpacked", again)
t.finish()
