"""The examples run, and what they claim holds."""

import json
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.ipynb")), ids=lambda p: p.stem)
def test_its_cells_run(path, capsys):
    """One after the other in one name space, as the kernel does."""
    scope = {}
    for cell in json.loads(path.read_text())["cells"]:
        assert not cell.get("outputs")
        if cell["cell_type"] == "code":
            exec(compile("".join(cell["source"]), path.stem, "exec"), scope)
    assert capsys.readouterr().out


@pytest.mark.long
@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.ipynb")), ids=lambda p: p.stem)
def test_it_runs_in_a_kernel(path):
    nbformat = pytest.importorskip("nbformat")
    client = pytest.importorskip("nbclient").NotebookClient
    client(nbformat.read(path, 4), timeout=600).execute()
