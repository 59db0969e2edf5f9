#!/usr/bin/env python3
"""The controller drives nodes that are not ours: CiA 402 drives made of python-canopen's LocalNode, over socketcand.

It has to boot them, check and configure them over SDO, home and enable them, bring them along the program's path, and
stop when one of them fails."""

import json
import logging
import os
import socket
import subprocess
import sys
import time

import packages

packages.require("can", "canopen")

import can
import canopen
import node402

TAKT = os.environ["TAKT"]
PROGRAM = "G21 G90 G61 F6000\nG1 X2 Y1 Z-1\nG3 X0 Y0 I-1 J-0.5\nG0 Z0\nM2\n"
INCREMENTS = 100000


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class Bench:
    """A running controller and three drives on one bus."""

    def __init__(self, *settings, habits=None, by_slcan=False, heartbeat_ms=5000):
        port = free_port()
        bus = "slcan:pty:controller" if by_slcan else f"socketcand:listen:{port}"
        command = [TAKT, "run", "part.ngc", "--exact-path", "--json", "run.json", "--quiet", "--bus", bus, "--drives",
                   "external", "--set", f"bus.heartbeat_ms={heartbeat_ms}"]
        for setting in settings:
            command += ["--set", setting]
        self.run = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        self.network = canopen.Network()
        self.network.NOTIFIER_CYCLE = 0.1
        self.how = {"interface": "slcan", "channel": "controller", "bitrate": 1000000, "sleep_after_open": 0.1} if by_slcan else {
            "interface": "socketcand", "host": "127.0.0.1", "port": port, "channel": "can0", "tcp_tune": True}
        self.connect()
        self.drives = [node402.Drive(self.network, number, habits=habits) for number in (1, 2, 3)]

    def connect(self):
        """As soon as the controller listens; until then python-can would complain."""
        logging.getLogger("can").setLevel(logging.CRITICAL)
        while self.run.poll() is None:
            try:
                self.network.connect(**self.how)
                return
            except (ConnectionRefusedError, OSError, can.CanError):
                time.sleep(0.01)
        sys.exit(f"the controller has ended: {self.run.stderr.read()}")

    def finish(self):
        """Exit status, message and summary of the run."""
        message = self.run.communicate(timeout=120)[1]
        try:
            self.network.disconnect()
        except can.CanError:
            pass  # the controller has left with frames unread
        summary = json.load(open("run.json", encoding="utf-8")) if os.path.exists("run.json") else None
        return self.run.returncode, message, summary


def check(claim, is_true, *details):
    if not is_true:
        sys.exit(f"FAILED: {claim} {details}")
    print(f"held: {claim}")


def expect(claim, found, expected):
    check(claim, found == expected, "found", found, "expected", expected)


def setpoints_of_embedded_run():
    """Digest and targets in increments of the same program on virtual drives."""
    done = subprocess.run([TAKT, "run", "part.ngc", "--exact-path", "--json", "own.json", "--trace", "own.csv", "--quiet"],
                          check=False, text=True, stderr=subprocess.PIPE)
    expect("the program runs on virtual drives", done.returncode, 0)
    return json.load(open("own.json", encoding="utf-8"))["setpoint_digest"]


