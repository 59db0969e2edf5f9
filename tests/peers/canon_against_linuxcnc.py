#!/usr/bin/python3
"""Compares `takt canon` with LinuxCNC's own interpreter, move by move.

    canon_against_linuxcnc.py TAKT PROGRAM...

TAKT is the takt executable, with its built-in machine. LinuxCNC is asked through its Python module gcode (Debian
package linuxcnc-uspace), which hands over every canonical call as doubles, in inches and in work coordinates; the
offsets are added here. Moves without length are left out on both sides, since the two need not agree on them.

What must agree: the order and kind of the moves, their ends and the centres of arcs to 1e-6 mm, plane, direction
and turns of arcs, and feeds outside inverse time mode to 1e-6 of themselves.

Exit status: 0 all agree, 1 something differs, 77 LinuxCNC's module is not installed.
"""
import ctypes
import os
import re
import subprocess
import sys
import tempfile

SKIPPED = 77
MM_PER_INCH = 25.4
TOLERANCE_MM = 1e-6
# Tools LinuxCNC is told of, all without length, as an empty tool table is to takt.
TOOLS = 99
AXES = "XYZ"
INVERSE_TIME = 930
# LinuxCNC's number of a plane -> its axes in order, the axis across, and the word.
PLANES = {1: ((0, 1), 2, "G17"), 2: ((1, 2), 0, "G19"), 3: ((2, 0), 1, "G18")}


class Move:
    """One motion: kind, end in mm, feed in mm/min or None, and for arcs centre, plane and turns."""

    def __init__(self, line, kind, end, feed=None, centre=None, plane=None, turns=None):
        self.line = line
        self.kind = kind
        self.end = end
        self.feed = feed
        self.centre = centre
        self.plane = plane
        self.turns = turns

    def __str__(self):
        text = f"{self.kind} " + " ".join(f"{a}{v:.9f}" for a, v in zip(AXES, self.end))
        if self.centre:
            text += f" centre {self.centre[0]:.9f} {self.centre[1]:.9f} {self.plane} P{self.turns}"
        return text if self.feed is None else text + f" F{self.feed:.6f}"


class Canon:
    """The canonical calls of LinuxCNC, gathered as moves."""

    def __init__(self, parameter_file):
        self.parameter_file = parameter_file
        self.moves = []
        self.line = 0
        self.inverse_time = False
        self.plane = 1
        self.feed = None
        self.offsets = {"g5x": (0.0,) * 3, "g92": (0.0,) * 3, "tool": (0.0,) * 3}
        self.end = (0.0,) * 3

    def machine(self, axis, inches):
        return MM_PER_INCH * (inches + sum(offset[axis] for offset in self.offsets.values()))

    def add(self, kind, inches, **arc):
        feed = None if kind == "rapid" or self.inverse_time else self.feed
        end = tuple(self.machine(axis, value) for axis, value in enumerate(inches))
        self.moves.append(Move(self.line, kind, end, feed, **arc))

    def next_line(self, state):
        self.line = state.sequence_number
        self.inverse_time = state.feed_mode == INVERSE_TIME

    def straight_traverse(self, x, y, z, *_):
        self.add("rapid", (x, y, z))

    def straight_feed(self, x, y, z, *_):
        self.add("feed", (x, y, z))

    def arc_feed(self, first_end, second_end, first_centre, second_centre, turns, across_end, *_):
        (first, second), across, plane = PLANES[self.plane]
        end = [0.0] * 3
        end[first], end[second], end[across] = first_end, second_end, across_end
        centre = (self.machine(first, first_centre), self.machine(second, second_centre))
        kind = "arc_ccw" if turns > 0 else "arc_cw"
        self.add(kind, end, centre=centre, plane=plane, turns=abs(turns))

    def set_plane(self, plane):
        self.plane = plane

    def set_feed_rate(self, inches_per_minute):
        self.feed = inches_per_minute * MM_PER_INCH

    def set_g5x_offset(self, _, x, y, z, *__):
        self.offsets["g5x"] = (x, y, z)

    def set_g92_offset(self, x, y, z, *_):
        self.offsets["g92"] = (x, y, z)

    def tool_offset(self, x, y, z, *_):
        self.offsets["tool"] = (x, y, z)

    def get_tool(self, pocket):
        return (pocket,) + (0.0,) * 12 + (0,)

    def get_external_length_units(self):
        return 1.0

    def get_external_angular_units(self):
        return 1.0

    def get_axis_mask(self):
        return 7

    def get_block_delete(self):
        return 0

    def check_abort(self):
        return False

    def ignore(self, *_):
        pass

    set_xy_rotation = comment = message = dwell = change_tool = set_traverse_rate = ignore
    set_feed_mode = user_defined_function = ignore


