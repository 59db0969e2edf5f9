"""`takt drives` from outside: data sheets, refusals, a node driven by hand over a pseudo-terminal; and scripted faults."""

import csv
import os
import re
import select
import subprocess
import termios
import tty

import takt_test as t

PATIENCE_S = 60


def refused(words, said, expected=2):
    status, out, err = t.run("drives", *words)
    t.check(status == expected and said in err and out == "", f"takt drives {' '.join(words)}: refused", status, out, err)


# ---- What cannot be ----

refused([], "--bus says where")
refused(["--bus", "carrier-pigeon:7"], "--bus: ")
refused(["--bus", "socketcan:no-such-if"], "no-such-if", 3)
for nodes in ("0", "128", "3-1", "1,", "1;2", "x", "-1"):
    refused(["--eds", ".", "--nodes=" + nodes], "1 ... 127")
refused(["--eds", ".", "--nodes", "1-3,2"], "2 is named twice")
refused(["--eds", ".", "--nodes", "1-40"], "more than 16 drives")
refused(["--eds", ".", "--bus-log", "bus.log"], "--bus-log needs --bus")
refused(["--bus", "slcan:pty", "--bus-log", "-"], "same place: -")
refused(["--bus", "slcan:pty", "--log", "all.log", "--bus-log", "all.log"], "same place: all.log")
refused(["--bus", "slcan:pty", "--bus-log", "no/such/folder/bus.log"], "no/such/folder/bus.log: it cannot be written: No such", 3)
refused(["--eds", "no/such/folder/x.eds"], "no/such/folder", 3)
refused(["--eds", ".", "--inject", "no.inject"], "no.inject")
refused(["--bus", "socketcand:listen:0", "--eds", "no.eds"], "no.eds:0:0: error: cannot be opened")
refused(["--bus", "socketcand:listen:0", "--eds", t.write("no.eds", "[1000]\n")], "no.eds:0:0: error: this is no drive")
for text, said in (
    ("power drive 1 jamm\n", "bad.inject:1:15: error: 'jamm' is no fault of a drive; known are emcy"),
    ("\npower drive 9 jam\n", "bad.inject:2:0: error: there is no drive with node 9"),
    ("power bus drop\n", "bad.inject:1:0: error: bus drop is a fault of the embedded bus"),
):
    refused(["--eds", ".", "--inject", t.write("bad.inject", text)], said)

# ---- Data sheets ----

refused(["--eds", t.write("foreign.eds", "[FileInfo]\nCreatedBy=somebody\n")], "would be written over")


def sections(path):
    with open(path, newline="", encoding="ascii") as file:
        text = file.read()
    t.check(text.count("\n") == text.count("\r\n"), path + " has the line ends of CiA 306")
    found = {}
    for line in text.split("\r\n"):
        if line.startswith("["):
            section = found.setdefault(line[1:-1], {})
        elif line:
            key, value = line.split("=", 1)
            section[key] = value
    return found


status, out, err = t.run("drives", "--eds", ".", "--set", "drive.2.following_error_window_mm=1.5")
t.check((status, out, err) == (0, "", ""), "data sheets are written", status, out, err)
sheets = [sections(f"takt-drive-{node}.eds") for node in (1, 2, 3)]
t.check([sheet["6065"]["DefaultValue"] for sheet in sheets] == ["0x30D40", "0x249F0", "0x30D40"],
        "each has the values of its drive", [sheet["6065"] for sheet in sheets])
t.check([sheet["1018sub4"]["DefaultValue"] for sheet in sheets] == ["0x1", "0x2", "0x3"], "each has its serial number")
t.check(sheets[1]["1801sub1"]["DefaultValue"] == "$NODEID+0x40000280", "identifiers are relative to the node")
t.check(sheets[1]["FileInfo"]["FileName"] == "takt-drive-2.eds", "each knows its name")
os.mkdir("sheets")
t.check(t.run("drives", "--nodes", "7,100-101", "--eds", "sheets")[0] == 0, "nodes may be any")
t.check(sorted(os.listdir("sheets")) == ["takt-drive-100.eds", "takt-drive-101.eds", "takt-drive-7.eds"],
        "a sheet for each", os.listdir("sheets"))
t.check(t.run("drives", "--nodes", "9", "--eds", "one.eds")[0] == 0 and os.path.exists("one.eds"), "or one by name")
t.check(t.run("drives", "--eds", "-")[1].startswith("[FileInfo]"), "or to standard output")

# ---- A node by hand ----


