#!/usr/bin/env python3
"""A program of very many short blocks, planned ahead and run: time, memory and bytes.

    TAKT=build/host/host/takt/takt tests/bench/many_blocks.py [BLOCKS]

BLOCKS: 1,000,000 without it, which takes some minutes. All blocks are one path within G64 P0.01, from rest to rest, so
that the whole of it is optimised at once: lines of 0.05 to 0.1 mm that turn gently, with a right angle now and then.
"""

import math
import os
import random
import subprocess
import sys
import tempfile
import time

# The path stays within such a circle, and turns from one curvature to the next after so many blocks.
RADIUS_MM = 60
EVEN_BLOCKS, CORNER_BLOCKS = 200, 1500
BLOCKS = 1000000


def lines(count):
    rng = random.Random(7)
    x = y = heading = turn = 0.0
    for i in range(count):
        if i % EVEN_BLOCKS == 0:
            turn = rng.uniform(-0.03, 0.03)
        if i % CORNER_BLOCKS == CORNER_BLOCKS - 1:
            heading += rng.choice((-1, 1)) * math.pi / 2
        heading += turn
        if math.hypot(x, y) > RADIUS_MM:
            heading = math.atan2(-y, -x) + rng.uniform(-0.5, 0.5)
        length = rng.uniform(0.05, 0.1)
        x += length * math.cos(heading)
        y += length * math.sin(heading)
        yield f"G1 X{x:.4f} Y{y:.4f} Z{2 * math.sin(1e-3 * i):.4f}\n"


def write(path, count):
    with open(path, "w", encoding="utf-8") as file:
        file.write("G21 G90 G94 G17 G64 P0.01 F3000\n")
        file.writelines(lines(count))
        file.write("M2\n")


def measure(*arguments):
    """Seconds of the clock and of processors, and the most KiB of memory, of one run of takt, which has to succeed."""
    began = time.monotonic()
    process = subprocess.Popen([os.environ["TAKT"], *arguments])
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"takt {arguments[0]} ended with status {process.returncode}")
    return time.monotonic() - began, usage.ru_utime + usage.ru_stime, usage.ru_maxrss


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else BLOCKS
    with tempfile.TemporaryDirectory() as folder:
        program, plan = os.path.join(folder, "many.ngc"), os.path.join(folder, "many.plan")
        write(program, count)
        print(f"{count} blocks, {1e-6 * os.path.getsize(program):.1f} MB of text")
        for what in (("compile", program, "-o", plan), ("run", program, "--plan", plan)):
            wall_s, cpu_s, kib = measure(*what)
            print(f"{what[0]:8} {wall_s:8.1f} s, {cpu_s:8.1f} s of processor time, {kib / 1024:8.1f} MiB at most")
        print(f"the compiled program has {1e-6 * os.path.getsize(plan):.2f} MB")


if __name__ == "__main__":
    main()
