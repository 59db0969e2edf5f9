"""Position-error correction on a machine with real errors: calibrated, live, offline, and refused when tables are broken."""

import math
import os
import random

import takt_test as t

WORN = os.path.join(t.EXAMPLES, "worn_mill.ini")
POINTS = 150


def summary_of(program, *options):
    status, _, err = t.run("run", program, *options, "--json", "run.json", "--quiet")
    t.check(status == 0, f"{program} runs {options}", err)
    return t.load_json("run.json")


def travel(machine):
    status, text, _ = t.run("machine", machine)
    t.check(status == 0, "the machine file is good")
    low = [float(line.split("=")[1]) for line in text.splitlines() if line.startswith("travel_min_mm")]
    high = [float(line.split("=")[1]) for line in text.splitlines() if line.startswith("travel_max_mm")]
    return list(zip(low, high))


def random_points(count, limits):
    rng = random.Random(6)
    return [[rng.uniform(low, high) for low, high in limits] for _ in range(count)]


def visit(points, rest=0.12, code="G0"):
    lines = ["G21 G90 G4 P4"]
    for x, y, z in points:
        lines += [f"{code} X{x:.4f} Y{y:.4f} Z{z:.4f}", f"G4 P{rest}"]
    return t.write("visit.ngc", "\n".join(lines) + "\nM2\n")


def tool_points(program, *options):
    """Where the tool's point stood at each of the points; the first rest is the start."""
    status, _, err = t.run("run", program, *options, "--rests", "rests.csv", "--quiet")
    t.check(status == 0, f"{program} runs {options}", err)
    rests = t.read_trace("rests.csv")
    return list(zip(*(rests[f"tool_{axis}_mm"][1:] for axis in "XYZ")))


def errors_at_points(tool):
    wanted = [[round(value, 4) for value in point] for point in random_points(POINTS, travel(WORN))]
    t.check(len(tool) == POINTS, "every point is measured", len(tool))
    return [math.dist(a, b) for a, b in zip(wanted, tool)]


# ---- live: 21 errors of up to 60 um, a table of 9 x 7 x 6 points

status, _, err = t.run("calibrate", "--machine", WORN, "--grid", "9x7x6", "-o", "volume.csv")
t.check(status == 0, "the volume is measured", err)
TABLE = "--machine", WORN, "--set", "correction.volume_table=volume.csv"
program = visit(random_points(POINTS, travel(WORN)))
before = summary_of(program, "--machine", WORN)["tool_point"]
after = summary_of(program, *TABLE)["tool_point"]
print("tool point, um, before", before, "after", after)
t.check(before["rest_error_max_mm"] > 0.040, "the machine has errors of tens of micrometres", before)
t.check(after["rests"] >= POINTS, "every point is measured", after)
t.check(after["rest_error_max_mm"] <= 0.002, "live correction leaves 2 um at most", after)
t.check(after["rest_error_mean_mm"] <= 0.001, "and one increment in the mean", after)
status, _, err = t.run("correct", program, "--machine", WORN, "--table", "volume.csv", "-o", "visit-corrected.ngc", "--quiet")
t.check(status == 0, "a program of points is corrected", err)
offline = errors_at_points(tool_points("visit-corrected.ngc", "--machine", WORN))
live = errors_at_points(tool_points(program, *TABLE))
print("tool point off the points, um: live", 1e3 * max(live), "offline, on a controller without correction", 1e3 * max(offline))
t.check(abs(max(live) - after["rest_error_max_mm"]) < 1e-6, "what is written of each rest is what the summary tells", max(live), after)
t.check(all(abs(a - b) <= 0.001 for a, b in zip(live, offline)), "at each point the offline program is as good within 1 um", max(offline))
off = summary_of(program, *TABLE, "--set", "correction.off=volume")
t.check(off["correction_max_mm"] == 0, "a layer that the machine file switches off corrects nothing", off["correction_max_mm"])

# ---- limits and time of programs with the table

