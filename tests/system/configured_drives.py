"""Drives with a concise configuration (CiA 302, object 1F22): compared with it, written where they differ, then only looked at."""

import os
import re
import struct

import data_sheets
import takt_test as t

POCKET = os.path.join(t.EXAMPLES, "pocket.ngc")


def concise(path, entries):
    """As dcfgen writes it: index, sub-index, bytes of the value."""
    data = struct.pack("<I", len(entries))
    for index, sub, size, value in entries:
        data += struct.pack("<HBI", index, sub, size) + value.to_bytes(size, "little")
    with open(path, "wb") as file:
        file.write(data)
    return path


def settings(node):
    """What takt would tell a drive, and its first TPDO as a generator has it: not valid while it is mapped."""
    return [(0x1017, 0, 2, 100), (0x1016, 1, 4, 127 << 16 | 300), (0x1006, 0, 4, 1000), (0x60C2, 1, 1, 1), (0x60C2, 2, 1, 0xFD),
            (0x6007, 0, 2, 3), (0x605A, 0, 2, 2), (0x605E, 0, 2, 2),
            (0x1800, 1, 4, 0xC0000180 + node), (0x1A00, 0, 1, 0), (0x1A00, 1, 4, 0x60410010), (0x1A00, 2, 4, 0x60640020),
            (0x1A00, 0, 1, 2), (0x1800, 2, 1, 1), (0x1800, 1, 4, 0x40000180 + node), (0x1801, 2, 1, 255), (0x1801, 5, 2, 100)]


def run(*options):
    status, out, err = t.run("run", POCKET, "--quiet", "--json", "-", "--bus-log", "bus.log",
                             *[word for option in options for word in ("--set", option)])
    return status, t.json.loads(out) if out else None, err


def written(node):
    """Objects that the master writes."""
    lines = re.findall(rf" {0x600 + node:03X}#(2.)(..)(..)(..)", open("bus.log").read())
    return [f"{high}{low}:{sub}" for _, low, high, sub in lines]


DIGEST = run()[1]["setpoint_digest"]
FILES = [f"drive.{node}.dcf={concise(f'{node}.bin', settings(node))}" for node in (1, 2, 3)]

status, summary, err = run(*FILES)
if t.check(status == 0 and summary["setpoint_digest"] == DIGEST, "drives are set up by it and run", err):
    t.check(not any(drive["given_up"] for drive in summary["drives"]), "and nothing is given up", summary["drives"])
    told = written(2)
    t.check(told[:17] == [f"{index:04X}:{sub:02X}" for index, sub, _, _ in settings(2)], "all of it, in its order", told)
    t.check(set(told[17:]) <= {"6060:00", "6040:00"}, "and takt changes nothing more", told[17:])

sheet = (t.run("drives", "--nodes", "1", "--eds", "own.eds"), data_sheets.read("own.eds"))[1]
for index, sub, _, value in settings(1):
    name = f"{index:04X}sub{sub}" if f"{index:04X}sub{sub}" in sheet else f"{index:04X}"
    if index not in (0x1800, 0x1A00):
        sheet[name]["DefaultValue"] = str(value if (index, sub) != (0x60C2, 2) else value - 256)
data_sheets.write("set_up.eds", sheet)
status, summary, err = run(*FILES, *(f"drive.{node}.eds=set_up.eds" for node in (1, 2, 3)))
if t.check(status == 0 and summary["setpoint_digest"] == DIGEST, "a drive that has it already runs", err):
    t.check(all(set(written(node)) <= {"6060:00", "6040:00"} for node in (1, 2, 3)), "and is only compared", written(1))

# The virtual drive of Y takes its target from the frame that X has for itself.
status, _, err = run(*FILES, "drive.1.eds=set_up.eds")
t.check(status == 1 and "axis X (node 1) takes the PDO" in err and "which is meant for another drive" in err and "maker's tool" in err,
        "drives that would take each other's targets are refused", err)

data_sheets.set_access(sheet, "ro", "605A", default="1")
data_sheets.write("other.eds", sheet)
status, _, err = run(*FILES, "drive.1.eds=other.eds")
t.check(status == 1 and "axis X (node 1), object 605A:00, refuses with abort code 06010002" in err and "maker's tool" in err,
        "what it cannot be told is refused by its object", err)

status, _, err = run("drive.1.dcf=" + concise("long.bin", [(0x1017, 0, 2, 100), (0x2000, 0, 100, 1)]))
t.check(status == 2 and "2000:00 has no value of 1 to 64 bytes" in err, "a value that is too long is named", err)
for name, data in (("short.bin", b"\1\0"), ("count.bin", struct.pack("<I", 2) + struct.pack("<HBIB", 0x1017, 0, 1, 5)), ("text.bin", b"[FileInfo]")):
    with open(name, "wb") as file:
        file.write(data)
    status, _, err = run("drive.1.dcf=" + name)
    t.check(status == 2 and name in err and ("concise configuration" in err or "has no value" in err), name + " is none", err)
status, _, err = run("drive.1.dcf=set_up.eds")
t.check(status == 2 and "set_up.eds" in err and "a text" in err and "eds" in err, "a configuration in text form is told so", err)
# A target takes them with its settings, where they are used in place.
status, _, err = t.run("machine", "--pack", "-o", "machine.bin", "--set", FILES[0], "--set", FILES[2])
t.check(status == 0 and open("1.bin", "rb").read() in open("machine.bin", "rb").read(), "settings for a target have them", err)
status, out, err = t.run("machine", "machine.bin", "--unpack")
t.check(status == 0 and "a configuration of node 1 (" in out and "node 3 (" in out and "node 2 (" not in out, "and tell so", out[:400], err)
status, _, err = t.run("machine", "--pack", "-o", "machine.bin", "--set", "drive.1.dcf=short.bin")
t.check(status == 2 and "short.bin" in err, "but none that is damaged", err)
status, _, err = t.run("run", POCKET, "--target", "m4f", "--image", "none", "--set", FILES[0])
t.check(status == 2 and "takt machine --pack" in err, "an image of the desk takes none, and says so", err)
t.finish()
