#!/usr/bin/env python3
"""The whole image in QEMU, live: three virtual drives on CAN, the panel over Modbus RTU by libmodbus, the log.

It homes, takes a program through the mailbox, runs it while positions are read, and gives the setpoints of takt run; then
two programs planned ahead come as streams: a short one gives the setpoints of takt run --plan, a long one ends.
With --kernel: the CAN bus is an interface of the kernel (or of user-mode Linux), which slcand makes of the serial line. A
kernel in a process gets its time when the host has some, and a bus does not tell drives whether a controller is late or dead.
So the drives there do not watch it: their data sheet has neither 1006 nor 1016.
"""

import os
import shutil
import signal
import subprocess
import sys

import target
import data_sheets
import serial_pair
import takt_test as t

PROGRAM = "G21 G90 G61 F3000\nG1 X6 Y4\nG2 X10 Y0 I0 J-4\nG1 X0 Z-1\nG0 Z1\nM2\n"
SMOOTH = "G21 G90 G64 P0.01 F3000\nG1 X3 Y2 Z0\nG2 X5 Y0 I0 J-2\nG1 X0 Z-1\nG0 Z0\nM2\n"
LONG = "G21 G90 G64 P0.01 F3000\n" + "".join(f"G1 X{x} Y{x % 2}\n" for x in range(1, 36)) + "G1 Z2\nM2\n"
IDLE, HOMING, ALARM = "1", "5", "8"
TURNS = 30
KERNEL = "--kernel" in sys.argv
INTERFACE = "slcan0"
READY, STOP = "drives.ready", "drives.stop"

# The controller keeps so many bytes of a plan that is not running yet.
KEPT_BYTES = 2048


def start_drives(bus, *options):
    return subprocess.Popen([t.TAKT, "drives", "--bus", bus, *options], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)


class Adapter:
    """The bus that the image's serial line becomes at once: the drives are the adapter."""

    def __init__(self):
        self.drives = start_drives("slcan:pty:bus")
        target.wait_for(lambda: os.path.exists("bus"), "the drives' end of the bus")
        self.path = os.path.realpath("bus")

    def stop(self):
        self.drives.send_signal(signal.SIGTERM)
        t.check(self.drives.wait() == 0, "the drives end")


class Kernel:
    """An interface of a kernel at the end of the line, and drives on that: a process of their own, where CAN is."""

    def __init__(self):
        self.line = serial_pair.Pair()
        self.path = self.line.paths[0]
        with_can = os.path.join(t.SOURCE, "tests", "with_can")
        self.process = subprocess.Popen([with_can, "--line", self.line.paths[1], sys.executable, *sys.argv, "--drives"], stdin=subprocess.DEVNULL)
        target.wait_for(lambda: os.path.exists(READY) or self.process.poll() is not None, "drives on " + INTERFACE)
        if self.process.poll() is not None:
            sys.exit(self.process.returncode)

    def stop(self):
        t.write(STOP, "")
        t.check(self.process.wait() == 0, "the drives end")
        self.line.close()


def run_drives():
    """What Kernel starts: until it asks for the end. User-mode Linux does not tell when its serial line has sent, which
    slcand's interface waits for; a pty does."""
    line = serial_pair.Pair(os.environ["TAKT_LINE"])
    slcand = subprocess.Popen(["slcand", "-o", "-c", "-s8", "-F", line.paths[0], INTERFACE], stdin=subprocess.DEVNULL)
    target.wait_for(lambda: os.path.exists("/sys/class/net/" + INTERFACE) or slcand.poll() is not None, INTERFACE)
    if slcand.poll() is not None:
        t.skip("slcand cannot make an interface of a serial line here")
    ip = ["ip"] if shutil.which("ip") else ["busybox", "ip"]
    subprocess.run([*ip, "link", "set", INTERFACE, "up"], check=True)
    t.check(t.run("drives", "--nodes", "1", "--eds", "own.eds")[0] == 0, "our own data sheet is written")
    sheet = data_sheets.read("own.eds")
    data_sheets.drop(sheet, "1006", "1016")
    drives = start_drives("socketcan:" + INTERFACE, "--eds", data_sheets.write("blind.eds", sheet))
    t.write(READY, "")
    target.wait_for(lambda: os.path.exists(STOP), "the end of the test")
    drives.send_signal(signal.SIGTERM)
    t.check(drives.wait() == 0, "the drives end")
    slcand.terminate()
    slcand.wait()
    line.close()
    t.finish()


