#!/usr/bin/env python3
"""Settings of a target: what is packed is the machine, and nothing damaged is taken for settings."""

import math
import os

import takt_test as t


def pack(name, *arguments):
    status, out, err = t.run("machine", *arguments, "--pack", "-o", name)
    t.check(status == 0 and "bytes" in out, f"{name} is packed", err)
    with open(name, "rb") as file:
        return file.read()


def check_back(name, *arguments):
    """What is unpacked is what the machine file says, but for what stays on this computer."""
    _, expected, _ = t.run("machine", *arguments)
    status, out, err = t.run("machine", name, "--unpack")
    t.check(status == 0, f"{name} is unpacked", err)
    kept = out[out.index("# A machine, every key"):].splitlines()
    said = expected.splitlines()
    for ours, theirs in zip(kept, said):
        if ours == theirs:
            continue
        key = theirs.split(" = ")[0]
        t.check(key in ("volume_table", "axis_table_x", "tool_table", "parameter_file"), f"{name}: {key} comes back", ours, theirs)
    t.check(len(kept) == len(said), f"{name}: every key comes back")
    return out


pack("plain.settings")
check_back("plain.settings")

rotary = ["--set", "axis.C.max_velocity_deg_s=77.7", "--set", "machine.cycle_us=2000", "--set", "axis.X.drive_type=step",
          "--set", "axis.X.max_jerk_mm_s3=12345.6789", "--set", "machine.name=a mill of our own"]
pack("rotary.settings", *rotary)
check_back("rotary.settings", *rotary)

with open("volume.csv", "w") as file:
    file.write("X_mm,Y_mm,Z_mm,KX_um,KY_um,KZ_um\n")
    for z in range(5):
        for y in range(6):
            for x in range(7):
                file.write(f"{50 * x},{40 * y},{30 * z},{10 * math.sin(x + y):.6f},{5 * math.cos(y):.6f},{3 * z}\n")
with open("pitch.csv", "w") as file:
    file.write("X_mm,KX_up_um,KX_down_um\n")
    for x in range(11):
        file.write(f"{30 * x},{4 * math.sin(x):.6f},{4 * math.sin(x) + 2:.6f}\n")
tables = ["--set", "correction.volume_table=volume.csv", "--set", "correction.axis_table_x=pitch.csv"]
packed = pack("tables.settings", *tables)
out = check_back("tables.settings", *tables)
t.check("# with a volume table over X (7 points) Y (6 points) Z (5 points)" in out, "the volume table is in it", out[:200])
t.check("# with a table over X that corrects X, both directions, (11 points)" in out, "so is the axis table", out[:200])

sector = pack("tables.sector", *tables, "--sector")
t.check(sector[:4] == b"TKS1" and sector[32:] == packed, "a sector is a head and the settings")
status, _, err = t.run("machine", "tables.sector", "--unpack")
t.check(status == 0, "a sector is unpacked too", err)


def refuse(claim, content, part):
    with open("wrong.settings", "wb") as file:
        file.write(content)
    status, out, err = t.run("machine", "wrong.settings", "--unpack")
    t.check(status == 2 and out == "" and part in err and err.startswith("wrong.settings:0:0: error: "), claim, status, err)


refuse("nothing is refused", b"", "no settings of this version")
refuse("a machine file is refused", b"[machine]\ncycle_us = 1000\n", "no settings of this version")
refuse("a part is refused", packed[:-8], "checksum is wrong")
refuse("a part of a head is refused", packed[:15], "no settings of this version")
refuse("more than all is refused", packed + bytes(8), "checksum is wrong")
refuse("another version is refused", packed[:12] + b"\x09" + packed[13:], "checksum is wrong")
for at in range(16, len(packed), 97):
    refuse(f"a bit that is wrong at {at} is found", packed[:at] + bytes([packed[at] ^ 0x10]) + packed[at + 1:], "checksum is wrong")
refuse("a sector's wrong head is refused", sector[:9] + b"\xff" + sector[10:], "head of this flash sector")
refuse("a sector with a wrong bit is refused", sector[:100] + bytes([sector[100] ^ 1]) + sector[101:], "head of this flash sector")

for arguments, part in (
        (["--pack"], "--pack needs -o FILE"),
        (["--unpack"], "--unpack needs the file"),
        (["--pack", "--unpack", "-o", "x"], "one of them"),
        (["-o", "x"], "go with --pack"),
        (["--sector"], "go with --pack"),
        (["--pack", "-o", "x", "--set", "axis.X.max_jerk_mm_s3=-1"], "out of range"),
        (["--pack", "-o", "x", "--set", "correction.volume_table=nowhere.csv"], "nowhere.csv"),
        (["--pack", "-o", os.path.join("nowhere", "x")], "nowhere"),
):
    status, out, err = t.run("machine", *arguments)
    t.check(status in (2, 3) and part in err and not os.path.exists("x"), "refused: " + " ".join(arguments), status, err)

t.finish()
