"""What the system tests share: running the command, reading what it wrote, telling failures."""

import cmath
import csv
import json
import math
import os
import subprocess
import sys

TAKT = os.environ["TAKT"]
SOURCE = os.environ["TAKT_SOURCE"]
OWN_PROGRAMS = os.path.join(SOURCE, "tests", "programs")
EXAMPLES = os.path.join(SOURCE, "host", "examples")

# What `takt serve` keeps by default is the test's own.
os.environ["XDG_STATE_HOME"] = os.path.abspath("state-home")

failures = []


def check(condition, claim, *details):
    """Notes a failed claim and goes on: one run shows all that is wrong."""
    if not condition:
        failures.append(claim)
        print("FAILED:", claim, *details)
    return bool(condition)


def finish():
    if failures:
        print(len(failures), "claims failed")
        sys.exit(1)
    sys.exit(0)


def skip(reason):
    print(reason)
    sys.exit(77)


def run(*arguments, text=None, environment=None):
    """Runs takt; returns status, stdout, stderr."""
    done = subprocess.run([TAKT, *arguments], input=text, capture_output=True, env=environment, check=False)
    return done.returncode, done.stdout.decode("utf-8", "replace"), done.stderr.decode("utf-8", "replace")


def write(path, text):
    mode = "wb" if isinstance(text, bytes) else "w"
    with open(path, mode) as file:
        file.write(text)
    return path


def real_programs(*names):
    """Paths of real part programs, or the test is skipped."""
    folder = os.environ.get("TAKT_PROGRAMS") or os.path.join(SOURCE, "..", "shared", "programs")
    if not os.path.isdir(folder):
        skip("no real programs: TAKT_PROGRAMS is not set and ../shared/programs does not exist")
    paths = [os.path.join(folder, name) for name in names]
    for path in paths:
        if not os.path.exists(path):
            skip("no program " + path)
    return paths


def read_trace(path):
    """Columns of a trace by name, as lists of numbers."""
    with open(path, newline="") as file:
        rows = csv.reader(file)
        names = next(rows)
        columns = list(zip(*(map(float, row) for row in rows)))
    return dict(zip(names, columns))


def peaks(positions, cycle_s, start=0.0):
    """Largest velocity, acceleration and jerk by differences; at rest at start before the first cycle."""
    x, v, a = start, 0.0, 0.0
    most = [0.0, 0.0, 0.0]
    for position in positions:
        velocity = (position - x) / cycle_s
        acceleration = (velocity - v) / cycle_s
        jerk = (acceleration - a) / cycle_s
        most = [max(most[0], abs(velocity)), max(most[1], abs(acceleration)), max(most[2], abs(jerk))]
        x, v, a = position, velocity, acceleration
    return most


