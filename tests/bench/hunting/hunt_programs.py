"""Random machines and part programs for `hunt`, drawn by dimensionless numbers on a log scale."""

import math

import hunt_path

# A program's time from stop to stop, seconds, at most; and its motions.
TIME_S = (0.5, 10)
MOTIONS = (2, 400)
# Of every axis on either side, mm or degrees.
TRAVEL = 2000
# Limits that a machine file may have. takt refuses accelerations and jerks lower than 5e-12 and 1e-12 of the travel in a
# cycle's units, which rounding of setpoints would hide.
HIGHEST = (1e5, 1e7, 1e10)
# Arcs are not smaller: takt refuses those whose centre is on their start.
RADIUS_MM = 2e-3


def decades(rng, low, high):
    return math.exp(rng.uniform(math.log(low), math.log(high)))


class Machine:
    """axes: letter -> (velocity, acceleration, jerk), mm or degrees."""

    def __init__(self, axes, cycle_us, law="jerk", look_ahead=256):
        self.axes, self.cycle_us, self.law, self.look_ahead = axes, cycle_us, law, look_ahead
        self.on_can = False # else step drives, which add nothing of their own

    def text(self):
        rows = ["[machine]", f"cycle_us = {self.cycle_us}", f"law = {self.law}", f"look_ahead_blocks = {self.look_ahead}"]
        for node, (letter, limits) in enumerate(self.axes.items(), 1):
            unit = "mm" if letter in hunt_path.LINEAR else "deg"
            keys = (f"max_velocity_{unit}_s", f"max_acceleration_{unit}_s2", f"max_jerk_{unit}_s3")
            rows += [f"[axis {letter}]", f"drive_node = {node}"]
            rows += [] if self.on_can else ["drive_type = step", f"steps_per_{unit} = 1"]
            rows += [f"increments_per_{unit} = 1000", f"travel_min_{unit} = {-TRAVEL}", f"travel_max_{unit} = {TRAVEL}"]
            rows += [f"following_error_max_{unit} = 0"] + [f"{key} = {value!r}" for key, value in zip(keys, limits)]
        return "\n".join(rows) + "\n"


def built_in():
    return Machine({a: (100.0, 1000.0, 50000.0) for a in "XYZ"}, 1000)


def limits(rng, cycle_s):
    """tau J / A in 0.002 ... 1, V J / A^2 in 0.1 ... 1000, V of 3 ... 300; what takes seconds to get going is drawn again."""
    while True:
        ramp_s = cycle_s / decades(rng, 0.002, 1)
        rise_s = ramp_s * decades(rng, 0.1, 1000)
        v = decades(rng, 3, 300)
        if rise_s <= 1 and v / rise_s <= 1e6:
            return v, v / rise_s, v / rise_s / ramp_s


def random_machine(rng):
    cycle_us = int(decades(rng, 250, 4000))
    letters = rng.choice(("XYZ", "XYZ", "XYZ", "XYZA", "XYZC", "XYZAC", "XYZABC"))
    base = limits(rng, cycle_us * 1e-6)
    apart = rng.choice((1, 10, 100))
    axes = {}
    for letter in letters:
        factors = [decades(rng, 1 / math.sqrt(apart), math.sqrt(apart)) for _ in range(3)]
        unit = 1 if letter in hunt_path.LINEAR else decades(rng, 0.3, 30)
        lowest = (0, 5.000001e-12 * TRAVEL / (cycle_us * 1e-6) ** 2, 1.000001e-12 * TRAVEL / (cycle_us * 1e-6) ** 3)
        values = [float(f"{unit * b * f:.6g}") for b, f in zip(base, factors)]
        axes[letter] = tuple(min(max(v, low), high) for v, low, high in zip(values, lowest, HIGHEST))
    law = rng.choice(("jerk", "jerk", "smooth", "gentle"))
    return Machine(axes, cycle_us, law, int(round(decades(rng, 2, 256))))


