"""CAN FD: the same setpoints in less time on the bus, within what was said of it before; advice where a bus is too slow."""

import random
import re

import bus_pair
import takt_test as t

ADVICE = "data_bitrate = 4000000 (CAN FD) or drive_bus = 1 for ZA and error_pdo = 0 (two buses) or cycle_us = 1000 would do"
DATA = ["--set", "bus.data_bitrate=5000000"]
PROGRAM = t.write("four.ngc", "G21 G90 G17 F3000\nG1 X20 Y10 Z-2 A30\nG2 X30 Y20 I0 J10\nG4 P0.05\nG0 X0 Y0 Z5 A0\nM2\n")


def machine(name, axes="XYZA", cycle_us=1000, rest=""):
    text = f"[machine]\ncycle_us = {cycle_us}\n{rest}"
    for node, axis in enumerate(axes, 1):
        text += f"[axis {axis}]\ndrive_node = {node}\n"
    return t.write(name + ".ini", text)


def run(name, *options, program=PROGRAM):
    return bus_pair.run_controller(name, *options, program=program)


def check_bus(what, summary):
    bus = summary["bus"]
    t.check(0 < bus["load_percent"] <= bus["predicted_load_percent"] <= 100, what + ": the load is within the computed one", bus)
    for response in bus["responses"]:
        within = response["predicted_us"] is not None and response["observed_us"] <= response["predicted_us"]
        t.check(within, what + ": no response above its worst case", response)
    cyclic = [r for r in bus["responses"] if r["name"] != "heartbeat"]  # those of all nodes may meet, and are last in rank
    t.check(all(r["predicted_us"] <= summary["cycle_us"] for r in cyclic), what + ": all within the cycle", bus)


def check_half_the_cycle():
    """Four axes at 0.5 ms: classical CAN is refused with advice, CAN FD is not."""
    fast = machine("fast", cycle_us=500)
    status, summary, err = run("classical", "--machine", fast)
    t.check(status == 2 and summary is None, "four axes at 0.5 ms are refused on classical CAN", status, err)
    t.check("965 of 500 bits" in err and ADVICE in err, "with advice", err)
    status, summary, err = run("fd", "--machine", fast, *DATA)
    if t.check(status == 0, "CAN FD carries them", err):
        summary["cycle_us"] = 500
        check_bus("0.5 ms", summary)
        t.check(len([r for r in summary["bus"]["responses"] if r["name"] == "RPDO2"]) == 1, "in one frame of targets", summary["bus"])


def check_digest():
    """The bus is not seen in the setpoints."""
    slow = machine("slow")
    status, classical, err = run("classical", "--machine", slow)
    t.check(status == 0, "four axes at 1 ms on classical CAN", err)
    for rate in (1000000, 2000000, 8000000):
        status, summary, err = run("fd", "--machine", slow, "--set", f"bus.data_bitrate={rate}")
        t.check(status == 0 and summary["setpoint_digest"] == classical["setpoint_digest"], f"{rate} bit/s: the same setpoints", err)
        summary["cycle_us"] = 1000
        check_bus(f"{rate} bit/s", summary)
        below = summary["bus"]["predicted_load_percent"] < classical["bus"]["predicted_load_percent"]
        t.check(below or rate == 1000000, "with a lower load, where data are sent faster", summary["bus"])


def check_drives():
    """Six axes; a drive that knows no dummies parts the group; noise on the bus; drives of another process; the log."""
    six = machine("six", "XYZABC", 500)
    status, summary, err = run("six", "--machine", six, "--set", "bus.data_bitrate=8000000")
    if t.check(status == 0, "six axes at 0.5 ms", err):
        summary["cycle_us"] = 500
        check_bus("six axes", summary)
        targets = [r["bytes"] for r in summary["bus"]["responses"] if r["name"] == "RPDO2"]
        t.check(targets == [24], "24 bytes of targets", targets)
    t.run("drives", "--eds", "plain.eds")
    with open("plain.eds") as file:
        t.write("dumb.eds", re.sub(r"Dummy000([1-7])=1", r"Dummy000\1=0", file.read()))
    status, summary, err = run("dumb", "--machine", machine("dumb", rest="[drive 3]\neds = dumb.eds\n"), *DATA)
    if t.check(status == 0, "a drive without dummies", err):
        targets = [r["bytes"] for r in summary["bus"]["responses"] if r["name"] == "RPDO2"]
        t.check(targets == [4] * 4, "a frame for each target", targets)
    noise = t.write("noise.inject", "enabled+0.2s bus corrupt ratio=0.05 seed=7\n")
    status, summary, err = run("noisy", "--machine", machine("noisy"), "--inject", noise, "--bus-log", "fd.log", *DATA)
    t.check(status == 0, "one frame of twenty destroyed and sent again", err)
    with open("fd.log") as log:
        kinds = {re.sub(r".*[0-9A-F]{3}(##1|#).*", r"\1", line.strip()) for line in log}
    t.check(kinds == {"##1"}, "the log has frames of CAN FD with rate switch", kinds)
    both = bus_pair.run_both(machine("pair", rest="[bus]\ndata_bitrate = 5000000\n"), PROGRAM, "drives of another process on CAN FD")
    if both:
        bus_pair.compare("outside", *both)


def advised(err):
    return re.findall(r"(data_bitrate|bitrate|cycle_us) = (\d+)", err.split("; ", 1)[1] if "; " in err else "")


def check_advice():
    """Random machines: what a refusal advises is not refused, and a cycle 50 us shorter than that is."""
    draw = random.Random(27)
    refused = 0
    for _ in range(60):
        axes = "XYZABC"[: draw.randint(1, 6)]
        keys = {"bus.bitrate": draw.choice([250000, 500000, 1000000]), "machine.cycle_us": 50 * draw.randint(4, 40)}
        keys["bus.data_bitrate"] = draw.choice([0, 0, 1000000, 2000000, 5000000])
        given = ["check", PROGRAM if "A" in axes else bus_pair.PROGRAM, "--machine", machine("any", axes)]

        def outcome(**changed):
            text = {**keys, **{k: v for k, v in changed.items()}}
            return t.run(*given, *[o for k, v in text.items() for o in ("--set", f"{k}={v}")])

        status, _, err = outcome()
        if "bus cannot carry" not in err:
            continue
        refused += 1
        for key, value in advised(err):
            full = ("machine." if key == "cycle_us" else "bus.") + key
            status, _, after = outcome(**{full: value})
            t.check("bus cannot carry" not in after, f"{keys}: {key} = {value} does", after)
            if key == "cycle_us":
                status, _, after = outcome(**{full: int(value) - 50})
                t.check("bus cannot carry" in after, f"{keys}: {value} is the shortest cycle", after)
    t.check(refused > 15, "enough are refused", refused)


def check_refusals():
    status, _, err = run("slow", "--set", "bus.data_bitrate=500000")
    t.check(status == 2 and "data_bitrate 500000 is below bitrate" in err, "data are not slower than the rest", err)
    status, _, err = run("mad", "--set", "bus.data_bitrate=9000000")
    t.check(status == 2 and "at most 8000000" in err, "nor faster than there is", err)


check_half_the_cycle()
check_digest()
check_drives()
check_advice()
check_refusals()
t.finish()
