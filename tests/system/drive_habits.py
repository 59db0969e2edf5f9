"""drive_habits.py [NUMBER FIRST]: drives with the habits of real ones, by their data sheets: one by one, and by seed.

Each habit by itself boots and runs the pocket with the setpoints of takt's own drives. Random combinations on one to six
axes either do the same with a short program, or are refused by one message that names object and remedy; none hangs."""

import json
import os
import random
import re
import sys

import bus_pair
import data_sheets
import takt_test as t

POCKET = os.path.join(t.EXAMPLES, "pocket.ngc")
NUMBER, FIRST = (int(word) for word in (sys.argv[1:3] or ["12", "1"]))
AXES = "XYZABC"


def run(program, *settings):
    """Status, error output and summary."""
    options = [word for setting in settings for word in ("--set", setting)]
    if os.path.exists("run.json"):
        os.remove("run.json")
    status, _, err = t.run("run", program, "--quiet", "--json", "run.json", *options)
    return status, err, json.load(open("run.json", encoding="utf-8")) if os.path.exists("run.json") else None


def sheet_of(node, *changes):
    sheet = data_sheets.read("own.eds")
    for change in changes:
        change(sheet, random.Random(1))
    return data_sheets.write(f"drive{node}.eds", sheet)


def all_drives(path):
    return [f"drive.{node}.eds={path}" for node in (1, 2, 3)]


t.check(t.run("drives", "--nodes", "1", "--eds", "own.eds")[0] == 0, "our own data sheet is written")
DIGEST = run(POCKET)[2]["setpoint_digest"]


def runs(claim, given_up, *settings):
    status, err, summary = run(POCKET, *settings)
    if not t.check(status == 0 and summary["setpoint_digest"] == DIGEST, f"{claim}: boots and runs the pocket", err):
        return
    found = {name for drive in summary["drives"] for name in drive["given_up"]}
    t.check(found == given_up, f"{claim}: what is given up is told", found, given_up)


def refused(claim, *texts_and_settings):
    texts = [word for word in texts_and_settings if "=" not in word]
    status, err, _ = run(POCKET, *(word for word in texts_and_settings if "=" in word))
    t.check(status == 1 and all(text in err for text in texts), f"{claim}: is refused with object and remedy", err)


# Our own drive by its data sheet is our own drive.
runs("our own data sheet", set(), *all_drives("own.eds"))
t.check(t.run("drives", "--nodes", "1", "--eds", "again.eds", "--set", "drive.1.eds=own.eds")[0] == 0, "it is written again")
own, again = data_sheets.read("own.eds"), data_sheets.read("again.eds")
own["FileInfo"] = again["FileInfo"] = {}
for name in ("1021", "2000", "2001"):  # texts and bytes of a sheet are but memory
    own[name]["DataType"] = again[name]["DataType"] = own[name]["ObjectType"] = again[name]["ObjectType"] = ""
    own[name].pop("DefaultValue", 0), again[name].pop("DefaultValue", 0)
t.check(own == again, "and is the same", [name for name in own if own[name] != again.get(name)])

for name, (change, lost) in data_sheets.HABITS.items():
    runs(name, lost, *all_drives(sheet_of(1, change)))
    runs(name + ", on one of three", lost, "drive.2.eds=" + sheet_of(1, change))
runs("boots slowly", set(), "drive.1.boot_time_ms=600", "drive.2.boot_time_ms=2000")
runs("boots as slowly as allowed", set(), "drive.2.boot_time_ms=9000", "bus.boot_timeout_ms=10000")
runs("answers slowly", set(), "drive.1.sdo_time_ms=1500", "drive.3.sdo_time_ms=700")
runs("controlword by slow SDO", {"mode_pdo", "control_pdo"}, "drive.1.sdo_time_ms=1500",
     "drive.1.eds=" + sheet_of(1, data_sheets.control_not_mappable))
