#!/usr/bin/env python3
"""A broken invariant is a safe stop in the STM32F405's image: it starts anew, moves nothing, and says file and line.

A debugger stands in for the defect: it calls takt_assert_failed where the image happens to be.
"""

import re
import socket
import struct
import subprocess

import stm32
import takt_test as t

IMAGE = stm32.for_qemu("takt-stm32f405-emulated")
FILE = b"firmware/plan/ring.c\0"
LINE = 105
REASON = "the controller had to stop and restart: invariant broken in firmware/plan/ring.c, line 105"


class Debugger:
    """The remote protocol of GDB, as much of it as this takes."""

    def __init__(self, path):
        self.line = socket.socket(socket.AF_UNIX)
        self.line.connect(path)
        self.line.settimeout(60)
        self.said = b""
        self.ask("qXfer:features:read:target.xml:0,fff")  # or QEMU sets no single register

    def receive(self):
        while not (packet := re.search(rb"\$([^#]*)#..", self.said)):
            self.said += self.line.recv(4096)
        self.said = self.said[packet.end():]
        self.line.sendall(b"+")
        return packet[1]

    def ask(self, text):
        """That the processor has stopped may be told unasked, when the debugger has just come."""
        data = text.encode()
        self.line.sendall(b"$%s#%02x" % (data, sum(data) % 256))
        while (answer := self.receive()).startswith(b"T") and text != "?":
            pass
        return answer

    def set_register(self, number, value):
        return self.ask(f"P{number:x}={struct.pack('<I', value).hex()}")


def addresses():
    out = subprocess.run(["arm-none-eabi-nm", IMAGE], capture_output=True, text=True, check=True).stdout
    return {words[-1]: int(words[0], 16) for words in map(str.split, out.splitlines()) if len(words) == 3}


def break_invariant(path):
    at = addresses()
    debugger = Debugger(path)
    name = at["image_stack_low"]  # the stack does not come so far
    said = [debugger.ask("?"), debugger.ask(f"M{name:x},{len(FILE):x}:{FILE.hex()}"), debugger.set_register(0, name),
            debugger.set_register(1, LINE), debugger.set_register(15, at["takt_assert_failed"] & ~1), debugger.ask("D")]
    t.check(said[1:] == [b"OK"] * 5, "the debugger is obeyed", said)


def main():
    board = stm32.Board(IMAGE, panel=True, debugger="debugger.sock")
    try:
        board.wait_for("alarm: ")
        t.check(not any("invariant" in line for line in board.log()), "at first there is none", board.log())
        break_invariant("debugger.sock")
        board.wait_for("invariant broken")
        seen = board.panel.read("STATE", "ALARM", "ALARM_TEXT", "CYCLES")
        t.check(seen["STATE"] == "8" and seen["ALARM"] == "6", "the panel shows an alarm", seen)
        t.check(REASON in seen["ALARM_TEXT"], "with file and line", seen)
        t.check(seen["CYCLES"] == "0", "no control cycle is done", seen)
        status, _, _ = t.run("panel", "write", "CYCLE_START", "1", *board.panel.options)
        t.check(status != 0, "nothing can be started")
        t.check(any(REASON in line for line in board.log()), "the log says it, too", board.log())
    finally:
        board.stop()
    t.finish()


main()
