"""Two CAN buses in one machine: the setpoints of one, node ids of each bus's own, loss of either, logs, drives outside."""

import os
import random
import re

import bus_pair
import data_sheets
import takt_test as t

PROGRAM = t.write("four.ngc", "G21 G90 G17 F3000\nG1 X20 Y10 Z-2 A30\nG2 X30 Y20 I0 J10\nG4 P0.05\nG0 X0 Y0 Z5 A0\nM2\n")


def section(axis, node, bus, rest=""):
    return f"[axis {axis}]\ndrive_node = {node}\ndrive_bus = {bus}\n{rest}"


def machine(name, places, cycle_us=1000, rest=""):
    """places: axis, node and bus of each drive, in the order of the file."""
    return t.write(name + ".ini", f"[machine]\ncycle_us = {cycle_us}\n" + "".join(section(*place) for place in places) + rest)


ONE = [("X", 1, 0), ("Y", 2, 0), ("Z", 3, 0), ("A", 4, 0)]
TWO = [("X", 1, 0), ("Y", 2, 0), ("Z", 1, 1), ("A", 2, 1)]
CROSSED = [("X", 1, 0), ("Y", 1, 1), ("Z", 2, 0), ("A", 2, 1)]


def run(name, *options):
    return bus_pair.run_controller(name, *options, program=PROGRAM)


def check_buses(what, summary, cycle_us):
    """Each bus for itself, as predicted of it."""
    for bus in (summary["bus"], summary["can1"]):
        t.check(0 < bus["load_percent"] <= bus["predicted_load_percent"] <= 100, what + ": the load is within the computed one", bus)
        late = [r for r in bus["responses"] if not r["observed_us"] <= r["predicted_us"]]
        # Heartbeats of all nodes may meet, and are last in rank.
        late += [r for r in bus["responses"] if r["name"] != "heartbeat" and r["predicted_us"] > cycle_us]
        t.check(not late, what + ": no response above its worst case", late)
    names = [check["name"] for check in summary["checks"]]
    t.check({"bus_load", "bus_load.can1", "bus_response", "bus_response.can1"} <= set(names), what + ": all of it is checked", names)


def check_setpoints():
    """Which drive is on which bus is not seen in the setpoints, nor in the positions that come back."""
    status, one, err = run("one", "--machine", machine("one", ONE))
    t.check(status == 0 and "can1" not in one, "one bus", err)
    for name, places in (("two", TWO), ("crossed", CROSSED)):
        status, two, err = run(name, "--machine", machine(name, places))
        if t.check(status == 0, name + ": runs", err):
            t.check(two["setpoint_digest"] == one["setpoint_digest"], name + ": the same setpoints")
            with open("one.csv", "rb") as a, open(name + ".csv", "rb") as b:
                t.check(a.read() == b.read(), name + ": the same trace, actual positions included")
            check_buses(name, two, 1000)
            lower = two["bus"]["predicted_load_percent"] < one["bus"]["predicted_load_percent"]
            t.check(lower, name + ": less on each", two["bus"], one["bus"])


def check_half_the_cycle():
    """Four axes at 0.5 ms: refused on one classical bus, and run on two as the refusal advises."""
    status, _, err = run("half", "--machine", machine("half", ONE, 500))
    found = re.search(r"drive_bus = 1 for (\w+) and error_pdo = 0 \(two buses\)", err)
    if not t.check(status == 2 and found, "refused on one, with advice", err):
        return
    advised = [("--set", f"axis.{axis}.drive_bus=1") for axis in found.group(1)] + [("--set", "bus.error_pdo=0")]
    status, two, err = run("advised", "--machine", "half.ini", *[word for pair in advised for word in pair])
    if t.check(status == 0, "run on two", err):
        check_buses("0.5 ms", two, 500)
        t.check(not any(r["name"] == "TPDO2" for r in two["bus"]["responses"]), "without TPDO2", two["bus"])
    status, fd, err = run("fd", "--machine", "half.ini", "--set", "bus.data_bitrate=5000000")
    t.check(status == 0 and fd["setpoint_digest"] == two["setpoint_digest"], "the setpoints of CAN FD on one", err)
    status, _, err = run("full", "--machine", machine("full", [(*p[:2], 0) for p in ONE[:2]] + [(*p[:2], 1) for p in ONE[2:]], 500))
    t.check(status == 2 and "the bus can0 cannot carry a cycle: 2 drives take 600 of 500 bits" in err, "each bus is judged on its own", err)
    t.check("error_pdo = 0 or cycle_us = 600 would do" in err, "with advice", err)


