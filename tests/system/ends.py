"""Every way out at random moments: signals, kill -9, a bus that goes down, a disk that is full.

NUMBER FIRST: how many moments, and the seed of the first. A proxy between controller and drives counts SYNC frames, which
are the clock of every judgement, and sees what the drives report after the controller is gone.
"""

import os
import random
import re
import resource
import signal
import socket
import struct
import subprocess
import sys
import threading

import bus_pair
import panel_client as p
import takt_test as t

NUMBER = int(sys.argv[1]) if len(sys.argv) > 1 else 18
FIRST = int(sys.argv[2]) if len(sys.argv) > 2 else 1
AT_A_TIME = 3
TURNS = 30

AXES = 3
INC_PER_MM = 100000
CYCLE_S = 0.001

# In cycles: the longest way to rest on the path and that of the brakes (firmware/controller/controller_drives.c), and three
# heartbeats of the built-in machine.
END_CYCLES = 2000 + 3000
HEARTBEAT_CYCLES = 100
STANDS_MM = 0.01

# The drives leave "operation enabled" before the program begins: SYNC frames until then are the start.
PROGRAM = "G21 G90 G64 P0.05 F6000\nM3 S500\n" + "G1 X100 Y40\nG2 X140 Y40 I20 J0\nG1 X300 Y0 Z20\nG61\nG1 X250\nG64\nG1 X0 Y0 Z0\n" * 60 + "M2\n"

PROGRAM_PATH = t.write("winding.ngc", PROGRAM)

WAYS = ("INT", "TERM", "HUP", "KILL", "BUS", "DISK")
COMMANDS = ("run", "realtime", "serve")


class Disturbed(Exception):
    """In real time a proxy that is kept from running is a drive, or a controller, that is silent: such a moment is tried again."""


def is_of_silence(text):
    return "has sent no position" in text or "heartbeat of the controller lost" in text


