#!/usr/bin/python3
"""Compares `takt canon` with LinuxCNC's own interpreter, move by move.

    canon_against_linuxcnc.py TAKT PROGRAM...     programs both must read the same way
    canon_against_linuxcnc.py TAKT --goldens      the goldens of this repository
    canon_against_linuxcnc.py --show PROGRAM...   what LinuxCNC makes of them, as NAME.linuxcnc has it

What must agree: the order and kind of the moves, their ends and the centres of arcs to 1e-6 mm or degrees, plane,
direction and turns of arcs, and feeds to 1e-6 of themselves. LinuxCNC makes lines of a spline, from point to point of it:
each of those must lie on ours. Moves without length are left out on both sides, since
the two need not agree on them.

A golden is a NAME.canon, which must agree, or a NAME.error, which LinuxCNC must refuse on the same line. Where takt
differs on purpose, NAME.linuxcnc says what LinuxCNC does; that must be so, and must be another thing than what takt
does, and a table of differences, in firmware/program/README.md or firmware/cutter_compensation/README.md, must name NAME. Nor may
the tables name anything else.

Exit status: 0 all agree, 1 something differs, 77 LinuxCNC's module is not installed.
"""
import glob
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile

import linuxcnc

SKIPPED = 77
SOURCE = os.environ.get("TAKT_SOURCE") or os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
GOLDENS = os.path.join(SOURCE, "tests", "golden")
DIFFERENCES = [os.path.join(SOURCE, "firmware", room, "README.md") for room in ("program", "cutter_compensation")]
DIFFERENCES_TITLE = "## Where it differs from LinuxCNC"
TOLERANCE_MM = 1e-6
TOLERANCE_FEED = 1e-6
# The canon has six decimals.
TOLERANCE_SPLINE_MM = 2e-6
MOTIONS = "rapid|feed|spline|arc_cw|arc_ccw|thread|tap|probe"
# What LinuxCNC's module makes of a thread is a feed, without saying that it follows the spindle.
KINDS = {"thread": "feed"}


class Refused(Exception):
    """takt does not take the program."""


def takt_move(line, kind, words):
    value = {word[0]: word[1:] for word in words if word[0] != "G"}
    end = [float(value.get(axis, 0.0)) for axis in linuxcnc.AXES]
    feed = value.get("F", "rev")
    feed = None if feed.endswith("rev") or kind in ("thread", "tap", "probe") else float(feed)
    kind = KINDS.get(kind, kind)
    if not kind.startswith("arc") and kind != "spline":
        return linuxcnc.Move(line, kind, end, feed)
    plane = next(word for word in words if word[0] == "G")
    if kind == "spline":
        return linuxcnc.Move(line, kind, end, feed, None, plane, [float(value[word]) for word in "IJPQR"])
    axes = next(axes for axes, _, name in linuxcnc.PLANES.values() if name == plane)
    centre = tuple(float(value["IJK"[axis]]) for axis in axes)
    return linuxcnc.Move(line, kind, end, feed, centre, plane, int(value["P"]))


def takt_moves(takt, program, options=()):
    run = subprocess.run([takt, "canon", program, *options], capture_output=True, text=True, errors="replace")
    if run.returncode != 0:
        errors = [line for line in run.stderr.splitlines() if ": error: " in line]
        raise Refused(errors[0] if errors else run.stderr.strip())
    moves = []
    for text in run.stdout.splitlines():
        line, kind, *words = text.split()
        if re.fullmatch(MOTIONS, kind):
            moves.append(takt_move(int(line), kind, words))
    return moves


def distance(a, b):
    return max(abs(x - y) for x, y in zip(a, b))


def with_length(moves):
    at = (0.0,) * len(linuxcnc.AXES)
    kept = []
    for move in moves:
        if move.centre or distance(move.end, at) > TOLERANCE_MM:
            kept.append(move)
        at = move.end
    return kept


class Largest:
    """The largest differences found on the way."""

    def __init__(self):
        self.end = self.centre = self.feed = 0.0

    def __str__(self):
        return f"{self.end:8.1e} {self.centre:8.1e} {self.feed:8.1e}"


