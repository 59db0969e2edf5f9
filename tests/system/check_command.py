"""`takt check` shows all errors of a file, not the first alone, and warnings apart from errors."""

import re

import takt_test as t


def findings(text):
    """Status, (line, column) of the errors and of the warnings, and all that is said."""
    status, out, err = t.run("check", t.write("part.ngc", text))
    places = {"error": [], "warning": []}
    for line, column, kind in re.findall(r"^part\.ngc:(\d+):(\d+): (error|warning): ", err, re.M):
        places[kind].append((int(line), int(column)))
    return status, places["error"], places["warning"], out + err


# Errors of words, of a subroutine, of a loop, of a call, of an arc and of an expression do not hide each other.
status, errors, warnings, said = findings("""\
G21 G90 F600
G0 X1 Q5
G1 X2 G77
O100 sub
G1 X[1/0]
G1 X3 Y?
O100 endsub
O1 while [1
O1 endwhile
O100 call
O200 call
G2 X10 Y0
#<a>=[#<b>+1]
G17 G18
G0 Z-999
M2
""")
t.check(status == 2, "errors: status 2", status)
lines = sorted(line for line, _ in errors)
t.check(lines == [2, 3, 5, 6, 8, 11, 12, 13, 14, 15], "every faulty line is named once", lines)
t.check(warnings == [], "and nothing is a warning", warnings)
t.check("part.ngc: 10 errors" in said, "the errors are counted", said)

# A loop without end is refused by every command that reads programs, with its line.
for body, line, said in (("G1 X0", 3, "endless loop"), ("G1 X1\nG1 X0", 2, "does not end")):
    path = t.write("loop.ngc", f"F100\no1 while [1]\n{body}\no1 endwhile\nM2\n")
    for command in (["check"], ["plan"], ["canon"], ["run"], ["compile", "-o", "loop.plan"]):
        status, _, err = t.run(command[0], path, "--lines-max", "2000000", *command[1:])
        t.check(status == 2 and f"loop.ngc:{line}:" in err and said in err, f"{command[0]}: an endless loop is refused", status, err)

# An error on one line does not make errors of the lines that follow from it.
status, errors, _, said = findings("G21 F100 G1 X0\nX1 Y$\nX2\nG41.1 D4 X20 ?\nX40\nG40 X60\nM2\n")
t.check([line for line, _ in errors] == [2, 4], "errors do not breed", errors, said)

# Warnings are no errors.
status, errors, warnings, said = findings("G21 G43 H5\nS99999 M3\nG33 Z-1 K1\nM2\n")
t.check(status == 0, "warnings: status 0", status, said)
t.check(errors == [] and warnings == [(1, 9), (2, 1)], "two warnings", errors, warnings)
t.check("part.ngc: no errors, 2 warnings; 1 moves" in said, "the warnings are counted", said)

# A file that is no part program is given up.
status, errors, _, said = findings("G0 X?\n" * 150)
t.check(len(errors) == 100 and "100 errors; the rest was not read" in said, "after 100 errors it is enough", len(errors))

# An unclosed block is an error at the line that opens it.
_, errors, _, said = findings("G21\nO1 if [0]\nG0 X1\n")
t.check([line for line, _ in errors] == [2], "an open block is told by its first line", errors, said)

t.finish()