class Proxy:
    """A TCP adapter for the controller, the computer for the drives; counts and keeps what passes."""

    def __init__(self, drives_address):
        host, port = drives_address.rsplit(":", 1)
        self.place = host, int(port)
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.address = "127.0.0.1:%d" % self.listener.getsockname()[1]
        self.changed = threading.Condition()
        self.syncs = 0  # since the first drive was enabled
        self.is_enabled = False
        self.is_open = True
        self.is_gone = False  # the controller, with all it has sent
        self.targets = [[] for _ in range(AXES)]  # increments, one a SYNC
        self.target = [0] * AXES
        self.status = [0] * AXES
        self.actual = [None] * AXES
        self.beats = [0] * AXES
        self.reports = [0] * AXES
        self.controller = None
        self.sockets = [self.listener]
        self.threads = []
        self.meet_drives()
        self.begin(self.serve_controllers)

    def begin(self, *work):
        self.threads.append(threading.Thread(target=work[0], args=work[1:], daemon=True))
        self.threads[-1].start()

    def meet_drives(self):
        self.drives = socket.create_connection(self.place)
        self.sockets.append(self.drives)
        self.begin(self.pump, self.drives, self.from_drive, self.to_controller)

    def meet_drives_again(self):
        """A controller that goes is gone for the drives as well; but we stay to watch them."""
        self.drives.shutdown(socket.SHUT_RDWR)
        self.beats = [0] * AXES
        self.meet_drives()
        self.drives.sendall(b"O\r")

    def serve_controllers(self):
        while self.is_open:
            try:
                self.controller, _ = self.listener.accept()
            except OSError:
                return
            self.sockets.append(self.controller)
            self.controller.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self.is_gone = False
            self.pump(self.controller, self.from_controller, self.drives.sendall)
            try:
                self.meet_drives_again()
            except OSError:
                return
            with self.changed:
                self.is_gone = True
                self.changed.notify_all()

    def to_controller(self, data):
        controller = self.controller
        try:
            if controller is not None:
                controller.sendall(data)
        except OSError:
            pass

    def pump(self, source, look, forward):
        rest = b""
        while True:
            try:
                data = source.recv(65536)
            except OSError:
                data = b""
            if not data:
                return
            lines = (rest + data).split(b"\r")
            rest = lines.pop()
            with self.changed:
                for line in lines:
                    frame = re.match(rb"t(...)(.)((?:..)*)", line.lstrip(b"z\a"))
                    if frame:
                        look(int(frame.group(1), 16), bytes.fromhex(frame.group(3).decode()))
                self.changed.notify_all()
            try:
                forward(data)
            except OSError:
                return

    def from_controller(self, number, data):
        if number == 0x080:
            self.syncs += self.is_enabled
            for axis in range(AXES):
                self.targets[axis].append(self.target[axis])
        elif number == 0x301:
            self.target[0], self.target[1] = struct.unpack("<ii", data[:8])
        elif number == 0x303:
            self.target[2] = struct.unpack("<i", data[:4])[0]

    def from_drive(self, number, data):
        axis = (number & 0x7F) - 1
        if not 0 <= axis < AXES:
            return
        if number & 0x780 == 0x180:
            self.status[axis], self.actual[axis] = struct.unpack("<Hi", data[:6])
            self.is_enabled = self.is_enabled or self.all_enabled()
        elif number & 0x780 == 0x580 and data[1:3] == b"\x41\x60":
            self.status[axis] = struct.unpack("<H", data[4:6])[0]
            self.reports[axis] += 1
        elif number & 0x780 == 0x580 and data[1:3] == b"\x64\x60":
            self.actual[axis] = struct.unpack("<i", data[4:8])[0]
            self.reports[axis] += 1
        elif number & 0x780 == 0x700:
            self.beats[axis] += 1

    def all_enabled(self):
        return all(status & 0x6F == 0x27 for status in self.status)

    def none_enabled(self):
        return not any(status & 0x6F == 0x27 for status in self.status)

    def wait(self, condition, told):
        with self.changed:
            good = self.changed.wait_for(condition, p.PATIENCE_S)
        assert good, told

    def ask_positions(self):
        """Objects 6041 and 6064 of every drive, once the controller is gone; returns positions, mm."""
        self.wait(lambda: self.is_gone, "the controller closes its connection")
        self.drives.sendall(b"O\r")
        for index in (b"4160", b"6460"):
            before = list(self.reports)
            for axis in range(AXES):
                self.drives.sendall(b"t60%d840%s0000000000\r" % (axis + 1, index))
            self.wait(lambda: all(now > was for now, was in zip(self.reports, before)), "the drives answer requests")
        return [actual / INC_PER_MM for actual in self.actual]

    def wait_for_beats(self, count):
        """So many of every drive, since the controller has gone."""
        self.wait(lambda: self.is_gone and min(self.beats) >= count, "the drives' time goes on")

    def pass_time(self):
        """A heartbeat of time, if the drives still take SYNC for their clock; else more, which does no harm."""
        self.drives.sendall(b"t0800\r" * HEARTBEAT_CYCLES)

    def cut(self):
        """The bus between controller and drives goes down, for the controller to see."""
        controller, self.controller = self.controller, None
        try:
            controller.shutdown(socket.SHUT_RDWR)
        except OSError as error:
            raise Disturbed from error

    def close(self):
        """Sockets are closed when nobody uses them any more: their numbers are for others then."""
        self.is_open = False
        for one in self.sockets:
            try:
                one.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass
        for thread in self.threads:
            thread.join(p.PATIENCE_S)
        for one in self.sockets:
            one.close()


class Alone:
    """A controller with its drives inside: the bus log tells what they did, the program's line when to strike."""

    def __init__(self, moment):
        self.moment = moment

    def bus(self):
        return []

    def wait_for_motion(self):
        if self.moment.client is not None:
            first = self.moment.client.counts("CYCLES")
            p.until(lambda: self.moment.client.counts("CYCLES") - first >= self.moment.at, lambda: "the cycles stand")
            return
        for _ in range(self.moment.at):
            assert self.moment.process.stdout.readline(), "the trace ends"

    def judge_order(self):
        status, positions = {}, {axis: [] for axis in range(AXES)}
        with open(self.moment.path("bus.log")) as file:
            for line in file:
                number, _, data = line.split()[2].partition("#")
                axis = int(number, 16) - 0x181
                if 0 <= axis < AXES:
                    status[axis], actual = struct.unpack("<Hi", bytes.fromhex(data))
                    positions[axis].append(actual / INC_PER_MM)
        self.moment.check(not any(s & 0x6F == 0x27 for s in status.values()), "no drive is enabled after an ordered end", status)
        for axis in range(AXES):
            self.moment.check(abs(positions[axis][-1] - positions[axis][-2]) < 1e-4, "the axes stand", positions[axis][-3:])

    def close(self):
        pass


