"""The command line: help, suggestions, and the commands that only read."""

import math
import os
import re

import takt_test as t

COMMANDS = "run", "plan", "check", "lint", "lsp", "convert", "canon", "trace", "view", "machine", "serve", "panel", "bore", "drives", "cycle-frequency", "precision"
PROGRAM = t.write("part.ngc", "F600\nG1 X10\nG2 X20 I5\nG4 P0.5\nG0 Z5\nM2\n")

status, out, _ = t.run("help")
t.check(t.run("help", "help")[:2] == (status, out), "help is a command with help")
t.check(status == 0 and all(f"\n  {name} " in out for name in COMMANDS), "help lists the commands", out)
for name in COMMANDS:
    status, out, _ = t.run("help", name)
    t.check(status == 0 and out.startswith(f"usage: takt {name}") and "Examples:" in out, f"help {name}", out)
    t.check(t.run(name, "--help")[1] == out, f"{name} --help says the same")
t.check(re.fullmatch(r"takt \d+\.\d+\.\d+\n", t.run("--version")[1]), "--version")

for words, said in (
    ([], "usage"),
    (["rum"], "did you mean run?"),
    (["serv"], "did you mean serve?"),
    (["run"], "file name is missing"),
    (["run", PROGRAM, "more"], "one argument too many"),
    (["run", PROGRAM, "--jsno", "x"], "did you mean --json?"),
    (["run", PROGRAM, "--t", "x"], "--target or --trace"),
    (["run", PROGRAM, "--json"], "needs a value"),
    (["run", PROGRAM, "--quiet=1"], "takes no value"),
    (["run", PROGRAM, "--until", "soon"], "number"),
    (["run", PROGRAM, "--json", "a", "--json", "b"], "twice"),
    (["run", PROGRAM, "-x"], "-x"),
    (["run", PROGRAM, "--save-parameters"], "--parameters"),
):
    status, out, err = t.run(*words)
    t.check(status == 2 and out == "" and said in err, f"takt {' '.join(words)}: refused", status, err)

# plan: a line of 10 mm from rest to rest at 10 mm/s takes 1 + 2 sqrt(10/50000) s.
status, out, _ = t.run("plan", PROGRAM)
rows = out.splitlines()
t.check(status == 0 and rows[-1].startswith("3 moves, 30.707963 mm"), "plan's totals", rows[-1])
t.check(rows[1].split()[:4] == ["1", "2", "feed", "10.000000"], "plan's rows", rows[1])
status, out, _ = t.run("plan", PROGRAM, "--json", "-")
plan = t.json.loads(out)
kinds = [block["kind"] for block in plan["blocks"]]
t.check(kinds == ["feed", "arc_cw", "dwell", "rapid", "end"], "plan's kinds", kinds)
t.check(plan["blocks"][2]["time_s"] == 0.5, "the dwell's time", plan["blocks"][2])
t.check(abs(plan["blocks"][0]["feed_cruise_mm_min"] - 600) < 1e-6, "the programmed feed is reached", plan["blocks"][0])
t.check(plan["blocks"][0]["governor"] == "program" and plan["blocks"][3]["end"] == "stop", "why and how", plan["blocks"])
run_cycles = t.json.loads(t.run("run", PROGRAM, "--json", "-", "--quiet")[1])["cycles"]
rows_s = sum(block["time_s"] for block in plan["blocks"])
t.check(abs(rows_s - plan["totals"]["time_s"]) < 1e-9, "the rows' times add up", rows_s, plan["totals"])
t.check(plan["totals"]["cycles"] == run_cycles, "the plan takes as long as the run", plan["totals"], run_cycles)

# Rotary axes: smoothed alone, in degrees; beside hardly any way of a linear one, as long as alone.
SIX = ("--machine", os.path.join(os.environ["TAKT_SOURCE"], "tests/golden/mill6.ini"))
turns = t.write("turns.ngc", "G64 P0.01\nF2000\nG1 A90\nA180 B20\nX10\nM2\n")
blocks = t.json.loads(t.run("plan", turns, *SIX, "--json", "-")[1])["blocks"]
t.check(abs(blocks[0]["length_deg"] - 90) < 1 and "length_mm" in blocks[2], "smoothed motions of rotary axes alone", blocks)
t.check(abs(blocks[0]["feed_cruise_deg_min"] - 2000) < 1, "their feed", blocks[0])
cycles = []
for way in ("A360", "X0.001 A360", "X0.0001 A360", "X0.00000001 A360", "X[0.000000001] A360"):
    turn = t.write("turn.ngc", f"G61\nF20000\nG1 {way}\nM2\n")
    cycles.append(t.json.loads(t.run("plan", turn, *SIX, "--json", "-")[1])["totals"]["cycles"])
