"""Ends the command in words where a package that campaigns need is not installed."""

import sys
from importlib.util import find_spec

missing = [name for name in ("dask", "distributed", "pyarrow") if find_spec(name) is None]
if missing:
    print(f"takt-campaign: not installed: {', '.join(missing)}; pip install 'takt[campaign]'", file=sys.stderr)
    sys.exit(2)
