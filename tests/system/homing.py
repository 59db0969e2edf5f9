"""Homing at start: in the machine file's order, to the switches of the virtual drives, and what goes wrong with it."""

import re

import takt_test as t

PROGRAM = t.write("part.ngc", "G21 G90 G61 F3000\nG1 X3 Y2 Z-1\nG0 X0 Y0 Z0\nM2\n")

# Switches at -12 mm (X) and 9 mm (Z): close, so that the way is short.
SWITCHES = (
    "drive.1.limit_switch_min_mm=-12",
    "drive.3.limit_switch_max_mm=9",
    "axis.X.home_order=2",
    "axis.X.home_method=17",
    "axis.X.home_offset_mm=-12",
    "axis.Z.home_order=1",
    "axis.Z.home_method=18",
    "axis.Z.home_offset_mm=9",
)


def run(*settings):
    options = [word for setting in settings for word in ("--set", setting)]
    status, _, err = t.run("run", PROGRAM, "--bus-log", "bus.log", "--json", "run.json", "--quiet", *options)
    summary = t.json.load(open("run.json", encoding="utf-8")) if t.os.path.exists("run.json") else {}
    return status, err, summary


def frames():
    """(seconds, identifier, data) of the bus log."""
    for line in open("bus.log", encoding="utf-8"):
        time, identifier, data = re.match(r"\(([\d.]+)\) \S+ ([0-9A-F]+)#([0-9A-F]*)", line).groups()
        yield float(time), int(identifier, 16), bytes.fromhex(data)


def homing_starts():
    """When each node is told first to look for its home: controlword bit 4 in mode 6."""
    starts = {}
    for time, identifier, data in frames():
        if identifier & 0x780 == 0x200 and data[2] == 6 and data[0] & 0x10:
            starts.setdefault(identifier & 0x7F, time)
    return starts


def homing_ends():
    """When each node shows first that it has been homed: statusword bits 12 and 10, in mode 6."""
    modes, ends = {}, {}
    for time, identifier, data in frames():
        if identifier & 0x780 == 0x200:
            modes[identifier & 0x7F] = data[2], data[0] & 0x10
        if identifier & 0x780 == 0x180 and modes.get(identifier & 0x7F) == (6, 0x10):
            if int.from_bytes(data[:2], "little") & 0x1400 == 0x1400:
                ends.setdefault(identifier & 0x7F, time)
    return ends


status, err, plain = run()
t.check(status == 0, "without homing the program completes", err)
t.check(homing_starts() == {}, "and nothing is homed")

status, err, homed = run(*SWITCHES)
t.check(status == 0, "after homing the program completes", err)
t.check(homed.get("setpoint_digest") == plain.get("setpoint_digest"), "setpoints are those without homing")
starts, ends = homing_starts(), homing_ends()
t.check(sorted(starts) == [1, 3], "X and Z are homed, Y is not", starts)
t.check(starts.get(1, 0) > ends.get(3, 1e9), "X begins when Z has ended", starts, ends)

status, err, _ = run(*SWITCHES, "axis.X.home_order=1")
starts, ends = homing_starts(), homing_ends()
t.check(status == 0 and abs(starts[1] - starts[3]) < 0.01 < ends[3] - starts[3], "axes of one order are homed together",
        err, starts, ends)

status, err, _ = run("axis.Y.home_order=1", "axis.Y.home_method=17", "axis.Y.home_timeout_s=0.5")
t.check(status == 1 and "homing of axis Y (node 2) has not ended within 0.5 s" in err, "a switch too far is given up", err)

status, err, _ = run("axis.Y.home_order=1", "axis.Y.home_method=15")
t.check(status == 1 and "axis Y (node 2), object 6098:00, refuses with abort code 06090030: invalid value" in err,
        "a method the drive does not know is refused", err)

status, err, _ = run("axis.X.home_offset_mm=30000")
t.check(status == 2 and "home_offset_mm does not fit" in err, "an offset beyond 32 bits is refused", err)

status, err, _ = run("axis.X.drive_product=1234")
t.check(status == 1 and "axis X (node 1) has another drive than the machine file says" in err, "another drive is refused",
        err)

status, err, _ = run("axis.X.drive_product=0x402")
t.check(status == 0, "the drive that is named is taken", err)

status, err, _ = run("bus.controller_node=2")
t.check(status == 2 and "controller_node 2 is the drive_node of axis Y" in err, "a node id cannot be used twice", err)

status, err, _ = run("bus.bitrate=500000")
t.check(status == 2 and "3 drives take 810 of 500 bits at worst, load 162.0 %" in err,
        "a bus that cannot carry the cycle is refused with the figures", err)

t.finish()
