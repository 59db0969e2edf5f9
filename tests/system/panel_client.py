"""What tests of the panel share: a Modbus client made of the standard library, registers by name, a running service."""

import atexit
import csv
import os
import pty
import select
import socket
import struct
import subprocess
import time
import zlib

import takt_test as t

# So long something that has to happen may take; no test waits that long unless it fails.
PATIENCE_S = 60

# Between two looks at a register; no result depends on it.
PAUSE_S = 0.002

FUNCTIONS = {"coil": 1, "input": 4, "holding": 3}


def until(condition, told):
    """Looks again and again until the condition is true; told() says what is seen instead."""
    end = time.monotonic() + PATIENCE_S
    while not condition():
        assert time.monotonic() < end, told()
        time.sleep(PAUSE_S)


class Refused(Exception):
    """An exception, by its code."""

    def __init__(self, code):
        super().__init__(f"exception {code}")
        self.code = code


def crc16(data):
    crc = 0xFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ 0xA001 if crc & 1 else crc >> 1
    return crc


def read_table():
    """The registers as their documentation has them, by name."""
    with open(os.path.join(t.SOURCE, "firmware", "panel", "registers.csv"), newline="") as file:
        return {row["name"]: row for row in csv.DictReader(file)}


REGISTERS = read_table()


class Client:
    """One connection on Modbus TCP."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=PATIENCE_S)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.transaction = 0

    def close(self):
        self.socket.close()

    def receive(self, size):
        data = b""
        while len(data) < size:
            part = self.socket.recv(size - len(data))
            if not part:
                raise ConnectionError("the server has closed the connection")
            data += part
        return data

    def ask(self, *pdus):
        """Requests as they are, in one packet; returns the last reply's PDU. Raises Refused."""
        numbers = [(self.transaction + i) % 65536 for i in range(1, len(pdus) + 1)]
        self.transaction = numbers[-1]
        self.socket.sendall(b"".join(struct.pack(">HHHB", n, 0, len(pdu) + 1, 1) + pdu for n, pdu in zip(numbers, pdus)))
        return [self.take_reply(number, pdu) for number, pdu in zip(numbers, pdus)][-1]

    def take_reply(self, number, pdu):
        transaction, protocol, length, unit = struct.unpack(">HHHB", self.receive(7))
        reply = self.receive(length - 1)
        assert (transaction, protocol, unit) == (number, 0, 1), "the reply's header is that of the request"
        return checked(pdu, reply)

    def read_words(self, function, address, count):
        reply = self.ask(struct.pack(">BHH", function, address, count))
        if function in (1, 2):
            return [reply[2 + i // 8] >> i % 8 & 1 for i in range(count)]
        return list(struct.unpack(f">{count}H", reply[2:]))

    def write_words(self, address, words):
        self.ask(struct.pack(f">BHHB{len(words)}H", 16, address, len(words), 2 * len(words), *words))

    def counts(self, name):
        """A register's number, in counts."""
        row = REGISTERS[name]
        words = self.read_words(FUNCTIONS[row["table"]], int(row["address"]), int(row["registers"]))
        if len(words) == 1:
            return words[0]
        value = words[0] << 16 | words[1]
        return value - (1 << 32) if row["form"] == "32 bits signed" and value >> 31 else value

    def get(self, name):
        """A register's value, in its unit."""
        return self.counts(name) * float(REGISTERS[name]["scale"])

    def text(self, name):
        row = REGISTERS[name]
        words = self.read_words(FUNCTIONS[row["table"]], int(row["address"]), int(row["registers"]))
        return struct.pack(f">{len(words)}H", *words).split(b"\0")[0].decode()

    def put(self, name, value):
        """Writes a value in the register's unit. Raises Refused."""
        row = REGISTERS[name]
        counts = round(value / float(row["scale"]))
        address = int(row["address"])
        if row["table"] == "coil":
            self.ask(struct.pack(">BHH", 5, address, 0xFF00 if counts else 0))
        elif row["registers"] == "1":
            self.ask(struct.pack(">BHH", 6, address, counts))
        else:
            self.write_words(address, [counts >> 16 & 0xFFFF, counts & 0xFFFF])

    def put_text(self, name, text):
        row = REGISTERS[name]
        size = 2 * int(row["registers"])
        self.write_words(int(row["address"]), struct.unpack(f">{size // 2}H", text.encode().ljust(size, b"\0")))

    def refusal(self, name, value):
        """The exception code that a write gets, 0: none, and what REFUSAL says of it."""
        try:
            self.put(name, value)
        except Refused as refused:
            return refused.code, self.counts("REFUSAL")
        return 0, 0

    def wait_for(self, name, *values):
        """Until a register has one of these values, in counts."""
        until(
            lambda: self.counts(name) in values,
            lambda: f"{name} stays {self.counts(name)}, {values} expected, state {self.counts('STATE')}",
        )

    def wait_while(self, name, value):
        until(lambda: self.counts(name) != value, lambda: f"{name} stays {value}")

    def wait_above(self, name, least):
        """Until a register's value, in its unit, is at least this."""
        until(lambda: self.get(name) >= least, lambda: f"{name} stays {self.get(name)} below {least}")

    def send_chunk(self, offset, data):
        words = struct.pack(">IHH", offset, len(data), crc16(data)) + data.ljust(238, b"\0")
        self.write_words(100, struct.unpack(">123H", words))

    def begin_upload(self, program):
        self.write_words(50, struct.unpack(">5H", struct.pack(">IIH", len(program), zlib.crc32(program), 1)))

    def upload(self, program):
        self.begin_upload(program)
        while (received := self.counts("UPLOAD_RECEIVED")) < len(program):
            self.send_chunk(received, program[received : received + 238])
        self.put("UPLOAD_COMMAND", 2)

    def digest(self):
        high, low = self.counts("DIGEST_HIGH"), self.counts("DIGEST_LOW")
        return f"{high << 32 | low:016x}"

    def reset(self):
        """RESET, which is refused while drives brake, until all is enabled and at rest."""
        until(lambda: self.refusal("RESET", 1)[0] == 0, lambda: "RESET stays refused")
        self.wait_for("STATE", IDLE)

    def run(self, program):
        """Uploads, starts, and follows to the end; returns how it ended."""
        self.upload(program)
        runs = self.counts("RUNS")
        self.put("CYCLE_START", 1)
        self.wait_while("RUNS", runs)
        return self.counts("OUTCOME")

    def run_line(self, text):
        """By hand (MODE 1): how it ends."""
        runs = self.counts("RUNS")
        self.put("MODE", 1)
        self.put_text("MDI_TEXT", text)
        self.put("MDI_START", 1)
        self.wait_while("RUNS", runs)
        return self.counts("OUTCOME")


def checked(request, reply):
    if reply[0] == request[0] | 0x80:
        raise Refused(reply[1])
    assert reply[0] == request[0], "the reply's function is that of the request"
    return reply


class Line:
    """One end of a serial line whose other end is the service's, and a client on it."""

    def __init__(self):
        self.near, far = pty.openpty()
        self.path = os.ttyname(far)
        self.far = far

    def close(self):
        os.close(self.near)
        os.close(self.far)

    def send(self, frame):
        os.write(self.near, frame)

    def receive(self, size):
        """So many bytes; fewer when nothing has come for long."""
        data = b""
        while len(data) < size and select.select([self.near], [], [], PATIENCE_S)[0]:
            data += os.read(self.near, size - len(data))
        return data

    def is_silent(self):
        return not select.select([self.near], [], [], 0.2)[0]

    def ask(self, pdu, size, unit=1):
        frame = bytes([unit]) + pdu
        self.send(frame + struct.pack("<H", crc16(frame)))
        reply = self.receive(size + 3)
        assert len(reply) >= 5 and reply[0] == unit, f"a reply is expected, not {reply!r}"
        assert struct.unpack("<H", reply[-2:])[0] == crc16(reply[:-2]), "the reply's checksum is right"
        return checked(pdu, reply[1:-2])


class Service:
    """A running takt serve, or takt drives."""

    def __init__(self, *options, command="serve"):
        self.process = subprocess.Popen(
            [t.TAKT, command, *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        atexit.register(self.process.kill)
        self.ready = self.process.stdout.readline()
        assert self.ready, self.process.communicate()[1]
        self.port = int(self.ready.rsplit(":", 1)[1].strip("/\n")) if ":" in self.ready else None

    def client(self):
        return Client(self.port)

    def stop(self):
        """SIGTERM; returns status, the rest of stdout, stderr, and how long it took."""
        began = time.monotonic()
        self.process.terminate()
        out, err = self.process.communicate(timeout=PATIENCE_S)
        return self.process.returncode, out, err, time.monotonic() - began


def serve(*options):
    """Without state and page, unless the options name them: tests do not see what others have left."""
    state = [] if "--state" in options else ["--state", "none"]
    page = [] if "--http" in options else ["--http", "off"]
    return Service("--listen", "127.0.0.1:0", *state, *page, *options)


STARTING, IDLE, RUNNING, MDI, JOGGING, HOMING, HELD, STOPPING, ALARM, EMERGENCY = range(10)
COMPLETED, ABORTED, FAILED = 1, 2, 3
