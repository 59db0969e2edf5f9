"""takt bore: its programs run, carry the figures of the page, and what cannot be milled is refused."""

import os
import re
import xml.etree.ElementTree

import takt_test as t

HOLE = "--hole", "200", "--cutter", "40"
ROUGH = (*HOLE, "--step", "4", "--allowance", "1")
WIDE = "--hole", "30", "--cutter", "20"
SMALL = "--hole", "30", "--cutter", "10", "--step", "2.5", "--allowance", "0.2"


def bore(*options):
    status, out, err = t.run("bore", *options)
    t.check(status == 0 and err == "", f"bore {' '.join(options)}", status, err)
    return out


def summary_of(program, *options):
    t.write("bore.ngc", program)
    status, _, err = t.run("run", "bore.ngc", "--json", "run.json", "--quiet", *options)
    t.check(status == 0, "every check held", err, program[:400])
    return t.load_json("run.json")


# The page's numbers.
rough = bore(*ROUGH)
for figure in ("R 79,", "n 20,", "H 3.95,", "r 0.628662025,", "involute 4963.71639 mm", "circle 496.371639 mm"):
    t.check(figure in rough, f"roughing: {figure}", rough)
t.check("\nG3.2 X0 Y-79 I-0.628662025 J0 R0.628662025\nG3 X0 Y-79 I0 J79\n" in rough, "roughing moves", rough)
t.check("S" not in rough.split("G94")[1] and "M3" not in rough, "no spindle words unless asked for", rough)
finish = bore(*HOLE, "--pass", "finishing", "--start", "-40,40", "--turns", "2")
for figure in ("R 80,", "r 6.36619772,", "psi 0.946567", "phi0 9.0448", "involute 242.2497", "circle 502.6548", "57.58107"):
    t.check(figure in finish, f"finishing: {figure}", finish)
t.check("G0 X-40 Y40\n" in finish and "G3.2 X64.9131188" in finish and "Y-46.7577480" in finish, "finishing moves", finish)
for other in (("--start-radius", "57.5810791999"), ("--start-length", "242.2497265")):
    same = bore(*HOLE, "--pass", "finishing", *other, "--turns", "2")
    t.check("phi0 9.044814" in same, f"the same approach by {other[0]}", same)

# The programs run. Lengths: per depth, and lines and arcs as long as what they replace.
summary = summary_of(bore(*SMALL))
length = float(re.search(r"involute ([\d.]+) mm", bore(*SMALL))[1])
circle = 2 * 3.141592653589793 * 9.8
t.check(abs(summary["path_length_mm"] - length - circle - 9.8) < 1e-6, "spiral, circle and back to the centre", summary["path_length_mm"])
both = bore(*SMALL, "--pass", "both", "--depth", "7", "--depth-step", "3", "--spindle", "8000", "--feed", "1200", "--plunge", "200")
t.check(both.count("G3.2") == 9, "three depths: roughing out, finishing out and in", both)
t.check(re.findall(r"G1 Z(-?[\d.]+) F200", both) == ["-2.333333333", "-4.666666667", "-7"] * 2, "equal depths", both)
t.check("M3 S8000\n" in both and both.endswith("G0 Z2\nM5\nM2\n") and "\nF1200\n" in both, "spindle and feed", both)
exact = summary_of(both)
for form in ("arcs", "lines"):
    program = bore(*SMALL, "--pass", "both", "--depth", "7", "--depth-step", "3", "--as", form, "--tolerance", "0.001")
    t.check("G3.2" not in program and ("G3 " in program) == (form == "arcs"), f"as {form}", program[:300])
    summary = summary_of(program)
    t.check(abs(summary["path_length_mm"] / exact["path_length_mm"] - 1) < 1e-3, f"as long as {form}", summary["path_length_mm"])

# Roughing from a place that is open already, and in another direction.
opened = bore(*SMALL, "--start", "3,4")
t.check("G0 X3 Y4\n" in opened and summary_of(opened)["path_length_mm"] < summary["path_length_mm"], "roughing from a start", opened)
turned = bore(*SMALL, "--direction", "90")
t.check("G3.2 X9.8 Y0 I0" in turned, "out in another direction", turned)
summary_of(turned)

# A helix: a turn for each depth, then the circle at the bottom.
helix = bore(*WIDE, "--as", "helix", "--depth", "6", "--depth-step", "2.5")
t.check(re.findall(r"^G3 X0 Y-5( Z-\d)? I0 J5$", helix, re.M) == [" Z-2", " Z-4", " Z-6", ""], "turns of a helix", helix)
expected = 3 * ((10 * 3.141592653589793) ** 2 + 4) ** 0.5 + 10 * 3.141592653589793 + 5 + 5 + 2 + 2 + 6 + 2
t.check(abs(summary_of(helix)["path_length_mm"] - expected) < 1e-6, "as long as it is", summary_of(helix)["path_length_mm"], expected)
both = bore(*WIDE, "--as", "helix", "--depth", "6", "--allowance", "0.3", "--pass", "both")
t.check("a helix, R 4.7" in both and both.count("G3.2") == 2, "finished by involutes", both)

