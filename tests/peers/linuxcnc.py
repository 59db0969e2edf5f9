"""What LinuxCNC's interpreter makes of a part program.

LinuxCNC is asked through its Python module gcode (Debian package linuxcnc-uspace), which hands over every canonical
call as doubles, in inches and in work coordinates; the offsets and the rotation are added here.
"""
import ctypes
import math
import multiprocessing
import os
import shutil
import tempfile

MM_PER_INCH = 25.4
AXES = "XYZABC"
LINEAR = 3
# Tools LinuxCNC is told of when there is no table: without length, as an empty tool table is to takt.
TOOLS = 99
# LinuxCNC's number of a plane -> its axes in order, the axis across, and the word.
PLANES = {1: ((0, 1), 2, "G17"), 2: ((1, 2), 0, "G19"), 3: ((2, 0), 1, "G18")}
UNITS_INCH = 200
# Number, nine offsets, diameter, two angles, orientation.
NO_TOOL = (0,) + (0.0,) * 12 + (0,)
# An endless program is given up after so many seconds.
PATIENCE_S = 120


class Refused(Exception):
    """The interpreter does not take the program; the line may be None."""

    def __init__(self, line, message):
        super().__init__(message)
        self.line = line
        self.message = message

    def __reduce__(self):
        return (Refused, (self.line, self.message))


class Move:
    """One motion: kind, end in mm and degrees, feed in mm/min (degrees/min if only A B C move) or None, and for arcs
    centre, plane and turns."""

    def __init__(self, line, kind, end, feed=None, centre=None, plane=None, turns=None):
        self.line = line
        self.kind = kind
        self.end = tuple(end)
        self.feed = feed
        self.centre = centre
        self.plane = plane
        self.turns = turns

    def words(self, axes=AXES):
        """As `takt canon` writes it, without its line."""
        text = self.kind + "".join(f" {a}{v + 0.0:.6f}" for a, v in zip(AXES, self.end) if a in axes)
        if self.centre:
            text += f" centre {self.centre[0] + 0.0:.6f} {self.centre[1] + 0.0:.6f} P{self.turns} {self.plane}"
        text = text if self.feed is None else text + f" F{self.feed:.6f}"
        return text.replace("-0.000000", "0.000000")


class Canon:
    """The canonical calls of LinuxCNC, gathered as moves."""

    def __init__(self, parameter_file, axes, tools, block_delete):
        self.parameter_file = parameter_file
        self.axes = axes
        self.tools = tools
        self.spindle = NO_TOOL
        self.block_delete = block_delete
        self.moves = []
        self.line = 0
        self.inches = False
        self.plane = 1
        self.feed = None
        self.feed_was_inches = False
        self.offsets = {"g5x": (0.0,) * 6, "g92": (0.0,) * 6, "tool": (0.0,) * 6}
        self.rotation = 0.0

    def machine(self, at):
        """Work coordinates in inches and degrees to machine coordinates in mm and degrees."""
        at = [a + b for a, b in zip(at, self.offsets["g92"])]
        if self.rotation != 0.0:
            sine, cosine = math.sin(self.rotation), math.cos(self.rotation)
            at[0], at[1] = at[0] * cosine - at[1] * sine, at[0] * sine + at[1] * cosine
        at = [a + b + c for a, b, c in zip(at, self.offsets["g5x"], self.offsets["tool"])]
        return [MM_PER_INCH * value for value in at[:LINEAR]] + at[LINEAR:]

    def feed_of(self, kind, end):
        """F counts along X Y Z, unless only A B C move; then the module's inches were none."""
        if kind == "rapid" or self.feed is None:
            return None
        last = self.moves[-1].end if self.moves else (0.0,) * 6
        moved = [abs(a - b) > 1e-9 for a, b in zip(end, last)]
        rotary_only = any(moved[LINEAR:]) and not any(moved[:LINEAR])
        return self.feed if rotary_only and self.feed_was_inches else self.feed * MM_PER_INCH

    def add(self, kind, at, **arc):
        end = self.machine(at)
        self.moves.append(Move(self.line, kind, end, self.feed_of(kind, end), **arc))

    def next_line(self, state):
        self.line = state.sequence_number
        self.inches = state.units == UNITS_INCH

    def straight_traverse(self, *at):
        self.add("rapid", at[:6])

    def straight_feed(self, *at):
        self.add("feed", at[:6])

    def straight_probe(self, *at):
        self.add("probe", at[:6])

    def rigid_tap(self, x, y, z, *_):
        last = self.moves[-1].end if self.moves else (0.0,) * 6
        self.add("tap", (x, y, z) + last[LINEAR:])

    def arc_feed(self, first_end, second_end, first_centre, second_centre, turns, across_end, *rotary):
        (first, second), across, plane = PLANES[self.plane]
        end = [0.0] * LINEAR + list(rotary[:3])
        end[first], end[second], end[across] = first_end, second_end, across_end
        centre = [0.0] * LINEAR + list(rotary[:3])
        centre[first], centre[second], centre[across] = first_centre, second_centre, across_end
        centre = self.machine(centre)
        kind = "arc_ccw" if turns > 0 else "arc_cw"
        self.add(kind, end, centre=(centre[first], centre[second]), plane=plane, turns=abs(turns))

    def set_plane(self, plane):
        self.plane = plane

    def set_feed_rate(self, inches_per_minute):
        self.feed = inches_per_minute
        self.feed_was_inches = self.inches

    def set_g5x_offset(self, _, *offset):
        self.offsets["g5x"] = offset[:6]

    def set_g92_offset(self, *offset):
        self.offsets["g92"] = offset[:6]

    def tool_offset(self, *offset):
        self.offsets["tool"] = offset[:6]

    def set_xy_rotation(self, degrees):
        self.rotation = math.radians(degrees)

    def change_tool(self, place):
        self.spindle = self.tools[place] if 0 < place < len(self.tools) else NO_TOOL

    def get_tool(self, place):
        """Place 0 is the spindle; the others are those of the table."""
        if place == 0:
            return self.spindle
        return self.tools[place] if place < len(self.tools) else NO_TOOL

    def get_external_length_units(self):
        return 1.0

    def get_external_angular_units(self):
        return 1.0

    def get_axis_mask(self):
        return self.axes

    def get_block_delete(self):
        return int(self.block_delete)

    def check_abort(self):
        return False

    def ignore(self, *_):
        pass

    comment = message = dwell = set_traverse_rate = ignore
    set_feed_mode = user_defined_function = ignore


