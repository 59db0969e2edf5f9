"""Which wrong lines the tests notice: mutants.py SECONDS [NUMBER [FIRST]].

Mutant number n is one random change of one line of firmware/, the same one every time. It is built in a copy of the sources,
and tests are run until one fails: those named after its room, goldens, unit, property and system tests. A change that does
not compile, or that the compiler makes the same code of, is none: another is drawn. What each came to stands in
build/campaign/mutants.txt; a mutant that is there already is not tried again.

Tests that are held to real time are left out: on a busy computer they fail without a mutant. So are those of what rooms may
include.
"""

import os
import random
import re
import shutil
import subprocess
import sys
import time

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FOLDER = os.path.join(SOURCE, "build", "campaign")
COPY = os.path.join(FOLDER, "mutants")
BUILD = os.path.join(COPY, "build", "host")
BOOK = os.path.join(FOLDER, "mutants.txt")

SECONDS = float(sys.argv[1])
NUMBER = int(sys.argv[2]) if len(sys.argv) > 2 else 300
FIRST = int(sys.argv[3]) if len(sys.argv) > 3 else 1

# A test that takes longer has been made endless.
TIMEOUT_S = 120
LEFT_OUT = "^(test_rooms?_.*|ends|buses|gantry|io_nodes|socketcan|speed|serve_hostile|report_in_browser|drives_command)$"
KEPT_OUT = "^(long|peers|target|fuzz|style)$"

# What stands in a line, and what may come in its place.
CHANGES = (
    (r" < ", (" <= ", " >= ")), (r" <= ", (" < ", " > ")), (r" > ", (" >= ", " <= ")), (r" >= ", (" > ", " < ")),
    (r" == ", (" != ",)), (r" != ", (" == ",)), (r" && ", (" || ",)), (r" \|\| ", (" && ",)),
    (r" \+ ", (" - ",)), (r" - ", (" + ",)), (r" \* (?=[\w(])", (" / ",)), (r" / ", (" * ",)),
    (r" \+= ", (" -= ", " = ")), (r" -= ", (" += ", " = ")), (r"\+\+", ("--",)), (r"--(?!>)", ("++",)),
    (r"\btrue\b", ("false",)), (r"\bfalse\b", ("true",)), (r"(?<=[(\s])!(?=[\w(])", ("",)),
    (r"(?<![\w.])0(?![\w.])", ("1",)), (r"(?<![\w.])1(?![\w.])", ("0", "2")), (r"(?<![\w.])2(?![\w.])", ("1", "3")),
    (r"\b0\.5\b", ("0.25", "1.0")), (r"\b[12]\.0\b", ("1.5",)), (r"(?<![\w.])0\.0\b", ("1.0",)),
    (r"\b(maths_)?max\(", ("maths_min(",)), (r"\b(maths_)?min\(", ("maths_max(",)), (r" & ", (" | ",)), (r" \| ", (" & ",)),
    (r" << ", (" >> ",)), (r" >> ", (" << ",)), (r"\bif \((.*)\) \{$", (r"if (!(\1)) {",)), (r"^( +)[\w>.\[\]()-]+ [-+*/]?= .*;$", (r"\1;",)),
    (r"^( +)\w+\(.*\);$", (r"\1;",)), (r"\bcontinue;", ("break;",)), (r"\bbreak;", (";",)),
)


def run(*command, **options):
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)


def copy_sources():
    """The copy as the repository is now; what has not changed keeps its time, and is not built again."""
    names = run("git", "-C", SOURCE, "ls-files", "-z", "--cached", "--others", "--exclude-standard").stdout.split("\0")
    for name in filter(None, names):
        to = os.path.join(COPY, name)
        os.makedirs(os.path.dirname(to), exist_ok=True)
        with open(os.path.join(SOURCE, name), "rb") as file:
            new = file.read()
        if not os.path.exists(to) or open(to, "rb").read() != new:
            shutil.copy(os.path.join(SOURCE, name), to)


def build(*targets):
    return run("cmake", "--build", BUILD, "--parallel", str(os.cpu_count()), *(["--target", *targets] if targets else [])).returncode == 0


def prepare():
    copy_sources()
    unity = "-DTAKT_UNITY_CACHE=" + os.path.join(SOURCE, "build", "unity")
    timeout = f"-DTAKT_TEST_TIMEOUT_S={TIMEOUT_S}"
    configured = run("cmake", "--preset", "host", "-G", "Ninja", "-DTAKT_TESTS=ON", unity, timeout, cwd=COPY)
    if configured.returncode != 0 or not build():
        sys.exit("the sources without a mutant cannot be built: see " + BUILD)


