#!/usr/bin/python3
"""Compares what happens between the moves with LinuxCNC: spindle, coolant, tools, dwells, stops and outputs.

    events_against_linuxcnc.py TAKT

LinuxCNC is asked through its program rs274, which prints every canonical call; of the goldens those are taken that
both must read the same way. A row of moves counts as one; canon_against_linuxcnc.py compares the moves themselves.
What must agree is the order of moves and events, and with each the state of spindle and coolant. Not compared: inputs, which
rs274 does not print, and the way the spindle turns to an angle, which it prints in two meanings.

Exit status: 0 all agree, 1 something differs, 77 rs274 is not installed.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

import canon_against_linuxcnc as canon
import linuxcnc

SKIPPED = 77
# What LinuxCNC takes for the highest speed when none is given.
NO_MAXIMUM = 1e20
CALL = re.compile(r"^ *\d+ +N\S* +([A-Z_0-9]+)\((.*)\)$")
MOVES = {"STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "ARC_FEED", "STRAIGHT_PROBE", "RIGID_TAP"}
TURNS = {"START_SPINDLE_CLOCKWISE": "cw", "START_SPINDLE_COUNTERCLOCKWISE": "ccw", "STOP_SPINDLE_TURNING": "off"}
COOLANT = {"MIST_ON": ("mist", True), "MIST_OFF": ("mist", False), "FLOOD_ON": ("flood", True),
           "FLOOD_OFF": ("flood", False)}
STOPS = {"PROGRAM_STOP": "stop", "OPTIONAL_PROGRAM_STOP": "optional stop", "PROGRAM_END": "end"}
OUTPUTS = {"SET_AUX_OUTPUT_BIT": ("output", 1), "CLEAR_AUX_OUTPUT_BIT": ("output", 0),
           "SET_MOTION_OUTPUT_BIT": ("output with motion", 1), "CLEAR_MOTION_OUTPUT_BIT": ("output with motion", 0)}
VALUES = {"SET_AUX_OUTPUT_VALUE": "analogue output", "SET_MOTION_OUTPUT_VALUE": "analogue output with motion"}


def numbers(text):
    return [float(number) for number in re.findall(r"-?\d+(?:\.\d+)?", text)]


def rounded(value):
    """Four decimals, as rs274 prints them."""
    return f"{float(value) + 0.0:.4f}"


class Story:
    """What happens, in order, each with the state of spindle and coolant."""

    def __init__(self):
        self.steps = []
        self.turning = "off"
        self.speed = 0.0
        self.surface_max = None  # of constant surface speed: the highest speed; 0: any
        self.mist = self.flood = False
        self.ended = False

    def add(self, what):
        if self.ended:
            return
        spindle = self.turning if self.turning == "off" else f"{self.turning} {rounded(self.speed)}"
        if self.surface_max is not None and self.turning != "off":
            spindle += f" m/min, at most {rounded(self.surface_max)}"
        coolant = " ".join(name for name in ("mist", "flood") if getattr(self, name))
        step = "end" if what == "end" else f"{what} [{spindle}; {coolant}]"
        if what != "moves" or not self.steps or self.steps[-1] != step:
            self.steps.append(step)
        self.ended = what == "end"


    def add_dwell(self, seconds):
        """LinuxCNC's cycles also wait for no time at all."""
        if seconds > 0.0:
            self.add("dwell " + rounded(seconds))


class LinuxcncStory(Story):
    def take(self, name, text):
        values = numbers(text)
        if name in MOVES:
            self.add("moves")
        elif name in TURNS:
            self.turning = TURNS[name]
        elif name == "SET_SPINDLE_SPEED":
            self.speed = values[1]
        elif name == "SET_SPINDLE_MODE":
            highest = 0.0 if values[1] >= NO_MAXIMUM else values[1]
            self.surface_max = highest if values[1] > 0.0 else None
        elif name in COOLANT:
            setattr(self, *COOLANT[name])
        elif name in STOPS:
            self.add(STOPS[name])
        else:
            self.take_event(name, values)

    def take_event(self, name, values):
        if name == "DWELL":
            self.add_dwell(values[0])
        elif name == "SELECT_TOOL":
            self.add("prepare")
        elif name == "CHANGE_TOOL":
            self.add("change")
        elif name == "CHANGE_TOOL_NUMBER":
            self.add("loaded")
        elif name == "ORIENT_SPINDLE":
            self.add(f"orient {rounded(values[1])}")
        elif name in OUTPUTS:
            what, state = OUTPUTS[name]
            self.add(f"{what} {values[0]:.0f} {state}")
        elif name in VALUES:
            self.add(f"{VALUES[name]} {values[0]:.0f} {rounded(values[1])}")