t.check(len(set(cycles)) == 1, "a tiny linear part takes no time", cycles)

# Smoothed: two lines that are nearly one become one row; its length and feed are those of the curve. Then a quarter of a circle
# in lines: so many corners that no stop at each is as quick.
CORNERS = 12
RADIUS_MM = 15
with open("smooth.ngc", "w", encoding="utf-8") as file:
    file.write("G21 G64 P0.01\nF3000\nG1 X1\nX2 Y0.0002\n")
    for turn in (k * math.pi / 2 / CORNERS for k in range(1, CORNERS + 1)):
        file.write(f"X{2 + RADIUS_MM * math.sin(turn):.3f} Y{RADIUS_MM * (1 - math.cos(turn)):.3f}\n")
    file.write("M2\n")
way_mm = 2 + CORNERS * 2 * RADIUS_MM * math.sin(math.pi / 4 / CORNERS)
status, out, _ = t.run("plan", "smooth.ngc")
first, second = (row.split() for row in out.splitlines()[1:3])
t.check(first[0] == "1-2" and second[0] == "3", "what became one curve", out)
t.check(int(first[-1]) > 5 and int(second[-1]) > 5, "their pieces", out)
plan = t.json.loads(t.run("plan", "smooth.ngc", "--json", "-")[1])
blocks = plan["blocks"]
t.check([(b.get("block_first"), b["block"]) for b in blocks[:2]] == [(1, 2), (3, 3)], "blocks that became one", blocks)
t.check(abs(sum(b["length_mm"] for b in blocks if "length_mm" in b) - way_mm) < 0.02, "the curve's length", way_mm, blocks)
t.check(abs(blocks[1]["feed_cruise_mm_min"] - 3000) < 5, "the curve's feed", blocks)
t.check(blocks[0]["end"] == "passed" and blocks[-2]["end"] == "stop", "how they end", blocks)
moves = CORNERS + 2
t.check(plan["totals"]["moves"] == moves and abs(plan["totals"]["length_mm"] - way_mm) < 0.02, "the totals of a smoothed plan", plan["totals"])
checked = t.run("check", "smooth.ngc")[1]
said = re.search(rf"; {moves} moves, ([0-9.]+) mm$", checked)
t.check(said and abs(float(said[1]) - way_mm) < CORNERS * 0.001, "check measures the programmed path", checked)

status, out, _ = t.run("check", PROGRAM)
t.check(status == 0 and out.endswith(": no errors, 0 warnings; 3 moves, 30.708 mm\n"), "check", out)
status, out, _ = t.run("canon", PROGRAM)
t.check(out.splitlines()[1] == "3 arc_cw X20.000000 Y0.000000 Z0.000000 I15.000000 J0.000000 K0.000000 P1 G17 F600.000000", "canon", out)

