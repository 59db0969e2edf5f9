"""The programs of tests/programs give the figures of their README."""

import os

import takt_test as t
from judged_run import judged_run


def table():
    with open(os.path.join(t.OWN_PROGRAMS, "README.md")) as file:
        for line in file:
            cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
            if cells[0].endswith(".ngc"):
                yield cells[0], cells[2:]


def expect(name, what, found, text, tolerance):
    if text != "-":
        t.check(abs(found - float(text)) <= tolerance, f"{name}: {what} of the README", found, text)


named = []
for program, (moves, stops, path_mm, time_s) in table():
    named.append(program)
    summary = judged_run(os.path.join(t.OWN_PROGRAMS, program))
    plan = t.load_json("plan.json")
    expect(program, "moves", summary["blocks"], moves, 0)
    expect(program, "stops", plan["totals"]["stops"], stops, 0)
    expect(program, "path", summary["path_length_mm"], path_mm, 0.6e-6)
    expect(program, "time", summary["program_time_s"], time_s, 1e-9)
    t.check(plan["totals"]["cycles"] == summary["cycles"], f"{program}: the run takes as long as planned")

t.check(sorted(named) == sorted(f for f in os.listdir(t.OWN_PROGRAMS) if f.endswith(".ngc")), "README names all programs")
t.finish()
