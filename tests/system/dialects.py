"""Programs as they are found: other dialects, codes of the machine file, and subroutines in files of their own."""

import os

import takt_test as t


def moves(*arguments):
    """Status, moves without their lines, and messages."""
    status, out, err = t.run("canon", *arguments)
    return status, [line.split(maxsplit=1)[1] for line in out.splitlines()], err


def rapid(x, y=0, z=0):
    return f"rapid X{x:.6f} Y{y:.6f} Z{z:.6f}"


# What LinuxCNC reads is read as ever, without a word.
t.write("plain.ngc", "O1000 (HAAS)\nG21 G0 X1\nM98 P2000\nM30\nO2000\nG0 Y1\nM99\n")
status, found, err = moves("plain.ngc")
t.check((status, err) == (0, "") and found[:2] == [rapid(1), rapid(1, 1)], "a program for LinuxCNC", found, err)

# Fanuc's macros: the line numbers are those of the program.
t.write("macro.nc", """\
%
O0001(LOOPS)
G21 G90
#1=0
WHILE [#1 LT 2] DO1
#1=[#1+1]
IF [#1 EQ 2] THEN G0 Y#1
G0 X#1
END1
N10 #1=[#1+1]
IF [#1 LT 4] GOTO 10
G0 Z#1
GOTO 20
G0 X99
N20 G65 P9001 A5. B6.
G0 G28 G91 Z0.
G90 X3
M30
O9001
G0 X#1 Y#2
M99
%
""")
status, found, err = moves("macro.nc")
t.check(status == 0 and found == [rapid(1), rapid(1, 2), rapid(2, 2), rapid(2, 2, 4), rapid(5, 6, 4), rapid(5, 6, 4),
                                  rapid(5, 6, 0), rapid(3, 6, 0), "end"], "loops, jumps and macros", found, err)
t.check(err == "takt canon: note: macro.nc is read as fanuc, since line 5 has 'WHILE' (--dialect says otherwise)\n",
        "the note says which, and why", err)
lines = [line.split()[0] for line in t.run("canon", "macro.nc")[1].splitlines()]
t.check(lines == ["8", "7", "8", "12", "20", "16", "16", "17", "18"], "moves have the lines of the program", lines)
status, found, err = moves("macro.nc", "--dialect", "linuxcnc")
t.check(status == 2 and err.startswith("macro.nc:5:1: error: "), "the dialect can be told", err)
status, found, err = moves("macro.nc", "--dialect", "fanoc")
t.check(status == 2 and "known are auto, linuxcnc, grbl, fanuc" in err, "one that is not known", err)

# Lines of old Macintoshes end with carriage returns alone.
t.write("returns.nc", "G21 G0 X1\rG0 X2\r\rG0 X[\rM30\r")
status, found, err = moves("returns.nc")
t.check(status == 2 and "returns.nc:4:5: error" in err, "lines that end with carriage returns", err)

# A lathe's program in one piece: turret, drill, thread, and the spindle that goes on turning.
t.write("lathe.nc", """\
%
O2(LATHE)
G21 G18 G99
G50 S2000
T0101
G97 S1000 M3
G0 X0 Z2.
G83 Z-9. Q5000 F.2
G0 Z5.
T0202
G0 X20.
G32 Z-10. F1.5
G0 X30.
M30
""")
status, found, err = moves("lathe.nc")
t.check(status == 0 and [m for m in found if m.startswith(("feed", "thread", "spindle"))] == [
    "spindle_cw S1000.000000", "feed X0.000000 Y0.000000 Z-3.000000 F0.200000rev",
    "feed X0.000000 Y0.000000 Z-8.000000 F0.200000rev", "feed X0.000000 Y0.000000 Z-9.000000 F0.200000rev",
    "spindle_off", "spindle_cw S1000.000000", "thread X10.000000 Y0.000000 Z-10.000000 F1.500000rev"], "a lathe", found, err)

# Polar coordinates.
t.write("polar.nc", "G15\nG21 G90 G16\nG0 X10. Y90.\nY180.\nG15\nX1. Y2.\nM30\n")
status, found, err = moves("polar.nc")
t.check(found[:3] == [rapid(0, 10), rapid(-10, 0), rapid(1, 2)], "polar coordinates", found, err)