# trace: limits of one, differences of two.
t.run("run", PROGRAM, "--trace", "a.csv", "--quiet")
t.run("run", PROGRAM, "--trace", "b.csv", "--quiet", "--set", "axis.X.max_jerk_mm_s3=40000")
status, out, _ = t.run("trace", "a.csv")
t.check(status == 0 and "X jerk" in out, "a trace within its limits", out)
status, out, _ = t.run("trace", "a.csv", "--set", "axis.X.max_jerk_mm_s3=40000")
t.check(status == 1 and re.search(r"X jerk .* BROKEN in \d+ cycles, first in cycle \d+, block 1, line 2", out), "a limit broken", out)
status, out, _ = t.run("trace", "a.csv", "a.csv")
t.check(status == 0 and out.startswith("equal: "), "a trace equals itself", out)
status, out, _ = t.run("trace", "a.csv", "b.csv")
t.check(status == 1 and re.search(r"set_X_mm +differs in \d+ rows: first by", out), "traces that differ", out)
rows = open("a.csv").read().splitlines()
columns = rows[50].split(",")
columns[8] = f"{float(columns[8]) + 1e-4:.9f}"
t.write("c.csv", "\n".join(rows[:50] + [",".join(columns)] + rows[51:]) + "\n")
status, out, _ = t.run("trace", "a.csv", "c.csv")
t.check(status == 1 and re.search(r"set_X_mm +differs in 1 rows: first by 0\.0001 in cycle 49", out), "one setpoint off", out)
t.check(t.run("trace", "a.csv", "c.csv", "--tolerance", "2e-4")[0] == 0, "a tolerance")
t.check(t.run("trace", "c.csv")[0] == 1, "one setpoint 1e-4 mm off is 3e5 mm/s3 of jerk")
t.write("short.csv", "\n".join(rows[:100]) + "\n")
status, out, _ = t.run("trace", "a.csv", "short.csv")
t.check(status == 1 and "more rows" in out, "a shorter trace", out)
status, _, err = t.run("trace", t.write("bad.csv", "\n".join(rows[:5]) + "\n1,2,x\n"))
t.check(status == 2 and err.startswith("bad.csv:6:5: error: "), "a broken trace", err)
t.check(t.run("trace", t.write("no.csv", "a,b\n1,2\n"))[0] == 2, "no trace at all")
for name, text, word in (
    ("gap.csv", rows[:9] + rows[11:], "gap.csv:10:0: error: time_s is 0.003 s behind"),
    ("order.csv", rows[:9] + [rows[10], rows[9]] + rows[11:], "not in order"),
    ("still.csv", [rows[0], rows[1], rows[1]], "time_s is 0 s"),
    ("turn.csv", [rows[0].replace("set_Z_mm", "set_C_deg"), *rows[1:]], "the machine has no axis C"),
):
    status, out, err = t.run("trace", t.write(name, "\n".join(text) + "\n"))
    t.check(status == 2 and out == "" and word in err, "what cannot be judged is told", name, status, out, err)
status, out, err = t.run("trace", t.write("two.csv", "\n".join([rows[0].replace("set_Z_mm", "z"), *rows[1:]]) + "\n"))
t.check(status == 0 and "no column set_Z_mm" in err, "an axis that is not in the trace is told", status, out, err)

# Numbers that would be taken for something else are refused: ports that sockets cut to 16 bits, 0 where 0 says "not given".
PANEL = "panel", "watch", "STATE", "--connect", "127.0.0.1:1"
for words, *arguments in (
    ("65535", "view", "a.csv", "--http", "127.0.0.1:99999"),
    ("65535", "serve", "--state", "none", "--http", "127.0.0.1:66000"),
    ("65535", "serve", "--state", "none", "--listen", "127.0.0.1:65537"),
    ("65535", "serve", "--state", "none", "--listen", "127.0.0.1:0", "--http", "off", "--grbl", "tcp:127.0.0.1:99999"),
    ("127.0.0.1:99999", "drives", "--spindle", "127.0.0.1:99999"),
    ("65535", "panel", "read", "STATE", "--connect", "127.0.0.1:99999"),
    ("--until 0: it must be above 0", "run", PROGRAM, "--until", "0"),
    ("--ceiling 0: it must be above 0", "compile", PROGRAM, "-o", "x.plan", "--ceiling", "0"),
    ("--speed 0", "view", "a.csv", "--speed", "0"),
    ("--count 1.5: a whole number from 1 on", *PANEL, "--count", "1.5"),
    ("--count 0: a whole number from 1 on", *PANEL, "--count", "0"),
    ("--interval 0", *PANEL, "--interval", "0"),
    ("--seed 1e20: a whole number from 0 on", "calibrate", "--grid", "3x3x3", "--seed", "1e20"),
    ("--seed 0.5: a whole number from 0 on", "resonance", "--seed", "0.5"),
    ("--comp-type 0.5: a whole number from 0 on", "calibrate", "--comp", "x.comp", "--axis", "X", "--comp-type", "0.5"),
    ("--can 0.5: a whole number from 0 on", "drives", "--can", "0.5"),
):
    status, _, err = t.run(*arguments)
    t.check(status == 2 and words in err, "refused with a reason", arguments, status, err)
t.finish()