runs("motors that turn the other way", set(), "axis.X.increments_per_mm=-100000", "axis.Z.increments_per_mm=-50000")
runs("scaling that fits", set(), "axis.X.travel_per_turn_mm=10", "axis.Y.travel_per_turn_mm=10")
runs("a fixed mapping that the maker's tool has set up", {"pair", "error_pdo", "silence"}, "axis.X.drive_is_set_up=1",
     "axis.Y.drive_is_set_up=1", "axis.Z.drive_is_set_up=1",
     *all_drives(sheet_of(1, data_sheets.fixed_mapping, lambda sheet, _: [
         sheet[name].update(DefaultValue=kind) for name, kind in (("1402sub2", "1"), ("1800sub2", "255"), ("1802sub2", "1"))],
         lambda sheet, _: sheet["1017"].update(DefaultValue="100"),
         lambda sheet, _: sheet["1006"].update(DefaultValue="1000"),
         lambda sheet, _: sheet["1016sub1"].update(DefaultValue=str(127 << 16 | 300)))))

refused("another time between targets", "60C2", "10000 us", "cycle_us", "drive.2.eds=" + sheet_of(2, data_sheets.other_period))
refused("a drive that keeps another SYNC", "object 1005:00", "maker's tool", "drive.3.eds=" + sheet_of(
    3, data_sheets.other_sync, lambda sheet, _: data_sheets.set_access(sheet, "ro", "1005")))
refused("wrong scaling", "increments_per_mm", "1000000 units", "axis.Y.travel_per_turn_mm=5")
refused("a drive that cannot follow", "6502", "set-up", "drive.1.eds=" + sheet_of(
    1, lambda sheet, _: sheet["6502"].update(DefaultValue="0x21")))
refused("ramps that are too slow", "6083", "maker's tool", *all_drives(sheet_of(1, data_sheets.own_ramps)))
refused("a drive of velocity that watches nobody", "1016", "maker's tool", *all_drives(
    sheet_of(1, data_sheets.velocity_only, data_sheets.nobody_watched)))
refused("reports by SYNC or a timer from none of its TPDOs", "object 6041:00", "1800:05", "maker's tool", *all_drives(sheet_of(
    1, data_sheets.reports_at_changes)))
refused("a drive of velocity without heartbeats", "heartbeat_ms", "bus.heartbeat_ms=0", *all_drives(sheet_of(1, data_sheets.velocity_only)))
refused("a drive that is slower than allowed", "boot_timeout_ms", "drive.3.boot_time_ms=20000")
refused("a drive that answers later than allowed", "_timeout_ms", "drive.3.sdo_time_ms=15000")
refused("frames that do not fit into a cycle", "1075 of 1000 bits", "cycle_us", "axis.A.drive_node=4", *(
    f"drive.{node}.eds=" + sheet_of(node, data_sheets.no_dummies) for node in (1, 2, 3, 4)))
status, err, _ = run(POCKET, "drive.1.eds=" + t.write("nothing.eds", "[6040]\nDataType=6\n"))
t.check(status == 2 and "nothing.eds" in err and "[1000]" in err, "what is no data sheet is told so", err)

# Velocities: in units of their own; of motors that turn the other way; where the ramps are the drive's, and steep enough.
VELOCITY = all_drives(sheet_of(1, data_sheets.velocity_only))
runs("velocities in rpm", {"position"}, *VELOCITY, *(f"axis.{axis}.velocity_units_per_mm_s=6" for axis in "XYZ"))
runs("velocities of motors that turn the other way", {"position"}, *VELOCITY, *(
    f"axis.{axis}.increments_per_mm=-20000" for axis in "XYZ"))
status, err, summary = run(POCKET, *all_drives(sheet_of(1, data_sheets.own_ramps)), *(
    f"axis.{axis}.max_acceleration_mm_s2=400" for axis in "XYZ"))
if t.check(status == 0, "ramps of the drive's own that are steep enough will do", err):
    t.check("ramps" in summary["drives"][0]["given_up"], "and are told")

# Drives of a sheet on a bus are what they are inside; without object 1006 SYNC is their clock all the same.
for name in ("nothing optional", "one entry a PDO", "interpolated position only"):
    sheet = sheet_of(1, data_sheets.HABITS[name][0])
    embedded = bus_pair.run_controller("embedded", *[w for s in all_drives(sheet) for w in ("--set", s)])[1]
    drives = bus_pair.Drives("socketcand:listen:0", "--eds", sheet)
    status, summary, err = bus_pair.run_controller("outside", "--bus", "socketcand:" + drives.address)
    if t.check(status == 0, f"{name}: runs over a bus", err):
        t.check(summary["setpoint_digest"] == embedded["setpoint_digest"], f"{name}: with the same setpoints")
    drives.stop()
