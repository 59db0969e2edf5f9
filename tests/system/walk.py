"""The page that follows one line: each of its commands prints what the page shows."""

import os
import re
import subprocess

import takt_test as t

PAGE = os.path.join(t.SOURCE, "host", "docs", "walk.md")
COMMANDS_MIN = 9


def steps(page):
    """Commands with what follows each, of all blocks that begin with a prompt."""
    for block in re.findall(r"^```\n(\$ .*?)^```$", page, flags=re.MULTILINE | re.DOTALL):
        for step in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
            command, _, shown = step.partition("\n")
            yield command, shown


def is_shown(output, shown):
    """Is the page's text this output? A line of dots stands for any lines."""
    pattern = "".join("(?:.*\n)*?" if line.strip() == "..." else re.escape(line) + " *\n" for line in shown.splitlines())
    return re.fullmatch(pattern, output) is not None


os.symlink(t.TAKT, "takt")
environment = {**os.environ, "PATH": os.getcwd() + os.pathsep + os.environ["PATH"]}
with open(PAGE, encoding="utf-8") as file:
    walk = list(steps(file.read()))
t.check(len(walk) >= COMMANDS_MIN, "the page has its commands", len(walk))
for command, shown in walk:
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, env=environment, check=False)
    t.check(is_shown(done.stdout, shown), "the page shows what the command prints", command, done.stdout, done.stderr)
    t.check(not is_shown(done.stdout + "more\n", shown), "and no less", command)
t.finish()
