"""Which wrong lines the tests notice: mutants.py SECONDS [NUMBER [FIRST]].

Mutant number n is one random change of one line of firmware/, the same one every time. It is built in a copy of the sources,
and tests are run until one fails: goldens, unit, property and system tests, of all whose programs hold the changed object.
First come those that are likely to notice soon: named after its room, or killers of earlier mutants of the room, and quick. A
change that does not compile, or that the compiler makes the same code of, is none: another is drawn. Nor is one of an
invariant (TAKT_ASSERT): a weaker one holds all the same. What each came to stands in build/campaign/mutants.txt; a mutant
that is there already is not tried again.

Before the first mutant, and whenever a source has changed, all tests are run without one: how long each takes, and that it
passes. Those that do not are left out, and named. So are tests that are held to real time: on a busy computer they fail
without a mutant; and those of what rooms may include. `taskset -c 0` keeps all of it to one processor.
"""

import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor, as_completed

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FOLDER = os.path.join(SOURCE, "build", "campaign")
COPY = os.path.join(FOLDER, "mutants")
BUILD = os.path.join(COPY, "build", "host")
BOOK = os.path.join(FOLDER, "mutants.txt")
COSTS = os.path.join(BUILD, "Testing", "Temporary", "CTestCostData.txt")

SECONDS = float(sys.argv[1])
NUMBER = int(sys.argv[2]) if len(sys.argv) > 2 else 300
FIRST = int(sys.argv[3]) if len(sys.argv) > 3 else 1

JOBS = len(os.sched_getaffinity(0))
# A test that takes longer than these, and so many times as long as without a mutant, has been made endless.
TIMEOUT_S = 120
ENDLESS_S, ENDLESS_TIMES = 10, 5
# How likely a test of the mutant's own room, and any other, is to notice, beside one kill that has been seen.
OWN_KILLS, OTHER_KILLS = 0.5, 0.01
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
    """The copy as the repository is now, and whether any file was new; what is not keeps its time, and is not built again."""
    names = run("git", "-C", SOURCE, "ls-files", "-z", "--cached", "--others", "--exclude-standard").stdout.split("\0")
    is_new = False
    for name in filter(None, names):
        to = os.path.join(COPY, name)
        os.makedirs(os.path.dirname(to), exist_ok=True)
        with open(os.path.join(SOURCE, name), "rb") as file:
            new = file.read()
        if not os.path.exists(to) or open(to, "rb").read() != new:
            shutil.copy(os.path.join(SOURCE, name), to)
            is_new = True
    return is_new


def build(*targets):
    return run("cmake", "--build", BUILD, "--parallel", str(JOBS), *(["--target", *targets] if targets else [])).returncode == 0


def prepare():
    """The copy built without a mutant, and its tests."""
    is_new = copy_sources()
    unity = "-DTAKT_UNITY_CACHE=" + os.path.join(SOURCE, "build", "unity")
    timeout = f"-DTAKT_TEST_TIMEOUT_S={TIMEOUT_S}"
    configured = run("cmake", "--preset", "host", "-G", "Ninja", "-DTAKT_TESTS=ON", unity, timeout, cwd=COPY)
    if configured.returncode != 0 or not build():
        sys.exit("the sources without a mutant cannot be built: see " + BUILD)
    selection = ["--test-dir", BUILD, "-LE", KEPT_OUT, "-E", LEFT_OUT]
    if is_new or not os.path.exists(COSTS):
        run("ctest", "-j", str(JOBS), *selection)
    listed = json.loads(run("ctest", "--show-only=json-v1", *selection).stdout)["tests"]
    tests = passing([Test(entry) for entry in listed])
    find_symbols(tests)
    return tests


