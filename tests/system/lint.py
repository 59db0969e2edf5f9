"""`takt lint` finds what is right and yet hardly meant, tells each once where it is, and nothing else."""

import re

import takt_test as t

t.write("tools.tbl", "T1 P1 Z0\nT2 P2 Z0 D6\n")


def findings(text, *arguments):
    """Status, and line and beginning of each finding."""
    status, out, err = t.run("lint", t.write("part.ngc", text), "--tools", "tools.tbl", *arguments)
    found = [(int(line), what) for line, what in re.findall(r"^part\.ngc:(\d+):1: warning: (.*)", err, re.M)]
    t.check(out == f"part.ngc: {len(found)} finding{'' if len(found) == 1 else 's'}\n" or status == 2, "counted", out, err)
    return status, found


def expect(what, text, *wanted, arguments=()):
    status, found = findings(text, *arguments)
    good = len(found) == len(wanted) and all(line == at and said.startswith(begin)
                                             for (line, said), (at, begin) in zip(found, wanted))
    t.check(good and status == (1 if wanted else 0), what, status, found)


HEAD = "G21 G90 G17 F300 S1000 M3\nG0 Z5\n"

expect("a good program", HEAD + "G0 X1\nG1 Z-1\nX2\nG0 Z5\nX0\nM2\n")
expect("rapids in the stock", HEAD + "G0 X10\nG0 Z-2\nG1 X20\nG0 X30\nG0 Z5\n",
       (4, "rapid down to Z-2 mm, below the top of the stock (Z0)"), (6, "rapid sideways at Z-2 mm"))
expect("pecks go back into their hole", HEAD + "G83 X3 Y2 Z-5 R1 Q1\nX5\nG80\nM2\n")
expect("the top of the stock is told", HEAD + "G0 Z1\nG0 Z5\n", (3, "rapid down to Z1 mm, below the top of the stock (Z2)"),
       arguments=("--stock-top", "2"))
expect("work offsets count", HEAD + "G92 Z-20\nG0 Z-19\nG0 X5\n",
       (5, "rapid sideways at Z-19 mm"))
expect("feed without spindle, once", "F300\nG0 Z5\nG1 X1\nX2\nM3 S100\nX3\nM5\nX4\n",
       (3, "feed while the spindle stands"), (8, "feed while"))
expect("a spindle of 0 rev/min stands", "F300\nM3 S0\nG0 Z5\nG1 X1\n", (4, "feed while"))
expect("compensation without radius", HEAD + "T1 M6 M3\nG42\nG1 X5\nX9\nG40\nT2 M6 M3\nG42\nG1 X1 Y9\nX2 Y20\nG40\nG0 Z5\n",
       (5, "cutter compensation of a tool without a radius"))
expect("tools without a row", HEAD + "T7 M6\nT2 M6\n", (3, "tool 7 is not in the tool table"))
expect("lines that are never reached", HEAD + "o1 if [0]\nG1 X9\n(nothing)\nG1 X8\no1 endif\no2 sub\nG1 X7\no2 endsub\nM2\nG1 X1\n",
       (4, "lines 4 to 9 are never reached"), (12, "this line is never reached"))
expect("feeds that are never reached", HEAD + "G1 X1 F9000\nX1.5\nX2 Y1\nX50 Y9 F600\n",
       (3, "F9000 mm/min is never reached"))

expect("feeds of smoothed paths are the program's", "G64 P0.05 " + HEAD + "G1 X10 F9000\n" +
       "".join(f"X{10 + i} Y{i % 2}\n" for i in range(40)) + "G0 Z5\n",
       (3, "F9000 mm/min is never reached"))
expect("hundreds of hours at a feed that is reached at once", "G64 P0.01 " + HEAD + "F1\n" + "G2 X0 Y0 I2 P100\n" * 100)

status, found = findings("G1 X1\n")
t.check(status == 2 and not found, "a program with errors", status, found)
status, out, err = t.run("lint", "part.ngc", "--stock-top", "x")
t.check(status == 2 and "a height in mm is expected" in err, "a wrong height", err)

t.finish()
