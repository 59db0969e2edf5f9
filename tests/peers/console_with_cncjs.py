#!/usr/bin/env python3
"""The server of CNCjs, unmodified, on the console's pseudo terminal, ordered about as its page does: connect, home, jog,
stream, pause, overrides, hold, reset, check mode, alarm, sleep; what it has streamed gives the setpoints of takt run.

Skipped where CNCjs is not: npm install cncjs@1.11.5, and TAKT_CNCJS is its folder node_modules, if not build/peers/node_modules.
"""

import json
import math
import os
import shutil
import socket
import subprocess
import sys
import threading
import urllib.error
import urllib.request

sys.path.insert(0, os.path.join(os.environ["TAKT_SOURCE"], "tests", "system"))

import grbl_sender
import panel_client as p
import takt_test as t

MODULES = os.environ.get("TAKT_CNCJS") or os.path.join(os.environ["TAKT_SOURCE"], "build", "peers", "node_modules")
LINES = 400
# What CNCjs appends to every program.
LAST = "G4 P0.5\n"


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def answers(port):
    try:
        urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=p.PATIENCE_S).close()
    except urllib.error.HTTPError:
        return True
    except OSError:
        return False
    return True


class Cncjs:
    def __init__(self, link):
        self.link = os.path.abspath(link)
        self.told, self.read, self.state, self.sender, self.workflow = set(), [], "", {}, ""
        port = free_port()
        t.write("cncrc", json.dumps({"secret": "none", "checkForUpdates": False}))
        environment = {**os.environ, "HOME": os.getcwd(), "NODE_ENV": "production"}
        command = ["node", os.path.join(MODULES, "cncjs", "bin", "cncjs"), "-H", "127.0.0.1", "-p", str(port), "-c", "cncrc"]
        self.server = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        p.until(lambda: answers(port), lambda: "the server of CNCjs does not answer")
        client = os.path.join(os.path.dirname(os.path.abspath(__file__)), "cncjs_client.cjs")
        self.client = subprocess.Popen(["node", client, MODULES, str(port)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        threading.Thread(target=self.hear, daemon=True).start()
        p.until(lambda: "startup" in self.told, lambda: "CNCjs does not greet")
        self.emit("open", self.link, {"controllerType": "Grbl", "baudrate": 115200})
        self.wait_for("Idle")

    def hear(self):
        for line in self.client.stdout:
            name, *data = json.loads(line)
            self.told.add(name)
            if name == "serialport:read":
                self.read.append(data[0])
            elif name == "controller:state":
                self.state = data[1]["status"]["activeState"]
            elif name == "sender:status":
                self.sender = data[0]
            elif name == "workflow:state":
                self.workflow = data[0]

    def emit(self, *order):
        self.client.stdin.write(json.dumps(order) + "\n")
        self.client.stdin.flush()

    def order(self, *words):
        self.emit("command", self.link, *words)

    def wait_for(self, state):
        p.until(lambda: self.state == state, lambda: f"{state} is expected, not {self.state}: {self.read[-5:]}")

    def refused(self):
        return [line for line in self.read if line.startswith(("error", "ALARM"))]

    def close(self):
        self.client.terminate()
        self.server.terminate()
        self.client.wait()
        self.server.wait()


def wave():
    lines = "".join(f"X{0.4 * i:.3f} Y{2 * math.sin(0.1 * i):.3f}\n" for i in range(1, LINES + 1))
    return "G21 G90 G17 G64 P0.01\nG0 Z2\nG1 F1200\n" + lines


def move_to(one, client, line):
    """A line by hand, until it is done."""
    runs = client.counts("RUNS")
    one.order("gcode", line)
    client.wait_while("RUNS", runs)
    one.wait_for("Idle")


def stream(one, client):
    text = wave()
    status, out, err = t.run("run", t.write("wave.ngc", text + LAST), "--quiet", "--json", "-")
    t.check(status == 0, "what it sends is a program", err)
    one.order("gcode:load", "wave.ngc", text)
    p.until(lambda: one.sender.get("total", 0) >= LINES, lambda: "the program is loaded")
    runs = client.counts("RUNS")
    one.order("gcode:start")
    client.wait_while("RUNS", runs)
    one.wait_for("Idle")
    t.check(client.digest() == json.loads(out)["setpoint_digest"], "its setpoints are those of takt run", client.digest())
    p.until(lambda: one.workflow == "idle", lambda: "CNCjs sees the end of the program")


def jog(one, client):
    runs = client.counts("RUNS")
    one.order("homing")
    client.wait_while("RUNS", runs)
    one.wait_for("Idle")
    move_to(one, client, "$J=G91 G21 X20 F6000")
    t.check(client.get("POSITION_X") == 20, "it jogs", client.get("POSITION_X"))
    one.order("gcode", "$J=G91 X300 F600")
    one.wait_for("Jog")
    one.order("jogCancel")
    one.wait_for("Idle")
    t.check(20 < client.get("POSITION_X") < 320, "a jog is cancelled", client.get("POSITION_X"))
    move_to(one, client, "G0 X0")


def hold_and_reset(one, client):
    one.order("gcode", "G1 X-100 F600")
    one.wait_for("Run")
    one.order("feedhold")
    one.wait_for("Hold")
    one.order("cyclestart")
    one.wait_for("Run")
    for order, change, name, percent in (("feedOverride", -10, "FEED_OVERRIDE", 90), ("rapidOverride", 50, "RAPID_OVERRIDE", 50),
                                         ("spindleOverride", 10, "SPINDLE_OVERRIDE", 110)):
        one.order(order, change)
        p.until(lambda: client.get(name) == percent, lambda: f"{name} is {client.get(name)}, {percent} expected")
    one.order("reset")
    one.wait_for("Idle")
    t.check(client.get("FEED_OVERRIDE") == 100 and client.get("POSITION_X") > -100, "a reset leads to rest and to 100 %")


def stop_a_program(one):
    """As its page's buttons do: pause, resume, pause, stop, which resets."""
    one.order("gcode:start")
    one.wait_for("Run")
    one.order("gcode:pause")
    one.wait_for("Hold")
    one.order("gcode:resume")
    one.wait_for("Run")
    one.order("gcode:stop", {"force": True})
    p.until(lambda: one.workflow == "idle", lambda: "the program is stopped")
    one.wait_for("Idle")
    t.check(one.refused() == [], "nothing was refused", one.refused())


def modes(one):
    one.order("gcode", "$C")
    one.wait_for("Check")
    one.order("gcode", "$C")
    one.wait_for("Idle")
    one.order("gcode", "G1 X9000 F100")
    one.wait_for("Alarm")
    t.check([line.split(" ")[0] for line in one.refused()] == ["error:15", "ALARM:2"], "beyond the travel is an alarm", one.refused())
    one.order("unlock")
    one.wait_for("Idle")
    one.order("sleep")
    one.wait_for("Sleep")
    one.order("reset")
    one.wait_for("Idle")


if not shutil.which("node") or not os.path.isdir(os.path.join(MODULES, "cncjs")):
    t.skip("CNCjs is not installed: npm install cncjs@1.11.5, and TAKT_CNCJS is its node_modules")
service, link = grbl_sender.serve("pty:./line")
client = service.client()
client.wait_for("STATE", p.IDLE)
one = Cncjs(link)
jog(one, client)
stream(one, client)
hold_and_reset(one, client)
stop_a_program(one)
modes(one)
one.close()
service.stop()
t.finish()
