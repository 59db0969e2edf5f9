"""takt serve: registers, states, programs, MDI, jog, homing, offsets, faults, as a client on Modbus TCP sees them."""

import re
import struct

import panel_client as p
import takt_test as t

# After a first wrong password none is looked at for so many.
WRONG_CYCLES = 1000

PROGRAM = b"G21 G90 G61 F1800\nG1 X3 Y2\nG2 X5 Y0 I0 J-2\nG1 X0\nG0 Z1\nM2\n"


def ready(*options):
    service = p.serve(*options)
    client = service.client()
    client.wait_for("STATE", p.IDLE)
    return service, client


def check_registers():
    """Every register can be read as its table says, alone and in blocks; what is not there cannot."""
    service, client = ready()
    for name, row in p.REGISTERS.items():
        function, address, count = p.FUNCTIONS[row["table"]], int(row["address"]), int(row["registers"])
        words = client.read_words(function, address, count)
        t.check(len(words) == count, f"{name} is read")
        if row["form"] in ("16 bits", "bit") and row["written_in"] != "never" and name not in ("UPLOAD_LENGTH", "UPLOAD_COMMAND"):
            t.check(int(row["least_counts"]) <= words[0] <= int(row["most_counts"]), f"{name} is within its range", words)
    t.check(client.read_words(2, 0, 13) == client.read_words(1, 0, 13), "function 02 reads what 01 does")
    t.check(client.read_words(4, 56, 6)[3] == 0 and client.read_words(3, 36, 20)[3] == 0, "gaps read as 0")
    block = client.read_words(4, 0, 51)
    t.check(block[0] == 1 and block[1] == p.IDLE and block[15] == 7, "a block of input registers", block)
    for function, address, count, code in (
        (1, 26, 1, 2), (3, 420, 1, 2), (4, 400, 1, 2), (4, 390, 52, 2), (3, 65535, 2, 2),
        (3, 0, 0, 3), (3, 0, 126, 3), (1, 0, 2001, 3), (4, 0, 65535, 3), (22, 0, 1, 1), (43, 0, 1, 1),
    ):
        try:
            client.read_words(function, address, count)
            got = 0
        except p.Refused as refused:
            got = refused.code
        t.check(got == code, f"function {function} at {address}, {count}: exception {code}", got)
    check_writes(client)
    service.stop()


def check_writes(client):
    """Each writable number takes its least and its most, where that starts nothing, and refuses what is beyond."""
    own = ("UPLOAD_COMMAND", "UPLOAD_CHECK", "PASSWORD", "JOG_AXIS", "WATCHDOG", "TOOL_DIAMETER", "TOOL_WEAR_LENGTH", "TOOL_WEAR_TIME")
    for name, row in p.REGISTERS.items():
        if row["table"] != "holding" or row["form"] in ("text", "bytes") or name in own or name.startswith("TOOL_OFFSET"):
            continue
        before = client.counts(name)
        for counts in (int(row["least_counts"]), int(row["most_counts"])):
            client.put(name, counts * float(row["scale"]))
            t.check(client.counts(name) == counts, f"{name} takes {counts}", client.counts(name))
        if int(row["most_counts"]) < 65535:
            beyond = (int(row["most_counts"]) + 1) * float(row["scale"])
            t.check(client.refusal(name, beyond) == (3, 4), f"{name} refuses what is beyond its range")
            t.check(client.counts(name) == int(row["most_counts"]), f"{name} keeps its value then")
        if before >= int(row["least_counts"]):
            client.put(name, before * float(row["scale"]))
    for name in ("SINGLE_BLOCK", "OPTIONAL_STOP", "BLOCK_DELETE", "CORRECTION_MATRIX", "CORRECTION_WEAR"):
        for value in (1, 0):
            client.put(name, value)
            t.check(client.counts(name) == value, f"{name} takes {value}")
    t.check(client.refusal("TOOL_DIAMETER", 5) == (3, 4), "a tool that is not in the table has no diameter to set")
    t.check(client.refusal("JOG_AXIS", 4) == (3, 4), "an axis that is not there cannot be jogged")
    t.check(client.refusal("PASSWORD", 7) == (3, 4), "a password where none is asked for is wrong")
    t.check(client.refusal("CYCLE_START", 1) == (4, 1), "without a program nothing starts")
    t.check(client.refusal("RESUME", 1) == (4, 1), "when nothing is held nothing is resumed")


