"""The programs of tests/programs give the figures of their README; programs that end with motions without length are whole."""

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

# Cycles behind the last motion with a length have the number of one without.
for behind in ("G1 F200\nG4 P0.1", "G0 X1\nM3 S100\nG4 P0.1", "G64 P0.1\nG1 X1\nG4 P0.1", "G38.3 X1\nG4 P0.1\nG0 X2"):
    program = t.write("behind.ngc", f"G21 G90 F1000\nG1 X1\n{behind}\nM2\n")
    status, out, err = t.run("run", program, "--json", "behind.json", "--quiet")
    broken = [check["name"] for check in t.load_json("behind.json")["checks"] if not check["held"]]
    t.check(status == 0, "no motion is missing", behind, broken, out, err)
t.finish()
