#!/usr/bin/env python3
"""Seals an image: writes the CRC-32 of everything before the section .seal into it. port/image.c checks it at start.

Usage: seal_image.py OBJCOPY IMAGE.elf
"""
import os
import struct
import subprocess
import sys
import tempfile
import zlib

SEAL_LENGTH = 4


def main():
    objcopy, image = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        flat = os.path.join(folder, "flat")
        seal = os.path.join(folder, "seal")
        subprocess.run([objcopy, "-O", "binary", image, flat], check=True)
        with open(flat, "rb") as file:
            content = file.read()[:-SEAL_LENGTH]
        with open(seal, "wb") as file:
            file.write(struct.pack("<I", zlib.crc32(content)))
        subprocess.run([objcopy, "--update-section", f".seal={seal}", image], check=True)


if __name__ == "__main__":
    main()