def check_program():
    """A program through the mailbox gives the setpoints that takt run gives; the file has it whole."""
    with open("part.ngc", "wb") as file:
        file.write(PROGRAM)
    summary = t.json.loads(t.run("run", "part.ngc", "--json", "-", "--quiet")[1])
    service, client = ready("--store", "stored.ngc")
    t.check(client.run(PROGRAM) == p.COMPLETED, "an uploaded program runs to its end", client.text("ALARM_TEXT"))
    t.check(client.digest() == summary["setpoint_digest"], "its setpoints are those of takt run")
    t.check(abs(client.get("POSITION_Z") - 1) < 1e-9 and abs(client.get("ACTUAL_Z") - 1) < 0.01, "the axes are at its end")
    with open("stored.ngc", "rb") as file:
        t.check(file.read() == PROGRAM, "the file has the program")
    runs = client.counts("RUNS")
    client.put("FEED_OVERRIDE", 0) # it runs as long as we like
    client.put("CYCLE_START", 1)
    t.check(client.refusal("MODE", 1) == (4, 1), "the mode stays while a program runs")
    t.check(client.refusal("CYCLE_START", 1) == (4, 1), "it cannot be started twice")
    client.begin_upload(b"G0 X1\n")
    client.send_chunk(0, b"G0 X1\n")
    t.check(client.refusal("UPLOAD_COMMAND", 2) == (4, 1), "no program is exchanged while one runs")
    client.put("FEED_OVERRIDE", 100)
    client.wait_while("RUNS", runs)
    client.put("UPLOAD_COMMAND", 2)
    t.check(client.counts("PROGRAM_SIZE") == 6, "then it is")
    status, out, err, _ = service.stop()
    t.check(status == 0 and "served" in out and err == "", "SIGTERM is status 0", status, out, err)

    service, client = ready("--store", "stored.ngc")
    t.check(client.counts("PROGRAM_SIZE") == 6, "the stored program is there again")
    service.stop()


def check_single_block():
    """Switched on and off while a program runs."""
    service, client = ready()
    client.upload(b"G21 G90 G64 F6000\n" + b"".join(b"G1 X%d\n" % x for x in range(5, 155, 5)) + b"M2\n")
    runs = client.counts("RUNS")
    client.put("FEED_OVERRIDE", 20)
    client.put("CYCLE_START", 1)
    client.wait_above("POSITION_X", 12)
    client.put("SINGLE_BLOCK", 1)
    client.wait_for("STATE", p.HELD)
    client.wait_for("FEED", 0)
    held = client.get("POSITION_X")
    t.check(held % 5 == 0 and held < 150 and client.counts("HOLD_REASON") == 2, "the axes hold at a block end", held)
    client.put("CYCLE_START", 1)
    client.wait_for("STATE", p.HELD)
    client.wait_for("FEED", 0)
    t.check(client.get("POSITION_X") == held + 5, "and at the next", client.get("POSITION_X"))
    client.put("SINGLE_BLOCK", 0)
    client.put("FEED_OVERRIDE", 100)
    client.put("CYCLE_START", 1)
    client.wait_while("RUNS", runs)
    t.check(client.counts("OUTCOME") == p.COMPLETED and client.get("POSITION_X") == 150, "switched off they run through")
    service.stop()


