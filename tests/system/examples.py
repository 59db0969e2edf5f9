"""Every example program runs on every example machine, and the README's table is true."""

import os
import re

import takt_test as t

TOOLS = os.path.join(t.EXAMPLES, "tools.tbl")
MACHINES = [f for f in sorted(os.listdir(t.EXAMPLES)) if f.endswith(".ini")]
PROGRAMS = [f for f in sorted(os.listdir(t.EXAMPLES)) if f.endswith(".ngc")]


def summary_of(program, machine):
    options = "--tools", TOOLS, "--machine", os.path.join(t.EXAMPLES, machine)
    status, _, err = t.run("run", os.path.join(t.EXAMPLES, program), *options, "--json", "run.json", "--quiet")
    t.check(status == 0, f"{program} runs on {machine}", err)
    return t.load_json("run.json")


with open(os.path.join(t.EXAMPLES, "README.md")) as file:
    readme = file.read()
for program in PROGRAMS:
    lengths = {machine: summary_of(program, machine)["path_length_mm"] for machine in MACHINES}
    t.check(max(lengths.values()) - min(lengths.values()) < 1e-9, f"{program}: one path on all machines", lengths)
    summary = summary_of(program, "mill3.ini")
    row = re.search(rf"\[{program}\].*\| (\d+) \| ([\d.]+) \| ([\d.]+) \|", readme)
    if t.check(row, f"{program} is in the README"):
        found = summary["blocks"], f"{summary['path_length_mm']:.3f}", f"{summary['program_time_s']:.1f}"
        t.check(found == (int(row[1]), row[2], row[3]), f"{program}: the README's figures", found, row[0])

status, mill3, _ = t.run("machine", os.path.join(t.EXAMPLES, "mill3.ini"))
t.check(mill3 == t.run("machine")[1], "mill3.ini is the built-in machine")
t.finish()