def difference(ours, theirs, largest):
    """What differs between two moves, or None."""
    if (ours.kind, ours.plane, ours.turns) != (theirs.kind, theirs.plane, theirs.turns):
        return "kind"
    end = distance(ours.end, theirs.end)
    largest.end = max(largest.end, end)
    if end > TOLERANCE_MM:
        return f"end by {end:.3g} mm"
    if ours.centre:
        centre = distance(ours.centre, theirs.centre)
        largest.centre = max(largest.centre, centre)
        if centre > TOLERANCE_MM:
            return f"centre by {centre:.3g} mm"
    if ours.feed is not None and theirs.feed is not None:
        feed = abs(ours.feed - theirs.feed)
        largest.feed = max(largest.feed, feed)
        if feed > TOLERANCE_FEED * (theirs.feed + 1.0):
            return f"feed by {feed:.3g}"
    return None


class Piece:
    """A piece of a spline: the polynomial of firmware/geometry/quintic.c, from its course."""

    def __init__(self, start, move):
        self.axes = next(axes for axes, _, name in linuxcnc.PLANES.values() if name == move.plane)
        heading, curvature, self.length = move.turns[0:2], move.turns[2:4], move.turns[4]
        self.start, self.terms = start, []
        for i, axis in enumerate(self.axes):
            way = move.end[axis] - start[axis]
            angle = [math.radians(h) for h in heading]
            t = [self.length * (math.cos(a), math.sin(a))[i] for a in angle]
            b = [self.length**2 / 2 * k * (-math.sin(a), math.cos(a))[i] for a, k in zip(angle, curvature)]
            self.terms.append((start[axis], t[0], b[0], 10 * way - 6 * t[0] - 4 * t[1] - 3 * b[0] + b[1],
                               -15 * way + 8 * t[0] + 7 * t[1] + 3 * b[0] - 2 * b[1],
                               6 * way - 3 * t[0] - 3 * t[1] - b[0] + b[1]))

    def off(self, point, u):
        at = list(self.start)
        for axis, terms in zip(self.axes, self.terms):
            at[axis] = sum(c * u**n for n, c in enumerate(terms))
        return math.dist(at, point)

    def distance(self, point):
        low, high = 0.0, 1.0
        for _ in range(60):
            third = (high - low) / 3
            if self.off(point, low + third) < self.off(point, high - third):
                high -= third
            else:
                low += third
        return min(self.off(point, u) for u in (0.0, (low + high) / 2, 1.0))


def is_near(piece, point):
    """Can the piece come so near? It is no farther from its start than its length."""
    return piece.off(point, 0.0) <= piece.length + 1e-3


def along(pieces, at, point):
    """The piece that the point is on, looked for from one on, where the point before it was; None: it is on none."""
    for i in range(len(pieces)):
        piece = pieces[(at + i) % len(pieces)]
        if is_near(piece, point) and piece.distance(point) <= TOLERANCE_SPLINE_MM:
            return (at + i) % len(pieces)
    return None


def without_splines(ours, theirs):
    """Both lists with a run of pieces, and their lines along it, as one feed to its end; or what is off the curve."""
    mine, yours, at, k = [], [], (0.0,) * len(linuxcnc.AXES), 0
    for i, move in enumerate(ours):
        if move.kind != "spline":
            mine.append(move)
            yours += theirs[k:k + 1]
            k += 1
            at = move.end
            continue
        if i == 0 or ours[i - 1].kind != "spline":
            pieces = []
        pieces.append(Piece(at, move))
        at = move.end
        if i + 1 < len(ours) and ours[i + 1].kind == "spline":
            continue
        on = 0
        while k < len(theirs) and theirs[k].kind == "feed":
            on = along(pieces, on, theirs[k].end)
            if on is None:
                break
            k += 1
        if k == 0 or distance(theirs[k - 1].end, at) > TOLERANCE_SPLINE_MM:
            return None, None, f"line {move.line}: LinuxCNC's spline leaves ours behind its line {k}"
    return mine, yours + theirs[k:], None