def check_quarter():
    """Four axes at 0.25 ms: refused on one bus of CAN FD, and run on two as advised."""
    quarter = ["--machine", machine("quarter", ONE, 250), "--set", "bus.data_bitrate=5000000"]
    status, _, err = run("quarter", *quarter)
    t.check(status == 2 and "drive_bus = 1 for ZA and error_pdo = 0 (two buses)" in err, "refused on one, with advice", err)
    moved = [word for axis in "ZA" for word in ("--set", f"axis.{axis}.drive_bus=1")]
    status, two, err = run("quarters", *quarter, *moved, "--set", "bus.error_pdo=0")
    if t.check(status == 0, "run on two", err):
        check_buses("0.25 ms", two, 250)


def check_refusals():
    for places, part in (
        ([("X", 1, 1), ("Y", 1, 1)], "axes X and Y have the same drive_node 1"),
        ([("X", 1, 2)], "drive_bus"),
    ):
        status, _, err = run("refused", "--machine", machine("refused", places))
        t.check(status == 2 and part in err, "refused: " + part, err)
    status, _, err = run("twice", "--machine", machine("twice", TWO, rest="[io 1]\nnode = 2\nbus = 1\noutputs = P0\n"))
    t.check(status == 2 and "another node on the bus has its id 2" in err, "an I/O node with the id of a drive on its bus", err)
    status, _, err = run("list", "--machine", "two.ini", "--bus", "slcan:/dev/null")
    t.check(status == 2 and "1 address, and the machine has 2 buses" in err, "an address is missing", err)
    fault = t.write("none.inject", "enabled can1 cut node=controller\n")
    status, _, err = run("none", "--machine", "one.ini", "--inject", fault)
    t.check(status == 2 and "none.inject:1" in err and "nothing on CAN bus 1" in err, "a fault of a bus that is not there", err)


def check_loss():
    """The controller is cut off either bus: an alarm that names an axis of it, and all axes stop."""
    for bus, axes in ((0, "XY"), (1, "ZA")):
        fault = t.write(f"cut{bus}.inject", f"enabled+0.3s {'bus' if bus == 0 else 'can1'} cut node=controller\n")
        status, summary, err = run(f"lost{bus}", "--machine", "two.ini", "--inject", fault)
        t.check(status == 1 and summary["outcome"] == "faulted", f"bus {bus} is lost: a fault", status, err)
        node = r"node 1:\d" if bus else r"node \d"
        t.check(re.search(rf"axis [{axes}] \({node}\)", err), "of an axis that is on it", err)
        t.check(0.29 < summary["program_time_s"] < 0.4, "within few cycles", summary["program_time_s"])
    dead = t.write("dead.inject", "enabled+0.3s drive 1:1 hang\n")
    status, _, err = run("dead", "--machine", "two.ini", "--inject", dead)
    t.check(status == 1 and "Z (node 1:1)" in err, "node 1 of the second bus fails, not that of the first", err)


def check_log():
    """One log of both, in order of time, a SYNC on each in every cycle; its second bus can be replayed alone."""
    status, summary, err = run("logged", "--machine", "crossed.ini", "--bus-log", "two.log")
    t.check(status == 0, "logged", err)
    with open("two.log") as file:
        lines = [line.split() for line in file]
    for name, bus in (("can0", "bus"), ("can1", "can1")):
        own = [line for line in lines if line[1] == name]
        t.check(len(own) == summary[bus]["frames"], name + ": a line for each frame", len(own))
    times = [line[0] for line in lines]
    t.check(times == sorted(times), "in order of time")
    syncs = [[line[0] for line in lines if line[1] == name and line[2] == "080#"] for name in ("can0", "can1")]
    apart = [abs(float(a[1:-1]) - float(b[1:-1])) for a, b in zip(*syncs)]
    t.check(len(syncs[0]) == len(syncs[1]) > 100, "SYNC goes out on both in every cycle", len(syncs[0]), len(syncs[1]))
    t.check(max(apart) <= 135e-6, "it waits for a frame under way at most", max(apart))
    second = [line for line in lines if line[1] == "can1"]
    status, out, err = t.run("replay", "two.log", "--bus", "slcan:pty", "--interface", "can1", "--fast", "--ids", "fff")
    t.check(status == 2, "a replay of what is no identifier is refused", err)
    hearer = bus_pair.Drives("slcan:pty", "--bus-log", "heard.log")
    status, out, err = t.run("replay", "two.log", "--bus", "slcan:" + hearer.address, "--interface", "can1", "--fast")
    hearer.stop()
    t.check(status == 0 and f"{len(second)} frames sent" in out, "the second bus is replayed alone", out, err)


