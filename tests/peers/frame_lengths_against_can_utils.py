"""Lengths of frames on the wire, bit by bit, against the exact count of can-utils (canframelen.c)."""

import ctypes
import glob
import os
import shutil
import subprocess
import sys

FRAMES = 40000
EXTENDED = 1 << 31
EXACT = 2  # of enum cfl_mode
CLASSICAL_MTU = 16


class Frame(ctypes.Structure):
    """struct canfd_frame of the kernel, which begins as its struct can_frame does."""

    _fields_ = [("id", ctypes.c_uint32), ("length", ctypes.c_uint8), ("rest", ctypes.c_uint8 * 3), ("data", ctypes.c_uint8 * 64)]


def skip(reason):
    print(reason)
    sys.exit(77)


def build():
    """can-utils installs no library; its source package has the function."""
    if not shutil.which("candump"):
        skip("can-utils is not installed")
    script = os.path.join(os.environ["TAKT_SOURCE"], "tests", "support", "source_from_apt")
    if subprocess.run([script, "can-utils", "source"], capture_output=True, check=False).returncode != 0:
        skip("the source package of can-utils cannot be had from the distribution")
    found = glob.glob("source/*/canframelen.c")
    if not found:
        skip("can-utils has no canframelen.c")
    folder = os.path.dirname(found[0])
    include = ["-I" + folder, "-I" + os.path.join(folder, "include")]
    subprocess.run(["cc", "-w", "-O1", "-shared", "-fPIC", *include, "-o", "canframelen.so", found[0]], check=True)
    return ctypes.CDLL("./canframelen.so").can_frame_length


def main():
    count = build()
    lines = subprocess.run([sys.argv[1], str(FRAMES)], capture_output=True, text=True, check=True).stdout.splitlines()
    standard = wrong = 0
    for line in lines:
        flags, identifier, length, data, bits = line.split()
        standard += flags == "0"
        frame = Frame(int(identifier, 16) | (EXTENDED if flags != "0" else 0), int(length))
        for i, byte in enumerate(bytes.fromhex(data.replace("-", ""))):
            frame.data[i] = byte
        theirs = count(ctypes.byref(frame), EXACT, CLASSICAL_MTU)
        if theirs != int(bits):
            wrong += 1
            print("can-utils counts", theirs, "bits:", line)
    print(f"{len(lines)} frames, {standard} of them with 11-bit identifiers: {wrong} differ")
    sys.exit(1 if wrong or len(lines) != FRAMES or standard < 10000 else 0)


main()
