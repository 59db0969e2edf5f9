"""Machine files: every mistake is refused with its place, and what is printed can be read again."""

import re

import takt_test as t

PROGRAM = t.write("move.ngc", "G0 X1\nM2\n")
AXIS_X = "[axis X]\nmax_velocity_mm_s = 50\n"


def refuse(what, text, line, column, said):
    status, out, err = t.run("run", PROGRAM, "--machine", t.write("bad.ini", text), "--json", "j.json")
    place = re.match(r"bad\.ini:(\d+):(\d+): error: (.+)", err)
    t.check(status == 2 and out == "", f"{what}: status 2", status, out)
    if t.check(place, f"{what}: has a place", err):
        t.check((int(place[1]), int(place[2])) == (line, column), f"{what}: at {line}:{column}", err)
        t.check(said in place[3], f"{what}: says {said}", err)
    t.check(not t.os.path.exists("j.json"), f"{what}: nothing is written")


def refuse_set(what, assignment, said):
    status, _, err = t.run("run", PROGRAM, "--set", assignment)
    t.check(status == 2 and said in err, f"{what}: refused", status, err)


refuse("unknown key", "[machine]\ncycle_su = 1000\n", 2, 1, "did you mean cycle_us?")
refuse("unknown section", "[machin]\nname = a\n", 1, 2, "did you mean machine?")
refuse("axis takt has not", "[axis U]\n", 1, 2, "X Y Z A B C")
refuse("key before a section", "name = a\n", 1, 1, "section")
refuse("no key at all", AXIS_X + "nonsense\n", 3, 1, "key = value")
refuse("bracket missing", "[axis X\n", 1, 1, "]")
refuse("value that is no number", "[axis X]\nmax_velocity_mm_s = fast\n", 2, 21, "fast")
refuse("number with a tail", "[axis X]\nmax_velocity_mm_s =  10 mm\n", 2, 22, "10 mm")
refuse("value out of range", "[machine]\ncycle_us = 50\n", 2, 12, "at least 100")
refuse("no whole number", "[machine]\ncycle_us = 1000.5\n", 2, 12, "whole")
refuse("zero jerk", "[axis X]\nmax_jerk_mm_s3 = 0\n", 2, 18, "above 0")
refuse("key given twice", AXIS_X + "max_velocity_mm_s = 60\n", 3, 1, "first in line 2")
refuse("rotary key of a linear axis", "[axis X]\nmax_velocity_deg_s = 5\n", 2, 1, "max_velocity_mm_s")
refuse("linear key of a rotary axis", "[axis C]\nmax_velocity_mm_s = 5\n", 2, 1, "max_velocity_deg_s")
refuse("wrong type", "[axis A]\ntype = linear\n", 2, 8, "rotary")
refuse("drive of no axis", "[drive 9]\ninertia_kg_m2 = 1\n", 1, 2, "drive_node")
refuse("node used twice", AXIS_X + "[axis Y]\ndrive_node = 1\n", 0, 0, "same drive_node 1")
refuse("travel beyond 32 bits", AXIS_X + "travel_max_mm = 30000\n", 0, 0, "32 bits")
refuse("bus too slow", "[bus]\nbitrate = 125000\n", 0, 0, "bus cannot carry")
refuse("junk", "[axis X]\n\x01\x02\x03\n", 2, 1, "control characters")
refuse("a line of 1 MB", "[machine]\nname = " + "x" * 1000000 + "\n", 2, 1, "too long")

refuse_set("unknown key", "axis.X.max_jrk=3", "did you mean max_jerk_mm_s3?")
refuse_set("unknown section", "axes.X.max_jerk_mm_s3=3", "did you mean axis?")
refuse_set("no value", "axis.X.max_jerk_mm_s3", "SECTION.KEY=VALUE")
refuse_set("empty", "", "SECTION.KEY=VALUE")
refuse_set("out of range", "machine.look_ahead_blocks=257", "at most 256")

# Indented keys, comments and either letter case of an axis are read as people mean them.
status, text, err = t.run("machine", t.write("good.ini", "[axis x]\n  max_velocity_mm_s = 50 ; slow\n# note\n\tdrive_node = 7\n"))
t.check(status == 0, "a good file is good", err)
t.check(re.findall(r"^\[axis (.)\]", text, re.M) == ["X"], "the machine has the axes the file names", text)
t.check("max_velocity_mm_s = 50\n" in text and "[drive 7]" in text, "its values are printed", text)
t.check("max_jerk_mm_s3 = 50000\n" in text, "keys left out have their defaults", text)
for name, given in (("good.ini", ["good.ini"]), ("built in", []), ("rotary", ["--set", "axis.B.max_velocity_deg_s=33.3"])):
    text = t.run("machine", *given)[1]
    t.check(t.run("machine", t.write("again.ini", text))[1] == text, f"{name}: what is printed reads as the same machine")
t.check("max_velocity_deg_s = 33.3\n" in text, "degrees stay degrees", text)

# --set takes the way of the file: half the jerk, and the run keeps to it.
status, _, err = t.run("run", PROGRAM, "--set", "axis.X.max_jerk_mm_s3=20000", "--json", "j.json", "--quiet")
axis = t.load_json("j.json")["axes"][0]
t.check(status == 0 and axis["limit_jerk_mm_s3"] == 20000, "--set changes a limit", err, axis)
t.check(19000 < axis["max_jerk_mm_s3"] <= 20000 * 1.001, "and the run keeps it", axis)

