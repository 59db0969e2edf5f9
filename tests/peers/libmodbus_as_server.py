#!/usr/bin/env python3
"""Why takt's server is not libmodbus's (host/serve/README.md): how long a good client of each waits beside a bad one.

One request of a good client is timed while a bad one has sent half a request, and after one with a quantity of 0,
several times: the good one may come first, or wait for others on this machine."""

import atexit
import os
import socket
import statistics
import struct
import subprocess
import sys
import time

sys.path.insert(0, os.path.join(os.environ["TAKT_SOURCE"], "tests", "system"))

import panel_client as p
import takt_test as t


TRIES = 5


def timed(port, bad):
    """Seconds a good client waits, beside a client who has sent these bytes."""
    stranger = socket.create_connection(("127.0.0.1", port))
    client = p.Client(port)
    client.read_words(4, 0, 1)
    stranger.sendall(bad)
    began = time.monotonic()
    client.read_words(4, 0, 1)
    taken = time.monotonic() - began
    client.close()
    stranger.close()
    return taken


HALF = struct.pack(">HHHBBH", 1, 0, 6, 1, 3, 0)
NOTHING = struct.pack(">HHHBBHH", 1, 0, 6, 1, 3, 0, 0)

server = subprocess.Popen([sys.argv[1]], stdout=subprocess.PIPE, text=True)
atexit.register(server.kill)
theirs = int(server.stdout.readline())
service = p.serve()
for what, bad in (("half a request", HALF), ("a quantity of 0", NOTHING)):
    others = max(timed(theirs, bad) for _ in range(TRIES))
    ours = statistics.median(timed(service.port, bad) for _ in range(TRIES))
    print(f"beside {what}: libmodbus {1000 * others:.1f} ms, takt {1000 * ours:.1f} ms")
    t.check(others > 0.3, f"libmodbus makes others wait beside {what}: if not, think again about using it", others)
    t.check(ours < others / 2, f"takt does not make others wait beside {what}", ours)
service.stop()
t.finish()