class Move:
    """A motion as `takt canon` prints it."""

    def __init__(self, line, start):
        words = line.split()
        self.line = int(words[0])
        self.kind = words[1]
        self.start = start
        values = {word[0]: word[1:] for word in words[2:]}
        self.end = tuple(float(values[axis]) for axis in "XYZ")
        if self.kind == "spline":
            self.set_spline(values)
        if self.is_arc() or self.is_involute():
            self.centre = tuple(float(values[axis]) for axis in "IJK")
            self.plane = {"G17": (0, 1, 2), "G18": (2, 0, 1), "G19": (1, 2, 0)}["G" + values["G"]]
        if self.is_arc():
            self.turns = int(float(values["P"]))
            self.set_arc()
        if self.is_involute():
            self.base = float(values["R"])
            self.set_involute()

    def is_arc(self):
        return self.kind.startswith("arc")

    def is_involute(self):
        return self.kind.startswith("involute")

    def string(self, point):
        """The string from a point to the base circle: how far it is unrolled, and where it touches."""
        first, second, _ = self.plane
        at = complex(point[first] - self.centre[first], point[second] - self.centre[second])
        unrolled = math.sqrt(max(0.0, (abs(at) / self.base) ** 2 - 1))
        return unrolled, cmath.phase(at) + self.hand * math.atan(unrolled)

    def set_involute(self):
        first, second, _ = self.plane
        start, end = (math.hypot(p[first] - self.centre[first], p[second] - self.centre[second])
                      for p in (self.start, self.end))
        self.hand = 1 if (end > start) == (self.kind == "involute_ccw") else -1
        self.unrolled = self.string(self.start)[0], self.string(self.end)[0]
        outer = self.start if start > end else self.end
        self.heading = self.string(outer)[1] - self.hand * max(self.unrolled)

    def involute_distance(self, point):
        """Across the curve: the string unrolled too far; and along the third axis, which goes with the length."""
        unrolled, touches = self.string(point)
        turn = self.hand * (touches - self.heading) - unrolled
        off = self.base * abs(turn - 2 * math.pi * round(turn / (2 * math.pi)))
        start, end = self.unrolled
        place = min(1.0, max(0.0, (unrolled**2 - start**2) / (end**2 - start**2)))
        third = self.plane[2]
        along = self.start[third] + place * (self.end[third] - self.start[third])
        return math.hypot(off, point[third] - along), place

    def set_spline(self, values):
        """The polynomial of fifth degree with the place, direction and curvature of both ends (firmware/geometry)."""
        first, second = {"G17": (0, 1), "G18": (2, 0), "G19": (1, 2)}["G" + values["G"]]
        length = float(values["R"])
        heading = [math.radians(float(values[word])) for word in "IJ"]
        curve = [float(values[word]) * length**2 / 2 for word in "PQ"]
        self.terms = [(s, 0, 0, 0, 0, 0) for s in self.start]
        for axis, turn in ((first, 0.0), (second, math.pi / 2)):
            way = self.end[axis] - self.start[axis]
            a, b = (length * math.cos(h - turn) for h in heading)
            c, d = (-k * math.sin(h - turn) for k, h in zip(curve, heading))
            self.terms[axis] = (self.start[axis], a, c, 10 * way - 6 * a - 4 * b - 3 * c + d,
                                -15 * way + 8 * a + 7 * b + 3 * c - 2 * d, 6 * way - 3 * a - 3 * b - c + d)

    def spline_distance(self, point):
        """By thirds: a piece hardly bends."""
        def off(u):
            return math.dist(point, [sum(k * u**n for n, k in enumerate(terms)) for terms in self.terms])

        low, high = 0.0, 1.0
        for _ in range(50):
            third = (high - low) / 3
            low, high = (low, high - third) if off(low + third) < off(high - third) else (low + third, high)
        return min((off(u), u) for u in (0.0, (low + high) / 2, 1.0))

    def set_arc(self):
        first, second, _ = self.plane
        at = [self.start[first] - self.centre[first], self.start[second] - self.centre[second]]
        to = [self.end[first] - self.centre[first], self.end[second] - self.centre[second]]
        self.angle = math.atan2(at[1], at[0])
        self.radii = math.hypot(*at), math.hypot(*to)
        sign = 1 if self.kind == "arc_ccw" else -1
        sweep = sign * (math.atan2(to[1], to[0]) - self.angle) % (2 * math.pi)
        # Six decimals of the ends leave a full circle a little open, either way.
        if sweep < 1e-5:
            sweep += 2 * math.pi
        self.sweep = sign * (sweep + 2 * math.pi * (self.turns - 1))

    def distance(self, point, near):
        """Distance of a point from the curve, and where on it (0 ... 1), near the place given."""
        if self.is_involute():
            return self.involute_distance(point)
        if self.kind == "spline":
            return self.spline_distance(point)
        return self.arc_distance(point, near) if self.is_arc() else self.line_distance(point)

    def line_distance(self, point):
        way = [e - s for e, s in zip(self.end, self.start)]
        off = [p - s for p, s in zip(point, self.start)]
        square = sum(w * w for w in way)
        place = min(1.0, max(0.0, sum(o * w for o, w in zip(off, way)) / square)) if square > 0 else 0.0
        return math.dist(off, [place * w for w in way]), place

    def arc_distance(self, point, near):
        first, second, third = self.plane
        at = point[first] - self.centre[first], point[second] - self.centre[second]
        turn = 2 * math.pi / abs(self.sweep)
        place = (math.atan2(at[1], at[0]) - self.angle) / self.sweep
        place += turn * round((near - place) / turn)
        place = min(1.0, max(0.0, place))
        angle = self.angle + place * self.sweep
        radius = self.radii[0] + place * (self.radii[1] - self.radii[0])
        along = self.start[third] + place * (self.end[third] - self.start[third])
        wanted = radius * math.cos(angle), radius * math.sin(angle), along
        return math.dist((at[0], at[1], point[third]), wanted), place


def canon(program, *options):
    """The motions of a program, in order; block n of a trace is element n - 1."""
    status, out, err = run("canon", program, *options)
    check(status == 0, "canon reads " + program, err)
    moves, at = [], (0.0, 0.0, 0.0)
    for line in out.splitlines():
        if line.split()[1] in ("rapid", "feed", "arc_cw", "arc_ccw", "involute_cw", "involute_ccw", "spline"):
            moves.append(Move(line, at))
            at = moves[-1].end
    return moves


def load_json(path):
    with open(path) as file:
        return json.load(file)