class Hand:
    """An SLCAN client of a few lines."""

    def __init__(self, path):
        self.file = os.open(path, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self.file, termios.TCSANOW)
        self.text = self.all = b""
        os.write(self.file, b"C\rS8\rO\r")

    def send(self, identifier, data):
        os.write(self.file, b"t%03X%d%s\r" % (identifier, len(data), data.hex().upper().encode()))

    def wait_for(self, identifier):
        """Data of the next frame with this identifier."""
        while True:
            found = re.search(rb"t%03X(\d)([0-9A-F]*)[\r\a]" % identifier, self.text)
            if found:
                self.text = self.text[found.end():]
                return bytes.fromhex(found.group(2).decode())[: int(found.group(1))]
            if not select.select([self.file], [], [], PATIENCE_S)[0]:
                t.check(False, f"frame {identifier:03X} comes", self.text)
                t.finish()
            got = os.read(self.file, 4096)
            self.text += got
            self.all += got

    def heartbeats(self):
        """How many have come."""
        return len(re.findall(rb"t7021", self.all))

    def sdo(self, command, index, sub, value=0):
        self.send(0x602, bytes([command]) + index.to_bytes(2, "little") + bytes([sub]) + value.to_bytes(4, "little"))
        answer = self.wait_for(0x582)
        return answer[0], int.from_bytes(answer[4:], "little")

    def read(self, index, sub=0):
        return self.sdo(0x40, index, sub)[1]

    def write(self, index, sub, size, value):
        return self.sdo(0x23 | (4 - size) << 2, index, sub, value)




def open_drives(*options):
    """The process, and a hand on its bus."""
    process = subprocess.Popen([t.TAKT, "drives", "--bus", "slcan:pty", "--nodes", "2", *options],
                               stdout=subprocess.PIPE, text=True)
    address = re.match(r"0\.000000 bus (\S+)\n", process.stdout.readline())
    if not t.check(address, "the drives say where they are"):
        t.finish()
    return process, Hand(address.group(1))


def close_drives(process):
    """The log."""
    process.terminate()
    rest = process.stdout.read()
    t.check(process.wait() == 0, "SIGTERM is the regular end")
    return rest


SCRIPT = t.write("hot.inject", "enabled+100ms drive 2 emcy code=4310\n")
drives, hand = open_drives("--inject", SCRIPT)
t.check(hand.sdo(0x40, 0x1000, 0) == (0x43, 0x00020192), "the device type is read")
t.check(hand.sdo(0x40, 0x5000, 0) == (0x80, 0x06020000), "an object that is not there is refused")
t.check(hand.write(0x1017, 0, 2, 20)[0] == 0x60, "heartbeats are asked for")
t.check(hand.wait_for(0x702) == b"\x7f", "and come")
hand.send(0x000, bytes([1, 2]))
hand.write(0x6060, 0, 1, 1)
for word in (0x06, 0x07, 0x0F):
    hand.write(0x6040, 0, 2, word)
t.check(hand.read(0x6041) & 0x6F == 0x27, "the drive is enabled by SDO alone")
hand.write(0x607A, 0, 4, 3000)
hand.write(0x6040, 0, 2, 0x1F)
code = hand.wait_for(0x082)
t.check(code[:3] == b"\x10\x43\x09", "the scripted fault comes, with its register", code)
while hand.read(0x6041) & 0x4F != 0x08:
    pass
t.check(hand.read(0x603F) == 0x4310, "the drive shows why it is in fault")
hand.write(0x6040, 0, 2, 0x80)
t.check(hand.read(0x6041) & 0x4F == 0x40, "a fault reset is taken")
log = close_drives(drives)
for line in ("node 2: boot-up", "node 2: SDO for 5000:00 aborted: 06020000", "node 2: NMT operational",
             "node 2: mode profile position", "node 2: switched on -> operation enabled", "node 2: target 3000 increments",
             "node 2: scripted fault emcy of line 1", "node 2: EMCY 4310: drive too hot, register 09",
             "node 2: fault reaction active -> fault", "node 2: fault -> switch on disabled",
             "node 2: EMCY 0000: errors are gone, register 00"):
    t.check(re.search(rf"^\d+\.\d{{6}} {re.escape(line)}$", log, re.MULTILINE), f"the log has: {line}", log)

# ---- What is stored ----

os.mkdir("stored")
for value, stored in ((1234, True), (5678, False)):
    drives, hand = open_drives("--quiet", "--log", "-", "--store", "stored")
    t.check(hand.read(0x6081) == (5000000 if stored else 1234), "stored values are there at the next start", hand.read(0x6081))
    hand.write(0x6081, 0, 4, value)
    if stored:
        t.check(hand.write(0x1010, 1, 4, 0x65766173)[0] == 0x60, "values are stored")
    close_drives(drives)
with open("stored/takt-drive-2.store") as file:
    t.check(file.read() == "# stored by node 2, object 1010\n6081:00 000004D2\n", "and can be read")
drives, hand = open_drives("--quiet", "--log", "-", "--store", "no/such/folder")
t.check(hand.write(0x1010, 1, 4, 0x65766173) == (0x80, 0x06060000), "a drive whose memory fails says so")
close_drives(drives)
t.write("stored/takt-drive-2.store", "6081:00 000004D2\n6041:00 0000\n")
refused(["--bus", "slcan:pty", "--nodes", "2", "--quiet", "--store", "stored"],
        "stored/takt-drive-2.store:2:0: error: node 2 has no object 6041:00 that can be stored")
