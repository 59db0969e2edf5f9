#!/usr/bin/env python3
"""An image that is stopped anywhere while it stores settings has the old or the new ones when it starts again.

With a number, so many stops: target_storage_stops.py 200
"""

import random
import shutil
import subprocess
import sys

import target
import takt_test as t

STOPS = int(sys.argv[1]) if len(sys.argv) > 1 else 24
FLASH_BYTES = 2 * 16384
DONE, STOPPED = 0, 3

# The longest that the clock can wait, in its ticks.
TICKS_MAX = (1 << 24) - 1


def start(*words):
    """The image from power-on to its end; its exit status, and the settings that it has found."""
    words = ("storage", "flash.bin", "found.bin", *(str(word) for word in words))
    done = subprocess.run(
        [target.QEMU, "-M", target.BOARDS["m4f"], "-kernel", target.image("m4f", "takt-storage"), "-display", "none", "-monitor", "none",
         "-serial", "null", "-icount", "shift=0,sleep=off", "-semihosting-config",
         ",".join(["enable=on", "target=native", *("arg=" + word for word in words)])],
        stdin=subprocess.DEVNULL, check=False)
    with open("found.bin", "rb") as file:
        return done.returncode, file.read()


def pack(name, resolution):
    t.write("mill.ini", f"[machine]\nresolution_per_mm = {resolution}\n")
    status, _, err = t.run("machine", "mill.ini", "--pack", "-o", name)
    t.check(status == 0, f"{name} is packed", err)
    with open(name, "rb") as file:
        return file.read()


def is_done(name, ticks):
    """Is the image done with storing when it is stopped after so many ticks?"""
    shutil.copyfile("before.bin", "flash.bin")
    return start(name, ticks)[0] == DONE


def least_ticks(name):
    """That storing takes."""
    shutil.copyfile("flash.bin", "before.bin")
    low, high = 1, TICKS_MAX
    while high - low > high // 64:
        middle = (low + high) // 2
        low, high = (low, middle) if is_done(name, middle) else (middle, high)
    return high


def main():
    target.need_qemu()
    target.image("m4f", "takt-storage")
    sets = {"a.settings": pack("a.settings", 1000), "b.settings": pack("b.settings", 2000)}
    t.check(sets["a.settings"] != sets["b.settings"], "the two sets differ")
    with open("flash.bin", "wb") as file:
        file.write(b"\xff" * FLASH_BYTES)
    status, found = start("a.settings", 0)
    t.check(status == DONE and found == b"", "blank flash takes the first set", status, len(found))
    status, found = start("b.settings", 0)
    t.check(status == DONE and found == sets["a.settings"], "it is there at the next start", status)
    t.check(start()[1] == sets["b.settings"], "and the second after it")

    source = random.Random(9)
    most = least_ticks("a.settings")
    shutil.copyfile("before.bin", "flash.bin")
    counts, old = {"old": 0, "new": 0, "stopped": 0}, "b.settings"
    for stop in range(STOPS):
        new = "a.settings" if old == "b.settings" else "b.settings"
        ticks = source.randrange(1, most + most // 16)
        status, found = start(new, ticks)
        t.check(status in (DONE, STOPPED) and found == sets[old], f"stop {stop}, after {ticks} ticks: the set before is what it starts with",
                status, len(found))
        counts["stopped"] += status == STOPPED
        found = start()[1]
        t.check(found in (sets[old], sets[new]), f"stop {stop}, after {ticks} ticks: the old or the new set is there", len(found))
        t.check(status == STOPPED or found == sets[new], f"stop {stop}: what has been stored is there")
        counts["new" if found == sets[new] else "old"] += 1
        old = new if found == sets[new] else old
    print(f"{STOPS} stops in {most} ticks of 40 instructions: {counts['stopped']} while storing; {counts['old']} times the old set, "
          f"{counts['new']} times the new one")
    t.check(counts["old"] > 0 and counts["new"] > 0, "both sets are met", counts)
    t.finish()


main()