def give_tools(folder):
    """LinuxCNC 2.9 keeps its tool table in a file mapped from the home folder, which its main program makes."""
    os.environ["HOME"] = folder
    table = os.path.join(folder, "tool.tbl")
    with open(table, "w") as text:
        for number in range(1, TOOLS + 1):
            text.write(f"T{number} P{number} Z0\n")
    library = ctypes.CDLL("libtooldata.so.0")
    library["_Z17tool_mmap_creatorPK13EMC_TOOL_STATi"](None, 0)
    library["_Z13tooldata_initb"](False)
    library["_Z13tooldata_loadPKcPPc"](table.encode(), None)


def linuxcnc_moves(gcode, program, folder):
    parameters = os.path.join(folder, "parameters.var")
    open(parameters, "w").close()
    canon = Canon(parameters)
    result, line = gcode.parse(program, canon, "G21", "G61")
    if result > gcode.MIN_ERROR:
        raise ValueError(f"LinuxCNC refuses line {line}: {gcode.strerror(result)}")
    return canon.moves


def takt_move(line, kind, words):
    value = {word[0]: float(word[1:]) for word in words if word[0] != "G"}
    end = tuple(value[axis] for axis in AXES)
    if not kind.startswith("arc"):
        return Move(line, kind, end, value.get("F"))
    plane = next(word for word in words if word[0] == "G")
    axes = next(axes for axes, _, name in PLANES.values() if name == plane)
    centre = tuple(value["IJK"[axis]] for axis in axes)
    return Move(line, kind, end, value["F"], centre, plane, int(value["P"]))


def takt_moves(takt, program):
    run = subprocess.run([takt, "canon", program], capture_output=True, text=True)
    if run.returncode != 0:
        raise ValueError(f"takt ends with status {run.returncode}: {run.stderr.strip()}")
    moves = []
    for text in run.stdout.splitlines():
        line, kind, *words = text.split()
        if re.fullmatch("rapid|feed|arc_cw|arc_ccw", kind):
            moves.append(takt_move(int(line), kind, words))
    return moves


def distance(a, b):
    return max(abs(x - y) for x, y in zip(a, b))


def with_length(moves):
    at = (0.0,) * 3
    kept = []
    for move in moves:
        if move.centre or distance(move.end, at) > TOLERANCE_MM:
            kept.append(move)
        at = move.end
    return kept


def difference(ours, theirs):
    """What differs between two moves, or None."""
    if (ours.kind, ours.plane, ours.turns) != (theirs.kind, theirs.plane, theirs.turns):
        return "kind"
    if distance(ours.end, theirs.end) > TOLERANCE_MM:
        return f"end by {distance(ours.end, theirs.end):.3g} mm"
    if ours.centre and distance(ours.centre, theirs.centre) > TOLERANCE_MM:
        return f"centre by {distance(ours.centre, theirs.centre):.3g} mm"
    if theirs.feed is not None and abs(ours.feed - theirs.feed) > 1e-6 * theirs.feed + 1e-6:
        return "feed"
    return None


def compare(gcode, takt, program, folder):
    """Prints the verdict on one program; True when all its moves agree."""
    try:
        ours = with_length(takt_moves(takt, program))
        theirs = with_length(linuxcnc_moves(gcode, program, folder))
    except ValueError as error:
        print(f"{program}: {error}")
        return False
    for our, their in zip(ours, theirs):
        what = difference(our, their)
        if what:
            print(f"{program}:{our.line}: {what}\n  takt     {our}\n  LinuxCNC {their} (line {their.line})")
            return False
    if len(ours) != len(theirs):
        print(f"{program}: {len(ours)} moves, LinuxCNC makes {len(theirs)}")
        return False
    print(f"{program}: {len(ours)} moves agree")
    return True


def compare_all(gcode, takt, programs):
    with tempfile.TemporaryDirectory() as folder:
        give_tools(folder)
        return all([compare(gcode, takt, program, folder) for program in programs])


def main(arguments):
    if len(arguments) < 2:
        print(__doc__)
        return 1
    try:
        import gcode
    except ImportError as error:
        print(f"LinuxCNC's Python module gcode is not installed: {error}")
        return SKIPPED
    return 0 if compare_all(gcode, arguments[0], arguments[1:]) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