# A loop that one line becomes has the number of this line in every round.
t.write("pocket.nc", "G0 X1\nG13 I2. K5. Q2. F200\nX9\nM30\n")
status, out, err = t.run("canon", "pocket.nc")
lines = [tuple(line.split()[:3]) for line in out.splitlines()]
t.check(lines == [("1", "rapid", "X1.000000"), ("2", "arc_ccw", "X3.000000"), ("2", "arc_ccw", "X3.000000"),
                  ("2", "feed", "X5.000000"), ("2", "arc_ccw", "X5.000000"), ("2", "feed", "X6.000000"),
                  ("2", "arc_ccw", "X6.000000"), ("2", "arc_ccw", "X1.000000"), ("2", "feed", "X1.000000"),
                  ("3", "feed", "X9.000000"), ("4", "end")], "a round pocket", lines, err)

# What moves something and is known elsewhere is no unknown word, and nobody is told to leave it out.
t.write("tilted.nc", "G68.2 X0 Y0 J30.\nG43.4 H1\nG1 B5\n")
status, found, err = moves("tilted.nc")
t.check(status == 2 and "tilted.nc:1:1: error: 'G68.2' is not supported: a tilted plane\n" in err and "ignore" not in err,
        "a tilted plane", err)
t.write("table.nc", "G254\nG1 X5 F100\n")
status, found, err = moves("table.nc")
t.check(status == 2 and "table.nc:1:1: error: 'G254' is not supported: a part that turns with its table (Haas)\n" in err and
        "ignore" not in err, "a turning part", err)

for code in ("G44 H1 Z5", "G29 X1", "G27 X0", "G331 Z-9 K1"):
    t.write("moves.nc", f"G0 X1\n{code}\n")
    status, found, err = moves("moves.nc")
    t.check(status == 2 and f"moves.nc:2:1: error: '{code.split()[0]}' is not supported: " in err and "ignore" not in err,
            "a code that moves, or shifts what is moved", err)

for code in ("G54.1 P7", "G154 P5", "G114", "G129"):
    t.write("far.nc", f"(HAAS)\n{code}\nG0 X1\n")
    status, found, err = moves("far.nc", "--dialect", "haas")
    t.check(status == 2 and f"far.nc:2:1: error: '{code.split()[0]}' is not supported: a work offset beyond" in err and
            "G10 L2 P7" in err and "ignore" not in err, "an offset that is not there", err)

# Errors stand where they are in the program as it was found.
t.write("wrong.nc", "G54.1 P1\nIF[#1 EQ 0] THEN  G0 X1 Q3\nM30\n")
status, found, err = moves("wrong.nc")
t.check(status == 2 and "wrong.nc:2:25: error: no code on this line uses the word 'Q3'\n" in err, "the column", err)
t.write("jump.nc", "G0 X1\nGOTO 7\nM30\n")
status, found, err = moves("jump.nc")
t.check(status == 2 and "jump.nc:2:1: error: 'GOTO 7' goes to a label that no line" in err, "a jump to nowhere", err)
t.write("jump.nc", "IF [1 EQ 0] GOTO 7\nG0 X1\nM30\n")
status, found, err = moves("jump.nc", "--dialect", "fanuc")
t.check(status == 0 and found == [rapid(1), "end"], "one that is not taken", found, err)

# Siemens: words with '=', parameters, flow, subprograms and cycles.
t.write("part.mpf", """\
%_N_PART_MPF
N10 G17 G71 G90 G64 SOFT
N20 R1=5 R2=R1*2
MSG("rough")
G0 X=R1 Y=R2 Z5
G1 Z-1 F=R1*100
G2 X=R1+15 Y10 CR=10
IF R1>4 GOTOF SKIP
X99
SKIP: G0 X=IC(5)
FOR R5=1 TO 2
X=30+R5
ENDFOR
MCALL CYCLE81(50,0,2,-10)
Y1
MCALL
L100 P2
M30
%_N_L100_SPF
Z=IC(1)
M17
""")
status, out, err = t.run("canon", "part.mpf")
found = [tuple(line.split()[:5]) for line in out.splitlines()]
t.check(status == 0 and found == [
    ("5", "rapid", "X5.000000", "Y10.000000", "Z5.000000"), ("6", "feed", "X5.000000", "Y10.000000", "Z-1.000000"),
    ("7", "arc_cw", "X20.000000", "Y10.000000", "Z-1.000000"), ("10", "rapid", "X25.000000", "Y10.000000", "Z-1.000000"),
    ("12", "rapid", "X31.000000", "Y10.000000", "Z-1.000000"), ("12", "rapid", "X32.000000", "Y10.000000", "Z-1.000000"),
    ("14", "rapid", "X32.000000", "Y10.000000", "Z50.000000"), ("15", "rapid", "X32.000000", "Y1.000000", "Z50.000000"),
    ("15", "rapid", "X32.000000", "Y1.000000", "Z2.000000"), ("15", "feed", "X32.000000", "Y1.000000", "Z-10.000000"),
    ("15", "rapid", "X32.000000", "Y1.000000", "Z50.000000"), ("16", "rapid", "X32.000000", "Y1.000000", "Z50.000000"),
    ("20", "rapid", "X32.000000", "Y1.000000", "Z51.000000"), ("20", "rapid", "X32.000000", "Y1.000000", "Z52.000000"),
    ("18", "end")], "a program for Siemens", found, err)