drives = bus_pair.Drives("socketcand:listen:0", "--eds", sheet_of(1, data_sheets.interpolated_only))
status, out, err = t.run("run", bus_pair.PROGRAM, "--bus", "socketcand:" + drives.address)
t.check(status == 0 and "  given up      XYZ     6502 " in err and "  given up      XYZ     6502 " in out,
        "what is given up is told when the drives have been enabled, and in the summary", err)
drives.stop()

# The axes of a motor that turns the other way are where they would be.
for name, settings in (("plain", []), ("turned", ["axis.X.increments_per_mm=-100000", "axis.Z.increments_per_mm=-100000"])):
    homed = [f"axis.{axis}.{key}" for axis in "XZ" for key in ("home_order=1", "home_method=35", "home_offset_mm=3")]
    options = [word for setting in settings + homed for word in ("--set", setting)]
    t.run("run", POCKET, "--quiet", "--trace", name + ".csv", *options)
t.check(open("plain.csv", "rb").read() == open("turned.csv", "rb").read(), "turned motors give the same trace")

# Homing goes by the drive's own directions: turned, the upper limit switch is where the lower one was.
for method, turned in ((17, 18), (19, 20), (33, 34), (1, 2)):
    traces = []
    for number, increments in ((method, 100000), (turned, -100000)):
        settings = ["axis.X.home_order=1", f"axis.X.home_method={number}", f"axis.X.increments_per_mm={increments}",
                    "drive.1.limit_switch_min_mm=-40", "drive.1.home_switch_mm=-5", "drive.1.start_mm=-3"]
        settings = settings if method != 19 else settings[:-1] + ["drive.1.start_mm=-8"]
        t.run("run", POCKET, "--quiet", "--trace", "homed.csv", *[w for s in settings for w in ("--set", s)])
        traces.append(open("homed.csv", "rb").read())
        os.remove("homed.csv")
    t.check(traces[0] == traces[1] if method != 19 else all(traces), f"homing by {turned} turned is homing by {method}")


# ---- Random combinations ----

t.write("short.ngc", "G21 G90 G61 F3000\nG1 X2 Y1\nG3 X0 Y0 I-1 J-0.5\nG0 X1\nM2\n")
t.write("six.ngc", "G21 G90 G61 F3000\nG1 X2 Y1 A20\nG3 X0 Y0 I-1 J-0.5\nG0 X1 A0\nM2\n")


def random_machine(seed):
    """Settings of a machine, names of the habits of its drives."""
    draw = random.Random(seed)
    count = draw.randint(1, 6)
    cycle_us = draw.choice([1000, 1000, 1000, 2000] if count < 5 else [2000, 4000])
    lines = [f"[machine]\ncycle_us = {cycle_us}\n[bus]\nboot_timeout_ms = 1500\nsdo_timeout_ms = 400\n"]
    habits = []
    for node, axis in enumerate(AXES[:count], 1):
        sheet = data_sheets.read("own.eds")
        names = data_sheets.draw_habits(sheet, 1000 * seed + node)
        data_sheets.write(f"drive{node}.eds", sheet)
        lines.append(f"[axis {axis}]\ndrive_node = {node}\n")
        if draw.random() < 0.3:
            lines.append(f"increments_per_{'mm' if node <= 3 else 'deg'} = -20000\n")
        lines.append(f"[drive {node}]\neds = drive{node}.eds\nboot_time_ms = {draw.choice([0, 0, 0, 700, 1400])}\n"
                     f"sdo_time_ms = {draw.choice([0, 0, 0, 3, 300])}\n")
        habits.append(names)
    return "".join(lines), count, cycle_us, habits