refused(["--eds", ".", "--store", "stored"], "--store needs --bus")

# ---- Without a node id ----

drives, hand = open_drives("--unconfigured")
for request, answer in ((b"\x4c", 0x50), (b"\x51\0\0\0\0\x80", 0x4F), (b"\x04\x01", None), (b"\x5d", 0x5D), (b"\x11\x02", 0x11)):
    hand.send(0x7E5, request.ljust(8, b"\0"))
    got = hand.wait_for(0x7E4) if answer else None
    t.check(not answer or got[0] == answer, f"LSS {request.hex()} is answered", got)
t.check(b"t702" not in hand.all, "a node without an id does not boot")
hand.send(0x000, bytes([130, 0]))
t.check(hand.wait_for(0x702) == b"\0", "with an id it does")
t.check(hand.read(0x1018, 4) == 2, "and answers")
close_drives(drives)

# ---- Whose clock ----

# A SYNC is a millisecond, however fast they come: 101 of them are 100 ms, and five heartbeats.
drives, hand = open_drives("--quiet", "--log", "-")
hand.write(0x1006, 0, 4, 1000)
hand.write(0x1017, 0, 2, 20)
for _ in range(101):
    hand.send(0x080, b"")
hand.write(0x1017, 0, 2, 0)
t.check(hand.heartbeats() == 5, "SYNC is the clock", hand.all)
close_drives(drives)

# Paced drives keep to the wall clock.
drives, hand = open_drives("--realtime")
hand.write(0x1006, 0, 4, 1000)
hand.write(0x1017, 0, 2, 20)
for _ in range(3):
    hand.wait_for(0x702)
close_drives(drives)

# ---- Scripted faults in a run ----

status, text, _ = t.run("help", "inject")
with open(os.path.join(t.SOURCE, "host", "inject", "inject.h"), encoding="ascii") as file:
    kinds = re.search(r"enum inject_kind \{(.*?)INJECT_KINDS", file.read(), re.DOTALL).group(1)
for kind in re.findall(r"INJECT_([A-Z_]+),", kinds):
    t.check(re.search(rf"^  {kind.lower()} ", text, re.MULTILINE), f"takt help inject explains {kind.lower()}", text)

POCKET = os.path.join(t.EXAMPLES, "pocket.ngc")
SCRIPTS = [name for name in sorted(os.listdir(t.EXAMPLES)) if name.endswith(".inject")]
with open(os.path.join(t.EXAMPLES, "README.md"), encoding="utf-8") as file:
    readme = file.read()
for name in SCRIPTS:
    row = re.search(rf"\[{name}\].*\| (.*) \|", readme)
    if not t.check(row, f"{name} is in the README"):
        continue
    runs = []
    for trace in ("first.csv", "second.csv"):
        status, _, err = t.run("run", POCKET, "--inject", os.path.join(t.EXAMPLES, name), "--trace", trace, "--until", "3",
                               "--quiet")
        with open(trace, "rb") as file:
            runs.append((status, err, file.read()))
    expected = (4, "") if row[1] == "completed" else (1, f"takt run: error: {row[1]}\n")
    t.check(runs[0][:2] == expected, f"{name}: the README's outcome", runs[0][:2])
    t.check(runs[0] == runs[1], f"{name}: two runs are the same to the last digit")

# A drive that only warns: the setpoint stops on the line through 0, where M53 forbids a feed hold too.
WARNING = t.write("warning.inject", "enabled+0.4s drive 2 warn code=FF01\n")
for hold in ("M53 P1", "M53 P0"):
    PROGRAM = t.write("line.ngc", f"G21 G90\n{hold}\nG1 X100 Y60 F6000\nM2\n")
    status, _, _ = t.run("run", PROGRAM, "--inject", WARNING, "--trace", "line.csv", "--quiet")
    with open("line.csv", encoding="ascii") as file:
        last = list(csv.DictReader(file))[-1]
    t.check(status == 1 and float(last["feed_mm_min"]) == 0 and 30 < float(last["cmd_X_mm"]) < 40,
            f"after {hold} a fault stops the setpoint soon", last)
    t.check(abs(float(last["cmd_Y_mm"]) - 0.6 * float(last["cmd_X_mm"])) < 1e-6, f"after {hold}: on the path", last)

status, _, err = t.run("run", POCKET, "--inject", SCRIPT, "--bus", "slcan:pty", "--drives", "external")
t.check(status == 2 and "takt drives --inject" in err, "faults of drives outside are not up to takt run", status, err)
status, _, err = t.run("run", POCKET, "--inject", t.write("late.inject", "power drive 3 jam\npower bus cut node=4\n"))
t.check(status == 2 and "late.inject:2:0: error: there is no drive with node 4" in err, "nodes are checked", status, err)
t.finish()