t.check("part.mpf is read as siemens, since line 1 has '%_N_PART_MPF'" in err, "and why it is one", err)

def siemens(text, *arguments):
    t.write("try.mpf", text)
    return moves("try.mpf", "--dialect", "siemens", *arguments)


status, found, err = siemens("TRANS X10\nTRANS Y5\nG0 X0 Y0\nATRANS X1 Y1\nX0 Y0\nSCALE\nX0 Y0\n")
t.check(found == [rapid(0, 5), rapid(1, 6), rapid(0, 0), "end"], "TRANS takes the place of all frames, ATRANS adds", found, err)
status, found, err = siemens("PROC MAIN\nG0 X5\nUP2\nM30\nPROC UP1\nX1\nM17\nPROC UP2\nX2\nRET\n")
t.check(found == [rapid(5), rapid(2), "end"], "PROC of a main program, and of two subprograms", found, err)
t.write("HOLE.SPF", "G0 Y1\nM17\n")
status, found, err = siemens("HOLE\nG0 X1\nM30\n")
t.check(found == [rapid(0, 1), rapid(1, 1), "end"], "a subprogram in a file that says nothing of it", found, err)
status, found, err = siemens("DEF INT HH\nIF HH GOTOF ENDE\nG0 X10\nA1: X=IC(1)\nREPEAT A1 P=2\nM30\n")
t.check(found == [rapid(x) for x in (10, 11, 12, 13)] + ["end"], "a jump that is not taken, and a section again", found, err)

# Pecks: to FDEP, then shorter by DAM, the last two alike; back by 1 mm, or out.
heights = [[float(line.split()[3][1:]) for line in siemens(f"G0 X0 F100\n{cycle}\n")[1][1:-2]] for cycle in (
    "CYCLE83(10,0,2,-20,,-8,,3,0,0,1,0)", "CYCLE83(10,0,2,,20,,8,3,0,0,1,1)", "G91\nCYCLE83(10,0,2,-20,,-15,,0,,,,1)",
    "CYCLE83(10,0,2,-20,,-15,,0,0,0,0.5,0,0,0,0.25)")]
t.check(heights == [[2, -8, -7, -13, -12, -16, -15, -18, -17, -20, 10],
                    [2, -8, 2, -7.4, -13, 2, -12.4, -16, 2, -15.4, -18, 2, -17.4, -20, 10],
                    [2, -15, 2, -14.4, -20, 10], [2, -15, -14.75, -20, 10]], "pecks of CYCLE83", heights)
status, found, err = siemens("G0 X0 F100\nCYCLE83(10,0,2,-20,,5,,3,0,0,1,0)\n")
t.check(status == 2 and "FDEP must be below RFP" in err, "a first peck above the reference", err)

# What is wrong is called what the program calls it.
for text, wrong in (
        ("G0 X1\nENDIF\n", "2:1: error: 'ENDIF' belongs to no open block"),
        ("N10 IF R1==1\nX1\n", "1:5: error: 'IF R1==1' is not closed"),
        ("LOOP\nG0 X=IC(1)\n", "1:1: error: 'LOOP' is not closed"),
        ("R1=1\nIF R1 GOTOF ENDE ; out\n", "2:7: error: 'GOTOF ENDE' goes to a label that no line"),
        ("AA: GOTOF AA\n", "1:5: error: 'GOTOF AA' goes to a label"),
        ("ROT Z30\n", "1:1: error: unknown word 'ROT Z30'"),
        ("IF $P_SIM\nX1\nELSE\nX2\nENDIF\n", "1:1: error: unknown word 'IF $P_SIM'"),
        ("CYCLE83(10,0,2,-20)\n", "1:1: error: unknown word 'CYCLE83(10,0,2,-20)'"),
        ("NOSUB(3)\n", "1:1: error: 'NOSUB(3)' calls a subroutine")):
    status, found, err = siemens(text)
    t.check(status == 2 and err.count(": error: ") == 1 and "try.mpf:" + wrong in err and "o1 if" not in err, "what is wrong", err)

