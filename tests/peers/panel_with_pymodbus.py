#!/usr/bin/env python3
"""pymodbus as the operator's panel, on TCP and on a serial line: every register read and written, every exception
provoked; a program uploaded, started, followed to its end."""

import os
import struct
import sys
import time
import zlib

import packages

packages.require("pymodbus", "serial")

sys.path.insert(0, os.path.join(os.environ["TAKT_SOURCE"], "tests", "system"))

import panel_client as p
import serial_pair
import takt_test as t
from pymodbus import FramerType
from pymodbus.client import ModbusSerialClient, ModbusTcpClient

UNIT = 9
PROGRAM = b"G21 G90 G61 F600\nG1 X3 Y2\nG2 X5 Y0 I0 J-2\nG1 X0\nM2\n" + b"(" + b"-" * 400 + b")\n"
WAITING = ("UPLOAD_COMMAND", "UPLOAD_CHECK", "PASSWORD", "JOG_AXIS", "WATCHDOG", "TOOL_DIAMETER")
TURNS = 30
NEED_TOOL = ("TOOL_OFFSET", "TOOL_WEAR")  # of a tool that is there


class Panel:
    """Registers by name, through a client of pymodbus."""

    def __init__(self, client):
        self.client = client
        assert client.connect(), "pymodbus connects"
        self.exception = 0

    def keep(self, reply):
        self.exception = reply.exception_code if reply.isError() else 0
        return None if self.exception else reply

    def words(self, name):
        row = p.REGISTERS[name]
        address, count = int(row["address"]), int(row["registers"])
        if row["table"] == "coil":
            reply = self.keep(self.client.read_coils(address, count=count, device_id=UNIT))
            return reply and [int(bit) for bit in reply.bits[:count]]
        read = self.client.read_input_registers if row["table"] == "input" else self.client.read_holding_registers
        reply = self.keep(read(address, count=count, device_id=UNIT))
        return reply and reply.registers

    def counts(self, name):
        words = self.words(name)
        if len(words) == 1:
            return words[0]
        value = words[0] << 16 | words[1]
        return value - (1 << 32) if p.REGISTERS[name]["form"] == "32 bits signed" and value >> 31 else value

    def put(self, name, counts):
        """The exception code; 0: done."""
        row = p.REGISTERS[name]
        address = int(row["address"])
        if row["table"] == "coil":
            self.keep(self.client.write_coil(address, bool(counts), device_id=UNIT))
        elif row["registers"] == "1":
            self.keep(self.client.write_register(address, counts, device_id=UNIT))
        else:
            words = [counts >> 16 & 0xFFFF, counts & 0xFFFF]
            self.keep(self.client.write_registers(address, words, device_id=UNIT))
        return self.exception

    def write_block(self, address, data):
        words = list(struct.unpack(f">{len(data) // 2}H", data))
        self.keep(self.client.write_registers(address, words, device_id=UNIT))
        return self.exception

    def wait_for(self, name, value):
        until = time.monotonic() + p.PATIENCE_S
        while self.counts(name) != value:
            if time.monotonic() > until:
                return False
        return True


def check_registers(panel):
    """Every register is read, and every number that starts nothing is written, at both ends of its range."""
    for name, row in p.REGISTERS.items():
        words = panel.words(name)
        t.check(words is not None and len(words) == int(row["registers"]), f"{name} is read", panel.exception)
        if row["table"] != "holding" or row["form"] in ("text", "bytes") or name in WAITING or name.startswith(NEED_TOOL):
            continue
        before = panel.counts(name)
        for counts in (int(row["least_counts"]), int(row["most_counts"])):
            t.check(panel.put(name, counts) == 0 and panel.counts(name) == counts, f"{name} takes {counts}", panel.exception)
        panel.put(name, max(before, int(row["least_counts"])))
    for name in p.REGISTERS:
        if name.startswith("CORRECTION") or name in ("SINGLE_BLOCK", "OPTIONAL_STOP", "BLOCK_DELETE"):
            t.check(panel.put(name, 1) == 0 and panel.counts(name) == 1 and panel.put(name, 0) == 0, f"{name} is written")
    t.check(panel.write_block(300, b"G0 X1\0") == 0 and bytes.fromhex("%04x" % panel.words("MDI_TEXT")[0]) == b"G0", "texts are written")
    for name, counts in (("FEED_HOLD", 1), ("ACKNOWLEDGE", 1), ("RESET", 1)):
        t.check(panel.put(name, counts) == 0, f"{name} is pushed", panel.exception)


