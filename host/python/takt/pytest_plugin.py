"""
For pytest: the fixture ``takt_run`` and the marker ``takt``.

    @pytest.mark.takt("part.ngc", machine="mill.ini", overrides=120)
    def test_part(takt_run):
        assert takt_run.summary.program_time_s < 60

With the marker ``takt_run`` is the run's result, and a test whose run breaks a limit fails before it begins. Without it
``takt_run`` is a function like :func:`takt.run` that fails likewise; ``verify=False`` leaves the judgement to the test.
The report of a failing run is kept in the test's ``tmp_path`` where ``report=True`` is given. Paths are relative to the
test's file.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "takt(program, **options): the run that the fixture takt_run gives; see takt.run")


class Runner:
    """``takt.run`` with paths relative to a folder, and a failure for every broken limit."""

    def __init__(self, folder: Path, kept: Path) -> None:
        self.folder = folder
        self.kept = kept

    def _path(self, given: Any) -> Any:
        there = isinstance(given, (str, Path)) and "\n" not in str(given) and (self.folder / given).exists()
        return self.folder / given if there else given

    def __call__(self, program: Any, *, verify: bool = True, **options: Any) -> Any:
        import takt

        paths = {"machine", "inject", "overrides", "rapid_overrides", "probe", "tools", "parameters", "plan", "subroutines"}
        given = {name: self._path(value) if name in paths else value for name, value in options.items()}
        result = takt.run(self._path(program), **given)
        if verify and not result.held:
            if result.report is not None:
                (self.kept / "report.html").write_text(result.report, encoding="utf-8")
            result.verify()
        return result


@pytest.fixture
def takt_run(request: pytest.FixtureRequest, tmp_path: Path) -> Any:
    """A run: of the marker, or to be called."""
    runner = Runner(Path(request.path).parent, tmp_path)
    marker = request.node.get_closest_marker("takt")
    return runner if marker is None else runner(*marker.args, **marker.kwargs)