# Tables named in a machine file count from its folder.
t.os.mkdir("sub")
t.write("sub/m.ini", "[machine]\ntool_table = t.tbl\nparameter_file = p.var\n")
t.write("sub/t.tbl", "T5 P1 Z10 ; long\n")
t.write("sub/p.var", "5221 3\n5161\t7\n")
status, out, err = t.run("canon", t.write("tool.ngc", "T5 M6\nG43\nG0 X1 Z1\nG28\nM2\n"), "--machine", "sub/m.ini")
t.check(status == 0 and "X4.000000 Y0.000000 Z11.000000" in out, "tool and offset are taken from the tables", out, err)
t.check("X7.000000 Y0.000000 Z0.000000" in out, "and the reference position", out)
status, _, err = t.run("canon", "tool.ngc", "--tools", t.write("bad.tbl", "T1 P1\nT2 Z\n"))
t.check(status == 2 and err.startswith("bad.tbl:2:4: error: "), "errors of tool tables have a place", err)
status, _, err = t.run("canon", "tool.ngc", "--parameters", t.write("bad.var", "5161 1\n5162 x\n"))
t.check(status == 2 and err.startswith("bad.var:2:1: error: "), "errors of parameter files have a place", err)

# The mark that some editors put before UTF-8 is no part of a text.
MARK = b"\xef\xbb\xbf"
t.run("run", "tool.ngc", "--machine", "sub/m.ini", "--trace", "marked.csv", "--quiet")
for name in ("sub/t.tbl", "sub/p.var", "sub/m.ini", "tool.ngc", "marked.csv"):
    with open(name, "rb") as file:
        data = file.read()
    t.write(name, MARK + data)
t.write("over.txt", MARK + b"0 50\n")
t.write("faults.inject", MARK + b"power+50ms drive 1 emcy code=8130\n")
again = t.run("canon", "tool.ngc", "--machine", "sub/m.ini")
t.check(again[0] == 0 and again[1] == out, "a mark of UTF-8 changes nothing", again)
status, _, err = t.run("trace", "marked.csv", "--machine", "sub/m.ini")
t.check(status == 0, "nor before a trace", status, err)
status, _, err = t.run("run", "tool.ngc", "--machine", "sub/m.ini", "--override", "over.txt", "--inject", "faults.inject", "--quiet")
t.check(status != 2 and "error" not in err.replace("fault", ""), "nor before overrides and faults", status, err)

# What is wrong with a machine as a whole is told at the key that it names, with its value.
for number, line in enumerate(("home_method = 0", "increments_per_mm = 0", "max_jerk_mm_s3 = 1e-3", "max_acceleration_mm_s2 = 1e-6"), 3):
    key, _, value = line.partition(" = ")
    filler = "\n" * (number - 2)
    status, _, err = t.run("machine", t.write("whole.ini", f"{filler}[axis X]\n  {line}\n"))
    t.check(status == 2 and err.startswith(f"whole.ini:{number}:{len(key) + 6}: error: axis X: ") and f"({key} = " in err, "an axis", line, err)
for section, line in (("drive 1", "hard_stop_min_mm = 16"), ("drive 1", "hard_stop_max_mm = -1"), ("machine", "chain = abc"), ("bus", "data_bitrate = 16")):
    status, _, err = t.run("machine", t.write("whole.ini", f"[axis X]\n[{section}]\n{line}\n"))
    t.check(status == 2 and err.startswith(f"whole.ini:3:{line.index('=') + 3}: error: ") and f"({line})" in err, "another section", line, err)
status, _, err = t.run("machine", "--set", "axis.X.home_method=0")
t.check(status == 2 and "axis X: home_method" in err and "(home_method = 0)" in err, "a key of no file", err)

# takt machine refuses what other commands refuse.
for section, key in (("machine", "tool_table"), ("machine", "parameter_file"), ("correction", "volume_table"), ("correction", "axis_table_x"), ("drive 1", "eds"), ("drive 1", "dcf")):
    status, _, err = t.run("machine", t.write("sub/missing.ini", f"[axis X]\n[{section}]\n{key} = nowhere\n"))
    t.check(status == 2 and "sub/nowhere" in err, "a file that is missing", key, status, err)
for key in ("listen", "allow"):
    status, _, err = t.run("machine", t.write("panel.ini", f"[panel]\n{key} = abc\n"))
    t.check(status == 2 and "panel." + key in err and "abc" in err, "a panel that cannot be served", key, status, err)

# Sections that commands write take the place of a file's own; all else stays as it is.
t.write("sub/over.ini", "[axis X]\nmax_jerk_mm_s3 = 7000\n[drive 1]\ncoulomb_friction_nm = 0.25\n")
before, after = (t.run("machine", "sub/m.ini", *more)[1] for more in ([], ["--with", "sub/over.ini"]))
changed = [(a, b) for a, b in zip(before.splitlines(), after.splitlines()) if a != b]
t.check([b for _, b in changed] == ["max_jerk_mm_s3 = 7000", "coulomb_friction_nm = 0.25"] and len(before.splitlines()) == len(after.splitlines()),
        "--with changes the keys it has", changed)
status, _, err = t.run("machine", "--with", t.write("wrong_over.ini", "[drive 1]\ncoulomb_friction_nm = x\n"))
t.check(status == 2 and err.startswith("wrong_over.ini:2:"), "errors of such a file have a place", err)
t.finish()
