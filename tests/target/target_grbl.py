#!/usr/bin/env python3
"""The image with a console in QEMU: a sender of Grbl on a serial line of its own homes, jogs, streams by counting characters
and line by line, holds, resets; what it streams gives the setpoints of takt run. The panel stays usable beside it."""

import os
import signal
import subprocess

import target
import data_sheets
import grbl_sender as g
import panel_client
import serial_pair
import takt_test as t

PART = "G21 G90 G64 P0.01 F1200\n" + "".join(f"G1 X{0.2 * i:.1f} Y{i % 3}\n" for i in range(1, 41)) + "M2\n"
WINDOW = 500

# The last answer of a program comes when it is done, and on a busy computer a second of an image takes many.
panel_client.PATIENCE_S = target.PATIENCE_S


def ask_states(sender):
    sender.wait_for("Idle")
    t.check(sender.ask("$H") == "ok" and sender.status()[0] == "Idle", "homing is answered when it is done")
    t.check("[FIRMWARE:takt]" in asked(sender, "$I+") and any(line.startswith("[GC:") for line in asked(sender, "$G")), "it tells what it is", sender.others)
    t.check(len(asked(sender, "$$")) > 25 and len(asked(sender, "$#")) == 11, "settings and offsets are told in whole", sender.others)
    t.check(sender.ask("$J=G91 G21 X2 F6000") == "ok", "a jog is taken")
    sender.wait_for("Idle")
    t.check(sender.status()[1]["MPos"].startswith("2.000,"), "a jog ends where it says", sender.status())
    sender.ask("G0 X0")
    sender.wait_for("Idle")


def asked(sender, command):
    t.check(sender.ask(command) == "ok", f"{command} is answered")
    return sender.others


def stream(sender, panel, digest, window, claim):
    def back():
        sender.ask("G0 X0 Y0 Z0")
        sender.wait_for("Idle")

    def send():
        t.check(sender.stream(PART, window) == [], f"{claim}: every line is good")
        sender.wait_for("Idle")

    g.send_whole(lambda: panel.number("RUNS"), back, send)
    t.check(panel.digest() == digest, f"{claim}: the setpoints are those of takt run", panel.digest(), digest)
    back()


def hold_and_reset(sender, panel):
    sender.ask("G1 X50 F600")
    sender.wait_for("Run")
    sender.realtime(b"!")
    sender.wait_for("Hold")
    sender.realtime(b"~\x92")
    sender.wait_for("Run")
    t.check(panel.number("FEED_OVERRIDE") == 90, "an override is the panel's too")
    sender.realtime(g.RESET)
    sender.expect("Grbl 1.1h ['$' for help]")
    sender.wait_for("Idle")
    t.check(sender.ask("G5 X") == "error:2" and sender.ask("$C") == "error:3", "what is wrong or not there is an error")
    panel.write("EMERGENCY_STOP", 1)
    sender.wait_for("Alarm")
    t.check(sender.ask("G0 X1") == "error:9", "after an emergency stop it moves nothing")


def read_nothing(sender, panel):
    """More is asked than all buffers hold of the answers; what is left of them is read when the panel has shown that it goes on."""
    sender.line.write(b"$$\n" * (WINDOW // 3))
    end = panel.number("CYCLES") + 2000
    goes_on = any(panel.number("CYCLES") >= end for _ in range(20000))
    t.check(goes_on, "the controller goes on while nobody reads")
    if not goes_on:
        return
    looks = 0
    while looks < 3:  # each is longer than a piece of text is on its way
        while sender.line.has_data():
            sender.line.read()
            looks = 0
        panel.number("CYCLES")
        looks += 1
    sender.text = b""
    sender.realtime(g.RESET)
    sender.expect("Grbl 1.1h ['$' for help]")
    t.check(sender.ask("G4 P0") == "ok", "a sender that has read nothing for a while is served again")


def blind_sheet():
    """Of drives that do not watch when SYNC comes: it is the console that is tried here, not the time a busy computer has."""
    t.check(t.run("drives", "--nodes", "1", "--eds", "own.eds")[0] == 0, "our own data sheet is written")
    sheet = data_sheets.read("own.eds")
    data_sheets.drop(sheet, "1006", "1016")
    return data_sheets.write("blind.eds", sheet)


def main():
    target.need_qemu()
    image = target.image("m4f", "takt-mps2-grbl")
    status, out, err = t.run("run", t.write("part.ngc", PART), "--quiet", "--json", "-")
    t.check(status == 0, "the part is a program", err)
    drives = subprocess.Popen([t.TAKT, "drives", "--bus", "slcan:pty:bus", "--eds", blind_sheet()], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    target.wait_for(lambda: os.path.exists("bus"), "the drives' end of the bus")
    line, console = serial_pair.Pair(), serial_pair.Pair()
    terminal = g.Terminal(console.paths[1])
    board = target.Board("m4f", image, line.paths[0], os.path.realpath("bus"), "log.txt", console.paths[0])
    try:
        panel = target.Panel(line.paths[1])
        sender = g.Sender(terminal)
        ask_states(sender)
        digest = t.json.loads(out)["setpoint_digest"]
        stream(sender, panel, digest, WINDOW, "counting characters")
        stream(sender, panel, digest, 0, "line by line")
        read_nothing(sender, panel)
        hold_and_reset(sender, panel)
    finally:
        board.stop()
        terminal.close()
        line.close()
        console.close()
        drives.send_signal(signal.SIGTERM)
        t.check(drives.wait() == 0, "the drives end")
    t.finish()


main()
