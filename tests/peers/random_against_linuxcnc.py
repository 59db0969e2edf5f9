#!/usr/bin/python3
"""Random part programs: what takt and LinuxCNC both take they read the same way, and takt takes what LinuxCNC takes.

    random_against_linuxcnc.py TAKT [NUMBER [FIRST]]

so many programs (random_programs.py), the first of this seed. One that differs is printed, and stands in the folder as
SEED.ngc. Exit status: 0 all agree, 1 something differs, 77 LinuxCNC's module is not installed.
"""
import importlib.util
import os
import sys

import canon_against_linuxcnc as canon
import linuxcnc
import random_programs

NUMBER = 60
MACHINE = """[machine]
name = wide
cycle_us = 2000
resolution_per_mm = 100
[spindle]
max_rpm = 0
encoder_counts_per_revolution = 4000
""" + "".join(f"[axis {axis}]\ntravel_min_{unit} = -20000\ntravel_max_{unit} = 20000\n"
              for axes, unit in (("XYZ", "mm"), ("ABC", "deg")) for axis in axes)


def knows_clearance():
    """Does this LinuxCNC know D of G83? Since 2.10."""
    with open("clearance.ngc", "w") as file:
        file.write("G0 Z1\nG83 X1 Z-1 R1 Q0.5 D0.1 F100\nM2\n")
    try:
        return bool(linuxcnc.moves("clearance.ngc"))
    except linuxcnc.Refused:
        return False


def compare(takt, seed, *, has_clearance):
    """None: they agree; "": LinuxCNC refuses it; else what differs."""
    path = f"{seed}.ngc"
    with open(path, "w") as file:
        file.write(random_programs.program(seed, has_clearance=has_clearance))
    try:
        theirs = canon.with_length(linuxcnc.moves(path, {"six_axes": True}))
    except linuxcnc.Refused:
        os.remove(path)
        return ""
    try:
        ours = canon.with_length(canon.takt_moves(takt, path, ("--machine", "wide.ini")))
    except canon.Refused as refusal:
        return f"{path}: takt: {refusal}"
    what, _ = canon.compare_moves(path, ours, theirs)
    if what is None:
        os.remove(path)
    return what


def main(takt, number=NUMBER, first=1):
    if importlib.util.find_spec("gcode") is None:
        print("LinuxCNC's module gcode is not installed")
        return canon.SKIPPED
    with open("wide.ini", "w") as file:
        file.write(MACHINE)
    has_clearance = knows_clearance()
    verdicts = [compare(os.path.abspath(takt), seed, has_clearance=has_clearance) for seed in range(first, first + number)]
    wrong = [verdict for verdict in verdicts if verdict]
    print("\n".join(wrong))
    print(f"{number} programs: LinuxCNC takes {sum(v != '' for v in verdicts)}, of those {len(wrong)} differ")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], *map(int, sys.argv[2:])))
