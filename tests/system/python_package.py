"""The package as its users get it: `pip install` of the sources into an empty environment, its size, and all of its tests,
notebooks and killed campaigns among them. Minutes, and a hundred megabytes from PyPI: only where TAKT_PYPI=1 says so."""

import glob
import os
import subprocess
import sys

import takt_test as t

WHEEL_MAX = 5_000_000


def run(*words, **options):
    return subprocess.run(words, check=False, **options)


if os.environ.get("TAKT_PYPI") != "1":
    t.skip("with TAKT_PYPI=1 it fetches from PyPI, builds the wheel and runs all of its tests")
if run(sys.executable, "-m", "venv", "venv", capture_output=True).returncode != 0:
    t.skip("this Python makes no virtual environments")
python = os.path.abspath("venv/bin/python")
if run(python, "-m", "pip", "download", "-q", "--no-deps", "-d", "pypi", "cffi", capture_output=True).returncode != 0:
    t.skip("PyPI cannot be reached")
built = run(python, "-m", "pip", "wheel", "-q", "--no-deps", "-w", "wheel", t.SOURCE)
t.check(built.returncode == 0, "the wheel is built")
wheel = glob.glob("wheel/takt-*.whl")
if t.check(len(wheel) == 1, "there is one wheel", wheel):
    t.check(os.path.getsize(wheel[0]) <= WHEEL_MAX, "it is no larger than 5 MB", os.path.getsize(wheel[0]))
    installed = run(python, "-m", "pip", "install", "-q", f"{wheel[0]}[campaign,test]")
    t.check(installed.returncode == 0, "it is installed with what it needs")
    tests = os.path.join(t.SOURCE, "host", "python", "tests")
    done = run(python, "-m", "pytest", "-q", "--long", "-p", "no:cacheprovider", tests)
    t.check(done.returncode == 0, "its tests pass")
t.finish()
