#!/usr/bin/env python3
"""controller_with_sheets.py [NUMBER FIRST | EDS...]: any data sheet as a foreign drive.

A sheet becomes a CiA 402 drive made of python-canopen's LocalNode (node402.py): objects, access, limits, dummies and PDOs are
those of the sheet. The controller starts it: each habit of tests/system/data_sheets.py by itself (without arguments every fourth),
and random combinations, or the sheets that are given. It runs with the setpoints of takt's own drives, or is refused by one message with object and remedy."""

import os
import random
import subprocess
import sys

import packages

packages.require("can", "canopen")

sys.path.insert(0, os.path.join(os.environ["TAKT_SOURCE"], "tests", "system"))

import controller_with_canopen as peer
import data_sheets
from node402 import Habits

NUMBER, FIRST = (int(word) for word in sys.argv[1:3]) if sys.argv[1:2] and sys.argv[1].isdigit() else (3, 1)
SHEETS = [] if sys.argv[1:2] and sys.argv[1].isdigit() else sys.argv[1:]
REMEDIES = ("cycle_us", "maker's tool", "_timeout_ms", "set-up", "drive_node")


def try_sheet(name, path, digest, given_up=None, slcan=False):
    """What is given up, where that is known; guarding needs remote frames, which python-can has on SLCAN."""
    bench = peer.Bench(habits=Habits(sheet=path), **(dict(by_slcan=True, heartbeat_ms=200) if slcan else {}))
    status, message, summary = bench.finish()
    if status != 0:
        peer.check(f"{name}: the refusal names object and remedy", given_up is None and any(word in message for word in REMEDIES), message)
        return
    peer.expect(f"{name}: the setpoints are those of our own drives", summary["setpoint_digest"], digest)
    found = {lost for drive in summary["drives"] for lost in drive["given_up"]}
    peer.check(f"{name}: what is given up is told", given_up is None or found == given_up, found, given_up)
    peer.check(f"{name}: all end at 0", all(abs(drive.targets[-1]) <= 100 for drive in bench.drives))


def main():
    with open("part.ngc", "w", encoding="utf-8") as program:
        program.write(peer.PROGRAM)
    digest = peer.setpoints_of_embedded_run()
    for path in SHEETS:
        try_sheet(os.path.basename(path), path, digest)
    if SHEETS:
        return
    subprocess.run([peer.TAKT, "drives", "--nodes", "1", "--eds", "own.eds"], check=True, stdout=subprocess.DEVNULL)
    for name, (habit, given_up) in list(data_sheets.HABITS.items())[:: 1 if sys.argv[1:] else 4]:
        sheet = data_sheets.read("own.eds")
        habit(sheet, random.Random(1))
        try_sheet(name, data_sheets.write("drive.eds", sheet), digest, given_up, "guarded" in given_up)
    for seed in range(FIRST, FIRST + NUMBER):
        sheet = data_sheets.read("own.eds")
        names = data_sheets.draw_habits(sheet, seed)
        try_sheet(f"seed {seed}, {names}", data_sheets.write("drive.eds", sheet), digest, slcan=True)


main()