# A file is written whole, or not at all.
bore(*ROUGH, "-o", "rough.ngc")
t.check(open("rough.ngc").read() == rough, "-o writes what standard output gets")
bore(*ROUGH, "--output=again.ngc")
t.check(open("again.ngc").read() == rough, "--output is the same")

for words, said in (
    (("--hole", "30"), "the cutter's diameter is 0 mm"),
    (("--cutter", "30", "--step", "1"), "the hole's diameter is 0 mm"),
    (("--hole", "30", "--cutter", "30", "--step", "1"), "not smaller than the hole"),
    (("--hole", "-30", "--cutter", "3", "--step", "1"), "--hole -30"),
    (("--hole", "30", "--cutter", "3", "--step", "0"), "the radial step is 0 mm"),
    (("--hole", "30", "--cutter", "3", "--step", "-1"), "--step -1"),
    (("--hole", "30", "--cutter", "3", "--step", "x"), "--step x"),
    (("--hole", "30", "--cutter", "10", "--step", "1", "--allowance", "10"), "leaves nothing to mill"),
    ((*HOLE, "--pass", "finishing", "--start", "80,0"), "must be inside the circle of 80 mm"),
    ((*HOLE, "--pass", "finishing", "--start", "8"), "--start 8: X,Y"),
    ((*HOLE, "--pass", "finishing", "--start", "8,"), "--start 8,: X,Y"),
    ((*HOLE, "--pass", "finishing", "--start", "8,9x"), "--start 8,9x: X,Y"),
    ((*HOLE, "--pass", "finishing", "--start", "nan,0"), "--start nan,0: X,Y"),
    ((*HOLE, "--pass", "finishing", "--turns", "1.5"), "--turns 1.5"),
    ((*HOLE, "--pass", "finishing", "--turns", "0"), "--turns 0: it must be above 0"),
    ((*ROUGH, "--as", "arcs", "--tolerance", "0"), "--tolerance 0: it must be above 0"),
    ((*ROUGH, "--depth", "9", "--depth-step", "0"), "--depth-step 0: it must be above 0"),
    ((*ROUGH, "--feed", "0"), "--feed 0: it must be above 0"),
    ((*HOLE, "--pass", "finishing", "--start", "1,1", "--start-radius", "9"), "only one of"),
    ((*ROUGH, "--turns", "2"), "--turns is of the finishing pass"),
    ((*ROUGH, "--start", "79,0"), "must be inside the circle of 79 mm"),
    ((*HOLE, "--as", "helix", "--depth", "5"), "a helix of radius 80 mm leaves a core: the cutter of 40 mm must be at least 100 mm"),
    ((*WIDE, "--as", "helix"), "a helix goes down: it needs a depth"),
    ((*WIDE, "--as", "helix", "--depth", "5", "--start", "1,1"), "a helix begins on its circle"),
    ((*ROUGH, "--start", "1,1", "--compare"), "--compare begins at the centre"),
    ((*ROUGH, "--pass", "rough"), "--pass rough: roughing, finishing or both"),
    ((*ROUGH, "--as", "spline"), "--as spline: involute, arcs, lines or helix"),
    ((*ROUGH, "--as", "lines", "--tolerance", "1e-9"), "the tolerance is 1e-09 mm"),
    ((*ROUGH, "--depth-step", "2"), "needs --depth"),
    ((*ROUGH, "--pass", "both", "--compare"), "--compare is about roughing"),
    ((*ROUGH, "rough.ngc"), "one argument too many"),
):
    status, out, err = t.run("bore", *words, "-o", "none.ngc")
    t.check(status == 2 and out == "" and said in err, f"bore {' '.join(words)}: refused", status, out, err)
    t.check(not os.path.exists("none.ngc"), "and nothing written")
t.check(t.run("bore", *ROUGH, "-o", "no/such/folder/x.ngc")[0] == 3, "a file that cannot be created")

# Side by side, within the limits of the machine.
out = bore(*SMALL, "--feed", "6000", "--compare", "-o", "spirals.svg", "--set", "axis.X.max_jerk_mm_s3=30000")
rows = re.findall(r"^  (.+?)  +([\d.]+) +([\d.]+) +([\d.]+) +([\d.]+) % +([\d.]+) +([\d.]+) %$", out, re.M)
t.check(len(rows) == 4 and rows[0][0] == "involute", "four spirals", out)
for name, time_s, _, acceleration, _, jerk, percent in rows:
    t.check(float(time_s) > 0 and float(acceleration) <= 1000.1 and float(jerk) <= 50050, f"{name}: within the limits", out)
    t.check(abs(float(jerk) / 300 - float(percent)) < 0.1, f"{name}: per cent of the smaller limit", out)
