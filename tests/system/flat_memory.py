"""`takt check` and `takt canon` take the same memory for a file of any length; from standard input the text is kept."""

import os
import subprocess

import takt_test as t

# With few lines the sanitizers have not touched all of the stacks yet that they give to frames.
LINES_FEW, LINES_MANY = 20000, 200000
GROWTH_MAX_KIB = 1024
COMMENT = "(" + "long lines make a long text of moves that are soon planned; " * 2 + ")"


def program(lines):
    path = f"part{lines}.ngc"
    with open(path, "w") as file:
        file.writelines(f"G1 X{i * 0.002:.3f} F6000 {COMMENT}\n" for i in range(lines))
        file.write("M2\n")
    return path


def resident_kib(*arguments):
    """The most a run of takt had in memory, or what this script has, whose copy it begins as: less than the long text."""
    process = subprocess.Popen([t.TAKT, *arguments], stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    t.check(process.returncode == 0, " ".join(arguments) + " is read", process.returncode)
    return usage.ru_maxrss


few, many = program(LINES_FEW), program(LINES_MANY)
size_kib = os.path.getsize(many) / 1024
# The sanitizers and the system add pages now and then: the least of a few runs is what the command needs.
TRIES = 4

for command in ("check", "canon"):
    least = min(resident_kib(command, few) for _ in range(TRIES))
    most = min(resident_kib(command, many) for _ in range(TRIES))
    t.check(most - least <= GROWTH_MAX_KIB, f"{command}: memory does not grow by {size_kib:.0f} KiB of text", least, most)

t.finish()