def read_tools(path):
    """The table as LinuxCNC counts it, from 1 in the order of the file, place 0 left out; and the file's text."""
    text = "".join(f"T{number} P{number} Z0\n" for number in range(1, TOOLS + 1))
    if path is not None:
        with open(path) as file:
            text = file.read()
    tools = [NO_TOOL]
    for line in text.splitlines():
        words = {word[0].upper(): float(word[1:]) for word in line.split(";")[0].split()}
        if "T" in words:
            offset = tuple(words.get(axis, 0.0) for axis in AXES + "UVW")
            angles = (words.get("I", 0.0), words.get("J", 0.0))
            tools.append((int(words["T"]),) + offset + (words.get("D", 0.0),) + angles + (int(words.get("Q", 0)),))
    return tools, text


def give_tools(folder, text):
    """LinuxCNC keeps its tool table in a file mapped from the home folder, which its main program makes."""
    os.environ["HOME"] = folder
    table = os.path.join(folder, "tool.tbl")
    with open(table, "w") as file:
        file.write(text)
    library = ctypes.CDLL("libtooldata.so.0")

    def function(plain, mangled):
        """2.10 has names of C."""
        return library[plain if hasattr(library, plain) else mangled]

    function("tool_mmap_creator", "_Z17tool_mmap_creatorPK13EMC_TOOL_STATi")(None, 0)
    function("tooldata_init", "_Z13tooldata_initb")(False)
    function("tooldata_load", "_Z13tooldata_loadPKcPPc")(table.encode(), None)


def ask(program, options, folder):
    import gcode

    tools, table = read_tools(options.get("tools"))
    give_tools(folder, table)
    parameters = os.path.join(folder, "parameters.var")
    if "parameters" in options:
        shutil.copy(options["parameters"], parameters)
    else:
        open(parameters, "w").close()
    canon = Canon(parameters, 63 if options.get("six_axes") else 7, tools, options.get("block_delete", False))
    # G94 also names the spindle, which LinuxCNC leaves undefined otherwise: its threads then crash.
    result, line = gcode.parse(program, canon, "G21", "G61 G94 F0")
    if result > gcode.MIN_ERROR:
        raise Refused(line, gcode.strerror(result))
    return canon.moves


def answer(pipe, program, options, folder):
    # What the interpreter says itself would only stand in the way of the verdicts.
    quiet = os.open(os.devnull, os.O_WRONLY)
    os.dup2(quiet, 1)
    os.dup2(quiet, 2)
    try:
        pipe.send(ask(program, options, folder))
    except Refused as refusal:
        pipe.send(refusal)


def moves(program, options=None):
    """LinuxCNC's moves; raises Refused. In a process of its own: the interpreter keeps its state, and may crash.

    options: tools and parameters (files), six_axes, block_delete.
    """
    ours, theirs = multiprocessing.Pipe(duplex=False)
    with tempfile.TemporaryDirectory() as folder:
        process = multiprocessing.Process(target=answer, args=(theirs, program, options or {}, folder))
        process.start()
        theirs.close()
        try:
            if not ours.poll(PATIENCE_S):
                raise Refused(None, f"does not end within {PATIENCE_S} s")
            result = ours.recv()
        except EOFError:
            result = Refused(None, "crashes")
        finally:
            process.kill()
            process.join()
    if isinstance(result, Refused):
        raise result
    return result