def compare_moves(program, ours, theirs):
    """The verdict on two lists of moves: None, or what differs; and the largest differences."""
    largest = Largest()
    ours, theirs, off = without_splines(ours, theirs)
    if off:
        return f"{program}: {off}", largest
    for our, their in zip(ours, theirs):
        what = difference(our, their, largest)
        if what:
            axes = linuxcnc.AXES
            text = f"{program}:{our.line}: {what}\n  takt     {our.words(axes)}"
            return text + f"\n  LinuxCNC {their.words(axes)} (line {their.line})", largest
    if len(ours) != len(theirs):
        return f"{program}: {len(ours)} moves, LinuxCNC makes {len(theirs)}", largest
    return None, largest


def counts(moves):
    kinds = [move.kind for move in moves]
    arcs = sum(kind.startswith("arc") for kind in kinds)
    others = sum(kind in ("tap", "probe") for kind in kinds)
    return f"{len(moves):6} {kinds.count('rapid'):6} {kinds.count('feed'):6} {arcs:6} {others:6}"


HEADING = f"{'moves':>6} {'rapid':>6} {'feed':>6} {'arcs':>6} {'other':>6}   end mm   centre     feed"


def compare_program(takt, program, name):
    """A program both must read the same way."""
    try:
        ours = with_length(takt_moves(takt, program))
        theirs = with_length(linuxcnc.moves(program))
    except (Refused, linuxcnc.Refused) as refusal:
        who = "takt" if isinstance(refusal, Refused) else f"LinuxCNC, line {refusal.line}"
        print(f"{name}: {who}: {refusal}")
        return False
    what, largest = compare_moves(program, ours, theirs)
    print(what or f"{counts(ours)} {largest}  {name}")
    return what is None


def compare_programs(takt, programs):
    """All of them; and a table of what was compared."""
    common = os.path.commonpath([os.path.dirname(program) for program in programs])
    print(f"{HEADING}  of {len(programs)} programs")
    return all([compare_program(takt, program, os.path.relpath(program, common)) for program in programs])


class Golden:
    """One program of tests/golden with what belongs to it."""

    def __init__(self, path):
        self.path = path
        self.name = os.path.basename(path)[: -len(".ngc")]
        self.is_error = os.path.exists(self.file("error"))
        self.options = self.read("options").split()

    def file(self, kind):
        return os.path.join(GOLDENS, f"{self.name}.{kind}")

    def read(self, kind):
        if not os.path.exists(self.file(kind)):
            return ""
        with open(self.file(kind)) as file:
            return file.read()

    def option(self, name):
        """The file an option names, or None."""
        return os.path.join(GOLDENS, self.options[self.options.index(name) + 1]) if name in self.options else None

    def theirs(self):
        """LinuxCNC's answer: moves, or the refusal."""
        options = {"six_axes": "mill6.ini" in self.options, "block_delete": "--block-delete" in self.options}
        for key in ("tools", "parameters"):
            if f"--{key}" in self.options:
                options[key] = self.option(f"--{key}")
        with tempfile.TemporaryDirectory() as folder:
            try:
                return with_length(linuxcnc.moves(self.with_end(folder), options))
            except linuxcnc.Refused as refusal:
                return refusal

    def with_end(self, folder):
        """LinuxCNC refuses a program without end. One that is to be refused anyway gets one, so that it is for the
        reason in question."""
        if not self.is_error:
            return self.path
        path = os.path.join(folder, os.path.basename(self.path))
        shutil.copy(self.path, path)
        with open(path, "a") as file:
            file.write("\nM2\n")
        return path

    def ours(self, takt):
        folder = os.getcwd()
        os.chdir(GOLDENS)
        try:
            return with_length(takt_moves(takt, self.name + ".ngc", self.options))
        finally:
            os.chdir(folder)

    def axes(self):
        return linuxcnc.AXES if "mill6.ini" in self.options else "XYZ"


