#!/usr/bin/env python3
"""Pages beside a program in real time: how late control cycles begin, and how old pictures are when they come.

    TAKT=build/host/host/takt/takt TAKT_SOURCE=. tests/bench/page_load.py [PAGES] [SECONDS]
"""

import os
import re
import select
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "system"))

import page_client as w  # noqa: E402
import panel_client as p  # noqa: E402


def measure(pages, seconds):
    """Overruns and their figures, the ages of all pictures in ms."""
    service = w.serve()
    client = service.client()
    client.wait_for("STATE", p.IDLE)
    line = "G1 X9 Y1\nG1 X0 Y0\nG2 X0 Y0 I2 J0\n"
    client.upload(b"G64 G21 F6000\n" + line.encode() * 40 * seconds + b"M2\n")
    client.put("CYCLE_START", 1)
    opened = [w.Page(service.page_port) for _ in range(pages)]
    ages, end = [], time.monotonic() + seconds
    while time.monotonic() < end:
        ready = select.select([page.socket for page in opened], [], [], 0.05)[0]
        for page in opened:
            if page.socket in ready and "n" in page.receive():
                ages.append(1e3 * time.time() - page.frame["t"])
    client.put("RESET", 1)
    return ages, service.stop()[1]


def main():
    pages = int(sys.argv[1]) if len(sys.argv) > 1 else 10
    seconds = int(sys.argv[2]) if len(sys.argv) > 2 else 20
    for count in (0, pages):
        ages, text = measure(count, seconds)
        served, late = re.search(r"served.*", text)[0], re.search(r"late  .*", text)[0]
        print(f"{count} pages: {served}; {' '.join(late.split())}")
        if ages:
            ages.sort()
            print(f"  {len(ages) / count / seconds:.1f} pictures a second each; age: median {ages[len(ages) // 2]:.1f} ms, 95 % {ages[int(0.95 * len(ages))]:.1f} ms, 99 % {ages[int(0.99 * len(ages))]:.1f} ms")


main()