def check_bus_log():
    """Every frame of the embedded bus, readable while the service runs."""
    service, client = ready("--bus-log", "serve.log")
    until = p.time.monotonic() + p.PATIENCE_S
    while not t.os.path.getsize("serve.log"):
        assert p.time.monotonic() < until, "the log is written while the service runs"
        p.time.sleep(0.05)
    status, out, err, _ = service.stop()
    t.check(status == 0 and err == "", "a logged service ends well", status, err)
    with open("serve.log") as file:
        lines = file.read().splitlines()
    wrong = [line for line in lines if not re.fullmatch(r"\(\d{10}\.\d{6}\) can0 [0-9A-F]{3}#[0-9A-F]*", line)]
    t.check(not wrong, "lines are those of candump -L", wrong[:3])
    syncs = sum("can0 080#" in line for line in lines)
    cycles = int(re.search(r"served (\d+) cycles", out).group(1))
    t.check(cycles - 2 <= syncs <= cycles, "there is a SYNC for each cycle", syncs, cycles)
    status, _, err = t.run("serve", "--listen", "127.0.0.1:0", "--bus-log", "no/such/folder/serve.log")
    t.check(status == 3 and "--bus-log no/such/folder/serve.log: it cannot be written" in err, "a log needs a place", status, err)
    for place in ("no/such/folder/program.ngc", "."):
        status, _, err = t.run("serve", "--listen", "127.0.0.1:0", "--http", "off", "--state", "none", "--store", place)
        t.check(status == 3 and f"--store {place}: programs cannot be kept there" in err, "and so does a store", status, err)


def check_errors_of_programs():
    service, client = ready()
    t.check(client.run(b"G21 F600\nG1 X1\nG1 Q5\nM2\n") == p.FAILED, "a program with an error fails")
    t.check(client.counts("STATE") == p.ALARM and client.counts("ALARM") == 1, "with an alarm of the program")
    t.check(client.counts("ALARM_LINE") == 3 and "Q" in client.text("ALARM_TEXT"), "that names line and word", client.text("ALARM_TEXT"))
    t.check(abs(client.get("POSITION_X") - 1) < 1e-9, "what stood before the error has been done")
    t.check(client.refusal("CYCLE_START", 1) == (4, 1), "it does not start again by itself")
    t.check(client.refusal("ACKNOWLEDGE", 1) == (4, 1), "to have seen it is not enough")
    client.put("RESET", 1)
    client.wait_for("STATE", p.IDLE)
    t.check(client.counts("ALARM") == 0, "reset clears it")
    service.stop()


def check_by_hand():
    service, client = ready()
    t.check(client.refusal("MDI_START", 1) == (4, 1), "MDI needs its mode")
    client.put("MODE", 1)
    t.check(client.run_line("G0 X5 Y-5") == p.COMPLETED, "a line runs", client.text("ALARM_TEXT"))
    t.check((client.get("POSITION_X"), client.get("POSITION_Y")) == (5.0, -5.0), "to where it says")
    t.check(client.run_line("G91") == client.run_line("X1") == p.COMPLETED and client.get("POSITION_X") == 6, "with the modes of the line before")
    t.check(client.run_line("G90 X5") == p.COMPLETED, "and back")
    t.check(client.run_line("G0 X9999") == p.FAILED and "travel" in client.text("ALARM_TEXT"), "not beyond the travel")
    client.put("RESET", 1)
    client.wait_for("STATE", p.IDLE)

    client.put("MODE", 2)
    client.put("JOG_AXIS", 1)
    client.put("JOG_FEED", 3000)
    t.check(client.refusal("JOG_PLUS", 1) == (4, 1), "a jog without end needs a panel in control")
    client.put("JOG_DISTANCE", 2.5)
    runs = client.counts("RUNS")
    client.put("JOG_PLUS", 1)
    client.wait_while("RUNS", runs)
    t.check(abs(client.get("POSITION_Y") + 2.5) < 1e-9, "a jog goes its distance", client.get("POSITION_Y"))
    client.put("JOG_DISTANCE", 1000)
    t.check(client.refusal("JOG_MINUS", 1) == (3, 4), "not beyond the travel", client.counts("STATE"))
    client.put("HOME", 1)
    client.wait_for("STATE", p.IDLE)
    t.check((client.get("POSITION_X"), client.get("POSITION_Y")) == (0.0, 0.0), "homing ends at zero")
    service.stop()


