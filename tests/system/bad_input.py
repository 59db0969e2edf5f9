"""Bad input of every kind: exit status 2, file, line and column on stderr, nothing written, nothing on stdout."""

import os
import random
import re

import takt_test as t

OUTPUTS = {"--trace": "t.csv", "--bus-log": "b.log", "--report": "r.html", "--json": "j.json", "--junit": "u.xml"}


def arguments():
    return [word for pair in OUTPUTS.items() for word in pair]


def expect_refusal(what, path, line, column, said, *options):
    before = sorted(os.listdir("."))
    status, out, err = t.run("run", path, *options, *arguments())
    first = err.splitlines()[0] if err else ""
    place = re.match(r"(.+?):(\d+):(\d+): error: (.+)", first)
    t.check(status == 2, f"{what}: status 2", status)
    t.check(out == "", f"{what}: nothing on stdout", out)
    if t.check(place, f"{what}: FILE:LINE:COLUMN: error: TEXT", first):
        t.check(place[1] == path, f"{what}: names the file", first)
        t.check((int(place[2]), int(place[3])) == (line, column), f"{what}: line {line}, column {column}", first)
        t.check(re.search(said, place[4]), f"{what}: says {said}", first)
    t.check(sorted(os.listdir(".")) == before, f"{what}: no file is left", os.listdir("."))


def refuse_program(what, text, line, column, said, *options):
    expect_refusal(what, t.write("bad.ngc", text), line, column, said, *options)


expect_refusal("missing file", "nowhere.ngc", 0, 0, "No such file")
os.mkdir("folder.ngc")
expect_refusal("a folder", "folder.ngc", 0, 0, "directory")

refuse_program("unknown word", "G21\nG0 X1\nG0 X2 G77\n", 3, 7, "G77")
refuse_program("unknown letter", "G0 X1\nG0 X2 !\n", 2, 7, "!")
refuse_program("arc with wrong centre", "F100\nG17 G2 X10 Y10 I3 J4\n", 2, 5, "circle|arc")
refuse_program("travel exceeded", "G0 X1\nG0 X500.1\n", 2, 4, "travel")
refuse_program("arc that bulges out of the travel", "G0 X490\nG2 X490 Y0 I20 F100\n", 2, 4, "travel")
refuse_program("feed missing", "G0 X1\n\nG1 X2\n", 3, 1, "feed")
refuse_program("unclosed comment", "G0 X1\nG0 Y1 (no end\n", 2, 7, "comment")
refuse_program("no number", "G0 X\n", 1, 4, "number")
refuse_program("axis the machine has not", "G0 A90\n", 1, 4, "axis A")
refuse_program("division by zero", "G0 X[1 / 0]\n", 1, 8, "division")
refuse_program("unset parameter", "G0 X#<width>\n", 1, 7, "(?i)width")
refuse_program("a line of 1 MB", "G0 X1\nG0 X" + "1" * 1000000 + "\n", 2, 257, "longer")
refuse_program("a program of one line of 1 MB", "G0 X" + "1" * 1000000, 1, 257, "longer")
refuse_program("a comment of 1 MB without an end", "(" + "x" * 1000000, 1, 1, "comment")
refuse_program("a late error", "G0 X1\n" * 5000 + "G0 X1 R?\n", 5001, 7, ".")

junk = random.Random(1)
for size in (1, 2, 17, 300, 5000, 100000):
    for _ in range(4):
        data = bytes(junk.randrange(256) for _ in range(size))
        status, _, err = t.run("run", t.write("junk.ngc", data), *arguments())
        t.check(status in (0, 2), f"binary junk of {size} bytes does not crash takt", status, err[-300:])
        t.check(status == 0 or re.match(r"junk\.ngc:\d+:\d+: error: ", err), "junk has a place", err[:200])
        t.check(status == 0 or not set(OUTPUTS.values()) & set(os.listdir(".")), "nothing is written for junk")
        for name in OUTPUTS.values():
            if os.path.exists(name):
                os.remove(name)
refuse_program("binary junk", bytes(range(256)) * 40, 1, 1, ".")

# takt check goes on after errors and shows each.
status, out, err = t.run("check", t.write("two.ngc", "G0 X1\nG0 X2 G77\nG0 Y1\nG0 Z9999\nM2\n"))
places = re.findall(r"^two\.ngc:(\d+):\d+: error: ", err, re.M)
t.check(status == 2 and places == ["2", "4"], "check finds all errors", status, err)
t.check("    G0 X2 G77\n          ^" in err, "the line is shown with a caret", err)

# Standard input is a file as well.
status, _, err = t.run("run", "-", text=b"G0 X1\nG1 X2\n")
t.check(status == 2 and err.startswith("<stdin>:2:1: error: "), "errors of standard input", err)
t.finish()
