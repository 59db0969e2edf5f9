"""Figures of README.md are what tests/bench/readme_figures measures, and one that is changed by hand is found."""

import os
import re
import subprocess
import sys

import takt_test as t

README = os.path.join(t.SOURCE, "README.md")

# By marker: a number of the figure.
NUMBERS = {
    "engraving.output": r"\d+(?= mm in )",
    "hold.exact": r"[\d.]+(?= s on the exact path)",
    "hold.smoothed": r"[\d.]+(?= s on a smoothed path)",
    "linuxcnc.jerk": r"\d+(?=-fold)",
    "linuxcnc.time": r"[\d.]+(?= times as long)",
}
NOT_MEASURED = "98765"


def figures(*arguments):
    done = subprocess.run([sys.executable, os.path.join(t.SOURCE, "tests", "bench", "readme_figures"), *arguments],
                          capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


text = read(README)
marked = {name for names in re.findall(r"<!-- figure: (.*?) -->", text) for name in names.split(", ")}
t.check(marked == set(NUMBERS), "this test changes a number below every marker", marked)

status, out = figures("--check")
t.check(status == 0, "README.md says what is measured (tests/bench/readme_figures --write brings it up to date)", out)

for name, number in NUMBERS.items():
    by_hand, count = re.subn(number, NOT_MEASURED, text)
    t.check(count == 1, f"{name}: one number is changed", count)
    status, out = figures("--check", "--readme", t.write("README.md", by_hand), name)
    t.check(status == 1 and out.startswith(name) and NOT_MEASURED in out, f"{name}: a change by hand is found", status, out)

by_hand = re.sub(NUMBERS["linuxcnc.time"], NOT_MEASURED, re.sub(NUMBERS["engraving.output"], NOT_MEASURED, text))
figures("--write", "--readme", t.write("README.md", by_hand), "engraving.output", "linuxcnc.time")
t.check(read("README.md") == text, "--write puts figures back and leaves everything else alone")

for wrong in (text.replace("figure: linuxcnc.jerk, ", "figure: "), text.replace("-fold", " times"),
              text.replace("figure: linuxcnc.jerk", "figure: linuxcnc.jerks")):
    status, out = figures("--check", "--readme", t.write("README.md", wrong), "linuxcnc.jerk")
    t.check(status == 1 and "linuxcnc.jerk" in out, "a figure without its marker, or a marker without its figure", out)

t.finish()