def as_text(theirs, axes):
    """LinuxCNC's answer as NAME.linuxcnc has it."""
    if isinstance(theirs, linuxcnc.Refused):
        # Some messages name the file by its whole path.
        message = re.sub(r"file:\S*/", "file:", theirs.message)
        return f"{theirs.line} refused: {message}\n"
    return "".join(f"{move.line} {move.words(axes)}\n" for move in theirs) or "no moves\n"


def judge(golden, theirs, takt):
    """What is wrong when takt and LinuxCNC ought to agree on a golden, or None."""
    if golden.is_error:
        line = int(golden.read("error").split(":")[0])
        if not isinstance(theirs, linuxcnc.Refused):
            return f"{golden.name}: refused by takt on line {line}, not by LinuxCNC"
        # An error that LinuxCNC finds while reading a line is said to be of the next one.
        if theirs.line not in (None, line, line + 1):
            return f"{golden.name}: refused by takt on line {line}, by LinuxCNC on {theirs.line}: {theirs}"
        return None
    if isinstance(theirs, linuxcnc.Refused):
        return f"{golden.name}: LinuxCNC refuses line {theirs.line}: {theirs}"
    try:
        return compare_moves(golden.name, golden.ours(takt), theirs)[0]
    except Refused as refusal:
        return f"{golden.name}: takt: {refusal}"


def check_golden(golden, takt, totals):
    theirs = golden.theirs()
    what = judge(golden, theirs, takt)
    expected = golden.read("linuxcnc")
    if not expected:
        if what:
            print(what)
            return False
        totals["refused by both" if golden.is_error else "with the same moves"] += 1
        return True
    found = as_text(theirs, golden.axes())
    if what is None:
        print(f"{golden.name}: no difference any more, but {golden.name}.linuxcnc exists")
    elif found != expected:
        print(f"{golden.name}.linuxcnc: found instead\n{found}", end="")
    totals["different on purpose"] += 1
    return what is not None and found == expected


def differences_listed(path):
    """Names in the last column of a table of differences, row by row."""
    with open(path) as file:
        section = file.read().partition(DIFFERENCES_TITLE)[2].partition("\n## ")[0]
    rows = [line for line in section.splitlines() if line.startswith("|")][2:]
    return [re.findall(r"`(\w+)`", row.rstrip("| ").rpartition("|")[2]) for row in rows]


def check_differences(goldens):
    """The tables and the .linuxcnc files name each other."""
    listed = set()
    good = True
    for path in DIFFERENCES:
        for number, names in enumerate(differences_listed(path), 1):
            listed.update(names)
            if not names:
                print(f"{path}: row {number} of the table of differences names no golden")
                good = False
    existing = {golden.name for golden in goldens if os.path.exists(golden.file("linuxcnc"))}
    for name in sorted(listed ^ existing):
        where = "has no .linuxcnc file" if name in listed else "is in no table of differences"
        print(f"{name} {where}")
        good = False
    return good


def all_goldens():
    return [Golden(path) for path in sorted(glob.glob(os.path.join(GOLDENS, "*.ngc")))]


def compare_goldens(takt):
    goldens = all_goldens()
    totals = {"with the same moves": 0, "refused by both": 0, "different on purpose": 0}
    good = all([check_golden(golden, takt, totals) for golden in goldens])
    print(f"{len(goldens)} goldens: " + ", ".join(f"{count} {what}" for what, count in totals.items()))
    return check_differences(goldens) and good


def show(programs):
    for program in programs:
        golden = Golden(os.path.abspath(program))
        print(as_text(golden.theirs(), golden.axes()), end="")
    return True


def main(arguments):
    if len(arguments) < 2:
        print(__doc__)
        return 1
    try:
        import gcode  # noqa: F401: loaded here once, used in the processes that are forked
    except ImportError as error:
        print(f"LinuxCNC's Python module gcode is not installed: {error}")
        return SKIPPED
    if arguments[0] == "--show":
        good = show(arguments[1:])
    elif arguments[1] == "--goldens":
        good = compare_goldens(arguments[0])
    else:
        good = compare_programs(arguments[0], arguments[1:])
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
