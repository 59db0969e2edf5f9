"""The foreign packages of requirements.txt: where tests find them.

    import packages
    packages.require("can", "canopen")     # first of all, then import them
"""

import importlib.util
import os
import sys

FOLDER = os.environ.get("TAKT_PEERS") or os.path.join(os.environ.get("TAKT_SOURCE", "."), "build", "peers")


def require(*modules):
    """Goes on if this Python has them; else runs the script again under the one that tests/run --all has set up; else
    the test is skipped."""
    missing = [name for name in modules if importlib.util.find_spec(name) is None]
    if not missing:
        return
    python = os.path.join(FOLDER, "bin", "python3")
    if os.path.exists(python) and not sys.executable.startswith(FOLDER):
        os.execv(python, [python, *sys.argv])
    print(f"{', '.join(missing)}: not installed; tests/run --all does it")
    sys.exit(77)
