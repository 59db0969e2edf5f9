"""No command writes over what it reads; where that is meant (convert, correct, saved parameters) it works."""

import os

import takt_test as t

t.write("p.ngc", "G21 G90 F1200\nG1 X5\nM2\n")
t.write("q.ini", t.run("machine")[1])
t.write("sub.ngc", "o<sub> sub\nG1 X1\no<sub> endsub\n")
t.write("calls.ngc", "G21 G90 F1200\no<sub> call\nM2\n")
t.run("run", "p.ngc", "--trace", "t.csv", "--quiet")
os.symlink("q.ini", "link.ini")
SERVE = "serve", "--listen", "127.0.0.1:0", "--http", "off", "--state", "none"

for victim, *arguments in (
    ("p.ngc", "run", "p.ngc", "--trace", "p.ngc"),
    ("p.ngc", "run", "p.ngc", "--trace", "./p.ngc"),
    ("q.ini", "run", "p.ngc", "--machine", "q.ini", "--json", "q.ini"),
    ("sub.ngc", "run", "calls.ngc", "--trace", "sub.ngc"),
    ("p.ngc", "compile", "p.ngc", "-o", "p.ngc"),
    ("q.ini", "compile", "p.ngc", "--machine", "q.ini", "-o", "q.ini"),
    ("sub.ngc", "compile", "calls.ngc", "-o", "sub.ngc"),
    ("p.ngc", "plan", "p.ngc", "--json", "p.ngc"),
    ("q.ini", "convert", "p.ngc", "--to", "grbl", "--machine", "q.ini", "-o", "q.ini"),
    ("p.ngc", *SERVE, "--program", "p.ngc", "--bus-log", "p.ngc"),
    ("q.ini", *SERVE, "--machine", "q.ini", "--bus-log", "q.ini"),
    ("q.ini", "machine", "q.ini", "--pack", "-o", "q.ini"),
    ("q.ini", "tune", "--axes", "X", "--machine", "q.ini", "-o", "q.ini"),
    ("q.ini", "tune", "--axes", "X", "--machine", "link.ini", "-o", "q.ini"),
    ("q.ini", "friction", "--axes", "X", "--machine", "q.ini", "-o", "link.ini"),
    ("q.ini", "resonance", "--axes", "X", "--machine", "q.ini", "-o", "q.ini"),
    ("q.ini", "circle", "--machine", "q.ini", "-o", "q.ini"),
    ("q.ini", "circle", "--machine", "q.ini", "--json", "q.ini"),
    ("q.ini", "cycle-frequency", "--machine", "q.ini", "--html", "q.ini"),
    ("q.ini", "bore", "--pass", "finishing", "--hole", "20", "--cutter", "4", "--step", "1", "--machine", "q.ini", "-o", "q.ini"),
    ("q.ini", "drives", "--machine", "q.ini", "--log", "q.ini", "--bus", "slcan:listen:0"),
    ("q.ini", "drives", "--machine", "q.ini", "--bus-log", "q.ini", "--bus", "slcan:listen:0"),
):
    with open(victim, "rb") as file:
        before = file.read()
    status, out, err = t.run(*arguments)
    with open(victim, "rb") as file:
        t.check(file.read() == before, "what is read stays", arguments)
    t.check(status in (2, 3) and "is read and would be written over" in err and victim in err, "and that is told", arguments, status, err)
    t.check(not any(".part-" in name for name in os.listdir(".")), "nothing is left", arguments)
    t.write(victim, before)

for arguments in (
    ("convert", "p.ngc", "--to", "grbl", "-o", "p.ngc"),
    ("correct", "p.ngc", "-o", "p.ngc"),
):
    status, _, err = t.run(*arguments)
    t.check(status == 0, "a program may be replaced by its own translation", arguments, err)
t.finish()