for name in sorted(os.listdir(t.EXAMPLES)):
    if name.endswith(".ngc"):
        path = os.path.join(t.EXAMPLES, name)
        tools = "--tools", os.path.join(t.EXAMPLES, "tools.tbl")
        plain = summary_of(path, "--machine", WORN, *tools)
        corrected = summary_of(path, *TABLE, *tools)
        t.check(all(check["held"] for check in corrected["checks"]), f"{name}: corrected setpoints keep all limits")
        growth = corrected["program_time_s"] / plain["program_time_s"] - 1
        t.check(growth < 0.02, f"{name}: takes less than 2 % longer", growth)

# ---- the program switches layers

t.write("switch.ngc", "G4 P4\nG0 X100\nG4 P4\nM121 P4\nG0 X101\nG4 P8\nM120\nG0 X100\nG4 P4\n")
status, _, err = t.run("run", "switch.ngc", *TABLE, "--trace", "switch.csv", "--quiet")
t.check(status == 0, "a program switches layers", err)
with open("switch.csv") as file:
    header = file.readline().strip().split(",")
    at = {name: i for i, name in enumerate(header)}
    k = {}
    for line in file:
        cells = line.split(",")
        k[int(cells[at["line"]])] = float(cells[at["set_X_mm"]]) - float(cells[at["cmd_X_mm"]])
t.check(abs(k[3]) > 1e-3 and k[6] == 0 and abs(k[9] - k[3]) < 1e-6, "M121 takes layer 4 out, M120 brings it back", k[3], k[6], k[9])
status, _, err = t.run("check", t.write("layer.ngc", "M121 P9\n"))
t.check(status == 2 and "layer.ngc:1:6" in err, "a layer that does not exist is an error", err)

# ---- single layers

PITCH = "--set", "geometry.exx=50 0 0 0 0", "--set", "geometry.eyy=-30 0 0 0 0"
MATRIX = "--set", "correction.matrix_x=-49.9975001e-6 0 0 0", "--set", "correction.matrix_y=0 30.0009e-6 0 0"
points = visit(random_points(30, [(-300, 300)] * 3))
before = summary_of(points, *PITCH)["tool_point"]["rest_error_max_mm"]
after = summary_of(points, *PITCH, *MATRIX)["tool_point"]["rest_error_max_mm"]
t.check(before > 0.010 and after < 2e-4, "a diagonal matrix removes a pitch error", before, after)

WARM = "--set", "geometry.growth_um_per_m_k=11 11 11", "--set", "geometry.warming_k=15", "--set", "geometry.warming_time_s=1", \
    "--set", "geometry.sensor_step_k=0.1"
THERMAL = "--set", "correction.thermal_um_per_m_k=11 11 11"
t.write("warm.ngc", "G0 X300 Y300 Z300\nG4 P30\nG0 X-300 Z100\nG4 P1\n")
before = summary_of("warm.ngc", *WARM)["tool_point"]["rest_error_max_mm"]
after = summary_of("warm.ngc", *WARM, *THERMAL)["tool_point"]["rest_error_max_mm"]
t.check(before > 0.080 and after < 2e-4, "the thermal layer removes growth by 15 K", before, after)

# Drives that do not overshoot: what they overshoot by, the play keeps.
STIFF = [f"--set=drive.{node}.{key}" for node in (1, 2, 3)
         for key in ("velocity_feed_forward_ratio=0", "velocity_integral_time_s=0", "viscous_friction_nm_s_per_rad=0")]
STIFF += [f"--set=axis.{axis}.max_velocity_mm_s=20" for axis in "XYZ"]
PLAY = "--set", "geometry.backlash_um=20 20 20", *STIFF
AXES = []
for axis in "XYZ":
    status, _, err = t.run("calibrate", *PLAY, "--axis", axis, "--grid", "5", "--from=-100", "--to=100", "-o", f"{axis}.csv")
    t.check(status == 0, f"axis {axis} is measured in both directions", err)
    AXES += ["--set", f"correction.axis_table_{axis.lower()}={axis}.csv"]
points = visit(random_points(25, [(-60, 60)] * 3), rest=1, code="G1 F1200")
before = summary_of(points, *PLAY)["tool_point"]["rest_error_max_mm"]
after = summary_of(points, *PLAY, *AXES)["tool_point"]["rest_error_max_mm"]
t.check(before > 0.015 and after < 1e-3, "backlash of 20 um vanishes at reversals", before, after)