def check_offsets():
    t.write("tools.tbl", "T3 P1 Z20 D6\n")
    service, client = ready("--tools", "tools.tbl")
    client.put("WORK_SYSTEM", 2)
    client.put("WORK_OFFSET_X", 12.345)
    client.put("WORK_SYSTEM", 1)
    t.check(client.get("WORK_OFFSET_X") == 0, "each system has its own offsets")
    client.put("TOOL_SELECT", 3)
    t.check(abs(client.get("TOOL_OFFSET_Z") - 20) < 1e-9 and abs(client.get("TOOL_DIAMETER") - 6) < 1e-9, "a tool's values are shown")
    client.put("TOOL_OFFSET_Z", 30)
    t.check(client.run(b"G55 G0 X1\nT3 M6\nG43 G0 Z1\nM2\n") == p.COMPLETED, "a program runs", client.text("ALARM_TEXT"))
    t.check(abs(client.get("POSITION_X") - 13.345) < 1e-9, "with the work offset")
    t.check(abs(client.get("POSITION_Z") - 31) < 1e-9, "and the tool's length")
    service.stop()


def check_emergency():
    service, client = ready()
    client.upload(b"G21 G90 F3000\nG1 X400\nM2\n")
    client.put("CYCLE_START", 1)
    client.wait_above("POSITION_X", 5)
    client.put("EMERGENCY_STOP", 1)
    t.check(client.counts("STATE") == p.EMERGENCY and client.counts("ALARM") == 5, "emergency stop at once")
    t.check(client.refusal("RESET", 1) == (4, 1), "no reset while the button is in")
    client.put("EMERGENCY_STOP", 0)
    client.wait_for("STATE", p.ALARM)
    client.reset()
    at = client.get("POSITION_X")
    t.check(5 < at < 400 and abs(client.get("ACTUAL_X") - at) < 0.01, "the drives are where the setpoint is", at)
    client.put("MODE", 1)
    t.check(client.run_line("G0 X0") == p.COMPLETED and client.get("POSITION_X") == 0, "and move from there")
    service.stop()


def check_emergency_at_the_end():
    """SIGTERM: on the way to rest nothing is begun any more, but everybody may stop at once."""
    service, client = ready("--set", "axis.X.max_acceleration_mm_s2=50", "--set", "axis.X.max_jerk_mm_s3=100")
    client.upload(b"G21 G90 F6000\nG1 X400\nM2\n")
    client.put("CYCLE_START", 1)
    client.wait_above("FEED", 3000)
    service.process.terminate()
    client.wait_for("STATE", p.STOPPING)
    t.check(client.refusal("SINGLE_BLOCK", 1) == (4, 1), "a service that ends takes no orders")
    t.check(client.refusal("FEED_HOLD", 1) == (0, 0), "but a hold")
    stop, state = (int(p.REGISTERS[name]["address"]) for name in ("EMERGENCY_STOP", "STATE"))
    reply = client.ask(struct.pack(">BHH", 5, stop, 0xFF00), struct.pack(">BHH", 4, state, 1))  # it is gone soon
    t.check(reply[2:] == struct.pack(">H", p.EMERGENCY), "and an emergency stop", reply)
    t.check(service.process.wait(p.PATIENCE_S) == 0, "it has ended in order")


def check_rights():
    service, one = ready("--set", "panel.password=4711")
    two = service.client()
    t.check(one.refusal("MODE", 1) == (4, 2), "without the password nothing is written")
    began = one.counts("CYCLES")
    t.check(one.refusal("PASSWORD", 1) == (3, 4), "a wrong one is refused")
    refusal = one.refusal("PASSWORD", 4711)
    is_soon = one.counts("CYCLES") - began < WRONG_CYCLES  # a busy computer may be late with the second
    t.check(refusal == (6, 6) or not is_soon, "after it none is looked at for a while", refusal)
    p.until(lambda: one.refusal("PASSWORD", 4711)[0] == 0, lambda: "the password stays refused")
    one.put("MODE", 1)
    t.check(two.refusal("MODE", 0) == (4, 2), "it counts for one client")
    two.put("FEED_HOLD", 1)
    two.put("PASSWORD", 4711)
    one.put("WATCHDOG", 60000)
    t.check(two.refusal("MODE", 0) == (6, 3), "one panel in control is the only one to write")
    t.check((one.counts("CONTROL"), two.counts("CONTROL")) == (1, 2), "each sees who it is")
    one.put("WATCHDOG", 0)
    two.put("MODE", 0)
    service.stop()

    service = p.serve("--set", "panel.allow=10.0.0.0/8,::1")
    try:
        client = service.client()
        client.get("STATE")
        answered = True
    except (ConnectionError, OSError):
        answered = False
    t.check(not answered, "an address that is not allowed is not answered")
    t.check("1 refused" in service.stop()[1], "and counted")