class Outside:
    """Drives in a process of their own, with the proxy between."""

    def __init__(self, moment):
        self.moment = moment
        self.drives = bus_pair.Drives("slcan:listen:0")
        self.proxy = Proxy(self.drives.address)

    def bus(self):
        """In real time reports that Python keeps back look like axes that lag."""
        patient = [word for axis in "XYZ" for word in ("--set", f"axis.{axis}.following_error_max_mm=0")]
        return ["--bus", "slcan:" + self.proxy.address] + (patient if self.moment.command != "run" else [])

    def wait_for_motion(self):
        process = self.moment.process
        self.proxy.wait(lambda: self.proxy.syncs >= self.moment.at or process.poll() is not None, "the program runs")
        self.began = self.proxy.syncs

    def judge_order(self):
        """At rest in time, nobody enabled, the limits held on the way."""
        check, proxy = self.moment.check, self.proxy
        check(proxy.none_enabled(), "no drive is enabled after an ordered end", [hex(s) for s in proxy.status])
        took = proxy.syncs - self.began if self.moment.way != "DISK" else 0 # nobody knows when it was full
        check(took < END_CYCLES, "the end comes in time", took)
        for axis in range(AXES if self.moment.command == "run" else 0):
            mm = [inc / INC_PER_MM for inc in proxy.targets[axis]]
            v = [b - a for a, b in zip(mm, mm[1:])]
            a = [(y - x) / CYCLE_S**2 for x, y in zip(v, v[1:])]
            most = max(map(abs, a))
            check(most <= 1000 * 1.0001 + 4 / INC_PER_MM / CYCLE_S**2, "acceleration is held to the end", axis, most)
        self.judge_standstill(self.proxy.pass_time)

    def judge_standstill(self, pass_time):
        here = self.proxy.ask_positions()
        pass_time()
        there = self.proxy.ask_positions()
        self.moment.check(all(abs(x - y) < STANDS_MM for x, y in zip(here, there)), "the axes stand", here, there)
        self.moment.check(self.proxy.none_enabled(), "no drive is enabled", [hex(s) for s in self.proxy.status])

    def judge_drives_alone(self):
        """The controller is gone: the drives rest by themselves. Their heartbeats are the clock."""
        self.proxy.ask_positions()
        if self.moment.command != "run" and self.proxy.none_enabled():
            raise Disturbed # in alarm before: drives that are off wait for SYNC, and move nothing
        self.proxy.wait_for_beats(2)
        self.judge_standstill(lambda: self.proxy.wait_for_beats(3))

    def close(self):
        self.drives.process.kill() # what the proxy still says to them ends with them
        self.drives.process.wait()
        self.proxy.close()


