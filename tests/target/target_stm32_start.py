#!/usr/bin/env python3
"""What is missing or wrong when the STM32F405's image starts is told on log and panel, and nothing moves.

QEMU has neither crystal nor CAN controller there, and a flash that cannot be written: it is such a board.
"""

import stm32
import takt_test as t

IMAGE = stm32.for_qemu("takt-stm32f405-emulated")

ALARM = "8"
INTERNAL = "6"


def start(claim, flash, reason, path=IMAGE):
    """Starts the image; the reason stands on its log and panel, and no order gets through."""
    board = stm32.Board(path, flash, panel=True)
    try:
        board.wait_for("alarm: ")
        log = board.log()
        t.check(any(line.startswith("alarm: ") and reason in line for line in log), f"{claim}: the log says so", log)
        seen = board.panel.read("STATE", "ALARM", "ALARM_TEXT", "CYCLES")
        t.check(seen["STATE"] == ALARM and seen["ALARM"] == INTERNAL, f"{claim}: the panel shows an alarm", seen)
        t.check(reason in seen["ALARM_TEXT"], f"{claim}: with the reason", seen)
        for name in ("RESET", "HOME", "CYCLE_START", "MDI_START"):
            status, _, _ = t.run("panel", "write", name, "1", *board.panel.options)
            t.check(status != 0, f"{claim}: {name} is refused")
        t.check(board.panel.read("CYCLES")["CYCLES"] == "0", f"{claim}: no control cycle is done")
        return log, settings_over_modbus(board)
    finally:
        board.stop()


def settings_over_modbus(board):
    """What takt panel says when settings are brought to this board."""
    status, _, err = t.run("panel", "settings", "mill.settings", "--quiet", *board.panel.options)
    return status, err


def damaged(path):
    """The image with one letter of a message wrong."""
    with open(path, "rb") as file:
        content = file.read()
    at = content.index(b" on STM32F405")
    with open("damaged.elf", "wb") as file:
        file.write(content[:at] + b"_" + content[at + 1:])
    return "damaged.elf"


t.check(t.run("machine", "--pack", "-o", "mill.settings")[0] == 0, "settings are packed")
with open("mill.settings", "rb") as file:
    settings = file.read()
t.check(t.run("machine", "--pack", "--sector", "-o", "mill.sector")[0] == 0, "so is a sector")
with open("mill.sector", "rb") as file:
    t.check(file.read() == stm32.sector(settings), "a sector is what the image expects")

_, (status, err) = start("nothing stored", None, "no settings are stored")
t.check(status == 2 and "the controller says: the memory for settings cannot be erased" in err, "a flash that cannot be erased is told", err)

log, _ = start("no crystal", stm32.sector(settings), "the crystal does not oscillate")
t.check(any("the CAN controller does not answer" in line for line in log), "the missing CAN controller is logged too", log)

wrong = bytearray(settings)
wrong[200] ^= 1
start("a wrong checksum", stm32.sector(bytes(wrong)), "the settings are damaged: their checksum is wrong")
start("other bytes", stm32.sector(b"[machine]\ncycle_us = 1000\n"), "these are no settings of this version")
t.write("rotate.ini", "[machine]\nname = a form for comparison\ninterpolator = rotate\n")
t.check(t.run("machine", "rotate.ini", "--pack", "-o", "rotate.settings")[0] == 0, "a machine with another interpolator is packed")
with open("rotate.settings", "rb") as file:
    start("a form for comparison", stm32.sector(file.read()), "'interpolator' of this machine is for comparison")
torn = stm32.sector(settings)
start("a torn head", torn[:8] + b"\xff\xff\xff\xff" + torn[12:], "no settings are stored")
start("a damaged image", stm32.sector(settings), "the image in the flash memory is damaged", damaged(IMAGE))
t.finish()
