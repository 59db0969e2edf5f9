"""Reads the part programs of `hunt`, in its own way, and writes what hunt_judge wants to know of them.

Known are G0 G1 G2 G3 G4, G17 G18 G19, G21, G61 G61.1 G64, G90 G91 G93 G94 and M2, one motion a line.
"""

import math
import re

LINEAR, ROTARY = "XYZ", "ABC"
# The plane's axes, in the order in which G3 turns from the first to the second, with the words of the centre.
PLANES = {17: ("X", "Y", "I", "J"), 18: ("Z", "X", "K", "I"), 19: ("Y", "Z", "J", "K")}
WORD = re.compile(r"([A-Z])([-+]?[0-9.]+)")


class Motion:
    """A line, or an arc with centre and sweep; place and end by axis letter, mm and degrees."""

    def __init__(self, number, start, end):
        self.number, self.start, self.end = number, start, end
        self.plane = self.centre = None
        self.sweep = 0.0
        self.tolerance = self.time_s = 0.0
        self.rapid = self.stops = False

    def linear_mm(self):
        way = {a: self.end[a] - self.start[a] for a in self.end if a in LINEAR}
        if self.centre:
            first, second = self.plane[:2]
            radii = [math.hypot(p[first] - self.centre[0], p[second] - self.centre[1]) for p in (self.start, self.end)]
            way[first], way[second] = self.sweep * sum(radii) / 2, 0.0
        return math.hypot(*way.values())

    def turning_deg(self):
        return math.hypot(*(self.end[a] - self.start[a] for a in self.end if a in ROTARY))


def arc_centre(motion, words, first, second, sign):
    """From the words of the centre, or from R: its sign chooses the shorter (+) or the longer arc."""
    if "R" not in words:
        return (motion.start[first] + words.get(motion.plane[2], 0.0), motion.start[second] + words.get(motion.plane[3], 0.0))
    x, y = (motion.end[a] - motion.start[a] for a in (first, second))
    half = math.hypot(x, y) / 2
    radius = abs(words["R"])
    height = math.sqrt(max(radius * radius - half * half, 0.0)) * sign * math.copysign(1, words["R"])
    return (motion.start[first] + x / 2 - y / (2 * half) * height, motion.start[second] + y / 2 + x / (2 * half) * height)


def make_arc(motion, words, plane, sign):
    motion.plane = PLANES[plane]
    first, second = motion.plane[:2]
    motion.centre = arc_centre(motion, words, first, second, sign)
    angles = [math.atan2(p[second] - motion.centre[1], p[first] - motion.centre[0]) for p in (motion.start, motion.end)]
    turn = sign * (angles[1] - angles[0]) % (2 * math.pi)
    if motion.start[first] == motion.end[first] and motion.start[second] == motion.end[second]:
        turn = 2 * math.pi
    motion.sweep = sign * (turn + 2 * math.pi * (int(words.get("P", 1)) - 1))


