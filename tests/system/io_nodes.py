"""I/O nodes: outputs of programs reach the bus, inputs come back, those that stop do so within two cycles."""

import re

import bus_pair
import panel_client as p
import takt_test as t

MACHINE = t.write("io.ini", "[io 1]\nnode = 20\noutputs = flood mist spindle ccw P0 P1 !P2\ninputs = - - - - P0 stop P2 limit\n")
LOOP = t.write("loop.ngc", """G21 G90 F3000
M3 S1000
M8
M64 P0
M66 P0 L3 Q1
(print, P0 #5399)
G1 X20 Y10
M65 P0
M66 P0 L4 Q1
(print, P0 #5399)
M66 P0 L3 Q0.2
(print, late #5399)
M4 S500
M9
M7
G1 X0 Y0
M2
""")
LONG = t.write("long.ngc", "G21 G90 F6000\nG1 X100 Y60\nX0 Y0\nM2\n")


def frames(path, identifier):
    """Times in ms and data of the frames with this identifier."""
    found = []
    with open(path) as file:
        for line in file:
            time, _, frame = line.split()
            if frame.startswith(identifier + "#"):
                found.append((1000 * float(time.strip("()")), frame.split("#")[1]))
    return found


def check_outputs():
    status, out, err = t.run("run", LOOP, "--machine", MACHINE, "--bus-log", "loop.log")
    t.check(status == 0, "a program with outputs and inputs runs", err)
    said = re.findall(r"(P0|late) (-?[\d.]+)", out + err)
    t.check([(word, float(value)) for word, value in said] == [("P0", 1), ("P0", 0), ("late", -1)], "M66 sees what M64 and M65 do", said)
    levels = [data for _, data in frames("loop.log", "214")]
    steps = [data for i, data in enumerate(levels) if i == 0 or data != levels[i - 1]]
    t.check(steps == ["4000", "5500", "4500", "4E00", "4000"], "every output is on the bus", steps)
    times = [time for time, _ in frames("loop.log", "214")]
    t.check(max(b - a for a, b in zip(times, times[1:])) < 101.5, "and is repeated every 100 ms")


def stop(script, name):
    t.write(name + ".inject", script)
    status, _, err = t.run("run", LONG, "--machine", MACHINE, "--inject", name + ".inject", "--bus-log", name + ".log", "--json", name + ".json")
    return status, err


CHANGER = t.write("changer.ini", "[io 1]\nnode = 20\noutputs = tool_change T0 T1 T2 spindle flood\ninputs = tool_changed\n")
CHANGES = t.write("changes.ngc", "G21 G90 F3000\nT5 M6\nM3 S1000\nG1 X5\nT2\nG1 X10\nM6\nM8\nG1 X0\nT3 M6\nM2\n")


def steps_of(log):
    levels = [data[:2] for _, data in frames(log, "214")]
    return [data for i, data in enumerate(levels) if i == 0 or data != levels[i - 1]]


def check_changer():
    """The virtual node answers each output by its input: request and answer rise and fall before anything else is done."""
    status, _, err = t.run("run", CHANGES, "--machine", CHANGER, "--bus-log", "changer.log", "--json", "changer.json")
    t.check(status == 0, "tools are changed", err)
    t.check(steps_of("changer.log") == ["00", "0B", "0A", "1A", "14", "05", "04", "24", "27", "26", "06"],
            "the changer is asked for each tool, and let go, before the program goes on", steps_of("changer.log"))
    t.write("deaf.inject", "power+0s io 20 report object=6000:01 value=00\n")
    status, _, err = t.run("run", CHANGES, "--machine", CHANGER, "--inject", "deaf.inject", "--set", "machine.tool_change_s=3")
    t.check(status == 1 and "the tool changer has not ended its answer to M6 within 3 s" in err, "one that does not answer is an alarm", err)
    t.write("stuck.inject", "power+0s io 20 report object=6000:01 value=01\n")
    status, _, err = t.run("run", CHANGES, "--machine", CHANGER, "--inject", "stuck.inject", "--set", "machine.tool_change_s=3",
                           "--bus-log", "stuck.log")
    t.check(status == 1 and "within 3 s" in err, "so is an answer that never falls", err)
    t.check(all(int(step, 16) & 1 == 0 for step in steps_of("stuck.log")), "and nothing is asked of it", steps_of("stuck.log"))
    status, _, err = t.run("compile", CHANGES, "-o", "changes.plan", "--machine", CHANGER, "--quiet")
    if t.check(status == 0, "the program is compiled", err):
        status, _, err = t.run("run", CHANGES, "--plan", "changes.plan", "--machine", CHANGER, "--bus-log", "planned.log")
        t.check(status == 0 and steps_of("planned.log") == steps_of("changer.log"), "a compiled one changes tools likewise", err,
                steps_of("planned.log"))


