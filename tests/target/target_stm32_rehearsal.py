#!/usr/bin/env python3
"""A program that is part of the STM32F405's image gives the host's setpoints, bit for bit, and its steps."""

import re

import stm32
import takt_test as t

board = stm32.Board(stm32.for_qemu("takt-stm32f405-rehearsal"))
try:
    board.wait_for("steps X")
    log = board.log()
finally:
    board.stop()

t.write("part.ngc", "".join(line[2:] + "\n" for line in log if line.startswith("| ")))
status, out, err = t.run("run", "part.ngc", "--drive-type", "step", "--json", "-", "--quiet")
t.check(status == 0, "the host runs the program", err)
host = t.json.loads(out)
said = re.search(r"completed, setpoints ([0-9a-f]{16}), (\d+) cycles", "\n".join(log))
if t.check(said, "the image completes it", log):
    t.check(said[1] == host["setpoint_digest"], "the setpoints are the host's", said[1], host["setpoint_digest"])
    t.check(int(said[2]) == host["cycles"], "in as many cycles", said[2], host["cycles"])
t.check("the image is sound" in log, "the image finds itself sound", log)
print("\n".join(log[-2:]))
t.finish()