WEAR = "--set", "geometry.wear_along_um_per_m=20"
t.write("wear.ngc", "F6000\n" + "G1 X100\nG1 X0\n" * 10 + "G4 P10\n")
before = summary_of("wear.ngc", *WEAR)["tool_point"]["rest_error_max_mm"]
after = summary_of("wear.ngc", *WEAR, "--set", "correction.wear_along_um_per_m=20")["tool_point"]["rest_error_max_mm"]
t.check(before > 0.035 and after < 2e-4, "a tool's wear is followed", before, after)

HEAD = t.write("head.ini", "".join(f"[axis {a}]\n" for a in "XYZB"))
t.write("head.ngc", "G0 B0\nF6000\n" + "G1 X100 B50\nG1 X0 B-70\n" * 10 + "G4 P10\nG0 B20\nG4 P1\n")
POINTS = "--machine", HEAD, "--set", "geometry.tool_direction=1 -2 0.5", "--set", "geometry.head_axis=B", *WEAR
FOLLOW = "--set", "correction.wear_along_um_per_m=20", "--set", "correction.tool_direction=1 -2 0.5"
before = summary_of("head.ngc", *POINTS, *FOLLOW)["tool_point"]["rest_error_max_mm"]
after = summary_of("head.ngc", *POINTS, *FOLLOW, "--set", "correction.head_axis=B")["tool_point"]["rest_error_max_mm"]
t.check(before > 0.01 and after < 2e-4, "and along a tool that a head turns", before, after)
for section in ("correction", "geometry"):
    for value, reason in (("tool_direction=0 0 0", "no direction"), ("head_axis=C", "no axis C")):
        status, _, err = t.run("run", "head.ngc", "--machine", HEAD, "--set", f"{section}.{value}")
        t.check(status == 2 and f"{section}.{value.split('=')[0]}: " in err and reason in err, f"{section}.{value} is refused", err)

TABLE_AXES = "".join(f"[axis {a}]\n" for a in "XYZC")
TURN = t.write("turn.ini", TABLE_AXES + "[geometry]\ntable_axis = C\ntable_yaw = 0 0 80 360 30\ntable_centre_mm = 20 10 0\n")
status, _, err = t.run("calibrate", "--machine", TURN, "--axis", "C", "--grid", "25", "--from=-360", "--to=360", "-o", "C.csv")
t.check(status == 0, "a turning table's yaw is measured", err)
t.write("turn.ngc", "G4 P4\n" + "".join(f"G0 X200 Y50 C{c}\nG4 P0.5\n" for c in range(-350, 351, 47)))
before = summary_of("turn.ngc", "--machine", TURN)["tool_point"]["rest_error_max_mm"]
after = summary_of("turn.ngc", "--machine", TURN, "--set", "correction.axis_table_c=C.csv")["tool_point"]["rest_error_max_mm"]
t.check(before > 0.015 and after < 5e-4, "the yaw of a turning table is corrected", before, after)

# ---- offline

PART = """%
(a part)
N10 G21 G90 G17 F1500 ; units
N20 G0 X-150 Y-100 Z-20
N30 G1 X150 (long) Y90 Z-40 ; line
N40 G2 X100 Y40 I-50 J0
N50 G3 X100 Y40 I-40 J5 F900 (full circle)
G91 G1 X-10 Y-10
Z-5
G90 G20
G1 X-2 Y1.5 F50
G21
o100 sub
  G1 X[#1] Y[#2] F800
  G1 Z[#3] (down)
o100 endsub
o100 call [20] [30] [-50]
o100 call [-120] [-30] [-60]
G1 X0 Y0 M0
M2
%
"""
t.write("part.ngc", PART)
status, _, err = t.run("correct", "part.ngc", "--machine", WORN, "--table", "volume.csv", "--tolerance", "0.0005", "-o", "corrected.ngc")
t.check(status == 0 and "pieces" in err, "a program is corrected", err)
with open("corrected.ngc") as file:
    text = file.read()
for kept in ("(a part)", "N10 G21 G90 G17 F1500 ; units", "N30 G1", "(long)", "; line", "F900", "(full circle)", "G91 G1", "G90 G20",
             "F50", "o100 sub", "F800", "(down)", "o100 call [-120] [-30] [-60]", "M2"):
    t.check(kept in text, f"{kept} is kept")


