"""What takt serve keeps: after a clean end, after kill -9, beside files that change, and what it refuses."""

import os
import signal
import struct

import panel_client as p
import takt_test as t

PROGRAM = b"G21 G90 F1200\n" + b"".join(b"G1 X%d\n" % (10 * (i % 2) + 5) for i in range(200)) + b"M2\n"


def start(*options):
    service = p.serve("--state", "kept", "--tools", "tools.tbl", *options)
    client = service.client()
    client.wait_for("STATE", p.IDLE)
    return service, client


def kept():
    """The text of the later generation."""
    found = {}
    for name in ("kept/state-0", "kept/state-1"):
        with open(name, "rb") as file:
            data = file.read()
        if data[:4] == b"TKS1":
            _, sequence, size = struct.unpack("<3I", data[:12])
            found[sequence] = data[32 : 32 + size].decode()
    return found[max(found)] if found else ""


def wait_until_kept(*lines):
    p.until(lambda: all(line in kept() for line in lines), lambda: f"{lines} are not kept in {kept()}")


def kept_line():
    """In which the program is cut short; 0: in none, or there is no program."""
    words = kept().partition("program ")[2].split("\n")[0].split()
    return int(words[2]) if len(words) > 2 else 0


def kill(service):
    service.process.send_signal(signal.SIGKILL)
    service.process.communicate()


def change_everything(client):
    client.put("WORK_SYSTEM", 2)
    client.put("WORK_OFFSET_X", 12.345)
    client.put("TOOL_SELECT", 3)
    client.put("TOOL_OFFSET_Z", 30.25)
    client.put("TOOL_WEAR_LENGTH", 1234)
    client.put("TOOL_WEAR_TIME", 56)
    t.check(client.run_line("#100 = 2.5") == p.COMPLETED, "a line sets a parameter", client.text("ALARM_TEXT"))
    t.check(client.run_line("G10 L1 P4 Z7.5 R2") == p.COMPLETED, "and a tool", client.text("ALARM_TEXT"))


def check_everything(client, when):
    client.put("WORK_SYSTEM", 2)
    t.check(client.get("WORK_OFFSET_X") == 12.345, "the work offset is there " + when, client.get("WORK_OFFSET_X"))
    client.put("TOOL_SELECT", 3)
    t.check(client.get("TOOL_OFFSET_Z") == 30.25 and client.get("TOOL_DIAMETER") == 6, "the tool is there " + when)
    t.check((client.get("TOOL_WEAR_LENGTH"), client.get("TOOL_WEAR_TIME")) == (1234, 56), "with its wear " + when)
    client.put("TOOL_SELECT", 4)
    t.check(client.get("TOOL_OFFSET_Z") == 7.5 and client.get("TOOL_DIAMETER") == 4, "what a line has made of a tool is there " + when)
    t.check(client.run_line("G53 G0 X#100") == p.COMPLETED and client.get("POSITION_X") == 2.5, "the parameter is there " + when)


def check_kept():
    """Nothing is lost by a clean end, and nothing older than what has been seen on the disk by kill -9."""
    t.write("tools.tbl", "T3 P1 Z20 D6\nT4 P2 Z10 D8\n")
    service, client = start()
    change_everything(client)
    status, out, err, _ = service.stop()
    t.check(status == 0 and err == "", "it ends well", status, out, err)
    service, client = start()
    check_everything(client, "after a clean end")
    client.put("TOOL_SELECT", 3)
    client.put("TOOL_WEAR_LENGTH", 0)
    client.put("WORK_OFFSET_X", -1)
    wait_until_kept("wear 3 0 56", "parameter 5241 -1\n")
    kill(service)
    service, client = start()
    client.put("TOOL_SELECT", 3)
    client.put("WORK_SYSTEM", 2)
    t.check(client.get("TOOL_WEAR_LENGTH") == 0 and client.get("WORK_OFFSET_X") == -1, "wear that was reset and an offset are there after kill -9")
    service.stop()


