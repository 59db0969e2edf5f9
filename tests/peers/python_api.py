#!/usr/bin/python3
"""The package takt from the source, on a library built for it: host/python/tests with the notebooks, but for what takes minutes."""

import os
import subprocess
import sys

import packages

packages.require("cffi", "numpy", "pytest", "distributed", "pyarrow")

SOURCE = os.environ["TAKT_SOURCE"]
BUILD = os.path.join(SOURCE, "build", "python")
HERE = os.path.join(SOURCE, "host", "python")


def run(*words, **options):
    if subprocess.run(words, check=False, **options).returncode != 0:
        sys.exit(f"failed: {' '.join(words)}")


run("cmake", "-S", SOURCE, "-B", BUILD, "-DTAKT_PYTHON=ON", "-DTAKT_TESTS=OFF", stdout=subprocess.DEVNULL)
run("cmake", "--build", BUILD, "--target", "takt_shared", "--parallel", "2", stdout=subprocess.DEVNULL)
run(sys.executable, "-m", "pytest", "-q", "-p", "takt.pytest_plugin", "-p", "no:cacheprovider", os.path.join(HERE, "tests"),
    env={**os.environ, "PYTHONPATH": HERE, "PYTHONDONTWRITEBYTECODE": "1",
         "TAKT_LIBRARY": os.path.join(BUILD, "host", "library", "libtakt.so"),
         "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"})  # that of an installed takt is the same one