def trace_of(program, column, *options):
    status, _, err = t.run("run", program, *options, "--trace", "path.csv", "--quiet")
    t.check(status == 0, f"{program} runs", err)
    with open("path.csv") as file:
        header = file.readline().strip().split(",")
        at = [header.index(f"{column}_{axis}_mm") for axis in "XYZ"]
        return [[float(cells[i]) for i in at] for cells in (line.split(",") for line in file)]


def distance(p, a, b):
    ab = [b[i] - a[i] for i in range(3)]
    square = sum(c * c for c in ab)
    s = sum((p[i] - a[i]) * ab[i] for i in range(3)) / square if square else 0
    s = min(1, max(0, s))
    return math.dist(p, [a[i] + s * ab[i] for i in range(3)])


# The layers fade in first; what follows must be the path of the corrected program.
t.write("live.ngc", PART.replace("N20 G0", "G0 X-150 Y-100 Z-20\nG4 P4\nN20 G0"))
live = trace_of("live.ngc", "set", *TABLE)[8000::7]
path = [p for i, p in enumerate(trace_of("corrected.ngc", "cmd", "--machine", WORN)) if i % 10 == 0]
k = min(range(len(path)), key=lambda j: math.dist(path[j], live[0]))
worst = 0
for p in live:
    best = math.inf
    for j in range(max(0, k - 10), min(len(path) - 1, k + 60)):
        d = distance(p, path[j], path[j + 1])
        if d < best:
            best, nearest = d, j
    k = nearest
    worst = max(worst, best)
print("offline path off the live one by", worst, "mm")
t.check(worst <= 0.0005 + 0.0002, "the corrected program, read again, follows the corrected path", worst)

points = random_points(40, [(low + 5, high - 5) for low, high in travel(WORN)])
program = visit(points)
status, _, err = t.run("correct", program, "--machine", WORN, "--table", "volume.csv", "-o", "points.ngc", "--quiet")
t.check(status == 0, "a program of rapids is corrected", err)
live_ends, offline_ends = (trace_of(name, column, *options)[-1] for name, column, options in
                           ((program, "set", TABLE), ("points.ngc", "cmd", ("--machine", WORN))))
t.check(math.dist(live_ends, offline_ends) < 1e-4, "offline and live come to the same place", live_ends, offline_ends)

STREAM = PART[:PART.index("o100")].encode() + b"M2\n%\nrest\n"
t.write("stream.ngc", STREAM)
whole = t.run("correct", "stream.ngc", "--machine", WORN, "--table", "volume.csv", "--quiet")[1]
status, filtered, err = t.run("correct", "-", "--filter", "--machine", WORN, "--table", "volume.csv", "--quiet", text=STREAM)
t.check(status == 0 and filtered == whole, "a filter writes the same, line by line", err)
status, _, err = t.run("correct", "-", "--filter", "--table", "volume.csv", "--machine", WORN, text=PART.encode())
t.check(status == 2 and "stream" in err, "a stream cannot go back", err)
status, _, err = t.run("correct", t.write("probe.ngc", "F100\nG38.2 Z-5\n"), "--machine", WORN, "--table", "volume.csv", "-o", "probe-corrected.ngc")
t.check(status == 2 and "probe.ngc:2" in err and not os.path.exists("probe-corrected.ngc"), "what cannot be written is refused", err)

# ---- LinuxCNC's files, broken tables, wrong words

t.write("x.comp", "0 0 0.001\n10 10.002 9.999\n20 20 20\n")
status, out, err = t.run("calibrate", "--axis", "X", "--grid", "5")
numbers = [float(word) for line in out.splitlines()[2:] if line[:1] in "-0123456789" for word in line.split(",")[1:]]
t.check(status == 0 and numbers and max(map(abs, numbers)) < 1, "a machine without errors has none to correct", status, out, err)
status, out, err = t.run("calibrate", "--comp", "x.comp", "--axis", "X")
t.check(status == 0 and "X_mm,KX_up_um,KX_down_um" in out and "\n10,-2,1\n" in out, "a COMP_FILE is converted", out, err)