class TaktStory(Story):
    def take(self, kind, words):
        value = {word[0]: word[1:] for word in words}
        if re.fullmatch(canon.MOTIONS, kind):
            self.add("moves")
        elif kind.startswith("spindle_") and kind != "spindle_orient":
            self.turning = kind[len("spindle_"):]
            self.speed = float(value.get("V", value.get("S", 0.0)))
            self.surface_max = float(value.get("S", 0.0)) if "V" in value else None
        elif kind.startswith("coolant"):
            self.mist, self.flood = "mist" in kind, "flood" in kind
        elif kind in ("stop", "optional_stop", "end"):
            self.add(kind.replace("_", " "))
        else:
            self.take_event(kind, value)

    def take_event(self, kind, value):
        if kind == "dwell":
            self.add_dwell(float(value["P"]))
        elif kind.startswith("tool_"):
            self.add(kind[len("tool_"):])
        elif kind == "spindle_orient":
            self.add(f"orient {rounded(value['R'])}")
        elif kind.startswith("output"):
            what = kind.replace("_", " ")
            if "E" in value:
                self.add(f"analogue {what} {value['E']} {rounded(value['Q'])}")
            else:
                self.add(f"{what} {value['P']} {float(value['Q']):.0f}")


# M100 to M199 are programs of the user in LinuxCNC, and rs274 has none: takt's own switches of correction.
OF_THE_USER = ("M120", "M121")


def table_in_inches(path):
    """rs274 by itself counts in inches."""
    lines = []
    for number, *offset, diameter, front, back, orientation in linuxcnc.read_tools(path)[0][1:]:
        words = [f"{axis}{value / linuxcnc.MM_PER_INCH}" for axis, value in zip("XYZ", offset)]
        words += [f"{axis}{value}" for axis, value in zip("ABC", offset[3:6])]
        lines.append(f"T{number} P{number} D{diameter / linuxcnc.MM_PER_INCH} I{front} J{back} Q{orientation} "
                     + " ".join(words) + "\n")
    return "".join(lines)


def linuxcnc_story(golden):
    """None and the reason when rs274 does not read the program."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "tool.tbl")
        with open(path, "w") as file:
            file.write(table_in_inches(golden.option("--tools")))
        arguments = ["-t", path]
        if golden.option("--parameters"):
            shutil.copy(golden.option("--parameters"), os.path.join(folder, "start.var"))
            arguments += ["-v", os.path.join(folder, "start.var")]
        if "--block-delete" in golden.options:
            arguments.append("-b")
        run = subprocess.run(["rs274", *arguments, "-g", golden.path], cwd=folder, capture_output=True, text=True,
                             stdin=subprocess.DEVNULL, errors="replace", timeout=linuxcnc.PATIENCE_S)
    story = LinuxcncStory()
    for line in run.stdout.splitlines():
        call = CALL.match(line)
        if call:
            story.take(*call.groups())
    refusal = run.stderr.replace("executing", "").strip()
    if refusal:
        return None, refusal.splitlines()[0]
    story.add("end")
    return story.steps, None


def takt_story(takt, golden):
    run = subprocess.run([takt, "canon", golden.name + ".ngc", *golden.options], cwd=canon.GOLDENS,
                         capture_output=True, text=True, check=True)
    story = TaktStory()
    for text in run.stdout.splitlines():
        _, kind, *words = text.split()
        story.take(kind, words)
    return story.steps


def compare(takt, golden, totals):
    theirs, reason = linuxcnc_story(golden)
    if theirs is None and any(reason.endswith(code) for code in OF_THE_USER):
        totals["with codes that LinuxCNC leaves to its user"] += 1
        return True
    if theirs is None:
        print(f"{golden.name}: rs274 does not read it: {reason}")
        totals["not read by rs274"] += 1
        return False
    ours = takt_story(takt, golden)
    totals["with the same events"] += ours == theirs
    for our, their in zip(ours, theirs):
        if our != their:
            print(f"{golden.name}:\n  takt     {our}\n  LinuxCNC {their}")
            return False
    if len(ours) != len(theirs):
        longer = ours if len(ours) > len(theirs) else theirs
        print(f"{golden.name}: {'takt' if longer is ours else 'LinuxCNC'} goes on: {longer[min(len(ours), len(theirs))]}")
    return len(ours) == len(theirs)


def main(arguments):
    if len(arguments) != 1:
        print(__doc__)
        return 1
    if shutil.which("rs274") is None:
        print("rs274 is not installed (Debian: linuxcnc-uspace)")
        return SKIPPED
    goldens = [golden for golden in canon.all_goldens() if not golden.is_error and not golden.read("linuxcnc")]
    totals = {"with the same events": 0, "with codes that LinuxCNC leaves to its user": 0, "not read by rs274": 0}
    good = all([compare(arguments[0], golden, totals) for golden in goldens])
    print(f"{len(goldens)} goldens: " + ", ".join(f"{count} {what}" for what, count in totals.items()))
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
