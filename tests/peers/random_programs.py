"""Random part programs of which most are right: a mill with six axes or a lathe, every line from one random stream.

What the tables of differences from LinuxCNC name on purpose is left out: a change of the feed mode without a new F, feed per
revolution without a spindle, spirals with G93, tapping and arcs across a rotated plane, G28 in one, compensation in G19, of
spirals, round corners of less than 2.9 degrees, or where a contour comes back to where it has been, turning cycles in inches.
"""
import math
import random

# First and second axis of each plane, the axis across, and the words of the centre.
PLANES = {"G17": ("XY", "Z", "IJ"), "G18": ("ZX", "Y", "KI"), "G19": ("YZ", "X", "JK")}
SYSTEMS = ("G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3")


class Writer:
    """One program: where its axes are in its own words, what is in effect, and its lines."""

    def __init__(self, seed, *, has_clearance):
        self.random = random.Random(seed)
        self.has_clearance = has_clearance
        self.lines = []
        self.at = dict.fromkeys("XYZABC", 0.0)
        self.plane = "G17"
        self.incremental = False
        self.centre_absolute = False
        self.feed_mode = "G94"
        self.rotated = False
        self.label = 100
        self.heading = 0.0
        self.inch = False

    # -- numbers --

    def between(self, low, high):
        return self.random.uniform(low, high)

    def chance(self, share):
        return self.random.random() < share

    def number(self, value):
        """A number as programs write it, or something that has its value."""
        value = round(value, 4)
        form = self.random.random()
        if form < 0.85:
            return f"{value:.4f}".rstrip("0").rstrip(".") if self.chance(0.5) else f"{value:.4f}"
        if form < 0.9:
            part = round(self.between(-5.0, 5.0), 4)
            return f"[{value - part:.4f} + {part:.4f}]"
        if form < 0.95:
            return f"[{2 * value:.4f} / 2]"
        return f"[ABS[{value:.4f}]]" if value >= 0.0 else f"[0 - ABS[{value:.4f}]]"

    def line(self, text):
        if self.chance(0.05):
            text = f"N{len(self.lines) + 1} {text}"
        if self.chance(0.05):
            text = text.lower()
        self.lines.append(text + (" (a comment)" if self.chance(0.03) else ""))

    # -- words --

    def word(self, axis, to):
        """The word that leads an axis there, and where that is."""
        to = round(to, 4)
        by = to - self.at[axis] if self.incremental else to
        return f"{axis}{self.number(by)}", to

    def go(self, targets):
        words = []
        for axis, to in targets.items():
            text, self.at[axis] = self.word(axis, to)
            words.append(text)
        self.random.shuffle(words)
        return " ".join(words)

    def feed(self, *, needed=False):
        if not needed and self.feed_mode != "G93" and self.chance(0.8):
            return ""
        low, high = {"G93": (0.5, 50.0), "G94": (10.0, 3000.0), "G95": (0.01, 2.0)}[self.feed_mode]
        return f" F{self.number(self.between(low, high))}"

    def rotary(self):
        return {axis: self.between(-180.0, 180.0) for axis in "ABC" if self.chance(0.1)}

    def some(self, axes):
        chosen = [axis for axis in axes if self.chance(0.6)] or [self.random.choice(axes)]
        return {axis: self.between(-80.0, 80.0) for axis in chosen}

    # -- blocks --

    def settle(self):
        """Every axis where the program says, after its words have got another meaning."""
        self.line("G90")
        self.incremental = False
        self.line("G0 " + self.go({axis: self.between(-50.0, 50.0) for axis in "XYZ"}))
        self.line("G0 " + self.go({axis: self.between(-50.0, 50.0) for axis in "ABC"}))

    def straight(self):
        targets = self.rotary() if self.chance(0.1) else self.some("XYZ") | self.rotary()
        if not targets:
            return
        if self.chance(0.3):
            self.line("G0 " + self.go(targets))
        else:
            self.line("G1 " + self.go(targets) + self.feed())

    def arc(self):
        (first, second), across, centres = PLANES[self.plane]
        if self.rotated and self.plane != "G17":
            return
        # Rounded ends make a spiral of what has a centre, and its length is another for LinuxCNC.
        by_radius = self.feed_mode == "G93" or self.chance(0.25)
        radius = self.between(0.5, 30.0)
        begin = self.between(0.0, 2.0 * math.pi)
        sweep = self.between(0.05, 6.0 if by_radius else 2.0 * math.pi - 0.05)
        left = self.chance(0.5)
        centre = (self.at[first] - radius * math.cos(begin), self.at[second] - radius * math.sin(begin))
        end = begin + (sweep if left else -sweep)
        targets = {first: centre[0] + radius * math.cos(end), second: centre[1] + radius * math.sin(end)}
        start = self.at[first], self.at[second]
        if self.chance(0.3):
            targets[across] = self.between(-40.0, 40.0)
        targets |= self.rotary()
        words = self.go(targets)
        if by_radius:
            words += f" R{self.number(radius if sweep < math.pi else -radius)}"
        else:
            from_start = (0.0, 0.0) if self.centre_absolute else start
            words += "".join(f" {c}{self.number(m - s)}" for c, m, s in zip(centres, centre, from_start))
            if self.chance(0.2):
                words += f" P{self.random.randint(1, 3)}"
        self.line(f"{'G3' if left else 'G2'} {words}{self.feed()}")

    def modes(self):
        self.line(self.random.choice(("G61", "G64", "G64 P0.01", "G61.1", "G64 P0.02 Q0.01", "M7", "M8", "M9", "M48", "M49",
                                      "G97 S900", "M3 S500", "G40", "G98", "G99", "G4 P0.1", "G80", "M50 P0")))

    def distance(self):
        self.incremental = self.chance(0.5)
        self.line("G91" if self.incremental else "G90")

    def centre(self):
        self.centre_absolute = self.chance(0.5)
        self.line("G90.1" if self.centre_absolute else "G91.1")

    def choose_plane(self):
        self.plane = self.random.choice(tuple(PLANES))
        self.line(self.plane)

    def choose_feed_mode(self):
        mode = self.random.choice([m for m in ("G93", "G94", "G95") if m != self.feed_mode])
        self.feed_mode = mode
        self.line(mode if mode == "G93" else mode + self.feed(needed=True))

    def system(self):
        number = self.random.randint(1, 9)
        if self.chance(0.6):
            words = "".join(f" {axis}{self.number(self.between(-20.0, 20.0))}" for axis in "XYZABC" if self.chance(0.5))
            turn = f" R{self.number(self.between(-90.0, 90.0))}" if self.chance(0.3) else ""
            self.line(f"G10 L{self.random.choice((2, 20)) if not turn else 2} P{number}{words}{turn}")
        self.line(SYSTEMS[number - 1])
        # Which systems are rotated is not followed: any may be from now on.
        self.rotated = True
        self.settle()

    def offset(self):
        kind = self.random.choice(("G92", "G92.1", "G92.2", "G92.3", "G52", "G43.1", "G49"))
        words = "".join(f" {axis}{self.number(self.between(-10.0, 10.0))}" for axis in "XYZABC" if self.chance(0.4))
        if kind in ("G92", "G52", "G43.1"):
            if not words:
                return
            kind += words
        self.line(kind)
        self.settle()

    def cycle(self):
        if self.plane != "G17" or self.feed_mode == "G93":
            return
        was = self.incremental
        if was:
            self.line("G90")
            self.incremental = False
        self.line("G0 " + self.go({"Z": self.between(5.0, 20.0)}))
        code = self.random.choice(("G81", "G82 P0.1", "G83 Q{}", "G85", "G86 P0.1", "G89 P0.2", "G73 Q{}"))
        # Bites that divide the depth leave it to rounding whether there is one more.
        code = code.format(f"{self.between(0.3, 3.0):.4f}7")
        words = self.go({axis: self.between(-40.0, 40.0) for axis in "XY"})
        # LinuxCNC 2.9 knows no D; without it 2.10 has a number of its configuration, whatever the unit of the program.
        if self.has_clearance and "Q" in code:
            words += f" D{self.between(0.05, 0.5):.4f}"
        self.line(f"{self.random.choice(('G98', 'G99'))} {code} {words} Z{self.number(self.between(-10.0, 0.0))}"
                  f" R{self.number(self.between(1.0, 4.0))}{self.feed(needed=True)}")
        for _ in range(0 if "Q" in code else self.random.randint(0, 3)):
            self.line(self.go({axis: self.between(-40.0, 40.0) for axis in "XY"}))
        self.line("G80")
        self.settle()

    def machine(self):
        if self.incremental:
            return
        self.line("G53 G0 " + "".join(f"{axis}{self.number(self.between(-50.0, 50.0))} " for axis in "XYZ"))
        self.settle()

    def reference(self):
        if self.rotated:
            return
        self.line(self.random.choice(("G28", "G30")) + " " + self.go(self.some("XYZ")))
        self.settle()

    def block_of(self, make):
        """A loop, a branch or a subroutine around other lines, whose end is known again afterwards."""
        self.label += 1
        label = f"o{self.label}"
        form = self.random.choice(("repeat", "if", "sub", "while"))
        if form == "repeat":
            self.line(f"{label} repeat [{self.random.randint(1, 3)}]")
        elif form == "if":
            self.line(f"{label} if [#<_metric> EQ {self.random.randint(0, 1)}]")
        elif form == "sub":
            self.line(f"{label} sub")
        else:
            self.line(f"#{self.label}=0")
            self.line(f"{label} while [#{self.label} LT {self.random.randint(1, 3)}]")
            self.line(f"#{self.label}=[#{self.label}+1]")
        self.line("G91 G1 " + "".join(f"{a}{self.number(self.between(-3.0, 3.0))} " for a in "XYZ") + self.feed(needed=True))
        if make == "polar" and not self.rotated:
            self.line("G90 G1 @[3] ^[#5420 * 2]" + self.feed(needed=True))
        self.line(f"{label} end{form}")
        if form == "sub":
            self.line(f"{label} call [{self.number(self.between(0.0, 9.0))}]")
        self.settle()

    # -- compensation --

    def corner(self):
        """The direction behind a corner that is one for both: not below 2.9 degrees, nor nearly a way back."""
        self.heading += self.random.choice((-1.0, 1.0)) * self.between(math.radians(3.0), math.radians(120.0))
        return self.heading

    def contour_line(self, first, second, least=4.0):
        """A line behind the corner: its word, and places along it."""
        length, angle = self.between(least, 30.0), self.corner()
        start = self.at[first], self.at[second]
        end = start[0] + length * math.cos(angle), start[1] + length * math.sin(angle)
        places = [tuple(s + (e - s) * i / 30.0 for s, e in zip(start, end)) for i in range(31)]
        return "G1 ", {first: end[0], second: end[1]}, "", places

    def contour_arc(self, first, second):
        """One or two quarters of a circle, which have no decimals more than its radius: see `cutter_arc_decimals`."""
        quarters, left, radius = self.random.randint(1, 2), self.chance(0.5), self.between(4.0, 20.0)
        begin = self.corner() + (-0.5 if left else 0.5) * math.pi
        sweep = (0.5 if left else -0.5) * math.pi * quarters
        i, j = round(-radius * math.cos(begin), 4), round(-radius * math.sin(begin), 4)
        back = (i, j) if quarters == 2 else (j, -i) if left else (-j, i)
        centre = self.at[first] + i, self.at[second] + j
        angles = [begin + sweep * k / 30.0 for k in range(31)]
        places = [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles]
        self.heading += sweep
        words = "".join(f" {letter}{value:.4f}" for letter, value in zip(PLANES[self.plane][2], (i, j)))
        return "G3 " if left else "G2 ", {first: centre[0] + back[0], second: centre[1] + back[1]}, words, places

    def contour(self, orientation=""):
        """
        G41.1 or G42.1 round a few lines and arcs, as far as they do not come back to where they have been: nobody looks
        for that. LinuxCNC refuses many that turn too sharply.
        """
        if self.plane == "G19" or (self.plane == "G18" and self.rotated):
            return
        first, second = PLANES[self.plane][0]
        radius = self.between(0.1, 3.0)
        self.line("G91.1 G80 G40")
        self.centre_absolute = False
        self.line(f"{self.random.choice(('G41.1', 'G42.1'))} D{self.number(radius)}{orientation}")
        self.heading = self.between(-math.pi, math.pi)
        gone = []
        for piece in range(self.random.randint(2, 7)):
            make = self.contour_line if piece == 0 else self.random.choice((self.contour_line, self.contour_arc))
            code, targets, words, places = make(first, second, *((8.0,) if piece == 0 else ()))
            if any(math.dist(a, b) < 2.5 * radius + 1.0 for old in gone[:-1] for a in old for b in places):
                break
            gone.append(places)
            self.line(code + self.go(targets) + words + self.feed(needed=piece == 0))
        self.line("G40")
        code, targets, _, _ = self.contour_line(first, second)
        self.line(code + self.go(targets) + self.feed())
        self.settle()

    # -- lathe --

    def lathe_contour(self):
        # Diameters would turn the corners by another angle, and give the arcs decimals more.
        self.line("G8")
        self.settle_lathe()
        self.contour(self.random.choice(("", " L0", *(f" L{n}" for n in range(1, 10)))))

    def profile(self):
        """A subroutine of a profile that begins at Z 0, goes one way in Z, and ends across it."""
        x, z = self.between(2.0, 6.0), 0.0
        self.line(f"G0 X{x:.4f}")
        self.line("G1 Z0")
        for _ in range(self.random.randint(2, 7)):
            by_x, by_z = self.random.choice(((0.0, 1.0), (1.0, 0.0), (1.0, 1.0)))
            x, z = x + by_x * self.between(0.2, 3.0), z - by_z * self.between(0.5, 6.0)
            self.line(f"G1 X{x:.4f} Z{z:.4f}")
        self.line("G1 X30")

    def turning(self):
        if self.inch:
            return
        self.line("G8 G90 G40 G80")
        self.incremental = False
        self.label += 1
        self.line(f"O{self.label} sub")
        self.profile()
        self.line(f"O{self.label} endsub")
        self.line("G0 " + self.go({"X": 30.0, "Z": self.between(0.5, 4.0)}))
        allowance = self.random.choice(("0", f"{self.between(0.05, 0.6):.3f}"))
        if self.chance(0.25):
            words = f"G70 Q{self.label} D{allowance} E{float(allowance) / 3:.3f} P{self.random.randint(1, 3)}"
        else:
            words = f"{self.random.choice(('G71', 'G71.1', 'G71.2', 'G72', 'G72.1', 'G72.2'))} Q{self.label} D{allowance}"
            words += f" I{self.between(0.3, 3.0):.3f} R{self.between(0.1, 1.0):.3f}"
        self.line(words)
        self.settle_lathe()

    def lathe_mode(self):
        self.line(self.random.choice(("G7", "G8")))
        self.settle_lathe()

    def settle_lathe(self):
        self.line("G90")
        self.incremental = False
        self.line("G0 " + self.go({axis: self.between(1.0, 50.0) for axis in "XZ"}))

    def lathe_spindle(self):
        self.line(self.random.choice((f"G96 D{self.random.randint(500, 3000)} S{self.number(self.between(50, 300))}",
                                      f"G97 S{self.random.randint(100, 2000)}")))
        self.line(self.random.choice(("M3", "M4")))

    def lathe_tool(self):
        self.line(f"G43.1 X{self.number(self.between(-5, 5))} Z{self.number(self.between(-5, 5))}")
        self.settle_lathe()

    def lathe_straight(self):
        self.line(f"{self.random.choice(('G0', 'G1', 'G1'))} " + self.go({a: self.between(1.0, 40.0) for a in "XZ"})
                  + self.feed())

    def lathe_thread(self):
        self.line(f"G33 Z{self.number(self.between(-30.0, 30.0))} K{self.number(self.between(0.2, 3.0))}")
        self.settle_lathe()

    def lathe_cycle(self):
        self.line("G90")
        self.incremental = False
        self.line("G8")
        self.line("G0 " + self.go({"X": self.between(25.0, 30.0), "Z": self.between(5.0, 10.0)}))
        words = [f"P{self.number(self.between(0.5, 3.0))}", f"Z{self.number(self.between(-30.0, -5.0))}",
                 f"I{self.number(self.between(-6.0, -1.0))}", f"J{self.number(self.between(0.1, 0.8))}",
                 f"K{self.number(self.between(1.0, 4.0))}"]
        words += [word for word in (f"R{self.number(self.between(1.0, 2.0))}", f"Q{self.number(self.between(0.0, 30.0))}",
                                    f"H{self.random.randint(0, 3)}") if self.chance(0.5)]
        if self.chance(0.3):
            words.append(f"E{self.number(self.between(0.1, 2.0))} L{self.random.randint(0, 3)}")
        self.line("G76 " + " ".join(words))
        self.settle_lathe()

    # -- the whole --

    def mill(self):
        self.line(self.random.choice(("G21", "G20")) + " G17 G90 G94 F500 S1000 M3")
        self.settle()
        makers = [self.straight] * 8 + [self.arc] * 8 + [self.modes] * 2 + [
            self.distance, self.centre, self.choose_plane, self.choose_feed_mode, self.system, self.offset, self.cycle,
            self.machine, self.reference, self.contour, lambda: self.block_of("plain"), lambda: self.block_of("polar")]
        for _ in range(self.random.randint(5, 40)):
            self.random.choice(makers)()

    def lathe(self):
        self.plane = "G18"
        self.inch = self.chance(0.5)
        self.line(("G20" if self.inch else "G21") + " G18 G90 G94 F200 S800 M3")
        self.settle_lathe()
        makers = [self.lathe_straight] * 6 + [self.modes] + [
            self.distance, self.centre, self.choose_feed_mode, self.lathe_mode, self.lathe_spindle, self.lathe_tool,
            self.lathe_thread, self.lathe_cycle, self.lathe_contour, self.turning]
        for _ in range(self.random.randint(5, 40)):
            self.random.choice(makers)()


def program(seed, *, has_clearance=False):
    """The text of one program; every third is for a lathe. Pecks have a D where LinuxCNC knows it."""
    writer = Writer(seed, has_clearance=has_clearance)
    if seed % 3 == 2:
        writer.lathe()
    else:
        writer.mill()
    return "\n".join(writer.lines + ["M2", ""])
