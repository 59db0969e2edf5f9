"""What the tests of buses share: virtual drives as a process of their own, and a controller that comes to them."""

import atexit
import os
import queue
import re
import subprocess
import threading

import takt_test as t

# A few seconds of motion of all axes, with stops and an arc.
PROGRAM = t.write("pair.ngc", "G21 G90 G17 F3000\nG1 X20 Y10 Z-2\nG2 X30 Y20 I0 J10\nG4 P0.05\nG0 X0 Y0 Z5\nG1 X3 F200\nM2\n")


class Drives:
    """`takt drives` on a bus; address is where a controller finds them."""

    def __init__(self, bus, *options):
        self.process = subprocess.Popen(
            [t.TAKT, "drives", "--bus", bus, *options], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        atexit.register(self.process.kill)
        self.lines = queue.SimpleQueue()  # of its log; empty: its end
        threading.Thread(target=self.hear, daemon=True).start()
        first = self.lines.get()
        found = re.search(r"bus (\S+)", first)
        t.check(found, "the drives say where they are", bus, first)
        self.address = found.group(1) if found else ""

    def hear(self):
        """All the time: drives whose log nobody takes stand still once the pipe is full."""
        for line in self.process.stdout:
            self.lines.put(line)
        self.lines.put("")

    def wait_for(self, text):
        """Until a line of the log has it."""
        while text not in (line := self.lines.get()):
            assert line, "the drives have ended"

    def stop(self):
        self.process.terminate()
        rest = "".join(iter(self.lines.get, ""))
        t.check(self.process.wait() == 0, "the drives end well when asked to", rest)
        return rest


def run_controller(name, *options, program=PROGRAM):
    """Runs the program; returns the exit status, the summary (None if there is none), and what went to stderr."""
    json, trace = name + ".json", name + ".csv"
    status, _, err = t.run("run", program, "--json", json, "--trace", trace, "--quiet", *options)
    return status, t.load_json(json) if os.path.exists(json) else None, err


def run_both(machine, program, what):
    """Summaries on the embedded bus and on one of two processes; None: what, a claim, does not hold."""
    status, embedded, err = run_controller("embedded", "--machine", machine, program=program)
    t.check(status == 0, "the embedded bus runs the program", err)
    drives = Drives("slcan:pty", "--machine", machine)
    status, outside, err = run_controller("outside", "--machine", machine, "--bus", "slcan:" + drives.address, program=program)
    drives.stop()
    return (embedded, outside) if t.check(status == 0, what, err) and outside else None


def compare(name, embedded, summary):
    """Setpoints and everything the drives have reported are the same to the last digit."""
    t.check(summary["setpoint_digest"] == embedded["setpoint_digest"], name + ": same setpoints", summary["setpoint_digest"])
    t.check(summary["axes"] == embedded["axes"], name + ": same figures of all axes")
    with open("embedded.csv", "rb") as a, open(name + ".csv", "rb") as b:
        t.check(a.read() == b.read(), name + ": same trace, actual positions included")


def read_log(path):
    """Frames of a bus log: those of the controller, and those of the drives."""
    frames = ([], [])
    with open(path) as file:
        for line in file:
            frame = line.split()[2]
            number = int(frame.split("#")[0], 16)
            of_drive = number & 0x780 in (0x180, 0x280, 0x580, 0x700) or 0x80 < number < 0x100
            frames[of_drive and number & 0x7F <= 3].append(frame)
    return frames


def check_logs_agree(name, controller_log, drives_log):
    """What one side has logged the other has, too, in the same order, but for what was under way at begin and end."""
    sent, answers = read_log(controller_log)
    heard, answered = read_log(drives_log)
    t.check(len(heard) > 1000 and heard == sent[: len(heard)], name + ": drives log what the controller has sent", len(heard), len(sent))
    t.check(len(sent) - len(heard) < 10, name + ": all of it but for the end", len(heard), len(sent))
    begin = len(answered) - len(answers)
    while begin > 0 and answered[begin : begin + len(answers)] != answers:
        begin -= 1
    t.check(len(answers) > 1000 and answered[begin : begin + len(answers)] == answers, name + ": drives log what they have sent")


def check_pair(name, bus, prefix, *options):
    """Separate drives on a bus, in lockstep, do what those of the embedded bus do."""
    status, embedded, err = run_controller("embedded")
    t.check(status == 0, "the embedded bus runs the program", err)
    drives = Drives(bus)
    status, summary, err = run_controller(name, "--bus", prefix + drives.address, "--drives", "external", *options)
    if t.check(status == 0, name + ": the run completes and holds", err) and summary:
        compare(name, embedded, summary)
    log = drives.stop()
    t.check(log.count("operation enabled") >= 3, name + ": all drives were enabled", log)