def enable(panel):
    """Before SYNC is the drives' clock they watch the controller by the wall's: an image that a busy computer keeps from running
    is a controller that has gone. Then RESET."""
    def is_idle():
        seen = panel.read("STATE", "ALARM_TEXT")
        if seen["STATE"].strip() == ALARM:
            t.check("heartbeat of the controller lost" in seen["ALARM_TEXT"], "no other alarm at the start", seen)
            t.run("panel", "write", "RESET", "1", *panel.options)
        return seen["STATE"].strip() == IDLE

    target.wait_for(is_idle, "the drives are enabled")


def home(panel):
    panel.write("MODE", 2)
    panel.write("HOME", 1)
    target.wait_for(lambda: panel.read("STATE")["STATE"].strip() != HOMING, "homing")
    state = panel.read("STATE")["STATE"].strip()
    t.check(state == IDLE, "it homes", state, panel.read("ALARM_TEXT"))
    panel.write("MODE", 0)


def run_program(panel):
    """Positions read on the way; the X of each look."""
    runs = panel.number("RUNS")
    seen = []
    panel.upload("part.ngc")
    panel.write("CYCLE_START", 1)
    while panel.number("RUNS") == runs:
        seen.append(panel.number("POSITION_X"))
    return seen


def follow(panel, digest):
    """The program, from zero: positions seen on the way, of which a busy computer may see few."""
    home(panel)
    seen = run_program(panel)
    t.check(panel.number("OUTCOME") == 1, "the program is completed", panel.read("ALARM_TEXT"))
    t.check(panel.digest() == digest, "its setpoints are those of takt run", panel.digest(), digest)
    t.check(abs(panel.number("ACTUAL_Z") - 1) < 0.01, "the drive stands where the program ends")
    return seen


def digest_of(program, *options):
    return t.json.loads(t.run("run", program, "--json", "-", "--quiet", *options)[1])["setpoint_digest"]


def stream(panel, name, text):
    """A compiled program, started by who brings it, where it was compiled to begin: at the origin. Its file's size."""
    t.write(name + ".ngc", text)
    t.check(t.run("compile", name + ".ngc", "-o", name + ".plan", "--quiet")[0] == 0, f"{name} is compiled")
    runs = panel.number("RUNS")
    panel.upload(name + ".ngc")
    status, _, err = t.run("panel", "stream", name + ".plan", "--start", "--quiet", *panel.options)
    if t.check(status == 0, f"{name} is streamed", err):
        target.wait_for(lambda: panel.number("RUNS") != runs, f"the end of {name}")
    t.check(panel.number("OUTCOME") == 1, f"{name} is completed", panel.read("ALARM_TEXT"))
    return os.path.getsize(name + ".plan")


def check_streams(panel):
    home(panel)
    t.check(stream(panel, "smooth", SMOOTH) <= KEPT_BYTES, "all of the short one is there before it starts")
    t.check(panel.digest() == digest_of("smooth.ngc", "--plan", "smooth.plan"), "its setpoints are those of takt run --plan")
    t.check(stream(panel, "long", LONG) > 2 * KEPT_BYTES, "the long one is more than is kept")
    t.check(abs(panel.number("ACTUAL_Z") - 2) < 0.01, "the drive stands where it ends")


def check_run(board, panel, digest):
    enable(panel)
    t.check(any(len(set(follow(panel, digest))) > 1 for _ in range(TURNS)), "positions were read in motion")
    log = "\n".join(board.log())
    t.check("state: running" in log and f"completed, setpoints {digest}" in log, "the log has what happened", log)


def run(image, digest):
    line = serial_pair.Pair()
    bus = Kernel() if KERNEL else Adapter()
    board = target.Board("m4f", image, line.paths[0], bus.path, "log.txt")
    try:
        panel = target.Panel(line.paths[1])
        check_run(board, panel, digest)
        if not KERNEL:  # what carries the frames is nothing to a stream
            check_streams(panel)
    finally:
        board.stop()
        line.close()
        bus.stop()


def main():
    target.need_qemu()
    image = target.image("m4f", "takt-mps2")
    if KERNEL and shutil.which("slcand") is None:
        t.skip("slcand is not installed (Debian and Ubuntu: can-utils)")
    t.write("part.ngc", PROGRAM)
    digest = digest_of("part.ngc")
    run(image, digest)
    t.finish()


if "--drives" in sys.argv:
    run_drives()
main()
