"""The recipes for CI (host/docs/ci) do what their page says: their shell steps are taken from the files and run."""

import glob
import os
import re
import subprocess
import xml.etree.ElementTree

import takt_test as t

RECIPES = os.path.join(t.SOURCE, "host", "docs", "ci")
LEFT = ".html", ".json", ".log", ".xml"
GOOD = "G21 G90 G61\nG1 X10 F600\nG1 Y10\nM2\n"
BROKEN = "--set machine.landing=scale"  # for comparison only: the feed steps at joints, and breaks the limits
JOINTS = "G21 G90 G61\n" + "".join(f"G1 X{i * 0.37:.2f} F3000\n" for i in range(1, 20)) + "M2\n"


def block(text, key):
    """The lines that are indented below a key, without their indent."""
    match = re.search(rf"^( *)(?:- )?{key}:[ |]*\n((?:\1 +.*\n|\n)+)", text, flags=re.MULTILINE)
    lines = match.group(2).splitlines()
    indent = min(len(line) - len(line.lstrip()) for line in lines if line.strip())
    return [line[indent:] for line in lines]


def read(name):
    with open(os.path.join(RECIPES, name)) as file:
        return file.read()


def github_script():
    """The action's shell steps; what GitHub would put into the environment is said by the caller."""
    return "\n".join(block(read("action.yml"), "run"))


def gitlab_script():
    """The job's script, from the place where before_script clones takt to."""
    lines = [line.removeprefix("- ") for line in block(read("gitlab-ci.yml"), "script")]
    return "\n".join(lines).replace("/tmp/takt/", t.SOURCE + "/")


def run_steps(script, out, programs, options):
    environment = dict(os.environ, TAKT_ACTION=RECIPES, TAKT_OUT=out, TAKT_PROGRAMS=programs, TAKT_OPTIONS=options)
    done = subprocess.run(["bash", "-e", "-o", "pipefail", "-c", script], env=environment, capture_output=True,
                          text=True, check=False)
    return done.returncode, done.stderr


def cases(path):
    """Of a JUnit file: how many cases there are, failed, and could not run."""
    root = xml.etree.ElementTree.parse(path).getroot()
    return [len(list(root.iter(tag))) for tag in ("testcase", "failure", "error")]


def check_recipe(name, script):
    status, errors = run_steps(script, name, "parts/*.ngc joints.ngc", "")
    t.check(status == 0, f"{name}: programs that hold their limits pass", errors)
    left = sorted(os.path.basename(path) for path in glob.glob(name + "/*"))
    t.check(left == sorted(part + end for part in ("joints", "parts_a", "parts_b") for end in LEFT),
            f"{name}: every program leaves a report, summary, checks and messages", left)
    t.check(cases(name + "/parts_a.xml")[1:] == [0, 0], f"{name}: no check failed")

    status, errors = run_steps(script, name + "_broken", "joints.ngc parts/a.ngc", BROKEN)
    t.check(status == 1, f"{name}: a broken limit fails", status, errors)
    t.check(cases(name + "_broken/joints.xml")[1] > 0, f"{name}: JUnit has the broken limit")
    t.check(os.path.exists(name + "_broken/joints.html"), f"{name}: the report of a broken limit is kept")
    t.check(os.path.exists(name + "_broken/parts_a.xml"), f"{name}: programs behind a broken limit run as well")

    status, errors = run_steps(script, name + "_wrong", "wrong.ngc parts/a.ngc", "")
    t.check(status == 2, f"{name}: an error in a program fails", status, errors)
    t.check(cases(name + "_wrong/wrong.xml") == [1, 0, 1], f"{name}: JUnit has the error")
    with open(name + "_wrong/wrong.log") as file:
        t.check("wrong.ngc:2:4: error:" in file.read(), f"{name}: the log has line and column")

    status, errors = run_steps(script, name + "_same", "parts/a.ngc parts/a.nc parts_a.ngc", "")
    t.check(status == 2, f"{name}: programs whose names are the same but for their ends or folders", status, errors)
    t.check(cases(name + "_same/parts_a.xml") != [1, 0, 1], f"{name}: the first keeps its result")
    t.check(cases(name + "_same/parts_a-2.xml") == [1, 0, 1], f"{name}: the second has its own")
    t.check(cases(name + "_same/parts_a-3.xml")[1:] == [0, 0], f"{name}: and the third")

    status, errors = run_steps(script, name + "_none", "missing/*.ngc", "")
    t.check(status == 2 and "missing/*.ngc" in errors, f"{name}: a pattern that matches nothing fails", errors)


os.makedirs("parts", exist_ok=True)
t.write("parts/a.ngc", GOOD)
t.write("parts/b.ngc", GOOD)
t.write("parts/a.nc", "G21 G90\nG1 X<2> F600\nM2\n")
t.write("parts_a.ngc", GOOD)
t.write("joints.ngc", JOINTS)
t.write("wrong.ngc", "G21 G90\nG1 X<2> F600\nM2\n")
check_recipe("github", github_script())
check_recipe("gitlab", gitlab_script())
for recipe in "action.yml", "gitlab-ci.yml":
    t.check("takt-out" in read(recipe).split("upload-artifact")[-1].split("artifacts:")[-1],
            f"{recipe}: what is left is kept as an artifact")
t.check("always()" in read("action.yml") and "when: always" in read("gitlab-ci.yml"), "artifacts are kept on failure")
t.finish()