# A printer's program is the way of its nozzle.
t.write("print.gcode", "M104 S200\nG28 X0 Y0\nG92 E0\nG1 X5 E1.5 F600\nM104 S0\n")
status, found, err = moves("print.gcode")
t.check(status == 0 and found == [rapid(0), rapid(0), "feed X5.000000 Y0.000000 Z0.000000 F600.000000", "end"],
        "a printer", found, err)
t.check(err.count("'M104' is left out (marlin: temperature)") == 1, "what is left out is told once", err)

# What LinuxCNC has Python do is not done without a word.
t.write("python.ngc", ";py,import interpreter\n( PYRUN,change.py)\n(copy, nothing)\n;py,this.params[1] = 2\nG0 X1\nM2\n")
status, found, err = moves("python.ngc")
t.check(status == 0 and found == [rapid(1), "end"] and err.splitlines() == [
    "python.ngc:1:1: warning: ';py' is left out (linuxcnc: Python)",
    "python.ngc:2:1: warning: '( PYRUN' is left out (linuxcnc: Python)"], "comments that run Python", found, err)

# Codes that only the owner of a machine can know: the message has the line to add.
t.write("codes.ngc", "G21\nG0 X1 M31\nM32 P2 (conveyor)\nM33\nM34\nM2\n")
status, found, err = moves("codes.ngc")
t.check(status == 2 and "codes.ngc:2:7: error: unknown word 'M31'" in err and "\n    [codes]\n    M31 = ignore " in err,
        "the message has the line", err)
t.write("mill.ini", "[codes]\nM31 = ignore\nM32 = subroutine conveyor\nM33=output 3 on\nM34 = stop\n")
t.write("conveyor.ngc", "o<conveyor> sub\nG0 Y#1\no<conveyor> endsub\n")
status, found, err = moves("codes.ngc", "--machine", "mill.ini")
t.check((status, err) == (0, "") and found == [rapid(1), rapid(1, 2), "output P3 Q1.000000", "stop", "end"],
        "declared codes", found, err)
status, found, err = moves("codes.ngc", "--machine", "mill.ini", "--set", "codes.M34=ignore")
t.check(status == 0 and "stop" not in found, "--set declares codes too", found, err)
status, out, err = t.run("machine", "mill.ini")
t.check(status == 0 and out.endswith("\n[codes]\nM31 = ignore\nM32 = subroutine conveyor\nM33 = output 3 on\nM34 = stop\n"),
        "a machine file is printed with them", out[-200:])

# U V W are other axes' letters: the message has the line to add; A counts their millimetres as degrees.
t.write("foam.ngc", "G21 F100\nG1 X1 U2 V3\nG20 G0 U1\nM2\n")
status, found, err = moves("foam.ngc")
t.check(status == 2 and "foam.ngc:2:7: error: the machine has no axis U" in err and "\n    [codes]\n    U = ignore " in err,
        "the message has the line for a letter", err)
t.write("foam.ini", "[codes]\nU = A\nV = ignore\n"
        "[axis X]\ntravel_min_mm = -500\ntravel_max_mm = 500\n[axis A]\ntravel_min_deg = -500\ntravel_max_deg = 500\n")
status, found, err = moves("foam.ngc", "--machine", "foam.ini")
t.check((status, err) == (0, "") and [line.split()[2] for line in found[:2]] == ["A2.000000", "A25.400000"],
        "letters that drive an axis", found, err)
status, out, err = t.run("machine", "foam.ini")
t.check(status == 0 and out.endswith("\n[codes]\nU = A\nV = ignore\n"), "they are printed", out[-100:])

