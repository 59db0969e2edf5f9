#!/usr/bin/env python3
"""The images: flash, memory and stack within their budgets, and nothing in them that has no place in a control cycle.

The budget of memory is that of all of it, stack included, wherever it lies: the STM32F405 has 128 KiB, and 64 KiB beside the
core, of which direct memory access reaches the first alone; its image would find room in the first.
"""

import glob
import os
import re
import subprocess

import stack
import stm32
import target
import takt_test as t

FLASH_MAX = 768 * 1024
MEMORY_MAX = 128 * 1024

# The same image with frames of CAN FD, of 64 bytes, in its queues. The STM32H743 has 640 KiB.
FD_MEMORY_MAX = 144 * 1024

FORBIDDEN = re.compile(
    r"^_?(malloc|calloc|realloc|free|_?sbrk|v?f?s?n?printf|puts|putchar|fopen|fwrite|fread|scanf|getc|exit|atexit"
    r"|sin|cos|tan|asin|acos|atan2?|exp|log|log10|pow|fmod|cbrt|hypot|floor|ceil|round|fma)f?l?(_r)?$")

# Who interrupts whom, the most urgent last: of those of one row at most one at a time.
DESK_INTERRUPTS = (
    ("takt_port_systick",),
    ("takt_uart_0_receive", "takt_uart_0_send", "takt_uart_1_receive", "takt_uart_1_send", "takt_uart_2_receive", "takt_uart_2_send", "takt_uart_3_receive", "takt_uart_3_send"))
DRIVE_INTERRUPTS = (("on_can_sent", "on_can_received"), ("takt_port_nmi", "takt_port_fault"))
CHIP_INTERRUPTS = (
    ("on_cycle",), ("on_log",), ("on_panel",), ("on_can_sent", "on_can_received"), ("takt_port_nmi", "takt_port_fault"))


def symbols(elf):
    out = subprocess.run(["arm-none-eabi-nm", elf], capture_output=True, text=True, check=True).stdout
    return {line.split()[-1]: int(line.split()[0], 16) for line in out.splitlines() if len(line.split()) == 3}


def sections(elf):
    out = subprocess.run(["arm-none-eabi-size", "-A", elf], capture_output=True, text=True, check=True).stdout
    rows = (line.split() for line in out.splitlines())
    return {row[0]: int(row[1]) for row in rows if len(row) == 3 and row[0].startswith(".")}


def check_sizes(elf, memory_max):
    part = sections(elf)
    flash = sum(part.get(name, 0) for name in (".text", ".ARM.exidx", ".data", ".seal"))
    memory = sum(part.get(name, 0) for name in (".stack", ".core", ".data", ".bss", ".noinit"))
    print(f"{os.path.basename(elf)}: flash {flash} of {FLASH_MAX}, memory {memory} of {memory_max}")
    t.check(flash <= FLASH_MAX, "the flash memory is enough", flash)
    t.check(memory <= memory_max, "the memory is enough", memory)


def check_names(names):
    wrong = sorted(name for name in names if FORBIDDEN.match(name))
    t.check(wrong == [], "no heap, no libm, no stdio", wrong)
    t.check("takt_assert_failed" in names, "assertions are there: a broken one stops the image")


def usage_files(elf, folder):
    """What the compiler has told of an image's own sources and of the rooms, not of other images."""
    own = os.path.basename(elf).replace(".elf", ".dir")
    found = glob.glob(os.path.join(folder, "**", "*.su"), recursive=True)
    return [path for path in found if "takt-" not in os.path.relpath(path, folder) or own in path.split(os.sep)]


def check_stack(elf, names, folder, interrupts):
    functions = stack.read_functions(elf)
    stack.add_usage(functions, usage_files(elf, folder))
    unknown = stack.add_pointers(functions)
    t.check(unknown == [], "every call through a pointer is known", unknown)
    depth, way, unbounded = stack.deepest(functions)
    t.check(unbounded == [], "recursion has a bound", unbounded)
    deepest = [max(row, key=depth.get) for row in interrupts]
    whole = depth["main"] + sum(depth[name] + stack.EXCEPTION_BYTES for name in deepest)
    given = names["image_stack_top"] - names["image_stack_low"]
    print(f"stack: main {depth['main']}, " + ", ".join(f"{name} {depth[name]}" for name in deepest)
          + f", all together {whole} of {given}")
    for root in ("main", deepest[0]):
        print("  " + " > ".join(f"{name} {functions[name].frame}" for name in stack.path(way, root)))
    t.check(whole <= given, "the stack is enough", whole, given)


def check_image(elf, folder, interrupts, memory_max=MEMORY_MAX):
    names = symbols(elf)
    check_sizes(elf, memory_max)
    check_names(names)
    check_stack(elf, names, folder, interrupts)


def main():
    for name in ("m4f", "m7"):
        check_image(target.image(name, "takt-mps2"), target.folder(name), DESK_INTERRUPTS)
    check_image(stm32.image("takt-stm32f405"), target.folder("stm32f405"), CHIP_INTERRUPTS)
    check_image(stm32.image("takt-stm32f405-drive"), target.folder("stm32f405"), DRIVE_INTERRUPTS)
    check_image(stm32.image("takt-stm32h743", "stm32h743"), target.folder("stm32h743"), CHIP_INTERRUPTS, FD_MEMORY_MAX)
    t.finish()


main()
