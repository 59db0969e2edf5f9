"""Concise configurations (CiA 302, object 1F22) that give drives a table of their error of pitch and their backlash."""

import struct

INCREMENTS_PER_MM = 100000  # of the built-in machine


def settings(node):
    """What takt would tell a drive by itself."""
    return [(0x1017, 0, 2, 100), (0x1016, 1, 4, 127 << 16 | 300), (0x1006, 0, 4, 1000), (0x60C2, 1, 1, 1), (0x60C2, 2, 1, 0xFD),
            (0x6007, 0, 2, 3), (0x605A, 0, 2, 2), (0x605E, 0, 2, 2),
            (0x1800, 1, 4, 0xC0000180 + node), (0x1A00, 0, 1, 0), (0x1A00, 1, 4, 0x60410010), (0x1A00, 2, 4, 0x60640020),
            (0x1A00, 0, 1, 2), (0x1800, 2, 1, 1), (0x1800, 1, 4, 0x40000180 + node), (0x1801, 2, 1, 255), (0x1801, 5, 2, 100)]


def pitch_table(first_mm, distance_mm, errors_mm, backlash_mm):
    """The points are written while their number is 0."""
    points = [(0x2011, number, 4, round(1e6 * error_mm)) for number, error_mm in enumerate(errors_mm, 1)]
    return [(0x2010, 1, 1, 0), (0x2010, 2, 4, round(first_mm * INCREMENTS_PER_MM)),
            (0x2010, 3, 4, round(distance_mm * INCREMENTS_PER_MM)), (0x2010, 4, 4, round(1e6 * backlash_mm)),
            *points, (0x2010, 1, 1, len(errors_mm))]


def concise(path, node, entries):
    """As dcfgen writes it: index, sub-index, bytes of the value."""
    entries = settings(node) + entries
    data = struct.pack("<I", len(entries))
    for index, sub, size, value in entries:
        data += struct.pack("<HBI", index, sub, size) + (value % 2 ** (8 * size)).to_bytes(size, "little")
    with open(path, "wb") as file:
        file.write(data)
    return path
