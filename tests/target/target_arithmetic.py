#!/usr/bin/env python3
"""Sums, products, division, square root, comparisons and conversions of an image give the bits of IEEE 754; its memory functions work.

With a number, so many pairs: target_arithmetic.py 1000000
"""

import math
import random
import struct
import subprocess
import sys

import target
import takt_test as t

PAIRS = int(sys.argv[1]) if len(sys.argv) > 1 else 60000
ANSWER = struct.Struct("<7dqQQ")
NAMES = ("sum", "difference", "product", "quotient", "root", "from signed", "from unsigned", "to signed", "to unsigned", "compared")
LARGEST = sys.float_info.max
SPECIAL = [0.0, 1.0, 2.0, 3.0, 0.5, 0.1, 5e-324, 2.2250738585072014e-308, 2.225073858507201e-308, LARGEST, math.inf, math.nan,
           2.0**52, 2.0**53, 2.0**53 + 2, 2.0**63, 2.0**62, 4503599627370497.5, 1 - 2.0**-53, 1 + 2.0**-52, 1e300, 1e-300]


def from_bits(bits):
    return struct.unpack("<d", struct.pack("<Q", bits))[0]


def to_bits(value):
    return struct.unpack("<Q", struct.pack("<d", value))[0]


def number(source):
    """Any double, often an everyday one, sometimes with few or nearly all of its bits set."""
    kind = source.randrange(6)
    if kind == 0:
        return from_bits(source.getrandbits(64))
    if kind == 1:
        return source.choice(SPECIAL) * source.choice((1.0, -1.0))
    if kind == 2:
        return float(source.randrange(-1000, 1001)) / source.choice((1, 2, 8, 1024))
    exponent = source.randrange(1023 - 60, 1023 + 66) << 52
    fraction = source.getrandbits(52)
    if kind == 3:
        fraction &= source.getrandbits(52) & source.getrandbits(52) & source.getrandbits(52)
    if kind == 4:
        fraction |= source.getrandbits(52) | source.getrandbits(52) | source.getrandbits(52)
    return from_bits(source.getrandbits(1) << 63 | exponent | fraction)


def pairs():
    source = random.Random(20260101)
    for a in SPECIAL:
        for b in SPECIAL:
            yield from ((a, b), (-a, b), (a, -b))
    for _ in range(PAIRS):
        a, b = number(source), number(source)
        yield a, b
        # Squares have exact roots, and products exact quotients: the edges of rounding.
        yield (a * a, a) if source.getrandbits(1) else (a * b, b)
        # A power of two, and what is just too small to be seen beside it: libgcc's difference is wrong there.
        power = math.ldexp(source.choice((1.0, -1.0)), source.randrange(-40, 60))
        yield power, math.ldexp(power * (1 + source.getrandbits(52) * 2.0**-52), -source.randrange(28, 58))


def quotient(a, b):
    try:
        return a / b
    except ZeroDivisionError:
        return math.nan if a == 0 or math.isnan(a) else math.copysign(math.inf, a) * math.copysign(1, b)


def expected(a, b):
    bits = to_bits(a)
    signed = bits - 2**64 if bits >> 63 else bits
    root = math.nan if math.isnan(a) or a < 0 else math.sqrt(a)
    compared = (a < b) | (a <= b) << 1 | (a == b) << 2 | (a >= b) << 3 | (a > b) << 4
    return (a + b, a - b, a * b, quotient(a, b), root, float(signed), float(bits), int(a) if -9e18 < a < 9e18 else 0, int(a) if -1 < a < 1.8e19 else 0,
            compared)


def is_same(a, b):
    if isinstance(a, float):
        return math.isnan(a) and math.isnan(b) or to_bits(a) == to_bits(b)
    return a == b


def check(processor):
    given = list(pairs())
    with open("pairs.bin", "wb") as file:
        file.write(b"".join(struct.pack("<2d", *pair) for pair in given))
    done = subprocess.run(
        [target.QEMU, "-M", target.BOARDS[processor], "-kernel", target.image(processor, "takt-arithmetic"), "-display", "none",
         "-monitor", "none", "-serial", "null", "-semihosting-config", "enable=on,target=native"],
        stdin=subprocess.DEVNULL, check=False)
    t.check(done.returncode == 0, f"{processor}: memcpy and memset of every size and alignment", done.returncode)
    with open("answers.bin", "rb") as file:
        answers = list(ANSWER.iter_unpack(file.read()))
    t.check(len(answers) == len(given), f"{processor}: every pair is answered", len(answers))
    wrong = 0
    for pair, answer in zip(given, answers):
        for name, found, right in zip(NAMES, answer, expected(*pair)):
            if not is_same(found, right) and wrong < 10:
                wrong += 1
                t.check(False, f"{processor}: {name} of {pair[0].hex()}, {pair[1].hex()}", found, right)


target.need_qemu()
for name in target.BOARDS:
    check(name)
t.finish()
