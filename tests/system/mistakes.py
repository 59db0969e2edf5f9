"""The page of common mistakes is what the command says: each wrong program has its message, each right one none."""

import os
import re

import takt_test as t

PAGE = os.path.join(t.SOURCE, "host", "docs", "mistakes.md")
MISTAKES_MIN = 50


def program(cell):
    return "\n".join(re.findall("`([^`]*)`", cell)) + "\n"


with open(PAGE, encoding="utf-8") as file:
    rows = [line.strip().strip("|").split("|") for line in file if line.startswith("| `")]
t.check(len(rows) >= MISTAKES_MIN, "there are fifty of them", len(rows))
for wrong, message, _, right in rows:
    with open("part.ngc", "w", encoding="utf-8") as file:
        file.write(program(wrong))
    status, _, err = t.run("check", "part.ngc")
    place, _, text = message.strip().partition(": ")
    t.check(status == 2 and err.startswith(f"part.ngc:{place}: error: {text}\n"), "the message", wrong, err)
    if right.strip():
        t.write("part.ngc", program(right))
        status, _, err = t.run("check", "part.ngc")
        t.check((status, err) == (0, ""), "the cure", right, err)
t.finish()