class Reader:
    def __init__(self, machine, exact):
        self.at = {a: 0.0 for a in machine.axes}
        self.velocity, self.exact = {a: limits[0] for a, limits in machine.axes.items()}, exact
        self.mode, self.plane, self.absolute, self.inverse = 1, 17, True, False
        self.tolerance, self.every_stop, self.feed = 0.0, False, 0.0
        self.motions = []

    def set_code(self, code, words):
        if code in (0, 1, 2, 3):
            self.mode = int(code)
        elif code in PLANES:
            self.plane = int(code)
        elif code in (90, 91):
            self.absolute = code == 90
        elif code in (93, 94):
            self.inverse = code == 93
        elif code in (61, 61.1, 64):
            self.tolerance = words.get("P", 0.0) if code == 64 and not self.exact else 0.0
            self.every_stop = code == 61.1
        elif code == 4 and self.motions:
            self.motions[-1].stops = True
        elif code not in (4, 21):
            raise ValueError(f"G{code} is not known here")

    def set_time(self, motion):
        length = motion.linear_mm() or motion.turning_deg()
        if self.mode == 0:
            motion.rapid = True
            motion.time_s = max(abs(motion.end[a] - motion.start[a]) / self.velocity[a] for a in self.at)
        elif self.inverse:
            motion.time_s = 60 / self.feed
        else:
            motion.time_s = 60 * length / self.feed

    def add_motion(self, number, words):
        end = {a: words.get(a, x if self.absolute else 0.0) + (0.0 if self.absolute else x) for a, x in self.at.items()}
        motion = Motion(number, self.at, end)
        if self.mode in (2, 3):
            make_arc(motion, words, self.plane, 1 if self.mode == 3 else -1)
        self.at = end
        if motion.linear_mm() == 0 and motion.turning_deg() == 0:
            return
        self.set_time(motion)
        motion.tolerance, motion.stops = self.tolerance, self.every_stop
        self.motions.append(motion)

    def read(self, number, line):
        found = WORD.findall(line.split("(")[0].upper())
        words = {letter: float(value) for letter, value in found if letter not in "GM"}
        codes = [float(value) for letter, value in found if letter == "G"]
        self.feed = words.get("F", self.feed)
        for code in codes:
            self.set_code(code, words)
        if not any(a in words for a in self.at) and not (self.mode in (2, 3) and any(w in words for w in "IJK")):
            return
        self.add_motion(number, words)


def read(text, machine, exact):
    reader = Reader(machine, exact)
    for number, line in enumerate(text.splitlines(), 1):
        reader.read(number, line)
    return reader.motions


def case(machine, motions, feed_factor, end):
    """The text of a case of hunt_judge; end: after the trace's last row the axes move (0), stand (1), or stand at the path's end (2)."""
    axes = list(machine.axes)
    rows = [f"{len(axes)} {sum(a in LINEAR for a in axes)} {machine.cycle_us * 1e-6!r} {feed_factor!r} {end}"]
    for a in axes:
        scale = 1.0 if a in LINEAR else math.pi / 180
        rows.append(" ".join(repr(x) for x in (scale, *machine.axes[a], 0.0)))
    for m in motions:
        row = ["A" if m.centre else "L", m.number, m.tolerance, m.time_s, int(m.rapid), int(m.stops), *m.end.values()]
        if m.centre:
            row += [axes.index(m.plane[0]), axes.index(m.plane[1]), *m.centre, m.sweep]
        rows.append(" ".join(x if isinstance(x, str) else repr(x) for x in row))
    return "\n".join(rows) + "\n"


def rest_time(length, v, a, j):
    """Least time from rest to rest over a length under v, a and j."""
    if v * j <= a * a and length >= 2 * v * math.sqrt(v / j):
        return length / v + 2 * math.sqrt(v / j)
    if v * j > a * a and length >= v * (v / a + a / j):
        return length / v + v / a + a / j
    if v * j > a * a and length >= 2 * a**3 / j**2:
        return 2 * (math.sqrt(a * length + (a * a / j / 2) ** 2) + a * a / j / 2) / a
    return 4 * (length / (2 * j)) ** (1 / 3)


def stop_and_go_time(machine, motion):
    """Upper bound of the time a motion takes from rest to rest, with everything slowed down for the slowest axis."""
    linear, turning = motion.linear_mm(), motion.turning_deg()
    length = linear or turning
    ways = {a: abs(motion.end[a] - motion.start[a]) for a in machine.axes}
    if motion.centre:
        ways[motion.plane[0]] = ways[motion.plane[1]] = linear
    v, a, j = (min(machine.axes[x][k] * length / way for x, way in ways.items() if way > 0) for k in range(3))
    v = min(v, length / motion.time_s)
    if motion.centre:
        radius = math.hypot(motion.start[motion.plane[0]] - motion.centre[0], motion.start[motion.plane[1]] - motion.centre[1])
        v = min(v, math.sqrt(a * radius / 2), (j * radius * radius / 2) ** (1 / 3))
    return rest_time(length, v, a / 2, j / 2) + 4e-6 * machine.cycle_us
