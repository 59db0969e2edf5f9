"""takt correct: what each kind of line becomes, what is refused, and that the machine comes to the same places."""

import math
import os
import re

import takt_test as t

SPAN = range(-300, 301, 100)


def bend(x, y, z):
    """Corrections in um that differ from place to place."""
    return (20 * math.sin(0.01 * x + 0.004 * y), 15 * math.cos(0.008 * y - 0.005 * z), 12 * math.sin(0.009 * z + 0.006 * x))


ROWS = [(x, y, z) + bend(x, y, z) for z in SPAN for y in SPAN for x in SPAN]
TABLE = t.write(
    "volume.csv", "X_mm,Y_mm,Z_mm,KX_um,KY_um,KZ_um\n" + "".join(",".join(f"{v:.5f}" for v in row) + "\n" for row in ROWS)
)


def correct(program, *options):
    return t.run("correct", t.write("part.ngc", program), "--table", TABLE, *options)


def corrected(program, *options):
    status, out, err = correct(program, *options)
    t.check(status == 0, "a program is corrected", err)
    return out.splitlines(), err


def words(line):
    return {letter: float(value) for letter, value in re.findall(r"([A-Z])(-?[0-9.]+)", re.sub(r"\(.*?\)", "", line))}


def near(a, b, tolerance=0.1):
    return abs(a - b) < tolerance


def refused(program, *parts):
    status, out, err = correct(program, "-o", "refused.ngc")
    t.check(status == 2 and out == "" and not os.path.exists("refused.ngc"), f"{program!r} is refused", status, err)
    for part in parts:
        t.check(part in err, f"the message says {part}", err)


# ---- involutes stay involutes, in every plane

for code, plane, first, second in (("G17", "XY", "X", "Y"), ("G18", "ZX", "Z", "X"), ("G19", "YZ", "Y", "Z")):
    centre = {"X": "I", "Y": "J", "Z": "K"}
    lines, err = corrected(
        f"G21 G90 {code} F600\nG0 X0 Y0 Z0\nN7 G3.2 {first}0 {second}-40 {centre[first]}-0.636619772 {centre[second]}0 R0.636619772 (hole)\nM2\n"
    )
    pieces = [line for line in lines if "G3.2" in line]
    t.check(len(pieces) > 20 and lines[2].startswith("N7 G3.2") and "(hole)" in lines[2], f"{plane}: pieces of an involute", lines[2])
    t.check(all(near(words(line)["R"], 0.636619772, 0.01) for line in pieces), "with base circles near the programmed one")
    t.check(near(words(pieces[-1])[second], -40) and "Z" in words(pieces[-1]), "to the programmed end")

# ---- threads: whole, with their words

lines, err = corrected("G21 G90 F600 S300 M3\nG0 X0 Y0 Z5\nG33 Z-200 K1.5 (thread)\nZ-250 K1.5\nG33.1 Z-280 K1.25 I2 (tap)\nG0 X3\nM2\n")
t.check(lines[2].startswith("G33 X") and "(thread)" in lines[2] and len(lines) == 7, "a thread stays one line", lines)
t.check(0 < abs(words(lines[2])["K"] - 1.5) < 1e-3, "its pitch grows as its length does", lines[2])
t.check(lines[3].startswith("X") and words(lines[4])["I"] == 2 and "(tap)" in lines[4], "modal, and tapped", lines)
t.check(near(words(lines[5])["Z"], -250), "a tap ends where it began", lines[5])
t.check("part.ngc:3" in err and "threads are not divided" in err, "how far an undivided thread is off is said", err)
lines, _ = corrected("G21 G90 G18 S300 M3\nG0 X20 Y0 Z5\nG76 P1.5 Z-10 I-1 J0.2 K0.6 R1 H1 (all of it)\nM2\n")
t.check(sum(line.startswith("G33") for line in lines) == 4 and not any("G76" in line for line in lines), "G76 becomes its threads", lines)
t.check(lines.count("M50 P0") == lines.count("M50 P1") == 4, "which are not to be overridden", lines)

# ---- cycles: what the spindle does in them is written too

lines, _ = corrected("G21 G90 F600 S300 M3\nG84 X10 Y0 Z-5 R2 (tap)\nX20\nG86 X30 Z-4 R2 P0.5\nG80\nM2\n")
events = [line for line in lines if line in ("M3", "M4", "M5")]
t.check(events == ["M5", "M4", "M5", "M3"] * 2 + ["M5", "M3"], "tapping turns the spindle back, boring stops it", lines)
t.check("G4 P0.5" in lines and "(tap)" in lines[1], "dwells and comments are kept", lines)
lines, _ = corrected("G21 G90 F600\nG81 X10 Z-5 R2 M0\nM2\n")
t.check([line.lower() for line in lines[-2:]] == ["m0", "m2"], "a stop on a cycle's line comes after the cycle", lines)