class Moment:
    """One controller, one way out."""

    def __init__(self, seed, turn):
        self.random = random.Random(1000 * seed + turn)
        self.command = COMMANDS[seed % len(COMMANDS)]
        self.way = WAYS[seed // len(COMMANDS) % len(WAYS)]
        self.at = self.random.randrange(1, 2500)
        self.name = f"seed {seed}, {self.command}, {self.way} after {self.at} cycles"
        self.folder = f"moment-{seed}-{turn}"
        os.mkdir(self.folder)
        self.client = None
        # In real time a proxy in Python is no bus; but what drives do alone does not depend on it.
        is_outside = self.command == "run" or self.way in ("KILL", "BUS", "DISK")
        self.field = Outside(self) if is_outside else Alone(self)

    def check(self, condition, claim, *details):
        t.check(condition, self.name + ": " + claim, *details)

    def path(self, name):
        return os.path.join(self.folder, name)

    def start(self):
        log = ["--bus-log", self.path("bus.log")]
        if self.command == "serve":
            command = ["serve", "--listen", "127.0.0.1:0", "--http", "off", "--state", "none", "--program", PROGRAM_PATH, *log]
        else:
            trace = "-" if isinstance(self.field, Alone) else self.path("trace.csv")
            command = ["run", PROGRAM_PATH, "--quiet", "--trace", trace, "--json", self.path("summary.json"), *log]
        if self.command == "realtime":
            command.append("--realtime")
        self.process = subprocess.Popen(
            [t.TAKT, *command, *self.field.bus()],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=self.limit, restore_signals=False,
        )
        if self.command == "serve":
            ready = self.process.stdout.readline()
            assert ":" in ready, self.process.communicate()
            self.client = p.Client(int(ready.rsplit(":", 1)[1]))
            p.until(lambda: self.client.counts("STATE") in (p.IDLE, p.ALARM), lambda: "the service does not start")
            self.look_for_silence()
            self.client.wait_for("STATE", p.IDLE)
            self.client.put("CYCLE_START", 1)

    def limit(self):
        """A disk that is full at a random place of the bus log; Python ignores SIGXFSZ, and so takt does here."""
        if self.way == "DISK":
            full = 800000 + 200 * self.at
            resource.setrlimit(resource.RLIMIT_FSIZE, (full, full))

    def strike(self):
        self.field.wait_for_motion()
        if self.way == "BUS":
            self.field.proxy.cut()
        elif self.way != "DISK":
            self.process.send_signal(getattr(signal, "SIG" + self.way))

    def judge_log(self):
        with open(self.path("bus.log")) as file:
            log = file.read()
        self.check(log.endswith("\n"), "the bus log ends with a whole line", log[-60:])

    def judge_files(self, out):
        self.judge_log()
        if self.command == "serve":
            return
        rows = out if isinstance(self.field, Alone) else open(self.path("trace.csv")).read()
        cycles = [int(row.split(",")[0]) for row in rows.splitlines() if row[0].isdigit()]
        self.check(rows.endswith("\n"), "the trace is whole", rows[-60:])
        self.check(all(b == a + 1 for a, b in zip(cycles, cycles[1:])), "it has every cycle")
        summary = t.load_json(self.path("summary.json"))
        self.check(summary["outcome"] == "interrupted" and (not cycles or summary["cycles"] == cycles[-1] + 1), "the summary tells of it", summary["outcome"], summary["cycles"])
        broken = [c["name"] for c in summary["checks"] if not c["held"]]
        self.check(not broken or self.way == "BUS", "every check held up to the end", broken)

    def expected_status(self):
        if self.way == "KILL":
            return -signal.SIGKILL
        if self.way == "DISK" or (self.way == "BUS" and self.command != "serve"):
            return 3
        return 0 if self.command == "serve" else 128 + getattr(signal, "SIG" + self.way)

    def look_for_silence(self):
        if is_of_silence(self.client.text("ALARM_TEXT")):
            raise Disturbed

    def judge_lost_bus_of_service(self):
        """The panel stays, tells of it, and after RESET the drives are enabled again."""
        proxy = self.field.proxy
        self.client.wait_for("STATE", p.ALARM)
        self.look_for_silence()
        self.check("bus" in self.client.text("ALARM_TEXT"), "the alarm is about the bus", self.client.text("ALARM_TEXT"))
        proxy.wait(lambda: proxy.controller is not None, "the service looks for the bus")
        proxy.wait(proxy.none_enabled, "the drives stay off until RESET")
        p.until(self.is_enabled_again, lambda: "RESET does not enable the drives: " + self.client.text("ALARM_TEXT"))
        self.field.began = proxy.syncs  # the bus has been looked for as long as the computer let it
        self.process.send_signal(signal.SIGTERM)

    def is_enabled_again(self):
        if self.client.counts("STATE") == p.ALARM:
            self.client.refusal("RESET", 1)
        return self.field.proxy.all_enabled()

    def judge(self):
        if self.way == "BUS" and self.command == "serve":
            self.judge_lost_bus_of_service()
            self.way = "TERM"
        elif self.way == "BUS":
            self.field.judge_drives_alone()
        out, err = self.process.stdout.read(), self.process.stderr.read()
        status = self.process.wait()
        if self.command == "realtime" and status == 1 and is_of_silence(err):
            raise Disturbed
        self.check(status == self.expected_status(), "the exit status says which end it was", status, err)
        if self.way == "KILL":
            self.field.judge_drives_alone()
        elif self.way == "DISK":
            self.field.judge_order()
            self.check("written" in err, "the files are told of", err)
            if self.command == "serve":
                self.judge_log()
        else:
            if self.way != "BUS":
                self.field.judge_order()
            self.judge_files(out)

    def run(self):
        """False: it has to be tried again."""
        try:
            self.start()
            self.strike()
            self.judge()
        except Disturbed:
            return False
        except Exception as error: # a moment that breaks down is told with its seed, and the others go on
            self.process.kill()
            self.check(False, "it breaks down", repr(error), self.process.communicate()[1])
        finally:
            self.process.kill()
            self.field.close()
        return True


def work(seeds):
    while seeds:
        seed = seeds.pop(0)
        if not any(Moment(seed, turn).run() for turn in range(TURNS)):
            t.check(False, f"seed {seed}: the computer is too busy for real time")


def main():
    sys.setswitchinterval(0.0002)  # of Python's threads: a proxy that waits for another is a silent drive
    seeds = list(range(FIRST, FIRST + NUMBER))
    workers = [threading.Thread(target=work, args=(seeds,)) for _ in range(AT_A_TIME)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    print(NUMBER, "moments")
    t.finish()


main()
