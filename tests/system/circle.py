"""takt circle: play, friction, geometry and correction show in the figures as formulas say; files and words."""

import xml.etree.ElementTree

import takt_test as t

RUB = ("--set", "drive.1.coulomb_friction_nm=0.3", "--set", "drive.2.coulomb_friction_nm=0.3")


def figures(*options):
    status, out, err = t.run("circle", "--json", "circle.json", *options)
    t.check(status == 0 and err == "", f"circle {' '.join(options)}", status, err)
    return t.load_json("circle.json")


def um(test, way, key):
    return 1000 * test[way][key]


plain = figures()
t.check(plain["plane"] == "XY" and plain["radius_mm"] == 50 and plain["feed_mm_min"] == 3000, "R 50 and F3000 in XY", plain)
t.check(um(plain, "both", "deviation_mm") < 0.05, "a machine without errors goes around a circle", plain["both"])

# Play of X is a step of as much where X turns round: out on one way, in on the other. Y has none.
play = figures("--set", "drive.1.backlash_mm=0.005")
for way, sign in (("ccw", 1), ("cw", -1)):
    for quadrant, wanted in ((0, 5), (1, 0), (2, 5), (3, 0)):
        step = 1000 * play[way]["reversals"][quadrant]["step_mm"]
        t.check(abs(step - sign * wanted) < 1.2, f"step of {wanted} um at reversal {quadrant}, {way}", step)

# Dry friction: spikes outwards, as large on both ways.
rubbed = figures(*RUB)
for quadrant in range(4):
    spikes = [1000 * rubbed[way]["reversals"][quadrant]["spike_mm"] for way in ("ccw", "cw")]
    t.check(min(spikes) > 20 and abs(spikes[0] - spikes[1]) < 0.1, f"friction shows at reversal {quadrant}", spikes)

# Out of square by s: an oval of R s at 45 degrees, so G = R s.
square = figures("--set", "geometry.squareness_urad=100 0 0")
t.check(abs(um(square, "both", "deviation_mm") - 5) < 0.05, "100 urad out of square are 5 um at R 50", square["both"])

# Every plane, another centre, every kind of drive.
for plane in ("ZX", "YZ"):
    t.check(um(figures("--plane", plane, "--centre=-20,30", "--radius", "30"), "both", "deviation_mm") < 0.1, f"plane {plane}")
stepped = figures("--set", "axis.X.drive_type=step", "--radius", "20", "--feed", "1000")
t.check(um(stepped, "both", "deviation_mm") < 2, "a step drive beside a servo drive", stepped["both"])

# A step drive's axis is where its steps have brought it, also on a machine with errors.
mixed = figures("--set", "axis.X.drive_type=step", "--radius", "20", "--feed", "1000", "--set", "geometry.squareness_urad=100 0 0")
t.check(1.9 < um(mixed, "both", "deviation_mm") < 4, "100 urad at R 20 are 2 um, and up to two steps more", mixed["both"])

# The picture, and standard output.
t.check(t.run("circle", *RUB, "-o", "circle.svg")[0] == 0, "a picture is written")
lines = [e for e in xml.etree.ElementTree.parse("circle.svg").iter() if e.tag.endswith("polyline")]
t.check(len(lines) == 2 and all(len(e.get("points").split()) > 3000 for e in lines), "with both ways in it", len(lines))
status, out, err = t.run("circle", "--json", "-")
t.check(status == 0 and out.startswith("{") and err == "", "- is standard output", out[:80], err)
t.check("circular deviation G" in t.run("circle")[1] and t.run("circle", "--quiet")[1] == "", "figures are printed, or not")

# The feed that figures are of: what the limits leave of --feed on a small circle is told. v^2/R = 1000 mm/s2 is F1897 at R 1.
status, _, err = t.run("circle", "--radius", "1", "--json", "small.json")
reached = t.load_json("small.json")["feed_reached_mm_min"]
t.check(status == 0 and f"F3000 is not reached: the limits of axes and path leave F{reached:.6g}" in err and 1500 < reached < 1898, "a feed that is not reached", status, err)
t.check(abs(plain["feed_reached_mm_min"] - 3000) < 1e-6, "and one that is", plain)
status, _, err = t.run("circle", "-o", "both", "--json", "both")
t.check(status == 2 and "--output and --json name the same file" in err, "two outputs in one file are refused", status, err)

# A tolerance for CI, and what cannot be run.
status, _, err = t.run("circle", *RUB, "--tolerance", "0.01")
t.check(status == 1 and "above --tolerance" in err, "beyond the tolerance: status 1", status, err)
t.check(t.run("circle", *RUB, "--tolerance", "0.1")[0] == 0, "within it: 0")
for words, told in (
    (("--plane", "XZ"), "XY, ZX or YZ is expected"),
    (("--centre", "3"), "two coordinates are expected"),
    (("--radius", "9000"), "circle.ngc:2"),
    (("--feed", "0"), "--feed"),
    (("-o", "no/folder/circle.svg"), "no/folder"),
):
    status, _, err = t.run("circle", *words)
    t.check(status in (2, 3) and told in err, f"refused: {' '.join(words)}", status, err)
t.finish()