# ---- references and offsets

lines, _ = corrected("G21 G90 F600\nG0 X100 Y100 Z50\nG28 Z90 (up)\nG1 X120\nG30\nG1 X0 Y0\nM2\n")
t.check(list(words(lines[2])) == ["G", "Z"] and words(lines[2])["Z"] != 90, "G28: the point on the way is corrected, other axes stay", lines[2])
t.check(lines[4] == "G30", "G30 alone stays as it is", lines[4])
lines, _ = corrected("G21 G90 F600\nG0 X100 Y100\nG92 X0 Y0\nG1 X10\nG92.1\nG10 L20 P1 X5\nG1 X10\nM2\n")
plain, _ = corrected("G21 G90 F600\nG0 X100 Y100\nG52 X100 Y100\nG1 X10\nG52 X0 Y0\nG10 L2 P1 X105\nG1 X10\nM2\n")
t.check(lines[2] != "G92 X0 Y0" and lines[2].startswith("G92 X0.0"), "G92 sets the offset it would set without correction", lines[2])
t.check(lines[3] == plain[3], "so that what follows is where it should be", lines[3], plain[3])
refused("G21 F600\nG0 X10\nG10 L20 P3 Z5\nM2\n", "part.ngc:3", "takes over where the machine stands")
refused("G21 F600\nG0 X10\nG28.1\nM2\n", "part.ngc:3")
refused("G21 F600\n#5161=5\nG28\nM2\n", "part.ngc:3", "set by this program")

# ---- what is not known before a program is run

refused("G21 F60\nG38.2 Z-5\nG1 X1\nM2\n", "part.ngc:2", "probing")
lines, err = corrected("G21 F60\nM66 P0 L3 Q5\nG1 X1\nM2\n")
t.check(lines[1] == "M66 P0 L3 Q5" and "part.ngc:2" in err and "M66" in err, "an input is passed on with a warning", err)
t.check("G41" in corrected("G21 F600\nG41.1 D4\nG1 X20\nX40\nG40 G1 X60\nM2\n")[1], "compensated contours bring a warning")

# ---- layers switched by the program: the next motion leads over

lines, err = corrected("G21 G90 F600\nG0 X100\nM121\nG1 X200\nG1 X250\nM120\nG1 X260 Y5\nM2\n", "--tolerance", "0.001")
t.check(lines[4] == "G1 X250 Y0 Z0" and words(lines[6])["X"] != 260, "M121 takes correction out, M120 brings it back", lines)

# ---- feeds: inverse time goes by the length of the pieces

lines, _ = corrected("G21 G90 G17\nG0 X0 Y0\nG93 G3.2 X0 Y-40 I-0.636619772 J0 R0.636619772 F0.5\nG94 F600 G1 X0 Y0\nM2\n")
rates = [words(line)["F"] for line in lines if "G3.2" in line]
t.check(near(sum(1 / rate for rate in rates), 2, 1e-6) and rates[0] > 10 * rates[-1], "the pieces take the time of the whole", rates)

# ---- a stream does the same

STREAM = "G21 G90 F600 S300 M3\nG0 X100\nG92 X0\nG33 Z-20 K1\nG84 X9 Z-30 R-25\nG80\nG28 Z0\nG1 X5\nM2\n"
whole, _ = corrected(STREAM)
status, out, err = t.run("correct", "-", "--filter", "--table", TABLE, text=STREAM.encode())
t.check(status == 0 and out.splitlines() == whole, "line by line", out, err)

# ---- wrong options

for options, part in (
    (("--tolerance", "0"), "tolerance"),
    (("--tolerance", "-1"), "tolerance"),
    (("--tolerance", "x"), "tolerance"),
    (("--table", "missing.csv"), "missing.csv"),
    (("--filter",), "standard input"),
    (("--tabel", "x"), "--table"),
):
    status, out, err = t.run("correct", "part.ngc", *options)
    t.check(status == 2 and part in err and out == "", f"{options} is refused", status, err)
t.check(t.run("correct")[0] == 2, "a program is needed")
status, out, err = t.run("correct", t.write("bare.ngc", "G1 F100 X5\nM2\n"))
t.check(status == 0 and "warning: nothing is corrected: name a table by --table" in err, "a program that nothing corrects is told", status, err)

t.finish()
