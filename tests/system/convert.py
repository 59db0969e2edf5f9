"""A round trip: `takt convert` writes a program in another dialect, and read in that dialect it gives the same moves.

    convert.py              goldens, every 24th of them, and random programs
    convert.py NUMBER       every golden, and so many random programs
"""

import glob
import os
import random
import sys

import takt_test as t

GOLDENS = os.path.join(os.environ["TAKT_SOURCE"], "tests", "golden")
DIALECTS = "linuxcnc", "grbl", "fanuc", "haas", "mach3"
TOLERANCE = 2.5e-6


def moves(out):
    """Of the canon: kind and words, without lines, moves of no length, and coolant that another order changes at once."""
    kept, at = [], None
    for text in out.splitlines():
        _, kind, *words = text.split()
        end = [word for word in words if word[0] in "XYZABC"]
        if kind in ("rapid", "feed") and (end == at or not at and all(float(word[1:]) == 0 for word in end)):
            continue
        at = end if end else at
        if kept and kind.startswith("coolant") and kept[-1][0].startswith("coolant"):
            kept.pop()
        if (kind, words) not in kept[-1:]:
            kept.append((kind, words))
    return kept


def same_word(a, b):
    try:
        return a[0] == b[0] and abs(float(a[1:]) - float(b[1:])) <= TOLERANCE * max(1.0, 1e-3 * abs(float(a[1:])))
    except ValueError:
        return a == b


def same(a, b):
    return len(a) == len(b) and all(x[0] == y[0] and len(x[1]) == len(y[1]) and all(map(same_word, x[1], y[1]))
                                    for x, y in zip(a, b))


converted = {dialect: 0 for dialect in DIALECTS}


def round_trip(name, program, options):
    status, out, err = t.run("canon", program, *options)
    if status != 0:
        return
    wanted = moves(out)
    for dialect in DIALECTS:
        status, text, err = t.run("convert", program, "--to", dialect, *options)
        if status == 2 and " has no words for " in err:
            continue
        t.check(status == 0, f"{name} to {dialect}", status, err)
        at = options.index("--parameters") if "--parameters" in options else len(options)
        options_back = [*options[:at], *options[at + 2:], "--dialect", dialect]
        status, out, err = t.run("canon", t.write("back.nc", text), *options_back)
        found = moves(out)
        first = next((pair for pair in zip(wanted, found) if not same([pair[0]], [pair[1]])), (len(wanted), len(found)))
        t.check(status == 0 and same(wanted, found), f"{name} back from {dialect}", first, err)
        converted[dialect] += 1


def random_program(seed):
    """Straight moves, arcs in all planes, dwells, coolant, spindle, feeds per minute and revolution, on four axes."""
    r = random.Random(seed)
    lines = [f"G2{r.randrange(2)} F{r.uniform(50, 900):.2f} S{r.randrange(100, 3000)} M{r.choice('34')}"]
    for _ in range(40):
        word = lambda letters: " ".join(f"{a}{r.uniform(-9, 9):.4f}" for a in r.sample(letters, r.randrange(1, len(letters) + 1)))
        plane, ends, centres = r.choice((("17", "XY", "IJ"), ("18", "ZX", "KI"), ("19", "YZ", "JK")))
        lines.append(r.choice((
            f"G0 {word('XYZA')}", f"G1 {word('XYZA')}", f"G1 {word('A')}", f"G1 {word('XYZ')} F{r.uniform(1, 900):.3f}",
            f"G9{r.randrange(2)}", f"G{plane} G{r.choice('23')} {centres[0]}{r.uniform(0.5, 5):.4f} {centres[1]}{r.uniform(-5, -0.5):.4f}",
            f"G4 P{r.uniform(0, 2):.3f}", f"M{r.choice('789')}", "M5", f"M3 S{r.randrange(1, 3000)}", "G95 F0.2 M3 S500", f"G94 F{r.randrange(1, 900)}",
            f"G83 G17 X{r.uniform(-3, 3):.3f} Y1 Z-4 R1 Q1.5 F100", "G80", f"T{r.randrange(1, 4)} M6 M3 S200", "M1")))
    return "\n".join([*lines, "M2", ""])


number = int(sys.argv[1]) if len(sys.argv) > 1 else 0
goldens = sorted(path[:-6] for path in glob.glob(os.path.join(GOLDENS, "*.canon")))
for base in goldens if number else goldens[::24]:
    options = open(base + ".options").read().split() if os.path.exists(base + ".options") else []
    options = [os.path.join(GOLDENS, word) if os.path.exists(os.path.join(GOLDENS, word)) else word for word in options]
    round_trip(os.path.basename(base), base + ".ngc", options)
for seed in range(number or 4):
    round_trip(f"seed {seed}", t.write("random.ngc", random_program(seed)),
               ["--machine", os.path.join(GOLDENS, "mill6.ini"), "--tools", "auto"])
t.check(all(converted[dialect] > 0 for dialect in DIALECTS), "every dialect has been tried", converted)

status, out, err = t.run("convert", "random.ngc", "--to", "marlin")
t.check(status == 2 and out == "" and "known are linuxcnc, grbl, fanuc, haas and mach3" in err, "another dialect", err)
t.write("tap.ngc", "G0 X1\nT1 M6\n")
status, out, err = t.run("convert", "tap.ngc", "--to", "grbl", "-o", "tap.out")
t.check(status == 2 and err == "tap.ngc:2:1: error: grbl has no words for a tool change\n" and not os.path.exists("tap.out"),
        "what cannot be said", err)

t.write("fast.ngc", "F1234567890\nG1 X1\nM2\n")
status, out, err = t.run("convert", "fast.ngc", "--to", "grbl")
t.check(status == 0 and " F1234567890.0\n" in out, "a number that is as large as programs write where there is no limit", out)

t.finish()