def check_spindle_lost():
    """The spindle drive goes silent in a cut: the axes rest, and nothing goes on without the operator."""
    fast = "--set", "spindle.ramp_rpm_s=100000"
    drive = p.Service("--spindle", "127.0.0.1:0", *fast, command="drives")
    service, client = ready("--spindle", f"127.0.0.1:{drive.port}", *fast)
    client.upload(b"G21 G90 F1200\nM3 S6000\nG1 X400\nM2\n")
    client.put("CYCLE_START", 1)
    client.wait_above("SPINDLE_SPEED", 5900)
    t.check(client.counts("STATE") == p.RUNNING, "a program turns the spindle and cuts")
    drive.stop()
    client.wait_for("STATE", p.HELD)
    t.check(client.counts("HOLD_REASON") == 4 and client.counts("ALARM") == 3, "held for the spindle, with an alarm")
    t.check("does not answer" in client.text("ALARM_TEXT"), "that says why", client.text("ALARM_TEXT"))
    client.wait_for("FEED", 0)
    at = client.get("POSITION_X")
    t.check(client.refusal("RESUME", 1) == (4, 1), "it does not go on")
    client.put("ACKNOWLEDGE", 1)
    client.wait_while("ALARM", 0)
    t.check(client.refusal("RESUME", 1) == (4, 1) and client.get("POSITION_X") == at, "while the drive is away")
    client.put("RESET", 1)
    client.wait_for("STATE", p.IDLE)
    t.check(client.counts("OUTCOME") == p.ABORTED, "it can be given up")
    service.stop()


def check_line():
    """The same panel on a serial line, by the target's own frames."""
    line = p.Line()
    service = p.Service("--listen", "127.0.0.1:0", "--serial", line.path + ",115200,none", "--unit", "7")
    client = service.client()
    client.wait_for("STATE", p.IDLE)
    reply = line.ask(b"\x04\x00\x00\x00\x02", 2 + 4, unit=7)
    t.check(reply == b"\x04\x04\x00\x01\x00\x01", "input registers on the line", reply)
    line.ask(b"\x06\x00\x00\x01\xf4", 5, unit=7)
    t.check(client.get("FEED_OVERRIDE") == 50, "what is written there is seen on TCP")
    try:
        line.ask(b"\x06\x00\x00\xff\xff", 2, unit=7)
        refused = 0
    except p.Refused as exception:
        refused = exception.code
    t.check(refused == 3, "out of range: exception 03")
    frame = b"\x00\x06\x00\x00\x02\x58"
    line.send(frame + p.struct.pack("<H", p.crc16(frame)))
    client.wait_for("FEED_OVERRIDE", 600)
    t.check(line.is_silent(), "a broadcast is carried out and not answered")
    frame = b"\x08\x06\x00\x00\x02\x59"
    line.send(frame + p.struct.pack("<H", p.crc16(frame)))
    t.check(line.is_silent() and client.counts("FEED_OVERRIDE") == 600, "other units are left alone")
    service.stop()
    line.close()


check_registers()
check_program()
check_single_block()
check_bus_log()
check_errors_of_programs()
check_by_hand()
check_offsets()
check_emergency()
check_emergency_at_the_end()
check_rights()
check_spindle_lost()
check_line()
t.finish()