class Writer:
    """A program in the making. size: a length of its features in mm; feed in mm/min."""

    def __init__(self, rng, machine, tolerance, size, feed):
        self.rng, self.machine, self.tolerance, self.size, self.feed = rng, machine, tolerance, size, feed
        self.places = min(max(5, 4 - int(math.floor(math.log10(size)))), 9)
        self.at = {a: 0.0 for a in machine.axes}
        self.heading = rng.uniform(0, 2 * math.pi)
        self.lines = []

    def number(self, value):
        return f"{value:.{self.places}f}"

    def say(self, text):
        self.lines.append(text)

    def go(self, code="G1", words="", **ends):
        """To these coordinates."""
        self.at.update({a: round(v, self.places) for a, v in ends.items()})
        self.say(code + "".join(f" {a}{self.number(self.at[a])}" for a in ends) + words)

    def step(self, length, turn=0.0, code="G1"):
        self.heading += turn
        x = self.at["X"] + length * math.cos(self.heading)
        y = self.at["Y"] + length * math.sin(self.heading)
        self.go(code, X=x, Y=y)

    def arc(self, radius, sweep, rise=0.0, plane=17, turns=1, by_radius=False):
        """Tangent to the heading; sweep in rad, its sign the direction."""
        radius = max(radius, RADIUS_MM)
        first, second, i, j = hunt_path.PLANES[plane]
        third = ({"X", "Y", "Z"} - {first, second}).pop()
        side = math.copysign(math.pi / 2, sweep)
        centre = [radius * math.cos(self.heading + side), radius * math.sin(self.heading + side)]
        if not by_radius:
            centre = [round(c, self.places) for c in centre]
        x, y = self.at[first] + centre[0], self.at[second] + centre[1]
        ends = {}
        if abs(sweep) < 6.28:
            start = math.atan2(-centre[1], -centre[0])
            ends = {first: x + radius * math.cos(start + sweep), second: y + radius * math.sin(start + sweep)}
            self.heading += sweep
        if rise != 0:
            ends[third] = self.at[third] + rise
        words = f" {i}{self.number(centre[0])} {j}{self.number(centre[1])}"
        if by_radius:
            words = f" R{self.number(radius if abs(sweep) < math.pi else -radius)}"
        if turns > 1:
            words += f" P{turns}"
        self.go("G3" if sweep > 0 else "G2", words, **ends)

    def length(self, low=0.1, high=3):
        return self.size * decades(self.rng, low, high)


def lines(w):
    w.step(w.length(), w.rng.uniform(-3.14, 3.14))


def lengths(w):
    """Of all sizes, beside each other."""
    w.step(w.length(1e-3, 10), w.rng.gauss(0, 1))


def zigzag(w):
    w.heading = 0
    length, pitch = w.length(0.9, 1.1), w.length(0.001, 0.3)
    for _ in range(w.rng.randint(2, 12)):
        w.go(X=w.at["X"] + pitch / 2, Y=w.at["Y"] + length)
        w.go(X=w.at["X"] + pitch / 2, Y=w.at["Y"] - length)


def raster(w):
    length, pitch = w.length(1, 3), w.length(0.01, 0.2)
    for _ in range(w.rng.randint(1, 6)):
        for way in (length, -length):
            w.go(X=w.at["X"] + way)
            w.go(Y=w.at["Y"] + pitch)


def arcs(w):
    rise = w.rng.choice((0, 0, 1)) * w.size * w.rng.uniform(-0.3, 0.3)
    sweep = w.rng.choice((-1, 1)) * w.rng.uniform(0.05, 5)
    if w.rng.random() < 0.4:
        w.heading += w.rng.uniform(-3, 3)
    w.arc(w.length(), sweep, rise, by_radius=w.rng.random() < 0.3 and abs(abs(sweep) - math.pi) > 0.3)


def circles(w):
    rise = w.rng.choice((0, 1)) * w.size * w.rng.uniform(-0.3, 0.3)
    turns = w.rng.choice((1, 1, 2, 5))
    w.arc(w.length(), w.rng.choice((-1, 1)) * 2 * math.pi, rise, turns=turns)
    if w.rng.random() < 0.7:
        w.step(w.length(), w.rng.uniform(-3, 3))


def spiral(w):
    """Chords of a growing circle."""
    radius, angle = w.length(0.05, 0.3), 0.0
    chord = w.rng.choice((0.02, 0.1, 0.4))
    x, y = w.at["X"], w.at["Y"]
    for _ in range(w.rng.randint(20, 120)):
        angle += chord
        grown = radius * angle / 3
        w.go(X=x + grown * math.cos(angle), Y=y + grown * math.sin(angle))


def reversals(w):
    """Strokes on one line, of parts of the tolerance to many of it."""
    on = w.tolerance * decades(w.rng, 3, 300)
    back = w.tolerance * decades(w.rng, 0.3, 10)
    w.step(on)
    w.step(-back)
    if w.rng.random() < 0.3:
        w.step(on, w.rng.uniform(-1, 1))


def tiny(w):
    """Lines of 1e-4 mm and more along a wave."""
    step = w.rng.choice((1e-4, 1e-3, 1e-2))
    for _ in range(w.rng.randint(10, 60)):
        w.step(step, w.rng.gauss(0, 0.2))


def chords(w):
    """A bend made of short lines, then a long one."""
    turn = w.rng.choice((-1, 1)) * w.rng.choice((0.02, 0.1, 0.3))
    length = abs(turn) * w.length(0.3, 3)
    for _ in range(w.rng.randint(5, 40)):
        w.step(length, turn)
    w.step(w.length(1, 10))