length = float(re.search(r"involute ([\d.]+) mm", bore(*SMALL))[1]) + circle
t.check(abs(float(rows[0][2]) / length - 1) < 1e-3, "the involute's length", rows[0], length)
t.check("15 mm" in out.splitlines()[-1], "what a helix would need", out)
removed = dict(re.findall(r"^  (\S.+?)  +([\d.]+ .. +[\d.]+ .*)$", out, re.M))
layer = {name: [float(x) for x in re.findall(r"[\d.]*\d", words)] for name, words in removed.items()}
step = 9.8 / 4
for name in ("involute", "semicircles, 2 poles", "quarter circles, 4 poles"):
    t.check(max(abs(x / step - 1) for x in layer[name][:2]) < 2e-3, f"{name}: a layer as thick as a step, everywhere", out)
t.check(layer["Archimedean spiral"][0] < 0.95 * step, "Archimedes' spiral takes less where it is steep", out)
t.check(all(row[3] > 1.3 * row[2] for row in layer.values()), "the load of none is even: the wall is longer where it bends more", out)
wide = bore(*WIDE, "--step", "1", "--depth", "3", "--feed", "6000", "--compare")
t.check(len(re.findall("^  helix ", wide, re.M)) == 2 and "not among them" not in wide, "a helix where the cutter is wide enough", wide)
helix = [float(x) for x in re.findall(r"[\d.]*\d", re.findall(r"^  helix (.*\.\..*)$", wide, re.M)[0])]
t.check(all(abs(x / 22.5 - 1) < 0.02 for x in helix[2:4]), "its chip area is even: 15 mm squared by 2 times 5 mm", wide)
t.check(helix[5] - helix[4] < 1 and helix[1] - helix[0] < 0.05, "so are its layer and its engagement", wide)
t.check("180.00 deg are engaged" in wide, "though a level is cut by the whole front first", wide)

# What the source claims of the involute, on holes beside its own: even is the layer, and as even that of joined arcs; the load is not.
for words in (("--hole", "60", "--cutter", "25", "--step", "2.5"), ("--hole", "60", "--cutter", "40", "--step", "2"),
              ("--hole", "100", "--cutter", "16", "--step", "1.5"), ("--hole", "200", "--cutter", "40", "--step", "4", "--allowance", "1")):
    out = bore(*words, "--feed", "6000", "--compare")
    row = {name: [float(x) for x in re.findall(r"[\d.]*\d", text)] for name, text in re.findall(r"^  (\S.+?)  +([\d.]+ .. +[\d.]+ .*)$", out, re.M)}
    even = [row[name][1] / row[name][0] for name in ("involute", "semicircles, 2 poles", "quarter circles, 4 poles")]
    t.check(max(even) < 1.003 < 1.04 < row["Archimedean spiral"][1] / row["Archimedean spiral"][0], f"{words}: the layer of all but Archimedes is even", out)
    t.check(all(r[3] > 2.4 * r[2] and r[5] > 1.6 * r[4] for r in row.values()), f"{words}: the load of none is", out)
t.check("it needs --depth" in bore(*WIDE, "--step", "1", "--compare"), "what it needs besides")
picture = xml.etree.ElementTree.parse("spirals.svg").getroot()
t.check(picture.tag.endswith("svg") and len(picture.findall(".//{*}polyline")) == 20, "the picture: four paths, sixteen curves")
status, out, err = t.run("bore", *SMALL, "--compare", "-o", "-")
t.check(status == 0 and out.startswith("<svg") and "Archimedean" in err, "a picture on standard output", err)

# What cannot be run is not written: each program that is made is one that takt reads.
for radius in (0.00005, 0.001, 0.0014, 0.02, 8):
    for turns in (1, 40, 700, 7500, 7501):
        for form in ("involute", "arcs", "lines") if turns < 1000 else ("involute",):
            words = "--pass", "finishing", "--hole", repr(20 + 2 * radius), "--cutter", "20", "--turns", str(turns), "--as", form
            status, out, err = t.run("bore", *words, "-o", "made.ngc")
            t.check(status == 0 or status == 2 and ("of it, and controllers take" in err or "--turns 7501" in err), "a hole is refused for a reason", words, err)
            t.check(status != 0 or t.run("check", "made.ngc")[0] == 0, "a program can be read", words)
            t.check(status == 0 or radius < 0.0014 or turns > 7500 or form == "arcs", "and most can be made", words, err)
t.finish()
