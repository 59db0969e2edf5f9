#!/usr/bin/env python3
"""libmodbus as the operator's panel, on TCP and on a serial line: every register read, exceptions by their numbers."""

import ctypes
import ctypes.util
import os
import sys

sys.path.insert(0, os.path.join(os.environ["TAKT_SOURCE"], "tests", "system"))

import panel_client as p
import serial_pair
import takt_test as t

FOUND = ctypes.util.find_library("modbus")
if FOUND is None:
    t.skip("libmodbus is not installed (Debian and Ubuntu: libmodbus-dev)")
LIBRARY = ctypes.CDLL(FOUND, use_errno=True)
LIBRARY.modbus_new_tcp.restype = LIBRARY.modbus_new_rtu.restype = ctypes.c_void_p
ERROR_BASE = 112345678
UNIT = 5


class Panel:
    def __init__(self, context):
        self.context = ctypes.c_void_p(context)
        LIBRARY.modbus_set_slave(self.context, UNIT)
        LIBRARY.modbus_set_response_timeout(self.context, 10, 0)
        done = LIBRARY.modbus_connect(self.context)
        assert done == 0, "libmodbus connects: " + os.strerror(ctypes.get_errno())

    def close(self):
        LIBRARY.modbus_close(self.context)
        LIBRARY.modbus_free(self.context)

    def read(self, table, address, count):
        """Words, or the exception's number."""
        if table == "coil":
            data = (ctypes.c_uint8 * count)()
            done = LIBRARY.modbus_read_bits(self.context, address, count, data)
        else:
            data = (ctypes.c_uint16 * count)()
            read = LIBRARY.modbus_read_input_registers if table == "input" else LIBRARY.modbus_read_registers
            done = read(self.context, address, count, data)
        return list(data) if done == count else ctypes.get_errno() - ERROR_BASE

    def write(self, address, words):
        data = (ctypes.c_uint16 * len(words))(*words)
        done = LIBRARY.modbus_write_registers(self.context, address, len(words), data)
        return 0 if done == len(words) else ctypes.get_errno() - ERROR_BASE

    def put(self, address, on):
        return 0 if LIBRARY.modbus_write_bit(self.context, address, on) == 1 else ctypes.get_errno() - ERROR_BASE


def wait_until_idle(panel):
    p.until(lambda: panel.read("input", 1, 1) == [p.IDLE], lambda: f"the state stays {panel.read('input', 1, 1)}")


def check(panel):
    for name, row in p.REGISTERS.items():
        words = panel.read(row["table"], int(row["address"]), int(row["registers"]))
        t.check(isinstance(words, list), f"{name} is read", words)
    t.check(panel.read("holding", 0, 10)[:2] == [1000, 1000], "a block is read")
    for name, row in p.REGISTERS.items():
        if row["table"] == "holding" and row["form"] == "16 bits" and name.endswith("OVERRIDE"):
            most = int(row["most_counts"])
            t.check(panel.write(int(row["address"]), [most]) == 0, f"{name} is written")
            t.check(panel.read("holding", int(row["address"]), 1) == [most], f"{name} is read back")
            t.check(panel.write(int(row["address"]), [most + 1]) == 3, f"{name} out of range: 03")
            panel.write(int(row["address"]), [1000])
    t.check(panel.read("input", 1000, 1) == 2 and panel.write(39, [1]) == 2, "what is not there: 02")
    t.check(panel.put(2, 1) == 4, "not in this state: 04")
    t.check(panel.write(300, [0x4730, 0x2058, 0x3700]) == 0 and panel.write(3, [1]) == 0 and panel.put(9, 1) == 0, "an MDI line is started")
    wait_until_idle(panel)
    t.check(panel.read("input", 60, 2) == [0, 7000], "and runs to its end", panel.read("input", 60, 2))
    t.check(panel.write(300, [0x4730, 0x2058, 0x3000]) == 0 and panel.put(9, 1) == 0, "and back")
    wait_until_idle(panel)
    t.check(panel.write(3, [0]) == 0, "the mode is as before")


PAIR = serial_pair.Pair()
SERVICE = p.Service("--listen", "127.0.0.1:0", "--serial", PAIR.paths[0] + ",115200,even", "--unit", str(UNIT))
SERVICE.client().wait_for("STATE", p.IDLE)
for made in (
    LIBRARY.modbus_new_tcp(b"127.0.0.1", SERVICE.port),
    LIBRARY.modbus_new_rtu(PAIR.paths[1].encode(), 115200, ctypes.c_char(b"E"), 8, 1),
):
    libmodbus_panel = Panel(made)
    check(libmodbus_panel)
    libmodbus_panel.close()
SERVICE.stop()
PAIR.close()
t.finish()