def candidates():
    """Lines of functions: what a statement, a condition or a return says."""
    found = []
    names = run("git", "-C", SOURCE, "ls-files", "firmware").stdout.split()
    for name in sorted(n for n in names if n.endswith(".c")):
        is_comment = False
        for number, line in enumerate(open(os.path.join(SOURCE, name)).read().split("\n")):
            text = line.strip()
            is_comment = is_comment or text.startswith("/*")
            if not is_comment and line.startswith("    ") and re.search(r"[;{]$|&&$|\|\|$", text) and not re.match(r"static |const .*\[", text):
                found.append((name, number))
            is_comment = is_comment and "*/" not in text
    return found


def changed(line, draw):
    """The line with one change, or None."""
    code, *comment = re.split(r"(?= /\*)", line, maxsplit=1)
    places = [(match, new) for old, news in CHANGES for match in re.finditer(old, code) for new in news]
    if not places:
        return None
    match, new = draw.choice(places)
    return code[: match.start()] + match.expand(new) + code[match.end() :] + "".join(comment)


def object_of(name):
    room = name.split("/")[1]
    path = os.path.join(BUILD, "firmware", room, "CMakeFiles", f"takt_{room}.dir", os.path.basename(name) + ".o")
    return open(path, "rb").read() if os.path.exists(path) else b""


def write(name, lines):
    with open(os.path.join(COPY, name), "w") as file:
        file.write("\n".join(lines))


def names_of(*selection):
    listed = run("ctest", "--test-dir", BUILD, "--show-only", *selection).stdout
    return re.findall(r"Test +#\d+: (\S+)", listed)


def stages(room):
    """Ever more tests, with what has to be built for them."""
    without = ["-LE", KEPT_OUT, "-E", LEFT_OUT]
    own = ["-R", f"^test_{room}(_|$)", "-L", "unit", *without]
    return ((names_of(*own), own), (["takt"], ["-L", "golden"]), ([], ["-L", "unit", *without]), ([], ["-L", "property", *without]), ([], ["-L", "system", *without]))


def find_killer(room):
    """The test that fails, or None."""
    for targets, tests in stages(room):
        if tests[0] == "-R" and not targets:
            continue
        if not build(*targets):
            return "build"
        done = run("ctest", "--test-dir", BUILD, "--stop-on-failure", "-j", str(os.cpu_count()), *tests)
        failed = re.search(r"Test +#\d+: (\S+) \.*\*\*\*(?!Skipped|Not Run)", done.stdout)
        if failed:
            return failed.group(1)
    return None


def draw_mutant(number, places):
    """Built, and of other code than the sources: name, line number, old and new line."""
    draw = random.Random(number)
    while True:
        name, at = draw.choice(places)
        lines = open(os.path.join(SOURCE, name)).read().split("\n")
        old, new = lines[at], changed(lines[at], draw)
        if new is None or new == old:
            continue
        before = object_of(name)
        write(name, lines[:at] + [new] + lines[at + 1 :])
        if build("takt_" + name.split("/")[1]) and object_of(name) != before:
            return name, at, old, new
        restore(name)


def restore(name):
    shutil.copy(os.path.join(SOURCE, name), os.path.join(COPY, name))
    os.utime(os.path.join(COPY, name))
    build("takt_" + name.split("/")[1])


def known():
    if not os.path.exists(BOOK):
        return {}
    return {int(line.split("\t")[0]): line.rstrip("\n") for line in open(BOOK)}


def try_one(number, places):
    name, at, old, new = draw_mutant(number, places)
    killer = find_killer(name.split("/")[1])
    restore(name)
    entry = "\t".join([str(number), killer or "SURVIVES", f"{name}:{at + 1}", old.strip(), "->", new.strip()])
    with open(BOOK, "a") as book:
        book.write(entry + "\n")
    return entry


def main():
    end = time.monotonic() + SECONDS
    os.makedirs(FOLDER, exist_ok=True)
    prepare()
    places = candidates()
    wanted = range(FIRST, FIRST + NUMBER)
    for number in wanted:
        if time.monotonic() > end:
            break
        if number not in known():
            print(try_one(number, places), flush=True)
    tried = [entry for number, entry in sorted(known().items()) if number in wanted]
    survivors = [entry for entry in tried if "\tSURVIVES\t" in entry]
    killed = len(tried) - len(survivors)
    print(f"{killed} of {len(tried)} mutants killed ({100 * killed / max(len(tried), 1):.1f} %); survivors:")
    print("\n".join(survivors))


main()