def check_exceptions(panel):
    client = panel.client
    panel.keep(client.read_exception_status(device_id=UNIT))
    t.check(panel.exception == 1, "a function that is not there: 01", panel.exception)
    panel.keep(client.read_holding_registers(1000, count=1, device_id=UNIT))
    t.check(panel.exception == 2, "a register that is not there: 02", panel.exception)
    t.check(panel.put("FEED_OVERRIDE", 1201) == 3, "a value out of range: 03", panel.exception)
    t.check(panel.put("RESUME", 1) == 4, "not in this state: 04", panel.exception)
    other = p.Client(SERVICE.port)
    other.put("WATCHDOG", 60000)
    t.check(panel.put("FEED_OVERRIDE", 500) == 6, "another panel in control: 06", panel.exception)
    other.put("WATCHDOG", 0)
    t.check(panel.put("FEED_OVERRIDE", 1000) == 0, "and again when it is not", panel.exception)
    reply = client.readwrite_registers(read_address=0, read_count=2, write_address=1, values=[250], device_id=UNIT)
    t.check(not reply.isError() and reply.registers == [1000, 250], "function 23 writes and reads", reply)
    t.check(panel.put("RAPID_OVERRIDE", 1000) == 0, "as before")


def check_program(panel, digest):
    panel.write_block(50, struct.pack(">IIH", len(PROGRAM), zlib.crc32(PROGRAM), 1))
    while (received := panel.counts("UPLOAD_RECEIVED")) < len(PROGRAM):
        chunk = PROGRAM[received : received + 200]
        words = struct.pack(">IHH", received, len(chunk), p.crc16(chunk)) + chunk + b"\0" * (len(chunk) % 2)
        t.check(panel.write_block(100, words) == 0, "a chunk is taken", panel.exception)
    t.check(panel.put("UPLOAD_COMMAND", 2) == 0 and panel.counts("PROGRAM_SIZE") == len(PROGRAM), "the program is taken", panel.exception)
    t.check(any(follow(panel, digest) > 4000 for _ in range(TURNS)), "its way is seen")


def follow(panel, digest):
    """The program, from X0 to X0: the largest X that is seen on the way, um. A busy computer may see little of it."""
    runs = panel.counts("RUNS")
    t.check(panel.put("CYCLE_START", 1) == 0, "it starts", panel.exception)
    places = [0]
    while panel.counts("RUNS") == runs:
        places.append(panel.counts("POSITION_X"))
    t.check(panel.counts("OUTCOME") == 1 and panel.counts("POSITION_X") == 0, "it runs to its end")
    t.check(panel.counts("DIGEST_HIGH") << 32 | panel.counts("DIGEST_LOW") == int(digest, 16), "its setpoints are those of takt run")
    return max(places)


def check_operator(panel):
    """Overridden, held, resumed, and given up."""
    program = b"G21 G90 F3000\nG1 X100\nG1 X0\nM2\n"
    panel.write_block(50, struct.pack(">IIH", len(program), zlib.crc32(program), 1))
    words = struct.pack(">IHH", 0, len(program), p.crc16(program)) + program + b"\0" * (len(program) % 2)
    t.check(panel.write_block(100, words) == 0 and panel.put("UPLOAD_COMMAND", 2) == 0, "another program", panel.exception)
    runs = panel.counts("RUNS")
    t.check(panel.put("CYCLE_START", 1) == 0 and panel.put("FEED_OVERRIDE", 500) == 0, "started and overridden")
    t.check(panel.wait_for("FEED", 15000), "the feed comes to half", panel.counts("FEED"))
    t.check(panel.put("FEED_HOLD", 1) == 0 and panel.counts("STATE") == p.HELD and panel.wait_for("FEED", 0), "held")
    held = panel.counts("POSITION_X")
    t.check(0 < held < 100000 and panel.counts("POSITION_X") == held, "at rest on the way", held)
    t.check(panel.put("RESUME", 1) == 0 and panel.wait_for("FEED", 15000), "resumed")
    t.check(panel.put("FEED_OVERRIDE", 1000) == 0 and panel.put("RESET", 1) == 0, "given up")
    t.check(panel.wait_for("STATE", p.IDLE) and panel.counts("OUTCOME") == p.ABORTED and panel.counts("RUNS") == runs + 1, "aborted")
    panel.put("MODE", 1)
    panel.write_block(300, b"G0 X0 Y0" + b"\0\0")
    panel.put("MDI_START", 1)
    t.check(panel.wait_for("STATE", p.IDLE) and panel.counts("POSITION_X") == 0 and panel.put("MODE", 0) == 0, "and back to zero")


t.write("part.ngc", PROGRAM)
DIGEST = t.json.loads(t.run("run", "part.ngc", "--json", "-", "--quiet")[1])["setpoint_digest"]
PAIR = serial_pair.Pair()
SERVICE = p.Service("--listen", "127.0.0.1:0", "--serial", PAIR.paths[0] + ",115200,none", "--unit", str(UNIT))
for made in (
    ModbusTcpClient("127.0.0.1", port=SERVICE.port, timeout=10),
    ModbusSerialClient(PAIR.paths[1], framer=FramerType.RTU, baudrate=115200, parity="N", stopbits=2, timeout=10),
):
    pymodbus_panel = Panel(made)
    t.check(pymodbus_panel.wait_for("STATE", p.IDLE), "the service is ready")
    check_registers(pymodbus_panel)
    check_exceptions(pymodbus_panel)
    check_program(pymodbus_panel, DIGEST)
    check_operator(pymodbus_panel)
    made.close()
SERVICE.stop()
PAIR.close()
t.finish()