def lag_most(cycle_us, habits):
    """mm or degrees that an axis may be off on its way: a drive of velocity lags, the slower the cycle the lower its gain; one that
    takes targets as they come is up to a cycle ahead, and what comes by a timer up to a cycle old, at 180 degrees per second. Where a direction or a scale is wrong it is
    all of the way, of 2 mm and of 20 degrees."""
    cycles = sum(any(name in names for names in habits) for name in ("RPDOs without SYNC", "TPDOs without SYNC", "TPDOs by a timer of their own"))
    return 0.1 + 5e-5 * cycle_us + 180e-6 * cycle_us * cycles


def actual_and_set():
    """Of each axis, both in the order of cycles: actual positions, and the setpoints to which they belong, 3 cycles ago."""
    if not os.path.exists("habit.csv"):
        return []
    header, *rows = (line.split(",") for line in open("habit.csv", encoding="ascii").read().splitlines())
    found = [at for at, name in enumerate(header) if name.startswith("act_")]
    return [([float(row[at]) for row in rows[3:]], [float(row[at - 1]) for row in rows[:-3]]) for at in found]


def farthest_from_setpoint():
    return max(abs(a - w) for actual, wanted in actual_and_set() for a, w in zip(actual, wanted))


def has_moved():
    """Whether an axis of drives that have been refused is not where it was."""
    return any(abs(at) > 1e-3 for actual, _ in actual_and_set() for at in actual)


def names_object_and_remedy(message):
    """An object, or what of the bus; behind it, after the last colon, what to do with a key or the maker's tool."""
    named = re.search(r"object [0-9A-F]{4}:[0-9A-F]{2}|objects? [0-9A-F]{4}|\d+ of \d+ bits|60C2", message)
    remedy = message.strip().rsplit(": ", 1)[-1]
    has_key = any(key in KEYS for key in re.findall(r"[a-z]\w*_\w+|bitrate", remedy))
    return bool(named) and (has_key or "maker's tool" in remedy)


KEYS = set(re.findall(r"(?m)^([a-z]\w*) = ", t.run("machine")[1]))
t.check("cycle_us" in KEYS and "drive_node" in KEYS, "the keys are those of the machine file", sorted(KEYS)[:5])
outcomes, farthest = {}, 0.0
for seed in range(FIRST, FIRST + NUMBER):
    machine, count, cycle_us, habits = random_machine(seed)
    t.write("machine.ini", machine)
    plain = "".join(line for line in machine.splitlines(True) if "eds" not in line and "time_ms" not in line)
    t.write("plain.ini", plain)
    program = {1: "line.ngc", 4: "six.ngc", 5: "six.ngc", 6: "six.ngc"}.get(count, "short.ngc")
    t.write("line.ngc", "G21 G90 G61 F3000\nG1 X2\nG1 X-1\nM2\n")
    results = []
    for name in ("plain.ini", "machine.ini"):
        if os.path.exists("habit.csv"):
            os.remove("habit.csv")
        trace = ["--trace", "habit.csv"] if name == "machine.ini" else []
        status, out, err = t.run("run", program, "--quiet", "--json", "-", "--machine", name, *trace)
        results.append((status, json.loads(out) if out else None, err))
    (_, expected, plain_err), (status, summary, err) = results
    t.check(expected is not None, f"seed {seed}: the machine is one", plain_err)
    if status == 0:
        t.check(summary["setpoint_digest"] == expected["setpoint_digest"], f"seed {seed}: the setpoints are the same", habits)
        lag = farthest_from_setpoint()
        t.check(lag < lag_most(cycle_us, habits), f"seed {seed}: every axis is where it should be", lag, habits)
        farthest = max(farthest, lag)
        outcomes["runs"] = outcomes.get("runs", 0) + 1
    else:
        t.check(status == 1 and names_object_and_remedy(err),
                f"seed {seed}: the refusal names object and remedy", status, err, habits)
        t.check(not has_moved(), f"seed {seed}: no axis of drives that are refused has moved", habits)
        reason = err.strip().split(": ")[-1]
        outcomes[reason] = outcomes.get(reason, 0) + 1
for outcome, times in sorted(outcomes.items(), key=lambda item: -item[1]):
    print(f"{times:5} {outcome}")
print(f"farthest from a setpoint: {farthest:.4f} mm or degrees")
t.finish()
