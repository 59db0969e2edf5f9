"""What strangers send to the panel: nothing of it stops the server, and nothing is written."""

import random
import socket
import struct

import panel_client as p
import takt_test as t

CONNECTS = 10000
SETTINGS = "FEED_OVERRIDE", "RAPID_OVERRIDE", "SPINDLE_OVERRIDE", "MODE", "JOG_FEED", "STATE", "PROGRAM_SIZE", "UPLOAD_STATE"


def settings(client):
    return [client.counts(name) for name in SETTINGS]


def is_closed(connection):
    """True: the server has closed it, and sent nothing before."""
    connection.settimeout(p.PATIENCE_S)
    try:
        return connection.recv(1024) == b""
    except ConnectionResetError:
        return True


def exchange(port, data, size=1024):
    connection = socket.create_connection(("127.0.0.1", port), timeout=p.PATIENCE_S)
    connection.sendall(data)
    reply = connection.recv(size)
    connection.close()
    return reply


def frame(pdu, transaction=1, protocol=0, length=None):
    return struct.pack(">HHHB", transaction, protocol, len(pdu) + 1 if length is None else length, 1) + pdu


service = p.serve()
watcher = service.client()
watcher.wait_for("STATE", p.IDLE)
before = settings(watcher)

# Headers that make no sense end the connection.
for name, data in (
    ("protocol", frame(b"\x03\0\0\0\1", protocol=1)),
    ("length 0", frame(b"\x03\0\0\0\1", length=0)),
    ("length 1", frame(b"\x03\0\0\0\1", length=1)),
    ("length 255", frame(b"\x03\0\0\0\1", length=255)),
    ("length 65535", frame(b"\x03\0\0\0\1", length=65535)),
    ("web browser", b"GET / HTTP/1.1\r\nHost: x\r\n\r\n"),
):
    connection = socket.create_connection(("127.0.0.1", service.port))
    connection.sendall(data)
    t.check(is_closed(connection), f"a header without sense ends the connection: {name}")
    connection.close()

# Lengths and quantities that do not fit are exceptions, and the stream stays in step.
for name, pdu in (
    ("read 0", b"\x03\0\0\0\0"),
    ("read 65535", b"\x03\0\0\xff\xff"),
    ("read coils 65535", b"\x01\0\0\xff\xff"),
    ("write 0", b"\x10\0\0\0\0\0"),
    ("write 65535", b"\x10\0\0\xff\xff\xfe" + b"\0" * 200),
    ("write too few bytes", b"\x10\0\0\0\2\4\0\1"),
    ("write coils 0", b"\x0f\0\0\0\0\0"),
    ("exchange 65535", b"\x17\0\0\xff\xff\0\0\xff\xff\xff\0\1"),
    ("too long", b"\x06\0\0\1\xf4\0\0\0"),
    ("too short", b"\x06\0\0\1"),
    ("coil 7", b"\x05\0\7\0\7"),
):
    reply = exchange(service.port, frame(pdu) + frame(b"\x04\0\0\0\1", transaction=2))
    if len(reply) == 9:
        reply += exchange(service.port, frame(b"\x04\0\0\0\1", transaction=2))
    t.check(reply[7:9] == bytes([pdu[0] | 0x80, 3]), f"{name}: exception 03", reply)
    t.check(reply[9:] == b"\0\2\0\0\0\5\1\4\2\0\1", f"{name}: the next request is answered", reply)
t.check(settings(watcher) == before, "nothing is written", settings(watcher))

# Headers cut off, requests that come a byte at a time and never end: the others are served meanwhile.
slow = []
for i in range(100):
    connection = socket.create_connection(("127.0.0.1", service.port))
    connection.sendall(frame(b"\x10\0\0\0\1\2\0\1")[: 1 + i % 14])
    slow.append(connection)
for _ in range(20):
    t.check(watcher.counts("STATE") == p.IDLE, "a client is served beside a hundred who never finish")
for connection in slow:
    connection.close()

# More clients than there are places: who has been silent for longest goes, the newest is served.
crowd = [service.client() for _ in range(300)]
t.check(crowd[-1].counts("STATE") == p.IDLE and crowd[-2].counts("VERSION") == 1, "the newest of many is served")
for client in crowd:
    client.close()
watcher.close()

for _ in range(CONNECTS):
    socket.create_connection(("127.0.0.1", service.port)).close()
watcher = service.client()
t.check(watcher.counts("STATE") == p.IDLE, f"after {CONNECTS} connects the server serves")

# Any bytes at all, from a fixed seed: as a stream, and as requests of functions that write nothing.
chance = random.Random(1)
for _ in range(300):
    connection = socket.create_connection(("127.0.0.1", service.port))
    connection.sendall(chance.randbytes(chance.randrange(1, 400)))
    connection.close()
for _ in range(300):
    pdu = bytes([chance.choice((1, 2, 3, 4, 7, 8, 11, 17, 20, 22, 24, 43, 100, 255))]) + chance.randbytes(chance.randrange(0, 20))
    exchange(service.port, frame(pdu))
t.check(settings(watcher) == before, "and nothing has been written", settings(watcher), before)

# A password that is needed stops every write of every function.
status, out, err, _ = service.stop()
t.check(status == 0 and err == "", "the server has lived through it", status, err)
service = p.serve("--set", "panel.password=99")
watcher = service.client()
watcher.wait_for("STATE", p.IDLE)
for _ in range(500):
    pdu = bytes([chance.choice((5, 6, 15, 16, 23))]) + chance.randbytes(chance.randrange(0, 30))
    exchange(service.port, frame(pdu))
t.check(settings(watcher) == before, "without the password nothing is written", settings(watcher))
service.stop()
t.finish()