# What R of a lathe's drilling is, the machine file says: the message has the line.
t.write("bore.nc", "G50 S900\nG28 U0\nM3 S500\nG0 X0 Z5\nG83 Z-9. R-2. Q5000 F.1\nG80\nM30\n")
status, found, err = moves("bore.nc", "--dialect", "fanuc")
t.check(status == 2 and "\n    [codes]\n    R = distance " in err, "the message asks for the meaning of R", err)
for use, height in ("distance", 3), ("height", -2):
    status, found, err = moves("bore.nc", "--dialect", "fanuc", "--set", f"codes.R={use}")
    t.check(status == 0 and any(line == f"rapid X0.000000 Y0.000000 Z{height}.000000" for line in found), use, found, err)

for line, wrong in (("M31 = maybe", "known are ignore"), ("W = Q", "the letter of an axis"), ("X31 = stop", "a code is expected")):
    t.write("bad.ini", "[codes]\n" + line + "\n")
    status, out, err = t.run("machine", "bad.ini")
    t.check(status == 2 and "bad.ini:2:1: error: " in err and wrong in err, "a wrong declaration", err)

# What programs ask of LinuxCNC's configuration is answered by the machine file.
t.write("ask.ngc", "G21\nG0 X#<_ini[axis_x]reach> Y#<_hal[probe.height]>\nM2\n")
status, found, err = moves("ask.ngc", "--set", "values._hal[probe.height]=12.5")
t.check(status == 2 and "\n    [values]\n    _ini[AXIS_X]REACH = NUMBER\n" in err, "the message has the line", err)
t.write("mill.ini", "[values]\n_ini[AXIS_X]REACH = 7\n_hal[probe.height] = 12.5\n")
status, found, err = moves("ask.ngc", "--machine", "mill.ini")
t.check((status, err) == (0, "") and found[0] == rapid(7, 12.5), "numbers of the machine file", found, err)
t.check(t.run("machine", "mill.ini")[1].endswith("\n[values]\n_ini[AXIS_X]REACH = 7\n_hal[probe.height] = 12.5\n"),
        "which are printed with it")

# Tools by what the program says of them.
t.write("tools.nc", "(T1 D=6.5 CR=0 - end mill)\n(T2 D=3.)\nG21 F100\nG0 X-20\nG41 D1\nG1 X0\nY5\nG40 X-20\nM2\n")
status, found, err = moves("tools.nc", "--tools", "auto")
t.check(status == 0 and found[1].startswith("feed X-3.250000 Y3.250000 "), "a radius from a comment", found, err)
t.check("warning: --tools auto: 2 tools without a table, all of length 0, 0 of diameter 0" in err, "with a warning", err)
t.write("tools.nc", "(T1 D=0.5)\nG20 F10\nG0 X-2\nG41 D1\nG1 X0\nY5\nG40 X-2\nM2\n")
status, found, err = moves("tools.nc", "--tools", "auto")
t.check(status == 0 and found[1].startswith("feed X-6.350000 "), "in inches", found, err)
status, found, err = moves("tools.nc")
t.check(status == 2 and "--tools auto" in err, "the message names it", err)

# Subroutines in files: the program's folder, and others.
os.makedirs("lib", exist_ok=True)
t.write("main.ngc", "G21\nG0 X1\no<one> call [2]\nM98 P300\n")
t.write("one.ngc", "%\no<one> sub\nG0 Y#1\no<two> call [#1+1]\no<one> endsub\n%\n")
t.write("lib/two.ngc", "; comes from elsewhere\no<two> sub\nG0 Z#1\no<two> endsub\nM2\n")
t.write("lib/300.ngc", "O300\nG0 X9\nM99\n")
status, found, err = moves("main.ngc", "--subroutines", "lib")
t.check((status, err) == (0, "") and found == [rapid(1), rapid(1, 2), rapid(1, 2, 3), rapid(9, 2, 3), "end"],
        "subroutines in files", found, err)
t.write("lib/two.ngc", "o<two> sub\n\n  G0 Z#1 K3\no<two> endsub\n")
status, found, err = moves("main.ngc", "--subroutines", "lib")
t.check(status == 2 and err.startswith("lib/two.ngc:3:10: error: ") and "\n      G0 Z#1 K3\n" in err,
        "an error in such a file is told with its own line", err)
status, found, err = moves("main.ngc")
t.check(status == 2 and "calls a subroutine" in err, "a folder that is not named is not looked into", err)
t.write("loop.ngc", "G21\no<self> call\nM2\n")
t.write("self.ngc", "o<self> sub\no<self> call\no<self> endsub\n")
status, found, err = moves("loop.ngc")
t.check(status == 2 and "self.ngc:2:" in err, "one that calls itself ends", err)

