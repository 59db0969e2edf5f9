from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
EXAMPLES = ROOT / "host" / "examples"
pytest_plugins = ["pytester"]


@pytest.fixture(scope="session")
def command():
    """`takt run` itself: its exit status and summary."""
    path = os.environ.get("TAKT") or shutil.which("takt")
    if not path:
        pytest.skip("the command takt is not there: TAKT names it")

    def call(*words):
        done = subprocess.run([path, "run", *map(str, words), "--json", "-", "--quiet"], capture_output=True, text=True)
        return done.returncode, json.loads(done.stdout) if done.stdout.strip() else None

    call.path = path
    return call


def pytest_addoption(parser):
    parser.addoption("--long", action="store_true", help="also what takes minutes")


def pytest_configure(config):
    config.addinivalue_line("markers", "long: takes minutes; run with --long")


def pytest_collection_modifyitems(config, items):
    if not config.getoption("--long"):
        for item in items:
            if "long" in item.keywords:
                item.add_marker(pytest.mark.skip(reason="--long"))
