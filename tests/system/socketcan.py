"""SocketCAN, on interfaces of the kernel or of user-mode Linux: frames of every kind, drives in lockstep, logs. Under
AddressSanitizer, where the kernel has no CAN, on interfaces made of pipes."""

import os
import shutil
import subprocess
import sys
import tempfile


def run_with_can():
    """This test where CAN is. Programs are found by links below /tmp, as `tests/without` makes them of a clone there."""
    with_can = os.path.join(os.environ["TAKT_SOURCE"], "tests", "with_can")
    how = ["--sanitized"] if "ASAN_OPTIONS" in os.environ else []
    with tempfile.TemporaryDirectory(dir="/tmp") as links:
        if busybox := shutil.which("busybox"):
            os.symlink(busybox, os.path.join(links, "busybox"))
        environment = dict(os.environ, TAKT_WITH_CAN="yes", PATH=links + os.pathsep + os.environ["PATH"])
        return subprocess.run([with_can, *how, sys.executable, *sys.argv], env=environment, check=False).returncode


if os.environ.get("TAKT_WITH_CAN") != "yes":
    sys.exit(run_with_can())

import time

import bus_pair
import takt_test as t


def check_frames(program):
    done = subprocess.run([program, "vcan1"], capture_output=True, text=True, check=False)
    t.check(done.returncode == 0, "frames of every kind pass, filters work, an interface that is down is told", done.stdout)


def frames(path):
    with open(path) as file:
        return [line.split()[2] for line in file if line.endswith("\n")]


def check_log():
    """What the controller has logged is what the drives have."""
    drives = bus_pair.Drives("socketcan:vcan0", "--bus-log", "drives.log")
    status, _, err = bus_pair.run_controller("logged", "--bus", "socketcan:vcan0", "--bus-log", "takt.log")
    t.check(status == 0, "a logged run completes", err)
    drives.stop()
    bus_pair.check_logs_agree("socketcan", "takt.log", "drives.log")


def listeners():
    """Sockets that take all frames of vcan0."""
    with open("/proc/net/can/rcvlist_all") as file:
        return sum(line.split()[0] == "vcan0" for line in file if line.strip())


def start_candump(path):
    """candump, as soon as it listens; it writes line by line."""
    before = listeners()
    with open(path, "w") as file:
        candump = subprocess.Popen(["stdbuf", "-oL", "candump", "-L", "-r", "16000000", "vcan0"], stdout=file)
    while listeners() == before and candump.poll() is None:
        time.sleep(0.01)
    return candump


def stop_candump(candump, path):
    """When it has written everything up to a frame that nobody else sends."""
    subprocess.run(["cansend", "vcan0", "7FE#"], check=True)
    while "7FE#" not in frames(path)[-1:] and candump.poll() is None:
        time.sleep(0.01)
    candump.terminate()
    candump.wait()


def check_log_against_candump():
    """What takt has logged is what candump has seen."""
    if not shutil.which("candump") or "TAKT_CAN" in os.environ:
        print("no candump here: the bus log is not compared with its")
        return
    drives = bus_pair.Drives("socketcan:vcan0")
    candump = start_candump("candump.log")
    status, _, err = bus_pair.run_controller("logged", "--bus", "socketcan:vcan0", "--bus-log", "takt.log")
    t.check(status == 0, "a logged run completes", err)
    drives.stop()
    stop_candump(candump, "candump.log")
    ours, theirs = frames("takt.log"), frames("candump.log")
    t.check(len(ours) > 1000, "the log has all frames", len(ours))
    # candump began before the run and ended after it.
    start = next((i for i, frame in enumerate(theirs) if frame == ours[0]), 0)
    t.check(sorted(theirs[start : start + len(ours)]) == sorted(ours), "the log has the frames candump has seen")


def check_fd():
    """Frames of CAN FD, to drives of another process: the setpoints and reports of the embedded bus."""
    machine = t.write("fd.ini", "[bus]\ndata_bitrate = 5000000\n" + "".join(f"[axis {a}]\ndrive_node = {n}\n" for n, a in enumerate("XYZ", 1)))
    status, embedded, err = bus_pair.run_controller("embedded", "--machine", machine)
    t.check(status == 0, "the embedded bus runs CAN FD", err)
    drives = bus_pair.Drives("socketcan:vcan0", "--machine", machine)
    status, summary, err = bus_pair.run_controller("vcan", "--machine", machine, "--bus", "socketcan:vcan0", "--bus-log", "fd.log")
    drives.stop()
    if t.check(status == 0, "CAN FD on an interface of the kernel", err):
        bus_pair.compare("vcan", embedded, summary)
        t.check(all("##1" in frame for frame in frames("fd.log")), "every frame switches its rate")


def main():
    check_frames(sys.argv[1])
    check_fd()
    bus_pair.check_pair("socketcan", "socketcan:vcan0", "")
    check_log()
    check_log_against_candump()
    t.finish()


main()
