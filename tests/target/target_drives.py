#!/usr/bin/env python3
"""Drives whose firmware runs in QEMU, one process a drive, against the simulated mechanics: takt run --drives m4f.

    target_drives.py [MACHINES [FIRST]]

The controller's setpoints and the drives' positions are those of the drives of this process, bit for bit: the traces and
the logs of the bus are the same files. On random machines, with homing, and with faults of bus and drives.
"""

import math
import os
import random
import shutil
import subprocess
import sys

import target
import takt_test as t
from drive_tables import concise, pitch_table

MACHINES, FIRST = (int(word) for word in (sys.argv[1:] + ["3", "1"][len(sys.argv) - 1:])[:2])
PROGRAM = t.write("part.ngc", "G21 G90 G64 P0.01 F2500\nG1 X3 Y2 Z-1\nG2 X5 Y0 I0 J-2\nG1 X1 Y1\nG61 G0 X0 Y0 Z0\nM2\n")
IMAGE = "takt-drive"


def run(name, processor, options):
    """takt run with the drives here, or in QEMU: status, summary, trace, log of the bus, messages."""
    where = () if processor is None else ("--drives", processor, "--drive-image", target.image(processor, IMAGE))
    for path in ("run.json", "run.csv", "run.log"):
        if os.path.exists(path):
            os.remove(path)
    status, _, err = t.run("run", PROGRAM, "--json", "run.json", "--trace", "run.csv", "--bus-log", "run.log", "--quiet", *options, *where)
    t.check(status in (0, 1), f"{name} runs", status, err)
    files = [open(path, "rb").read() if os.path.exists(path) else None for path in ("run.csv", "run.log")]
    return status, t.load_json("run.json"), files, err


def compare(name, options, processor="m4f"):
    here = run(name, None, options)
    there = run(name, processor, options)
    count = there[1]["drive_images"]["count"]
    t.check(there[1]["drive_images"]["differences"] == 0 and count >= 3, f"{name}: all that the images do is the host's", there[1]["drive_images"])
    t.check(there[1]["setpoint_digest"] == here[1]["setpoint_digest"], f"{name}: the digest is the host's")
    t.check(there[0] == here[0] and there[1]["outcome"] == here[1]["outcome"], f"{name} ends alike", there[0], here[0], there[3])
    t.check(here[2][0] and there[2] == here[2], f"{name}: positions and frames are the host's, byte for byte")
    print(f"{name:12} {processor} {here[1]['setpoint_digest']} {here[1]['cycles']:6} cycles, {here[1]['outcome']}", flush=True)


def log_uniform(rng, low, high):
    return low * (high / low) ** rng.random()


def drive(rng, node):
    """The section of a random drive; its loops are stable."""
    bandwidth = log_uniform(rng, 20, 200)
    period = min(1000, int(0.4e6 / (2 * 3.1416 * bandwidth)), rng.choice((63, 125, 250, 500, 1000)))
    values = {
        "travel_per_revolution_mm": round(log_uniform(rng, 2, 40), 3), "inertia_kg_m2": log_uniform(rng, 1e-4, 1e-3),
        "viscous_friction_nm_s_per_rad": log_uniform(rng, 1e-4, 1e-2), "coulomb_friction_nm": rng.choice((0, 0.05, 0.3)),
        "torque_max_nm": log_uniform(rng, 3, 20), "encoder_counts_per_revolution": rng.choice((0, 4096, 10000, 1 << 17, 1 << 23)),
        "position_gain_per_s": bandwidth * rng.uniform(0.3, 1), "velocity_feed_forward_ratio": rng.choice((0.9, 1)),
        "torque_feed_forward_ratio": rng.choice((0, 1)), "velocity_bandwidth_hz": bandwidth, "loop_period_us": period,
        "backlash_mm": rng.choice((0, 0.01)), "pitch_error_mm": rng.choice((0, 0.005)), "following_error_window_mm": 20,
        "friction_forward_step_mm_s": rng.choice((0, 10)), "limit_switch_min_mm": -12, "home_switch_mm": -6, "home_switch_length_mm": 3,
    }
    friction = " ".join(f"{rng.choice((0, 0.1)) + 0.02 * k:g}" for k in range(8))
    lines = [f"[drive {node}]", f"friction_forward_nm = {friction}", *(f"{key} = {value:.9g}" for key, value in values.items())]
    return "\n".join(lines) + "\n"


