"""SocketCAN, on interfaces of the kernel or of user-mode Linux: frames of every kind, drives in lockstep, logs."""

import os
import subprocess
import sys

if os.environ.get("TAKT_WITH_CAN") != "yes":
    with_can = os.path.join(os.environ["TAKT_SOURCE"], "tests", "with_can")
    done = subprocess.run([with_can, sys.executable, *sys.argv], env=dict(os.environ, TAKT_WITH_CAN="yes"), check=False)
    sys.exit(done.returncode)

import shutil

import bus_pair
import takt_test as t


def skip_if_too_large():
    """AddressSanitizer reserves more addresses than a process has in user-mode Linux."""
    with open("/proc/cpuinfo") as file:
        if "ASAN_OPTIONS" in os.environ and "User Mode Linux" in file.read():
            t.skip("the kernel has no CAN, and AddressSanitizer does not fit into user-mode Linux")


def check_frames(program):
    done = subprocess.run([program, "vcan1"], capture_output=True, text=True, check=False)
    t.check(done.returncode == 0, "frames of every kind pass, filters work, an interface that is down is told", done.stdout)


def frames(path):
    with open(path) as file:
        return [line.split()[2] for line in file]


def check_log():
    """What takt has logged is what candump has seen, in the same order."""
    if not shutil.which("candump"):
        print("no candump: the bus log is not compared with its")
        return
    drives = bus_pair.Drives("socketcan:vcan0")
    with open("candump.log", "w") as file: # it ends by itself when nothing has come for 3 s
        candump = subprocess.Popen(["candump", "-L", "-r", "16000000", "-T", "3000", "vcan0"], stdout=file)
    status, _, err = bus_pair.run_controller("logged", "--bus", "socketcan:vcan0", "--bus-log", "takt.log")
    t.check(status == 0, "a logged run completes", err)
    drives.stop()
    candump.wait()
    ours, theirs = frames("takt.log"), frames("candump.log")
    t.check(len(ours) > 1000, "the log has all frames", len(ours))
    # candump began before the run and ended after it.
    start = next((i for i, frame in enumerate(theirs) if frame == ours[0]), 0)
    t.check(sorted(theirs[start : start + len(ours)]) == sorted(ours), "the log has the frames candump has seen")


def main():
    skip_if_too_large()
    check_frames(sys.argv[1])
    bus_pair.check_pair("socketcan", "socketcan:vcan0", "")
    check_log()
    t.finish()


main()
