"""A gantry: two drives of an axis, squared by two switches, go together; what racks it is a fault."""

import re

import bus_pair
import takt_test as t

MACHINE = """[axis X]
drive_node = 1
[axis Y]
drive_node = 2
home_order = 1
home_method = 17
home_offset_mm = -10
[gantry]
axis = Y
drive_node = 3
is_reversed = 1
home_offset_mm = -9.4
skew_max_mm = 0.8
[drive 2]
absolute_encoder = 0
limit_switch_min_mm = -10
[drive 3]
absolute_encoder = 0
limit_switch_min_mm = -9.4
start_mm = 0.3
"""
FILE = t.write("gantry.ini", MACHINE)
PROGRAM = t.write("gantry.ngc", "G21 G90 F6000\nG1 X100 Y60\nX0 Y0\nM2\n")
INCREMENTS_PER_MM = 100000
CYCLE_S = 0.001


def run(name, *options, machine=FILE):
    status, _, err = t.run("run", PROGRAM, "--machine", machine, "--bus-log", name + ".log", "--json", name + ".json", *options)
    return status, err


def value(data, at):
    return int.from_bytes(bytes.fromhex(data)[at : at + 4], "little", signed=True) / INCREMENTS_PER_MM


def frames(path, identifier):
    """Times in s and data."""
    found = []
    with open(path) as file:
        for line in file:
            time, _, frame = line.split()
            if frame.startswith(identifier + "#"):
                found.append((float(time.strip("()")), frame.split("#")[1]))
    return found


def check_squaring():
    status, err = run("square")
    if not t.check(status == 0, "a gantry runs", err):
        return
    first = {round(1000 * time): value(data, 2) for time, data in frames("square.log", "182")}
    second = {round(1000 * time): -value(data, 2) for time, data in frames("square.log", "183")}
    both = [(time, first[time], second[time]) for time in first if time in second]
    homed = next((i for i, (_, a, b) in enumerate(both) if abs(a + 10) < 0.05 and abs(b + 9.4) < 0.05), None)
    if not t.check(homed is not None, "after homing each drive is at its own switch"):
        return
    homed = both[homed:]
    along = [position for _, position, _ in homed]
    moving = next(i for i, position in enumerate(along) if abs(position - along[0]) > 0.1)
    t.check(all(abs(a - b) < 0.01 for _, a, b in homed[moving:]), "squared, both drives go together")
    t.check(max(abs(a - along[0]) for a in along[: moving - 50]) < 0.1, "the second drive comes to the first")

    targets = [-value(data, 0) for time, data in frames("square.log", "303") if 1000 * time > homed[0][0]]
    at_switch = next(i for i, target in enumerate(targets) if abs(target + 9.4) < 0.05)
    squaring = targets[at_switch + 5 : at_switch + moving - 100]
    t.check(squaring[0] - squaring[-1] > 0.5, "the second drive makes the way")
    speed = [(b - a) / CYCLE_S for a, b in zip(squaring, squaring[1:])]
    change = [(b - a) / CYCLE_S for a, b in zip(speed, speed[1:])]
    t.check(max(map(abs, speed)) <= 2.02 and max(map(abs, change)) <= 520, "within velocity and acceleration of homing", max(map(abs, speed)), max(map(abs, change)))


def check_racking():
    for script, said in (
        ("weak ratio=0.02", "axis Y2 (node 3) is 0.8"),
        ("hang", "the drive of axis Y2 (node 3) has sent no position"),
    ):
        t.write("rack.inject", f"enabled+0.6s drive 3 {script}\n")
        status, err = run("rack", "--inject", "rack.inject")
        t.check(status != 0 and said in err, f"{script}: a fault", status, err)
    status, err = run("far", "--set", "gantry.skew_max_mm=0.5")
    t.check(status != 0 and re.search(r"axis Y2 \(node 3\) is 0\.6\d* mm off the other drive", err), "switches too far apart are a fault", status, err)


def check_two():
    """X and Y have two drives each; X finds its homes by a method of the maker, at hard stops."""
    two = t.write("two.ini", MACHINE.replace("[axis X]", "[machine]\ncycle_us = 2000\n[axis X]\nhome_order = 1\nhome_method = -4\nhome_offset_mm = -20") + """[gantry 2]
axis = X
drive_node = 5
is_reversed = 1
home_method = -3
home_offset_mm = -20.3
skew_max_mm = 0.8
[drive 1]
absolute_encoder = 0
hard_stop_min_mm = -20
following_error_window_mm = 0
[drive 5]
absolute_encoder = 0
hard_stop_min_mm = -20.3
following_error_window_mm = 0
""")
    status, err = run("two", machine=two)
    if not t.check(status == 0, "two gantries run", err):
        return
    for first, second, name in (("181", "185", "X"), ("182", "183", "Y")):
        here = {round(500 * time): value(data, 2) for time, data in frames("two.log", first)}
        there = {round(500 * time): -value(data, 2) for time, data in frames("two.log", second)}
        moving = [(here[time], there[time]) for time in here if time in there][-400:]
        t.check(max(abs(a - b) for a, b in moving) < 0.01, f"both drives of {name} go together", moving[:3])
    t.write("rack.inject", "enabled+2.5s drive 5 weak ratio=0.02\n")
    status, err = run("rack", "--inject", "rack.inject", machine=two)
    t.check(status != 0 and "axis X2 (node 5) is 0.8" in err, "each is watched", status, err)
    t.check(t.run("machine", two)[1].count("\n[gantry") == 2, "both are written")
    for option, said in (("gantry.2.axis=Y", "a gantry needs"), ("gantry.2.drive_node=3", "a gantry needs"),
                         ("gantry.axis=none", "a gantry needs"), ("gantry.4.axis=Z", "there is no gantry '4'"),
                         ("gantry.2.home_method=0", "gantry of axis X"), ("axis.X.home_method=0", "home_method is 1 ... 37")):
        status, err = run("refused", "--set", option, machine=two)
        t.check(status == 2 and said in err, option + ": refused", status, err)


def check_outside():
    """The same in two processes; when the drives have come to rest after homing depends on when the start heard of them."""
    both = bus_pair.run_both(FILE, PROGRAM, "takt drives has both drives of the gantry")
    if both:
        t.check(both[0]["setpoint_digest"] == both[1]["setpoint_digest"], "with the same setpoints")


def check_refusals():
    for option, said in (
        ("gantry.drive_node=2", "a gantry needs"),
        ("gantry.drive_node=127", "a gantry needs"),
        ("gantry.skew_max_mm=0", "a gantry needs"),
        ("gantry.axis=Z", "a gantry needs"),
        ("gantry.axis=A", "X, Y, Z or none is expected"),
        ("axis.Y.drive_type=step", "a gantry needs"),
    ):
        status, err = run("refused", "--set", option)
        t.check(status == 2 and said in err, option + ": refused", status, err)


check_squaring()
check_racking()
check_two()
check_outside()
check_refusals()
t.finish()
