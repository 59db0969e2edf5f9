"""takt compile of one long path within a tolerance: memory for each block, so that a million of them need less than 2 GB.

tests/bench/many_blocks.py compiles the million."""

import os
import sys

import takt_test as t

sys.path.insert(0, os.path.join(t.SOURCE, "tests", "bench"))

import many_blocks

FEW, MANY = 5000, 20000
MILLION_KIB_MAX = 2e9 / 1024


def resident_kib(count):
    many_blocks.write("many.ngc", count)
    return many_blocks.measure("compile", "many.ngc", "-o", "many.plan", "--quiet")[2]


few, many = resident_kib(FEW), resident_kib(MANY)
million = many + (many - few) / (MANY - FEW) * (1e6 - MANY)
print(f"{few} KiB for {FEW} blocks, {many} KiB for {MANY}: {million / 1024:.0f} MiB for a million")
t.check(million <= MILLION_KIB_MAX, "a million blocks need less than 2 GB", few, many, million)
t.finish()