class Test:
    """One test of CTest: how it is run, and what of the build it runs."""

    def __init__(self, entry):
        properties = {each["name"]: each["value"] for each in entry["properties"]}
        self.name = entry["name"]
        self.command = entry["command"]
        self.folder = properties["WORKING_DIRECTORY"]
        self.environment = dict(each.split("=", 1) for each in properties["ENVIRONMENT"])
        self.failures = properties.get("FAIL_REGULAR_EXPRESSION", [])
        programs = [word for word in self.command if word.startswith(BUILD) and os.path.isfile(word)]
        self.programs = programs if self.command[0] in programs else [*programs, self.environment["TAKT"]]
        self.symbols = set()
        self.seconds = 0.0

    def fails(self):
        process = subprocess.Popen(self.command, cwd=self.folder, env={**os.environ, **self.environment}, text=True, errors="replace",
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
        try:
            said, _ = process.communicate(timeout=ENDLESS_S + ENDLESS_TIMES * self.seconds)
        except subprocess.TimeoutExpired:
            return "endless"
        finally:
            end_session(process)
        if process.returncode == 77:
            return None
        return "fails" if process.returncode != 0 or any(re.search(each, said) for each in self.failures) else None


def end_session(process):
    """What a test has started and left behind ends with it."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    process.wait()


def passing(tests):
    """Those that pass without a mutant, with their seconds, as CTest has written them down."""
    times, _, failed = open(COSTS).read().partition("---\n")
    seconds = {line.split()[0]: float(line.split()[2]) for line in times.splitlines()}
    left_out = [test.name for test in tests if test.name in failed.split() or test.name not in seconds]
    if left_out:
        print("left out, as they fail without a mutant:", *left_out)
    for test in tests:
        test.seconds = seconds.get(test.name, 0.0)
    return [test for test in tests if test.name not in left_out]


def globals_of(path):
    listed = run("nm", "--defined-only", path).stdout
    return {line.split()[2] for line in listed.splitlines() if line.split()[1].isupper()}


def find_symbols(tests):
    """What is global in a test's programs: an object of an archive is linked as a whole, or not at all."""
    found = {path: globals_of(path) for path in {path for test in tests for path in test.programs}}
    for test in tests:
        test.symbols = set().union(*(found[path] for path in test.programs))


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


def object_path(name):
    room = name.split("/")[1]
    return os.path.join(BUILD, "firmware", room, "CMakeFiles", f"takt_{room}.dir", os.path.basename(name) + ".o")


def object_of(name):
    path = object_path(name)
    return open(path, "rb").read() if os.path.exists(path) else b""


def write(name, lines):
    with open(os.path.join(COPY, name), "w") as file:
        file.write("\n".join(lines))


def in_order(tests, name):
    """Those that can notice a change of this file; what is likely to, for its time, comes first."""
    room = name.split("/")[1]
    killers = [entry.split("\t")[1].split()[0] for entry in known().values() if f"\tfirmware/{room}/" in entry]

    def kills_per_second(test):
        is_own = re.match(f"test_{room}(_|$)", test.name)
        return (killers.count(test.name) + (OWN_KILLS if is_own else OTHER_KILLS)) / (test.seconds + 0.01)

    changed_here = globals_of(object_path(name))
    return sorted((test for test in tests if test.symbols & changed_here), key=kills_per_second, reverse=True)


def groups(tests):
    """First few, then more: a group is built as a whole."""
    at, size = 0, 8
    while at < len(tests):
        yield tests[at : at + size]
        at, size = at + size, 2 * size


def first_failure(tests):
    """One that fails, and how. One more than there are processors runs at a time: some wait for real time."""
    with ThreadPoolExecutor(JOBS + 1) as pool:
        running = {pool.submit(test.fails): test for test in tests}
        for done in as_completed(running):
            if done.result():
                pool.shutdown(cancel_futures=True)
                return running[done].name if done.result() == "fails" else running[done].name + " " + done.result()
    return None


def find_killer(tests, name):
    """The test that fails, or None."""
    for group in groups(in_order(tests, name)):
        if not build(*sorted({os.path.basename(path) for test in group for path in test.programs})):
            return "build"
        killer = first_failure(group)
        if killer:
            return killer
    return None


def draw_mutant(number, places):
    """Built, and of other code than the sources: name, line number, old and new line."""
    draw = random.Random(number)
    while True:
        name, at = draw.choice(places)
        lines = open(os.path.join(SOURCE, name)).read().split("\n")
        old, new = lines[at], changed(lines[at], draw)
        if new is None or new == old or "TAKT_ASSERT(" in old:
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


def try_one(number, places, tests):
    name, at, old, new = draw_mutant(number, places)
    killer = find_killer(tests, name)
    restore(name)
    entry = "\t".join([str(number), killer or "SURVIVES", f"{name}:{at + 1}", old.strip(), "->", new.strip()])
    with open(BOOK, "a") as book:
        book.write(entry + "\n")
    return entry


def main():
    end = time.monotonic() + SECONDS
    os.makedirs(FOLDER, exist_ok=True)
    tests = prepare()
    places = candidates()
    wanted = range(FIRST, FIRST + NUMBER)
    for number in wanted:
        if time.monotonic() > end:
            break
        if number not in known():
            print(try_one(number, places, tests), flush=True)
    tried = [entry for number, entry in sorted(known().items()) if number in wanted]
    survivors = [entry for entry in tried if "\tSURVIVES\t" in entry]
    killed = len(tried) - len(survivors)
    print(f"{killed} of {len(tried)} mutants killed ({100 * killed / max(len(tried), 1):.1f} %); survivors:")
    print("\n".join(survivors))


main()
