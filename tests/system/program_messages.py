"""What a program says in its comments: messages to the operator, files of its own, and its own end."""

import os

import takt_test as t

t.write("part.ngc", """\
G21 F600 (MSG, tool 3, please)
#<depth> = 2.5 #7 = 3
( Debug, depth #<depth> %d#7 %.2f#<DEPTH> 5%f of #<none>)
(LOGOPEN,first.txt)
(LOG, %d#7 holes)
(LOGCLOSE)
(LOGAPPEND,first.txt)
(LOG,and #<_x>)
(LOGOPEN,second.txt)
(log,last)
G1 X1 ; print, done #1
(an ordinary comment: MSG, nothing)
M2
""")
status, out, err = t.run("run", "part.ngc")
t.check(status == 0, "a program that says something runs", status, err)
t.check([line for line in err.splitlines() if ": message: " in line] == [
    "part.ngc:1:1: message: tool 3, please",
    "part.ngc:3:1: message: depth 2.500000 3 2.50 5 of ######",
    "part.ngc:11:1: message: done 0.000000"], "messages reach the operator, with values", err)
with open("first.txt") as file:
    t.check(file.read() == "3 holes\nand 0.000000\n", "a log is written and gone on with")
with open("second.txt") as file:
    t.check(file.read() == "last\n", "a log that is left open is whole at the end of the run")
status, out, err = t.run("check", "part.ngc")
t.check(status == 0 and err == "", "a check says nothing of it", err)

# (abort, ...): what comes before it is not begun either, because a run reads the program first.
t.write("abort.ngc", "G21\n#1=4\nG0 X1\n(ABORT, #1 is not a tool that this machine has got in its rack)\nG0 X2\nM2\n")
status, out, err = t.run("run", "abort.ngc", "--trace", "t.csv")
t.check(status == 2 and not os.path.exists("t.csv"), "an abort ends the run", status)
t.check(err.splitlines()[:2] == [
    "abort.ngc:4:1: message: 4.000000 is not a tool that this machine has got in its rack",
    "abort.ngc:4:1: error: the program ends itself: #1 is not a tool that this mac"], "and says why", err)

# Contacts of probing moves go into a file.
t.write("probe.ngc", "G21 F600\n(PROBEOPEN points.txt)\nG38.2 Z-20\nG91 G0 Z2\nG90 X7\nG38.3 Z-20\n(PROBECLOSE)\nM2\n")
t.write("world.probe", "box Z * -4\n")
status, out, err = t.run("run", "probe.ngc", "--probe", "world.probe")
with open("points.txt") as file:
    points = [[float(number) for number in line.split()] for line in file]
t.check(status == 0 and [len(point) for point in points] == [9, 9], "a line for each contact", status, points, err)
t.check([point[0] for point in points] == [0, 7] and all(abs(point[2] + 4) <= 0.001 for point in points),
        "with its place", points)
t.finish()
