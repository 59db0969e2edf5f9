#!/usr/bin/env python3
"""The same setpoints, bit for bit, on the host and on a Cortex-M4 and M7 in QEMU: every cycle of every program.

takt run --target compares each control cycle of the image with the host's: state, frames on the bus, the whole record.
Programs are planned on board, and some once more ahead (--plan): then the image replays the compiled file.
With --long, real programs from their first cycle to the last; else their beginning.
"""

import sys

import target
import takt_test as t

BEGINNING_S = "4"
REAL = ("3d_chips.ngc", "arcspiral.ngc", "spiral_lines.ngc")


def bore():
    t.check(t.run("bore", "--hole", "20", "--cutter", "10", "--step", "2", "--feed", "1500", "--depth", "4", "-o", "bore.ngc")[0] == 0,
            "a bore program is written")
    return ("bore.ngc",)


def correction():
    """Tables measured on a worn mill, then a program on that mill, with every layer that it has."""
    mill = t.EXAMPLES + "/worn_mill.ini"
    t.check(t.run("calibrate", "--machine", mill, "--grid", "5x4x3", "-o", "volume.csv")[0] == 0, "the volume is measured")
    return (t.EXAMPLES + "/planes.ngc", "--machine", mill, "--set", "correction.volume_table=volume.csv")


def override():
    t.write("override.txt", "0 100\n0.7 40\n1.3 120\n1.9 0\n2.3 75\n3.1 110\n")
    t.write("rapid.txt", "0 100\n1 30\n2 100\n")
    return (t.EXAMPLES + "/engraving.ngc", "--override", "override.txt", "--rapid-override", "rapid.txt")


def stops():
    """Lines, an arc and a helix as one curve, and what interrupts it: a dwell, a spindle, an exact stop."""
    t.write("stops.ngc", "G21 G90 G17 G64 P0.01 F3000\nS1000 M3\nG1 X5 Y3\nG2 X9 Y7 I0 J4\nG3 X9 Y7 Z-1 I-2 J0\nG4 P0.1\nG61.1 G1 X4 Y9\n"
            "G64 P0.02 X2 Y5\nX0 Y0\nM5\nG0 Z2\nM2\n")
    return ("stops.ngc",)


def compiled(arguments):
    program, *options = arguments
    status, _, err = t.run("compile", program, "-o", "ahead.plan", "--quiet")
    t.check(status == 0, f"{program} is compiled", err)
    return (program, *options, "--plan", "ahead.plan")


def check(name, arguments, *options):
    status, out, err = t.run("run", *arguments, *options, "--json", "-", "--quiet")
    if not t.check(status in (0, 4), f"{name} runs on the host", err):
        return
    host = t.json.loads(out)
    for processor in target.BOARDS:
        there = target.run(processor, *arguments, *options)
        if there is None:
            continue
        cost = there["target"]
        t.check(cost["cycles_differing"] == 0, f"{name} on {processor}: every cycle is the host's", cost)
        t.check(there["setpoint_digest"] == host["setpoint_digest"], f"{name} on {processor}: the digest is the host's")
        t.check(there["outcome"] == host["outcome"] and cost["cycles_counted"] == host["cycles"], f"{name} on {processor} ends alike")
        print(f"{name:20} {processor:4} {there['setpoint_digest']} {host['cycles']:8} cycles, {there['outcome']}; instructions a cycle "
              f"{cost['cycle_instructions'] / cost['cycles_counted']:.0f}, at most {cost['cycle_instructions_max']}; "
              f"a block {cost['background_instructions'] / max(1, cost['blocks_planned']):.0f}")


def main():
    until = () if "--long" in sys.argv else ("--until", BEGINNING_S)
    target.need_qemu()
    for processor in target.BOARDS:
        target.image(processor, "takt-desk")
    check("bore", bore(), *until)
    check("correction", correction(), *until)
    check("override", override(), *until)
    check("involute hole", (t.EXAMPLES + "/involute_hole.ngc",), *until)
    check("stops, ahead", compiled(stops()), *until)
    check("engraving, ahead", compiled(override()), *until)
    check("involutes, ahead", (t.EXAMPLES + "/involute_hole.ngc", "--plan", "ahead"), *until)
    for name in REAL if until == () else ():
        check(name, (t.real_programs(name)[0],))
    t.finish()


main()
