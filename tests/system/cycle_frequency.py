"""takt cycle-frequency: the figures of the page, the diagrams, and every mistake refused."""

import re
import xml.etree.ElementTree as xml

import takt_test as t


def needed(*arguments):
    status, out, err = t.run("cycle-frequency", *arguments)
    found = re.search(r"needed +([\d.]+) Hz", out)
    t.check(status == 0 and found, f"{arguments} is answered", status, err)
    return float(found[1]) if found else 0.0, out


# The machines of the page, with the digits it gives, and what governs them.
for name, frequency in (("6R13GN1", 111), ("FP7M", 122), ("FP7SMN", 157), ("MA655SM30A", 297), ("MA655 X", 177), ("16K20F3", 313)):
    hertz, out = needed("--machine", name)
    t.check(abs(hertz - frequency) < 0.55, f"{name} needs {frequency} Hz", hertz)
    t.check(needed("--machine", name.lower())[1] == out, f"{name} in small letters")
t.check("feed and jerk" in needed("--machine", "MA655SM30A")[1], "there jerk meets feed")

# Without a feed limit: 0.1 g and 5 m/s3, 1 g and 50 m/s3.
hertz, out = needed("--accel", "0.1g", "--jerk", "5")
t.check(round(hertz) == 350 and "11540.4 mm/min" in out, "0.1 g needs 350 Hz", out)
hertz, out = needed("--accel", "1g", "--jerk", "50")
t.check(round(hertz) == 1107 and "115404 mm/min" in out, "1 g needs 1107 Hz, not the 1170 printed", out)
t.check(needed("--accel", "9806.65", "--jerk", "50")[0] == hertz, "1 g is 9806.65 mm/s2")

# A machine without published limits is taken with those that are given.
for name in ("UCP710", "mikron ucp 710"):
    status, out, err = t.run("cycle-frequency", "--machine", name, "--jerk", "5")
    t.check(status == 2 and "not published" in err and "--feed-max" in err, f"{name} has no limits", err)
    given = needed("--machine", name, "--feed-max", "6000", "--accel", "0.1g", "--jerk", "5")
    t.check(given[0] == needed("--machine", "MA655SM30A")[0], f"{name} with limits of its own", given)

# Limits given replace the machine's, and the tolerance is an increment unless it is given.
t.check(needed("--machine", "MA655SM30A", "--feed-max", "9000")[0] > 310, "--feed-max replaces the machine's feed")
fine = needed("--accel", "0.1g", "--jerk", "5", "--resolution", "4000")
t.check(fine == needed("--accel", "0.1g", "--jerk", "5", "--resolution", "4000", "--tolerance", "0.00025"),
        "the tolerance is one increment")
t.check(abs(fine[0] - 2 * 350.1) < 1, "a quarter of the tolerance needs twice the frequency", fine[0])

# The table: rows from the tolerance on, none with a frequency that is no number, and none above what is needed.
hertz, out = needed("--machine", "16K20F3", "--radius-table", "--frequency", "200")
rows = [row.split() for row in out.split("R [mm]")[1].splitlines()[1:] if row]
t.check(len(rows) > 12 and float(rows[0][0]) == 0.001 and float(rows[0][2]) == 0, "the table begins at the tolerance", out)
t.check(all(0 <= float(row[2]) <= hertz + 0.1 for row in rows), "no circle needs more", out)
t.check("too slow" in out, "200 Hz are too slow for it", out)
radius = rows[9]
step_mm = float(radius[1]) / 60 / 200
t.check(abs(step_mm**2 / 8 / float(radius[0]) / float(radius[4]) - 1) < 0.02, "the chord error is h^2 / 8R", radius)

# A machine file: its limits, resolution and cycle.
hertz, out = needed()
t.check(abs(hertz - 353.8) < 0.1 and "1000 Hz: enough" in out, "the built-in mill", out)
mill = t.write("mill.ini", "[machine]\ncycle_us = 4000\n[axis X]\n[axis Y]\nmax_acceleration_mm_s2 = 500\n")
hertz, out = needed("--machine", mill)
t.check(abs(hertz - 251.3) < 0.1 and "250 Hz: too slow" in out, "of two axes the slower one counts", out)

# The controller says the same when it starts; the chord error holds all the same.
program = t.write("circle.ngc", "F6000\nG2 I20\nM2\n")
status, _, err = t.run("run", program, "--set", "machine.cycle_us=5000", "--json", "slow.json")
t.check(status == 0 and "warning: the control cycle of 200 Hz is below the 353.8 Hz" in err, "a slow cycle is told", err)
with open("slow.json") as file:
    summary = t.json.load(file)
t.check(0 < summary["chord_error_max_mm"] <= 0.001 + 1e-6, "its chord error holds", summary["chord_error_max_mm"])
status, _, err = t.run("run", program, "--quiet")
t.check(status == 0 and err == "", "a cycle that is short enough is not told of", err)

# The diagrams: three files of well-formed SVG with their curves, and one page with all.
status, out, err = t.run("cycle-frequency", "--machine", "MA655SM30A", "--svg", "d", "--html", "d.html", "--quiet")
t.check(status == 0 and out == "", "files alone", status, err)
SVG = "{http://www.w3.org/2000/svg}"
for name, curves, words in (
    ("chord-error", 6, ("R 0.25 mm", "R 5 mm", "control frequency [Hz]")),
    ("allowed-feed", 9, ("0.01 g", "10 g", "J 5", "J 5000", "machine", "radius [mm]")),
    ("needed-frequency", 14, ("R 1", "0.1 g", "J 50", "machine", "feed [mm/min]")),
):
    root = xml.parse(f"d-{name}.svg").getroot()
    texts = [text.text for text in root.iter(SVG + "text")]
    lines = [line for line in root.iter(SVG + "polyline") if line.get("points")]
    t.check(len(lines) == curves, f"{name} has {curves} curves", len(lines))
    t.check(all(word in texts for word in words), f"{name} is labelled", texts)
page = open("d.html", encoding="utf-8").read()
t.check(page.count("<svg") == 3 and "297.3 Hz" in page and "http" not in page.replace("http://www.w3.org/2000/svg", ""),
        "the page has all three and needs no other file")

for words, said in (
    (["--feed-max", "0"], "above 0"),
    (["--accel", "-3"], "above 0"),
    (["--accel", "1x"], "or one followed by g"),
    (["--accel", "g"], "a number is expected"),
    (["--jerk", "nan", "--accel", "1"], "a number is expected"),
    (["--jerk", "5"], "--feed-max or --accel"),
    (["--tolerance", "0"], "above 0"),
    (["--resolution", "fine"], "a number is expected"),
    (["--frequency", "-1"], "above 0"),
    (["--machine", "MA655SM30B"], "did you mean MA655SM30A?"),
    (["--machine", "nothing.ini"], "neither a file"),
    (["--set", "axis.X.max_jerk_mm_s3=0"], "above 0"),
    (["--html", "no/such/folder.html"], "no/such"),
    (["part.ngc"], "too many"),
):
    status, out, err = t.run("cycle-frequency", *words)
    t.check(status in (2, 3) and said in err, f"{' '.join(words)}: refused", status, err)
t.finish()