def check_stops():
    for bit, word in ((5, "stop"), (7, "limit")):
        value = 0xE0 ^ 1 << bit
        status, err = stop(f"enabled+0.3s io 20 report object=6000:01 value={value:02X}\n", word)
        t.check(status != 0 and f"the {word} input, bit {bit} of I/O node 20" in err, f"the {word} input is a fault", status, err)
        opened = next(time for time, data in frames(word + ".log", "194") if not int(data[:2], 16) >> bit & 1)
        braked = [next(time for time, data in frames(word + ".log", f"20{node}") if data.startswith("0200")) for node in (1, 2, 3)]
        # The report lies within the cycle after the switch; the quick stop in the cycle after the report.
        t.check(max(braked) - opened < 1.5, f"the {word} input brakes all drives in the next cycle", opened, braked)
        t.check(frames(word + ".log", "301")[-1][0] - opened < 1, "no target is sent in a later cycle")
    status, err = stop("enabled+0.3s io 20 mute what=heartbeat\n", "silent")
    t.check(status != 0 and "I/O node 20 has sent no heartbeat for 301 ms" in err, "a silent I/O node is a fault", status, err)
    status, err = stop("power bus cut node=20\n", "absent")
    t.check(status != 0 and "I/O node 20 has not booted" in err, "an absent I/O node is a fault", status, err)
    status, err = stop("power io 21 hang\n", "nobody")
    t.check(status == 2 and "there is no drive with node 21" in err, "a script names nodes there are", status, err)


def check_digest():
    """Outputs on the bus change no setpoint."""
    plain = t.run("run", LONG, "--json", "plain.json")
    with_io = t.run("run", LONG, "--machine", MACHINE, "--json", "with.json")
    same = t.load_json("plain.json")["setpoint_digest"] == t.load_json("with.json")["setpoint_digest"]
    t.check(plain[0] == with_io[0] == 0 and same, "an I/O node changes no setpoint")


def check_analogues():
    """M67 with the motion, M68 at once; what the node has is what the program says, and 0 when it is left."""
    machine = t.write("analogue.ini", "[io 1]\nnode = 20\nanalogue_outputs = E1 - E0\n")
    program = t.write("laser.ngc", "G21 G90 F3000\nM68 E0 Q25\nM67 E1 Q-100\nG1 X5\nM67 E1 Q200\nG1 X10\nM68 E0 Q0\nM68 E1 Q0\nM2\n")
    status, _, err = t.run("run", program, "--machine", machine, "--bus-log", "laser.log", "--json", "laser.json")
    t.check(status == 0, "a program with analogue outputs runs", err)
    values = [data for _, data in frames("laser.log", "314")]
    steps = [data for i, data in enumerate(values) if i == 0 or data != values[i - 1]]
    t.check(steps == ["0" * 16, "0180000000200000", "FF7F000000200000", "0" * 16],
            "every analogue output is on the bus", steps)
    times = [time for time, _ in frames("laser.log", "314")]
    t.check(max(b - a for a, b in zip(times, times[1:])) < 1.5, "in every cycle")
    both = bus_pair.run_both(machine, program, "takt drives has analogue outputs, too")
    if both:
        bus_pair.compare("outside", *both)
    for value, said in (("E4", "'E4' is none of E0 ... E3 and -"), ("E0 E0 E0 E0 E0", "more than 4 outputs")):
        status, _, err = t.run("machine", "--set", "io.1.node=20", "--set", f"io.1.analogue_outputs={value}")
        t.check(status == 2 and said in err, f"analogue_outputs={value} is refused", status, err)
    status, out, err = t.run("machine", machine)
    t.check("analogue_outputs = E1 - E0\n" in out, "and what is taken is printed", err)


def check_outside():
    """The same in two processes: the trace is that of the embedded bus."""
    both = bus_pair.run_both(MACHINE, LOOP, "takt drives has I/O nodes, too")
    if both:
        bus_pair.compare("outside", *both)


def check_service():
    """A stop input that opens is an alarm of the service, which turns coolant off; so it closes, and RESET helps."""
    loop = t.write("flood.ini", "[io 1]\nnode = 20\noutputs = flood P0\ninputs = !stop\n")
    service = p.serve("--machine", loop)
    client = service.client()
    client.wait_for("STATE", p.IDLE)
    client.put("MODE", 1)
    t.check(client.run_line("M64 P0") == p.COMPLETED, "a line sets an output", client.text("ALARM_TEXT"))
    client.put_text("MDI_TEXT", "M8")
    client.put("MDI_START", 1)
    client.wait_for("STATE", p.ALARM)
    t.check("the stop input, bit 0 of I/O node 20, is open" in client.text("ALARM_TEXT"), "the stop input is an alarm", client.text("ALARM_TEXT"))
    client.reset()
    t.check(client.run_line("G0 X5") == p.COMPLETED and client.get("POSITION_X") == 5, "after a reset the axes move", client.text("ALARM_TEXT"))
    service.stop()


check_outputs()
check_changer()
check_stops()
check_digest()
check_analogues()
check_outside()
check_service()
t.finish()