def faults(rng, nodes):
    node = rng.choice(nodes)
    at = f"enabled+{rng.uniform(0.05, 0.6):.3f}s"
    what = rng.choice(("emcy code=2310", "warn code=4210", "weak ratio=0.4 for=0.2s", "encoder_jump by_mm=0.01", "mute what=emcy", "hang", "reboot",
                       "freeze object=6041", "report object=6077 value=5", "jam for=0.05s", "mute what=tpdo"))
    return f"{at} drive {node} {what}\n"


def machine(seed):
    rng = random.Random(seed)
    drives = t.write(f"machine{seed}.ini", "".join(drive(rng, node) for node in (1, 2, 3)))
    settings = []
    for number, letter in enumerate("XYZ", 1):
        turns = rng.choice((-1, 1))  # a motor that turns the other way has its switches at the other end, far away
        settings.append(f"axis.{letter}.increments_per_mm={turns * round(log_uniform(rng, 500, 1e6), 2)}")
        if rng.random() < 0.6:
            method = rng.choice((1, 17, 21, 34, 35) if turns > 0 else (33, 34, 35))
            settings += [f"axis.{letter}.home_order={number}", f"axis.{letter}.home_method={method}"]
    settings.append(f"machine.cycle_us={rng.choice((1000, 1500, 2000))}")
    options = ["--machine", drives] + [word for setting in settings for word in ("--set", setting)]
    if rng.random() < 0.6:
        options += ["--inject", t.write(f"faults{seed}.inject", faults(rng, (1, 2, 3)))]
    return options


def spoil(path, wrong):
    """An image whose 2 pi is another double, with a checksum that is right."""
    content = bytearray(open(path, "rb").read())
    pi = bytes.fromhex("182d4454fb211940")
    at = content.find(pi)
    t.check(at > 0, "the image has a number to spoil")
    while at >= 0:
        content[at] ^= 1
        at = content.find(pi)
    open(wrong, "wb").write(content)
    shutil.copymode(path, wrong)
    subprocess.run([sys.executable, os.path.join(t.SOURCE, "hal/port/seal_image.py"), "arm-none-eabi-objcopy", wrong], check=True)


def refused(what, words, *options):
    status, _, err = t.run("run", PROGRAM, "--quiet", *options)
    t.check(status == 2 and all(word in err for word in words), what, status, err)


def with_tables():
    """Screws with errors, and drives that take them back by tables of their own."""
    table = pitch_table(-2, 0.5, [0.004 * math.sin(0.7 * i) for i in range(20)], 0.01)
    settings = [f"drive.{node}.{key}" for node in (1, 2, 3)
                for key in ("backlash_mm=0.01", "pitch_error_mm=0.004", "dcf=" + concise(f"{node}.bin", node, table))]
    return [word for setting in settings for word in ("--set", setting)]


target.need_qemu()
m4f = target.image("m4f", IMAGE)
compare("built-in", ())
compare("built-in", (), "m7")
compare("own tables", with_tables())
for seed in range(FIRST, FIRST + MACHINES):
    compare(f"machine {seed}", machine(seed))

spoil(m4f, "spoiled.elf")
status, out, err = t.run("run", PROGRAM, "--drives", "m4f", "--drive-image", "spoiled.elf", "--json", "run.json")
t.check(status == 1 and t.load_json("run.json")["drive_images"]["differences"] > 0, "a last bit of the image that differs is found", status, out, err)

refused("an image that is not there is said", ("drive 1", "nowhere.elf"), "--drives", "m4f", "--drive-image", "nowhere.elf")
refused("an image that is no drive's is said", ("drive 1",), "--drives", "m4f", "--drive-image", target.image("m4f", "takt-arithmetic"))
refused("the image has its option", ("--drive-image",), "--drives", "m4f")
refused("and the option its drives", ("--drive-image",), "--drive-image", m4f)
refused("an image on CAN FD is refused", ("bus.data_bitrate", "classical"), "--drives", "m4f", "--drive-image", m4f, "--set", "bus.data_bitrate=4000000")
refused("images are on the embedded bus", ("external",), "--drives", "m4f", "--drive-image", m4f, "--bus", "slcan:pty")
t.finish()
