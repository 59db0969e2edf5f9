#!/usr/bin/env python3
"""An image with a single wrong bit says so on its log and to the panel, and sends nothing on the bus.

And one without anybody on its bus: it says which drive is missing, and moves nothing.
"""

import os
import select
import tty

import target
import serial_pair
import takt_test as t

ALARM = "8"


class Silence:
    """A bus nobody is on; what the image sends."""

    def __init__(self):
        self.master, self.slave = os.openpty()
        tty.setraw(self.slave)
        self.path = os.ttyname(self.slave)
        self.sent = b""

    def read(self):
        while select.select([self.master], [], [], 0)[0]:
            self.sent += os.read(self.master, 4096)
        return self.sent


def frames(sent):
    return [line for line in sent.split(b"\r") if line.startswith(b"t")]


def flip_a_bit(path, wrong):
    """In the middle of the code, as the image lies in memory: the text of a panel's state."""
    with open(path, "rb") as file:
        content = bytearray(file.read())
    at = content.find(b"emergency stop")
    t.check(at > 0, "the image has a text to spoil")
    content[at] ^= 1
    with open(wrong, "wb") as file:
        file.write(content)


def look(name, image):
    """What an image says; its log's alarm, the panel's state and text, frames sent."""
    line, bus = serial_pair.Pair(), Silence()
    board = target.Board("m4f", image, line.paths[0], bus.path, name + ".txt")
    try:
        target.wait_for(lambda: bus.read() is not None and any("alarm: " in entry for entry in board.log()), "an alarm in the log")
        panel = target.Panel(line.paths[1])
        alarm = panel.read("STATE", "ALARM_TEXT")
        refused = t.run("panel", "write", "RESET", "1", *panel.options)
        return next(entry for entry in board.log() if "alarm: " in entry), alarm, refused, frames(bus.read())
    finally:
        board.stop()
        line.close()


def main():
    target.need_qemu()
    image = target.image("m4f", "takt-mps2")
    flip_a_bit(image, "wrong.elf")
    log, alarm, refused, sent = look("wrong", "wrong.elf")
    t.check("damaged" in log and "damaged" in alarm["ALARM_TEXT"], "a wrong bit is told", log, alarm)
    t.check(alarm["STATE"].strip() == ALARM and refused[0] != 0, "no order leads out of it", alarm, refused)
    t.check(sent == [], "no drive hears anything", sent[:3])
    log, alarm, _, sent = look("alone", image)
    t.check("drive of axis X" in log and "drive of axis X" in alarm["ALARM_TEXT"], "a bus without drives is told", log, alarm)
    t.check(alarm["STATE"].strip() == ALARM, "and it stays in alarm", alarm)
    # Controlwords (20x) may say quick stop, 0002; targets (30x) there are none.
    moving = [frame for frame in sent if frame[1:3] == b"30" or (frame[1:3] == b"20" and frame[5:9] != b"0200")]
    t.check(sent != [] and moving == [], "nothing is told to move", moving[:3])
    t.finish()


main()
