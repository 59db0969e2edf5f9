#!/usr/bin/env python3
"""The image: flash, memory and stack within their budgets, and nothing in it that has no place in a control cycle.

The budget of all of its memory is what it takes now; with --memory it is that of an STM32F405, which is not reached.
"""

import glob
import os
import re
import subprocess
import sys

import stack
import target
import takt_test as t

FLASH_MAX = 256 * 1024
MEMORY_MAX = 128 * 1024
MEMORY_NOW = 304 * 1024

FORBIDDEN = re.compile(
    r"^_?(malloc|calloc|realloc|free|_?sbrk|v?f?s?n?printf|puts|putchar|fopen|fwrite|fread|scanf|getc|exit|atexit"
    r"|sin|cos|tan|asin|acos|atan2?|exp|log|log10|pow|fmod|cbrt|hypot|floor|ceil|round|fma)f?l?(_r)?$")
INTERRUPTS = ("uart_0_receive", "uart_0_send", "uart_1_receive", "uart_1_send", "uart_2_receive", "uart_2_send")


def symbols(elf):
    out = subprocess.run(["arm-none-eabi-nm", elf], capture_output=True, text=True, check=True).stdout
    return {line.split()[-1]: int(line.split()[0], 16) for line in out.splitlines() if len(line.split()) == 3}


def sections(elf):
    out = subprocess.run(["arm-none-eabi-size", "-A", elf], capture_output=True, text=True, check=True).stdout
    rows = (line.split() for line in out.splitlines())
    return {row[0]: int(row[1]) for row in rows if len(row) == 3 and row[0].startswith(".")}


def check_sizes(elf):
    part = sections(elf)
    flash = sum(part.get(name, 0) for name in (".text", ".ARM.exidx", ".data", ".seal"))
    memory = sum(part.get(name, 0) for name in (".stack", ".data", ".bss", ".noinit"))
    print(f"{os.path.basename(elf)}: flash {flash} of {FLASH_MAX}, memory {memory} of {MEMORY_MAX}")
    t.check(flash <= FLASH_MAX, "the flash memory is enough", flash)
    t.check(memory <= (MEMORY_MAX if "--memory" in sys.argv else MEMORY_NOW), "the memory is enough", memory)


def check_names(names):
    wrong = sorted(name for name in names if FORBIDDEN.match(name))
    t.check(wrong == [], "no heap, no libm, no stdio", wrong)
    t.check("__assert_func" in names, "assertions are there: a broken one stops the image")


def check_stack(elf, names, folder):
    functions = stack.read_functions(elf)
    stack.add_usage(functions, glob.glob(os.path.join(folder, "**", "*.su"), recursive=True))
    unknown = stack.add_pointers(functions)
    t.check(unknown == [], "every call through a pointer is known", unknown)
    depth, way, unbounded = stack.deepest(functions)
    t.check(unbounded == [], "recursion has a bound", unbounded)
    cycle, line = depth["port_systick"], max(depth[name] for name in INTERRUPTS)
    whole = depth["main"] + cycle + line + 2 * stack.EXCEPTION_BYTES
    given = names["image_stack_top"] - names["image_stack_low"]
    print(f"stack: background {depth['main']}, cycle {cycle}, line {line}, all together {whole} of {given}")
    for root in ("main", "port_systick"):
        print("  " + " > ".join(f"{name} {functions[name].frame}" for name in stack.path(way, root)))
    t.check(whole <= given, "the stack is enough", whole, given)


def main():
    elf = target.image("m4f", "takt-mps2")
    names = symbols(elf)
    check_sizes(elf)
    check_names(names)
    check_stack(elf, names, target.folder("m4f"))
    t.finish()


main()
