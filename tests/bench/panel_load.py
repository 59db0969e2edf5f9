#!/usr/bin/env python3
"""What 50 clients who poll as fast as they can do to a program that runs in real time: panel_load.py PANEL_CLIENTS [S].

A program of about a minute runs twice on takt serve, alone and beside the clients. The setpoints must be those of
takt run; the replies' times and the lateness of control cycles are printed."""

import os
import subprocess
import sys

sys.path.insert(0, os.path.join(os.environ["TAKT_SOURCE"], "tests", "system"))

import panel_client as p
import takt_test as t

CLIENTS = 50
SECONDS = int(sys.argv[2]) if len(sys.argv) > 2 else 60
MOVES = [f"G1 X{10 * (i % 2)} Y{i % 7}" for i in range(2 * SECONDS + SECONDS // 3)]
NAMES = [name for name, row in p.REGISTERS.items() if row["table"] == "holding" and row["form"] not in ("text", "bytes")]

t.write("part.ngc", "G21 G90 G61 F1500\n" + "\n".join(MOVES) + "\nM2\n")
digest = t.json.loads(t.run("run", "part.ngc", "--json", "-", "--quiet")[1])["setpoint_digest"]
for count in (0, CLIENTS):
    service = p.serve("--program", "part.ngc")
    client = service.client()
    client.wait_for("STATE", p.IDLE)
    before = [client.counts(name) for name in NAMES]
    client.put("CYCLE_START", 1)
    print(f"--- {count} clients", flush=True)
    if count:
        print(subprocess.run([sys.argv[1], str(service.port), str(count), str(SECONDS)], capture_output=True, text=True, check=True).stdout, end="")
    while client.counts("RUNS") == 0:
        subprocess.run(["sleep", "1"], check=True)
    t.check(client.counts("OUTCOME") == p.COMPLETED and client.digest() == digest, "the setpoints are those of takt run")
    t.check([client.counts(name) for name in NAMES] == before, "nothing has been written")
    print(service.stop()[1], end="", flush=True)
t.finish()
