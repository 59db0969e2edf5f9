#!/usr/bin/env python3
"""The controller has an I/O node that is not ours: CiA 401 on python-canopen's LocalNode, beside drives of the same library.

Outputs of the program reach it, its inputs come back and are waited for, and a circuit that opens stops the axes, whether it
tells its inputs in every SYNC or only when they change."""

import json

import packages

packages.require("can", "canopen")

import controller_with_canopen as bench
import node401
from controller_with_canopen import check, expect

NODE = 20
STOP = 1 << 5
WIRING = [f"io.1.node={NODE}", "io.1.outputs=flood spindle - - P0 - - - - P1", "io.1.inputs=- - - - P0 stop - - - P1"]
PROGRAM = """G21 G90 G61 F3000
M8
M64 P0
M66 P0 L3 Q10
G1 X#5399
M64 P1
M66 P1 L3 Q10
G1 Y#5399
M65 P0
M66 P0 L4 Q10
G1 X[2+#5399]
M9
M2
"""


def start(**node):
    """A controller with three drives and the I/O node."""
    run = bench.Bench(*WIRING)
    return run, node401.Io(run.network, NODE, **node)


def test_outputs_and_inputs(takes_sync):
    run, io = start(takes_sync=takes_sync, held=STOP)
    status, message, summary = run.finish()
    expect(f"the program completes (in every SYNC: {takes_sync})", (status, message), (0, ""))
    steps = [level for level in io.levels if level]
    expect("outputs come in their order", steps[:4], [0x011, 0x211, 0x201, 0x200])
    expect("inputs came back in time: X, Y and X again", [drive.targets[-1] for drive in run.drives[:2]], [200000, 100000])
    expect("transmission type", io.get(0x1800, 2), 1 if takes_sync else 255)
    expect("heartbeats", (io.get(0x1017), io.get(0x1016, 1)), (5000, 127 << 16 | 15000))
    return summary["setpoint_digest"]


def test_stop(takes_sync):
    run, io = start(takes_sync=takes_sync, held=STOP)
    io.release_after = 40
    status, message, _ = run.finish()
    expect("an open circuit ends the run", status, 1)
    check("by its bit", f"the stop input, bit 5 of I/O node {NODE}, is open" in message, message)
    expect("no drive is left enabled", [drive.state for drive in run.drives], ["off", "off", "off"])


def main():
    with open("part.ngc", "w", encoding="utf-8") as program:
        program.write(PROGRAM)
    first, second = test_outputs_and_inputs(True), test_outputs_and_inputs(False)
    check("with setpoints", bool(first) and bool(second), json.dumps([first, second]))
    for takes_sync in True, False:
        test_stop(takes_sync)


if __name__ == "__main__":
    main()