def check_line():
    """A program that was cut short is there again, with the line it was cut short in."""
    service, client = start()
    client.upload(PROGRAM)
    client.put("MODE", 0)
    client.put("CYCLE_START", 1)
    client.wait_above("ACTIVE_LINE", 4)
    p.until(lambda: kept_line() >= 5, lambda: f"no line is kept in {kept()}")
    kill(service)
    line = kept_line()
    service, client = start()
    t.check(client.counts("PROGRAM_SIZE") == len(PROGRAM), "the program is there")
    t.check(client.counts("CUT_LINE") == line >= 5, "and where it was cut short", client.counts("CUT_LINE"), line)
    client.put("START_LINE", line)
    client.put("FEED_OVERRIDE", 1)  # the line lasts as long as we like
    client.put("CYCLE_START", 1)
    client.wait_for("ACTIVE_LINE", line)
    t.check(client.counts("START_LINE") == 0, "START_LINE counts once")
    client.put("RESET", 1)
    client.wait_for("STATE", p.IDLE)
    _, _, err, _ = service.stop()
    t.check(f"cut short in line {line}" in err, "the line is offered", err)


def check_files_that_change():
    t.write("tools.tbl", "T3 P1 Z21 D6\nT4 P2 Z10 D8\n")
    service, client = start()
    client.put("TOOL_SELECT", 3)
    t.check(client.get("TOOL_OFFSET_Z") == 21, "a tool table that has changed counts", client.get("TOOL_OFFSET_Z"))
    _, _, err, _ = service.stop()
    t.check("the tool table is another since" in err, "which is told", err)


def check_refusals():
    service, _ = start()
    status, _, err = t.run("serve", "--listen", "127.0.0.1:0", "--state", "kept")
    t.check(status == 3 and "another takt serve uses it" in err, "a folder is for one service", status, err)
    service.stop()
    status, _, err = t.run("serve", "--listen", "127.0.0.1:0", "--state", "kept", "--set", "machine.name=another")
    t.check(status == 3 and "of another machine" in err, "and for one machine", status, err)
    status, _, err = t.run("serve", "--listen", "127.0.0.1:0", "--state", "tools.tbl/x")
    t.check(status == 3 and "--state tools.tbl/x" in err, "it needs a place", status, err)
    status, _, err = t.run("serve", "--listen", "0.0.0.0:0", "--state", "none")
    t.check(status == 2 and "--insecure" in err, "nobody listens to everybody unasked", status, err)


def check_damaged(damage, what):
    """Offsets of zero in place of those that were kept are never taken without a word."""
    names = ["kept/" + name for name in ("state-0", "state-1") if os.path.exists("kept/" + name)]
    before = [open(name, "rb").read() for name in names]
    for name, data in zip(names, before):
        t.write(name, damage(data))
    status, _, err = t.run("serve", "--listen", "127.0.0.1:0", "--state", "kept")
    t.check(status == 3 and "--state kept" in err and "damaged" in err, what + " files are refused", status, err)
    t.check([open(name, "rb").read() for name in names] == [damage(data) for data in before], what + " files are left as they are")
    for name, data in zip(names, before):
        t.write(name, data)


def check_one_damaged():
    """The other generation makes up for it."""
    service, client = start()
    client.put("WORK_OFFSET_Y", 3)
    wait_until_kept("parameter 5222 3\n")
    client.put("WORK_OFFSET_Y", 4)
    service.stop()
    later = max(("kept/state-0", "kept/state-1"), key=lambda name: open(name, "rb").read()[4:8][::-1])
    data = open(later, "rb").read()
    t.write(later, bytes(len(data)))
    service, client = start()
    t.check(client.get("WORK_OFFSET_Y") in (3, 4), "one generation is enough", client.get("WORK_OFFSET_Y"))
    service.stop()


def check_never_kept():
    """A service that was killed before it kept anything leaves nothing that could be damaged."""
    os.makedirs("young", exist_ok=True)
    t.write("young/lock", "")
    service = p.serve("--state", "young")
    service.client().wait_for("STATE", p.IDLE)
    service.stop()
    t.check(os.path.exists("young/state-0"), "a folder without files is a new one")


def check_default_folder():
    service = p.Service("--listen", "127.0.0.1:0")
    service.client().wait_for("STATE", p.IDLE)
    service.stop()
    folder = os.path.join(os.environ["XDG_STATE_HOME"], "takt", "built-in-three-axis-mill")
    t.check(os.path.exists(folder + "/state-0"), "by default it is the user's folder", folder)


check_kept()
check_line()
check_files_that_change()
check_refusals()
check_one_damaged()
check_damaged(lambda data: bytes(500) + data[500:], "overwritten")
check_damaged(lambda data: data[:50], "cut")
check_damaged(lambda data: b"", "emptied")
check_never_kept()
check_default_folder()
t.finish()