# Runs have the same setpoints as the program written for takt.
t.write("same.ngc", "G21 G90 F600\nG0 X1\nG1 Y2\nG4 P0.5\nG2 X2 I0.5 J0\nM2\n")
t.write("same.nc", "G21 G90 F600\n$H\nG0 X1\nG1 Y2\nG4 P0.5\nG2 X2 I0.5 J0 K0\nM2\n")
digests = [[line for line in t.run("run", name)[1].splitlines() if "digest" in line] for name in ("same.ngc", "same.nc")]
t.check(digests[0] == digests[1] and digests[0], "the same setpoints", digests)

# Turning cycles of Fanuc: what roughing leaves, finishing takes; the blocks of the profile are passed over.
t.write("turning.nc", """\
%
O1
G50 S2000
G21 G97 S500 M3
G0 X20. Z2.
G71 P10 Q20 U1. W0. D2. F0.2
N10 G0 X6. Z2.
G1 Z-10.
N20 X20.
G70 P10 Q20
G0 X30.
M30
%
""")
status, found, err = moves("turning.nc", "--tools", "auto")
ways = [line.split()[0:4:3] + [line.split()[1]] for line in found if line.startswith(("feed", "rapid"))]
cuts = [(way[2], way[1]) for way in ways if way[0] == "feed"]
t.check(status == 0 and cuts[0] == ("X10.000000", "Z-9.500000") and ("X3.500000", "Z-9.500000") in cuts
        and ("X3.000000", "Z-10.000000") in cuts and ways[-1][2] == "X15.000000", "Fanuc's G71 and G70", ways, err)

# A feed, and a number for a name, that the machine file gives.
t.write("bare.nc", "G1 X#far\n")
status, found, err = moves("bare.nc")
t.check(status == 2 and "--set values.FAR=0" in err, "the message names the value", err)
status, found, err = moves("bare.nc", "--set", "values.FAR=4")
t.check(status == 2 and "--set codes.F=600" in err, "the message names the feed", err)
status, found, err = moves("bare.nc", "--set", "values.FAR=4", "--set", "codes.F=300")
t.check(status == 0 and found[0].startswith("feed X4.000000") and found[0].endswith("F300.000000"), "both", found, err)

# Without end by M99: read for long enough.
t.write("ever.nc", "G0 X1\nX0\nM99\n")
status, found, err = moves("ever.nc", "--lines-max", "30")
t.check(status == 0 and "warning: the program goes back to its beginning for ever (M99); it was read for 30 lines" in err
        and found[-1] == "end", "M99 for ever", found, err)

# Passes of lathes: G90, G92 and G94 end where they began, and hold until another motion.
t.write("passes.nc", """\
O1
G50 S2000
G97 S500 M3
G0 X50. Z2.
G90 X45. Z-20. F0.2
U-10.
/X30.
G0 U10. W3.
G92 X44.8 Z-15. F2.
G92 U-20. W-30. R-3.
G94 X10. Z-2. R0 F0.1
G0 Z50.
M30
""")
status, found, err = moves("passes.nc", "--dialect", "fanuc", "--block-delete")
ways = [tuple(line.split()[i] for i in (0, 1, 3)) for line in found if line.startswith(("rapid", "feed", "thread"))]
t.check((status, err) == (0, "") and ways == [
    ("rapid", "X25.000000", "Z2.000000"),
    ("rapid", "X22.500000", "Z2.000000"), ("feed", "X22.500000", "Z-20.000000"), ("feed", "X25.000000", "Z-20.000000"),
    ("rapid", "X25.000000", "Z2.000000"),
    ("rapid", "X20.000000", "Z2.000000"), ("feed", "X20.000000", "Z-20.000000"), ("feed", "X25.000000", "Z-20.000000"),
    ("rapid", "X25.000000", "Z2.000000"), ("rapid", "X30.000000", "Z5.000000"),
    ("rapid", "X22.400000", "Z5.000000"), ("thread", "X22.400000", "Z-15.000000"), ("rapid", "X30.000000", "Z-15.000000"),
    ("rapid", "X30.000000", "Z5.000000"),
    ("rapid", "X17.000000", "Z5.000000"), ("thread", "X20.000000", "Z-25.000000"), ("rapid", "X30.000000", "Z-25.000000"),
    ("rapid", "X30.000000", "Z5.000000"),
    ("rapid", "X30.000000", "Z-2.000000"), ("feed", "X5.000000", "Z-2.000000"), ("feed", "X5.000000", "Z5.000000"),
    ("rapid", "X30.000000", "Z5.000000"), ("rapid", "X30.000000", "Z50.000000")], "passes of lathes", ways, err)