def planes(w):
    plane = w.rng.choice((17, 18, 19))
    w.say(f"G{plane}")
    w.heading = w.rng.uniform(-3, 3)
    for _ in range(w.rng.randint(1, 4)):
        w.arc(w.length(), w.rng.choice((-1, 1)) * w.rng.uniform(0.1, 4), w.size * w.rng.choice((0, 0.2)), plane)
    w.say("G17")


def retrace(w):
    """There and back over the same way."""
    ways = [dict(w.at)]
    for _ in range(w.rng.randint(1, 6)):
        w.step(w.length(), w.rng.uniform(-1, 1))
        ways.append(dict(w.at))
    for at in reversed(ways[:-1]):
        w.go(X=at["X"], Y=at["Y"])


def rapids(w):
    w.step(w.length(), w.rng.uniform(-2, 2), "G0")
    lines(w)


def rotary(w):
    """Rotary axes with linear ones, or alone; as others where there are none."""
    turning = [a for a in w.machine.axes if a in hunt_path.ROTARY]
    if not turning:
        return lines(w)
    ends = {a: w.at[a] + w.rng.gauss(0, 1) * decades(w.rng, 0.1, 30) for a in turning if w.rng.random() < 0.7}
    if w.rng.random() < 0.8:
        for a in "XYZ":
            ends[a] = w.at[a] + w.rng.gauss(0, 1) * w.size
    return w.go(**ends) if ends else None


def stops(w):
    lines(w)
    w.say("G4 P0.01")


def modes(w):
    """Exact and rounded motions, of several tolerances."""
    code = w.rng.choice(("G61", "G61.1", f"G64 P{w.tolerance:.6f}", f"G64 P{3 * w.tolerance:.6f}"))
    w.say(code)
    w.rng.choice((lines, arcs, chords))(w)


def mixed(w):
    w.rng.choice((lines, arcs, circles, zigzag, chords, reversals, retrace, rapids))(w)


FAMILIES = {f.__name__: f for f in (lines, lengths, zigzag, raster, arcs, circles, spiral, reversals, tiny, chords, planes,
                                    retrace, rapids, rotary, stops, modes, mixed)}


def draw_tolerance(rng, machine):
    """P J^2 / A^3 in 1e-3 ... 1e3, or P itself, 0.0005 ... 1 mm."""
    _, a, j = machine.axes["X"]
    p = decades(rng, 1e-3, 1e3) * a**3 / j**2 if rng.random() < 0.5 else decades(rng, 5e-4, 1)
    return min(max(round(p, 6), 5e-4), 1)


def with_inverse_time(text, machine):
    """G93: every feed motion takes so many minutes as it did."""
    motions = {m.number: m for m in hunt_path.read(text, machine, False)}
    rows = []
    for number, line in enumerate(text.splitlines(), 1):
        motion = motions.get(number)
        feed = motion and not motion.rapid and f" F{60 / motion.time_s:.6f}"
        rows.append(line.replace(" G94", " G93") + (feed or ""))
    return "\n".join(rows) + "\n"


def build(rng, machine, family, tolerance, feed):
    size = tolerance * decades(rng, 0.3, 1000) if rng.random() < 0.7 else decades(rng, 0.01, 30)
    w = Writer(rng, machine, tolerance, min(size, 20), feed)
    w.say(f"G21 G90 G17 G94 G64 P{tolerance:.6f} F{feed:.4f}")
    budget_s, spent_s, most = decades(rng, *TIME_S), 0.0, int(decades(rng, *MOTIONS))
    reader, read = hunt_path.Reader(machine, False), 0
    while spent_s < budget_s and len(reader.motions) < most and read < 4 * MOTIONS[1]:
        FAMILIES[family](w)
        counted = len(reader.motions)
        for read in range(read, len(w.lines)):
            reader.read(read + 1, w.lines[read])
        read = len(w.lines)
        spent_s += sum(hunt_path.stop_and_go_time(machine, m) for m in reader.motions[counted:])
        if spent_s > 1.5 * TIME_S[1]:
            return None
    return "\n".join(w.lines) + "\nM2\n"


def random_program(rng, machine, family):
    """A program of some seconds: with a feed that takes much longer it is drawn again, with a higher one."""
    tolerance = draw_tolerance(rng, machine)
    v = max(machine.axes[a][0] for a in "XYZ")
    feed = max(0.1, 60 * v * (decades(rng, 1e-5, 1) if rng.random() < 0.2 else decades(rng, 0.05, 2)))
    while True:
        text = build(rng, machine, family, tolerance, feed)
        if text is not None:
            break
        feed *= 2
    return with_inverse_time(text, machine) if rng.random() < 0.1 and "G1" in text else text