def test_boot_and_run():
    digest = setpoints_of_embedded_run()
    bench = Bench("axis.X.drive_vendor=%d" % node402.VENDOR, "axis.Y.drive_product=%d" % node402.PRODUCT)
    status, message, summary = bench.finish()
    expect("the program completes on foreign drives", (status, message), (0, ""))
    expect("setpoints are those of the virtual drives", summary["setpoint_digest"], digest)
    first, second, third = bench.drives
    expect("X maps its half of the pair", [first.get(0x1601, sub) for sub in (0, 1, 2)], [2, 0x607A0020, 0x00070020])
    expect("Y maps the other half", [second.get(0x1601, sub) for sub in (0, 1, 2)], [2, 0x00070020, 0x607A0020])
    expect("Y listens to the frame of X", second.get(0x1401, 1), 0x301)
    expect("Z has a frame of its own", (third.get(0x1401, 1), third.get(0x1601, 0)), (0x303, 1))
    expect("the cycle is told", (first.get(0x1006), first.get(0x60C2, 1), first.get(0x60C2, 2)), (1000, 1, 0xFD))
    expect("the heartbeat is told", (first.get(0x1017), first.get(0x1016, 1)), (5000, 127 << 16 | 15000))
    expect("all are in cyclic synchronous position mode", [drive.mode for drive in bench.drives], [8, 8, 8])
    for drive, corner in zip(bench.drives, (2, 1, -1)):
        check(f"node {drive.number} has been at the corner", corner * INCREMENTS in drive.targets)
        expect(f"node {drive.number} ends at 0", drive.targets[-1], 0)
    # No step above the 100 mm/s of the axis, and none that the drive has not followed.
    steps = [abs(b - a) for drive in bench.drives for a, b in zip(drive.targets, drive.targets[1:])]
    check("targets never step", max(steps) <= 0.1 * INCREMENTS * 1.001, max(steps))


def test_homing():
    bench = Bench("axis.X.home_order=2", "axis.X.home_method=35", "axis.Z.home_order=1", "axis.Z.home_method=35",
                  "axis.Z.home_offset_mm=0.5")
    status, message, _ = bench.finish()
    expect("the program completes after homing", (status, message), (0, ""))
    first, second, third = bench.drives
    expect("X and Z have been homed and Y has not", [d.is_homed for d in (first, second, third)], [True, False, True])
    expect("the method is told", (first.get(0x6098), third.get(0x6098)), (35, 35))
    check("Z stands at its offset after homing", 50000 in third.targets)
    after = third.targets[third.targets.index(50000):]
    check("and comes to 0 before the program", 0 in after[: after.index(-INCREMENTS)])


def test_home_offset_of_either_sign():
    homed = "axis.Z.home_order=1", "axis.Z.home_method=35", "axis.Z.home_offset_mm=5"
    bench = Bench(*homed)
    bench.drives[2].offset_is_position = True
    status, message, _ = bench.finish()
    expect("a drive that takes the home offset with the other sign is a fault", status, 1)
    check("that says so", "after homing axis Z (node 3) is at -5 mm" in message and "home_offset_is_position" in message, message)
    expect("before anything has moved to a target", bench.drives[0].targets[-1:], bench.drives[0].targets[:1])

    bench = Bench(*homed, "axis.Z.home_offset_is_position=1")
    bench.drives[2].offset_is_position = True
    status, message, _ = bench.finish()
    expect("told so, the program completes", (status, message), (0, ""))
    expect("with its offset as its position", bench.drives[2].get(0x607C), 5 * INCREMENTS)


def test_wrong_identity():
    bench = Bench("axis.Y.drive_product=4711")
    status, message, _ = bench.finish()
    expect("another drive is refused", status, 1)
    check("the message names it", "axis Y (node 2) has another drive than the machine file says: its product code, "
          "object 1018:02, is 0BEE" in message, message)
    expect("nothing has been enabled", [drive.targets for drive in bench.drives], [[], [], []])


def test_emergency():
    bench = Bench()
    bench.drives[1].fail_at = (60, 0x2310)
    status, message, _ = bench.finish()
    expect("a drive that fails ends the run", status, 1)
    check("the message has axis, node, code and meaning",
          "the drive of axis Y (node 2) reports 2310: current at the output" in message, message)
    expect("no drive is left enabled", [d.state for d in bench.drives], ["off", "fault", "off"])


def main():
    with open("part.ngc", "w", encoding="utf-8") as program:
        program.write(PROGRAM)
    print(f"python-can {can.__version__}, canopen {canopen.__version__}")
    test_boot_and_run()
    test_homing()
    test_home_offset_of_either_sign()
    test_wrong_identity()
    test_emergency()


if __name__ == "__main__":
    main()