leads = [line.split()[-1] for line in found if line.startswith("thread")]
t.check(leads == ["F2.000000rev", "F2.009975rev"], "the lead along a cone is measured along its axis", leads)

# Threads of Fanuc's G76, from outside and inside, as far as X says, and from the crest itself.
for begin, ground, ways in (20, 17.6, {10, 10.0}), (22, 17.6, {11, 10.0}), (15, 20, {7.5}):
    t.write("thread.nc", f"O1\nG50 S900\nG97 S500 M3\nG0 X{begin} Z2.\n"
            f"G76 P010060 Q100 R.05\nG76 X{ground} Z-20. P1200 Q400 F1.5\nM30\n")
    status, found, err = moves("thread.nc", "--dialect", "fanuc")
    cuts = [float(line.split()[1][1:]) for line in found if line.startswith("thread")]
    deepest = max(cuts) if ground > begin else min(cuts)
    t.check(status == 0 and abs(deepest - ground / 2) < 1e-6, "a thread goes as deep as X says", begin, ground, cuts, err)
t.write("thread.nc", "O1\nG50 S900\nG97 S500 M3\nG0 X19 Z2.\nG76 P010060 Q100 R.05\nG76 X17.6 Z-20. P1200 Q400 F1.5\nM30\n")
status, found, err = moves("thread.nc", "--dialect", "fanuc")
t.check(status == 2 and "thread.nc:6:1: error: the program ends itself:G76 begins below its crest" in err, "from below it", err)

# Holes: R and Z stay where they are with G91, in subprograms too; L0 and K0 make none.
t.write("holes.nc", """\
O1
G90 G54.1 P1
G0 X0 Y0 Z20
G99 G81 Z-10. R2. F100 K0
X1
M98 P100
G80
M30
O100
G91 X10. K2
G90 X50
M99
""")
status, found, err = moves("holes.nc", "--dialect", "fanuc")
holes = [tuple(line.split()[1:4]) for line in found if line.startswith("feed")]
t.check(status == 0 and holes == [(f"X{x}.000000", "Y0.000000", "Z-10.000000") for x in (1, 11, 21, 50)], "holes", found, err)

# Jumps to a number that is worked out, and to lines behind a slash or a comment.
t.write("goto.nc", "O1\n#1=20\nGOTO #1\nN10 G0 X1\n/N20 G0 X6\nGOTO 30\nX9\n(c)N30 X7\nM30\n")
status, found, err = moves("goto.nc")
t.check(status == 0 and found == [rapid(6), rapid(7), "end"], "jumps", found, err)
t.write("goto.nc", "O1\n#1=20\nGOTO[#1+1]\nN20 M30\n")
status, found, err = moves("goto.nc")
t.check(status == 2 and "goto.nc:3:1: error: the program ends itself:GOTO: no line has this N" in err, "a jump to nowhere", err)

# Mistakes are told by what stands in the program.
for text, message in (("G0 X1\nEND2\n", "2:1: error: END2: no DO2 is open here"),
                      ("DO1\nG0 X1\n", "1:1: error: DO1 has no END1 in this program"),
                      ("G50 S9\nG90 X5.\n", "2:1: error: G90 on a lathe is a cycle and needs X or U, and Z or W"),
                      ("G50 S9\n  G73 U3. R3\n", "2:3: error: 'G73', a profile that is repeated, is not supported: G71 is")):
    t.write("wrong.nc", text)
    status, found, err = moves("wrong.nc", "--dialect", "fanuc")
    t.check(status == 2 and err.startswith(f"wrong.nc:{message}\n"), message, err)

# What a translation leaves out is among the warnings that are counted.
t.write("spline.gcode", "M104 S200\nG1 X1 F100\nG5 I0 J3 P0 Q-3 X6 Y5\n")
status, out, err = t.run("check", "spline.gcode")
t.check(status == 0 and ": no errors, 1 warning; " in out and "'G5'" not in err, "one warning, and a spline", out, err)
t.finish()
