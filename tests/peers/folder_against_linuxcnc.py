#!/usr/bin/python3
"""Compares `takt canon` with LinuxCNC's interpreter on every program below a folder, such as nc_files of LinuxCNC.

    folder_against_linuxcnc.py TAKT FOLDER [PATTERN]

those whose path has the regular expression PATTERN. A program is read in its own folder, with the tool table (*.tbl) and the
configuration (*.ini) that lie beside it: its subroutines, for LinuxCNC all of it, for takt what it says in [VARS]. What LinuxCNC
refuses does not count. Each that differs is told, then how many are equal, and how many of those that move.

PYTHONPATH chooses the module gcode of another LinuxCNC than the one that is installed. Exit status: 0 all agree, 1 something
differs, 77 the module is not installed.
"""
import glob
import importlib.util
import os
import re
import sys
import tempfile

import canon_against_linuxcnc as canon
import linuxcnc
import random_against_linuxcnc

# LinuxCNC's programs ask for tools that only its simulated machines have.
TABLE = "".join(f"T{number} P{number} Z0\n" for number in range(1, linuxcnc.TOOLS + 1))


def beside(program, ending):
    """The first file of this ending in its folder, or None."""
    return next(iter(sorted(glob.glob(os.path.join(glob.escape(os.path.dirname(program)), "*" + ending)))), None)


def machine_file(folder, configuration):
    """A wide machine, which answers what programs ask of LinuxCNC's configuration."""
    values = re.search(r"(?ms)^\[VARS\]\n(.*?)(?=^\[|\Z)", configuration)
    lines = re.findall(r"(?m)^(\w+) *= *([-+.\d]+) *$", values[1] if values else "")
    path = os.path.join(folder, "wide.ini")
    with open(path, "w") as file:
        file.write(random_against_linuxcnc.MACHINE + "[values]\n")
        file.writelines(f"_ini[vars]{name.lower()} = {value}\n" for name, value in lines)
    return path


def compare(takt, program, folder):
    """Whether it moves and what differs, None: nothing. Raises linuxcnc.Refused."""
    configuration, table = beside(program, ".ini"), beside(program, ".tbl")
    text = ""
    os.environ.pop("INI_FILE_NAME", None)
    if configuration:
        os.environ["INI_FILE_NAME"] = configuration
        with open(configuration) as file:
            text = file.read()
    subroutines = re.search(r"(?m)^SUBROUTINE_PATH *= *(\S+)", text)
    os.chdir(os.path.dirname(program))
    table = table or os.path.join(folder, "tool.tbl")
    theirs = canon.with_length(linuxcnc.moves(program, {"six_axes": True, "tools": table}))
    options = ("--machine", machine_file(folder, text), "--tools", table, "--dialect", "linuxcnc",
               "--subroutines", subroutines[1] if subroutines else ".")
    try:
        ours = canon.with_length(canon.takt_moves(takt, program, options))
    except canon.Refused as refusal:
        return bool(theirs), f"{program}: takt: {refusal}"
    return bool(theirs), canon.compare_moves(program, ours, theirs)[0]


def main(takt, folder, pattern=""):
    if importlib.util.find_spec("gcode") is None:
        print("LinuxCNC's module gcode is not installed")
        return canon.SKIPPED
    programs = sorted(glob.glob(os.path.join(glob.escape(os.path.abspath(folder)), "**", "*.ngc"), recursive=True))
    takt, found = os.path.abspath(takt), []
    with tempfile.TemporaryDirectory() as work:
        with open(os.path.join(work, "tool.tbl"), "w") as file:
            file.write(TABLE)
        for program in programs:
            try:
                found += [compare(takt, program, work)] if re.search(pattern, program) else []
            except linuxcnc.Refused:
                continue
            if found and found[-1][1]:
                print(found[-1][1], flush=True)
    equal = [moves for moves, what in found if what is None]
    print(f"{len(found)} programs that LinuxCNC takes, {len(equal)} equal; of {sum(moves for moves, _ in found)} that move {sum(equal)}")
    return 0 if len(equal) == len(found) else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
