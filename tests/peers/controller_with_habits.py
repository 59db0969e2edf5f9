#!/usr/bin/env python3
"""The controller starts foreign drives that have habits of real ones: CiA 402 drives made of python-canopen's LocalNode
that lack, refuse or do otherwise what takt's own drives do. Each boots and runs, with the setpoints of takt's own drives."""

import packages

packages.require("can", "canopen")

import controller_with_canopen as peer
from node402 import Habits

FIXED = {0x1600: [0x60400010], 0x1601: [0x60400010, 0x60600008], 0x1602: [0x60400010, 0x607A0020],
         0x1A00: [0x60410010], 0x1A01: [0x60410010, 0x60610008], 0x1A02: [0x60410010, 0x60640020]}
SMALL = {0x1600: [0x60400010, 0x607A0020], 0x1A00: [0x60410010, 0x60640020]}
OPTIONAL = (0x1006, 0x1016, 0x605A, 0x60C2)

# What is otherwise, and what must be told as given up.
HABITS = {
    "no dummy mapping": (Habits(dummies=False), {"pair"}),
    "no event timer": (Habits(absent=[(0x1800, 5), (0x1801, 5)]), {"event_timer"}),
    "603F and 60F4 absent": (Habits(absent=[0x603F, 0x60F4]), {"error_pdo"}),
    "603F and 60F4 not mappable": (Habits(not_mappable=[0x603F, 0x60F4]), {"error_pdo"}),
    "1006, 605A and 60C2 read-only": (Habits(read_only=[0x1006, 0x605A, 0x60C2]), {"sync_period"}),
    "1016 out of range": (Habits(limits={0x1016: 0xFFFF}), {"watch"}),
    "1016 refused with a code of its own": (Habits(limits={0x1016: 0xFFFF}, code=0x0800DEAD), {"watch"}),
    "1017 read-only": (Habits(read_only=[0x1017], absent=[0x100C]), {"heartbeat"}),
    "guarded": (Habits(absent=[0x1016, 0x1017]), {"guarded"}),
    "guarded, without a life time": (Habits(read_only=[0x1017], absent=[0x100D]), {"guarded"}),
    "nothing optional": (Habits(absent=OPTIONAL), {"watch", "sync_period", "period"}),
    "6060 not mappable": (Habits(not_mappable=[0x6060]), {"mode_pdo"}),
    "6040 not mappable": (Habits(not_mappable=[0x6040, 0x6060]), {"mode_pdo", "control_pdo"}),
    "one entry a PDO": (Habits(entries=1), {"pair", "mode_pdo", "error_pdo", "one_report"}),
    "a fixed mapping": (Habits(maps=FIXED, pdos=3), {"pair", "mapping", "error_pdo"}),
    "a fixed mapping without a mode": (Habits(maps=SMALL, pdos=1, not_mappable=[0x6060]),
                                       {"pair", "mapping", "mode_pdo", "error_pdo"}),
    "one PDO each way": (Habits(pdos=1), {"pair", "mode_pdo", "error_pdo"}),
    "interpolated position only": (Habits(modes=0x60), {"csp"}),
    "cyclic velocity only": (Habits(modes=0x120), {"position"}),
    "profile velocity only": (Habits(modes=0x24), {"position"}),
    "no modes told": (Habits(absent=[0x6502]), {"modes"}),
    "no mode shown": (Habits(absent=[0x6061]), {"mode_display"}),
    "boots after 1.2 s": (Habits(boots_after=1.2), set()),
    "starts itself, and takes no mapping then": (Habits(starts_itself=True), set()),
    "in fault at power-on, reset by the fourth edge": (Habits(resets=4), set()),
    "a brake that opens 0.3 s after operation enabled": (Habits(brake=300), set()),
    "no bit 12": (Habits(tells_following=False), set()),
    "emergencies with the boot-up": (Habits(emergencies=40), set()),
    "200 ms from each controlword to its state": (Habits(slow=200), set()),
}


def main():
    with open("part.ngc", "w", encoding="utf-8") as program:
        program.write(peer.PROGRAM)
    digest = peer.setpoints_of_embedded_run()
    for name, (habits, given_up) in HABITS.items():
        is_guarded = "guarded" in given_up  # by remote frames, which python-can has on SLCAN
        bench = peer.Bench(habits=habits, **(dict(by_slcan=True, heartbeat_ms=100) if is_guarded else {}))
        status, message, summary = bench.finish()
        missing = {"stop_option"}  # 6007 and 605E, which none of these drives has
        peer.expect(f"{name}: the program completes", (status, message), (0, ""))
        peer.expect(f"{name}: with the setpoints of our own drives", summary["setpoint_digest"], digest)
        found = {lost for drive in summary["drives"] for lost in drive["given_up"]}
        peer.expect(f"{name}: what is given up is told", found - missing, given_up)
        answers = [drive.guarded.answers for drive in bench.drives]
        peer.check(f"{name}: guarded drives are asked, others are not", all((n > 2) == is_guarded for n in answers), answers)
        near = 100 if "position" in given_up else 0  # a micrometre
        peer.check(f"{name}: all end at 0", all(abs(drive.targets[-1]) <= near for drive in bench.drives))


main()
