"""The package takt from the source, on the library of this build: host/python/tests, but for what takes minutes."""

import importlib.util
import os
import subprocess
import sys

import takt_test as t

NEEDED = ("cffi", "numpy", "pytest")

missing = [name for name in NEEDED if importlib.util.find_spec(name) is None]
if missing:
    t.skip(f"Python has no {', '.join(missing)}")
here = os.path.join(t.SOURCE, "host", "python")
environment = {**os.environ, "PYTHONPATH": here, "TAKT_LIBRARY": sys.argv[1], "PYTHONDONTWRITEBYTECODE": "1",
               "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}  # that of an installed takt is the same one
words = ["-q", "-p", "takt.pytest_plugin", "-p", "no:cacheprovider", os.path.join(here, "tests")]
done = subprocess.run([sys.executable, "-m", "pytest", *words], env=environment, check=False)
t.check(done.returncode == 0, "the tests of host/python pass")
t.finish()