BROKEN = {
    "X_mm,Y_mm,KX_um\n0,0,1\n9,0,nan\n": "broken.csv:3:5: error: nan is not finite",
    "X_mm,Y_mm,KX_um\n0,0,1\n9,0,1\n0,7,1\n": "the point X 9 Y 7 is expected here",
    "X_mm,Y_mm,KX_um\n0,0,1\n9,0,1\n0,7,1\n9,7,2000\n": "X 9 Y 7: KX: a correction of 2",
    "X_mm,Y_mm,KX_um\n0,0,1\n9,0,1\n0,7,1\n9,7,1\nchecksum,12345678\n": "the checksum is wrong",
}
# Between points that stand unevenly the curve may leave them far behind; and no axis goes so far that its position is not a number.
UNEVEN = {
    "X_mm,KY_um\n-400,0\n-120,0\n-60,20\n0,0\n400,0\n": "KY: between X -400 and -120 mm the curve through the points goes to -99.",
    "X_mm,KX_up_um,KX_down_um\n-400,0,0\n-300,0,0\n-200,1,10\n400,0,0\n": "KX_down: between X -200 and 400 mm",
    "X_mm,KX_um\n-1e200,1\n1e200,1\n": "X 1e+200 mm: a table goes from -1e+06 to 1e+06",
}
for tables, key in ((BROKEN, "volume_table"), (UNEVEN, "axis_table_x")):
    for text, message in tables.items():
        t.write("broken.csv", text)
        status, _, err = t.run("run", "visit.ngc", "--set", f"correction.{key}=broken.csv")
        t.check(status == 2 and "broken.csv" in err and message in err, "a broken table is refused", message, err)
t.write("uneven.comp", "-400 -400 -400\n-300 -300 -300\n-200 -200.01 -200\n400 400 400\n")
status, out, err = t.run("calibrate", "--comp", "uneven.comp", "--axis", "X")
t.check(status == 2 and out == "" and "KX_up: between X -200 and 400 mm" in err, "so is a COMP_FILE", status, out, err)
for points in range(2, 12):
    rows = [f"{-400 + 800 / (points - 1) * i:.6f},{random.Random(points * 100 + i).choice((-20, 20))}" for i in range(points)]
    status, _, err = t.run("correct", t.write("rest.ngc", "M2\n"), "--table", t.write("even.csv", "X_mm,KY_um\n" + "\n".join(rows) + "\n"))
    t.check("curve" not in err, "points that stand evenly are good whatever they say", err)
status, _, err = t.run("run", "visit.ngc", "--rests", "none.csv")
t.check(status == 2 and "[geometry]" in err and not os.path.exists("none.csv"), "without errors no rests are to be told", err)
for options, word in (((), "--grid"), (("--grid", "9x7"), "9x7x6"), (("--grid", "1x2x2"), "2 to"),
                      (("--grid", "3x3x3", "--from", "0,0"), "3 positions"), (("--grid", "3x3x3", "--to", "0,0,9000"), "travel"),
                      (("--axis", "Q", "--grid", "4"), "--axis Q"), (("--grid", "3x3x3", "--noise-um", "x"), "--noise-um"),
                      (("--comp", "x.comp", "--axis", "X", "--grid", "5"), "--comp and --grid"), (("--comp", "x.comp", "--axis", "X", "--unit", "Y"), "--unit"),
                      (("--axis", "X", "--unit", "Y", "--grid", "5"), "--unit and --axis"), (("--compose", "--unit", "X", "--grid", "5"), "--compose and --unit"),
                      (("--axis", "X", "--grid", "5", "--comp-type", "1"), "--comp-type")):
    status, _, err = t.run("calibrate", *options)
    t.check(status == 2 and word in err, f"calibrate {options} is refused", err)
status, _, err = t.run("machine", "--set", "correction.matrix_x=1 2 3")
t.check(status == 2 and "4 numbers" in err, "a vector of the wrong length is refused", err)
status, _, err = t.run("machine", "--set", "correction.off=volum")
t.check(status == 2 and "no layer 'volum'" in err, "an unknown layer is refused", err)
status, _, err = t.run("run", "visit.ngc", "--set", "correction.setup_offset_mm=400 0 0")
t.check(status == 2 and "fades" in err, "correction that would take an axis away is refused", err)
t.finish()
