#!/usr/bin/env python3
"""grbl-streamer, unmodified, on the console's pseudo terminal: connect, home, jog, stream, hold, resume, reset; what it has
sent of a program gives the setpoints of takt run."""

import json
import math
import os
import sys

import packages

packages.require("grbl_streamer", "serial")

sys.path.insert(0, os.path.join(os.environ["TAKT_SOURCE"], "tests", "system"))

import grbl_sender
import panel_client as p
import takt_test as t
from grbl_streamer import GrblStreamer

LINES = 150


class Watched:
    """The streamer, and what it tells."""

    def __init__(self, link):
        self.mode, self.written, self.refused = "", [], []
        self.wanted = None  # at the next answer
        self.streamer = GrblStreamer(self.hear)
        self.streamer.setup_logging()
        self.streamer.cnect(link, 115200)
        p.until(lambda: self.streamer.connected, lambda: "the streamer is not connected")
        self.streamer.poll_start()
        self.wait_for("Idle")

    def hear(self, event, *data):
        if event == "on_stateupdate":
            self.mode = data[0]
        elif event == "on_rx_buffer_percent" and self.wanted:
            self.wanted()
            self.wanted = None
        elif event == "on_write":
            self.written.append(data[0])
        elif event in ("on_error", "on_alarm"):
            self.refused.append(data)

    def wait_for(self, mode):
        p.until(lambda: self.mode.split(":")[0] == mode, lambda: f"{mode} is expected, not {self.mode}")

    def run_job(self):
        """Begun by the thread that hears answers: the streamer's two threads would take its lines from each other."""
        self.wanted = self.streamer.job_run
        self.streamer.send_immediately("$G")  # which is answered
        p.until(lambda: not self.wanted and self.streamer.job_finished, lambda: "the job is not finished")

    def send(self, line, client):
        """A line by hand, until the controller has done it."""
        runs = client.counts("RUNS")
        self.streamer.send_immediately(line)
        client.wait_while("RUNS", runs)
        self.wait_for("Idle")


def wave():
    lines = "".join(f"X{i:.3f} Y{2 * math.sin(0.1 * i):.3f}\n" for i in range(1, LINES + 1))
    return "G21 G90 G17\nG0 Z2\nG1 F3000\n" + lines


def stream(one, client):
    t.write("wave.ngc", wave())
    sent = 0

    def send():
        nonlocal sent
        one.streamer.job_new()
        one.streamer.incremental_streaming = False
        one.streamer.load_file("wave.ngc")
        sent = len(one.written)
        one.run_job()
        client.wait_for("STATE", p.IDLE)

    grbl_sender.send_whole(lambda: client.counts("RUNS"), lambda: one.send("G0 X0 Y0 Z0", client), send)
    program = "".join(line for line in one.written[sent:] if line not in ("?", "$G\n", "$#\n"))
    t.check(program.count("X") == LINES, "it has sent every line", program.count("X"))
    t.write("sent.ngc", program)
    status, out, err = t.run("run", "sent.ngc", "--quiet", "--json", "-")
    t.check(status == 0, "what it has sent is a program", err)
    t.check(client.digest() == json.loads(out)["setpoint_digest"], "its setpoints are those of takt run")


service, link = grbl_sender.serve("pty:./line")
client = service.client()
client.wait_for("STATE", p.IDLE)
one = Watched(link)
runs = client.counts("RUNS")
one.streamer.homing()
client.wait_while("RUNS", runs)
one.send("$J=G91 X20 F6000", client)
t.check(client.get("POSITION_X") == 20, "it jogs", client.get("POSITION_X"))
one.send("G0 X0", client)
stream(one, client)
one.wait_for("Idle")
one.streamer.send_immediately("G1 X-100 F600")
one.wait_for("Run")
one.streamer.hold()
client.wait_for("STATE", p.HELD)
one.streamer.resume()
client.wait_for("STATE", p.MDI)
one.streamer.softreset()
client.wait_for("STATE", p.IDLE)
t.check(client.get("POSITION_X") > -100 and one.refused == [], "it resets, and nothing was refused", one.refused)
one.streamer.disconnect()
service.stop()
for failure in t.failures:
    print(failure)
sys.stdout.flush()
os._exit(1 if t.failures else 0)  # its threads do not end