def check_outside():
    """Each bus a process of drives: as on embedded buses to the last digit. One goes away: status 3."""
    status, embedded, err = run("embedded", "--machine", "crossed.ini")
    drives = [bus_pair.Drives("slcan:pty", "--machine", "crossed.ini", "--can", str(bus)) for bus in (0, 1)]
    address = ",".join("slcan:" + d.address for d in drives)
    status, outside, err = run("outside", "--machine", "crossed.ini", "--bus", address, "--bus-log", "outside.log")
    for d in drives:
        d.stop()
    if t.check(status == 0 and outside, "drives of two processes", err):
        bus_pair.compare("outside", embedded, outside)
        with open("outside.log") as file:
            names = {line.split()[1] for line in file}
        t.check(names == {"can0", "can1"}, "the log has both buses", names)
    status, _, err = t.run("drives", "--machine", "one.ini", "--can", "1", "--bus", "slcan:pty")
    t.check(status == 2 and "no drive on that bus" in err, "a bus without drives", err)


def check_nodes():
    """An I/O node and the second drive of a gantry on the second bus; sections of drives there."""
    rest = "[gantry]\naxis = Y\ndrive_node = 3\ndrive_bus = 1\nskew_max_mm = 0.5\n[io 1]\nnode = 2\nbus = 1\noutputs = P0\ninputs = P0\n"
    rest += "[drive 1:1]\nstart_mm = 1\n[drive 1:3]\nboot_time_ms = 20\n"
    path = machine("nodes", [("X", 1, 0), ("Y", 2, 0), ("Z", 1, 1)], rest=rest)
    program = t.write("nodes.ngc", "G21 G90 F3000\nG1 X10 Y10 Z-1\nM64 P0\nG1 X0 Y0 Z0\nM65 P0\nM2\n")
    status, summary, err = bus_pair.run_controller("nodes", "--machine", path, program=program)
    if t.check(status == 0, "they run", err):
        kinds = [[r["name"] for r in summary[bus]["responses"]] for bus in ("bus", "can1")]
        t.check("inputs" not in kinds[0] and "inputs" in kinds[1], "inputs come over the second bus", kinds)
        t.check([k.count("TPDO1") for k in kinds] == [2, 2], "two drives report on each", kinds)
    status, printed, _ = t.run("machine", path)
    t.check("[drive 1:3]" in printed and "drive_bus = 1" in printed, "printed as it is read")
    status, again, _ = t.run("machine", t.write("again.ini", printed))
    t.check(again == printed, "read again it is the same")


def check_guarding():
    """Without a heartbeat a drive on the second bus is asked for its state there, and not on the first; silent, it is a fault."""
    t.run("drives", "--eds", "own.eds")
    sheet = data_sheets.read("own.eds")
    data_sheets.no_heartbeat(sheet, None)
    data_sheets.write("quiet.eds", sheet)
    guarded = machine("guarded", TWO, rest="[drive 1:1]\neds = quiet.eds\n")
    status, summary, err = run("guarded", "--machine", guarded, "--bus-log", "guarded.log")
    t.check(status == 0, "a drive without a heartbeat on the second bus runs", err)
    with open("guarded.log") as file:
        asked = {(line.split()[1], line.split()[2]) for line in file if "#R" in line}
    t.check({(bus, frame[:3]) for bus, frame in asked} == {("can1", "701")}, "its node alone is asked, on its bus", asked)
    kinds = [{r["name"] for r in summary[bus]["responses"]} for bus in ("bus", "can1")]
    t.check("guarding" not in kinds[0] and "guarding" in kinds[1], "guarding is in the worst case of that bus", kinds)
    check_buses("guarded", summary, 1000)
    mute = t.write("mute.inject", "enabled+0.2s drive 1:1 mute what=heartbeat for=2s\n")
    status, _, err = run("mute", "--machine", guarded, "--inject", mute)
    t.check(status == 1 and "Z (node 1:1)" in err, "no answer any more: a fault of that node", status, err)


def check_order():
    """The order of sections does not matter: the same judgement, the same setpoints."""
    draw = random.Random(27)
    for k in range(12):
        places = [(axis, 1 + i, draw.randint(0, 1)) for i, axis in enumerate("XYZABC"[: draw.randint(2, 6)])]
        cycle_us = draw.choice([250, 500, 1000])
        outcomes = set()
        for _ in range(2):
            draw.shuffle(places)
            status, summary, err = bus_pair.run_controller("order", "--machine", machine("order", places, cycle_us))
            outcomes.add((status, summary and summary["setpoint_digest"], err))
            if summary:
                os.remove("order.json")
        t.check(len(outcomes) == 1, f"machine {k}: in any order", outcomes)


check_setpoints()
check_half_the_cycle()
check_quarter()
check_refusals()
check_loss()
check_log()
check_outside()
check_nodes()
check_guarding()
check_order()
t.finish()
