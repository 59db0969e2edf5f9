"""The plug-in: a broken limit fails a test."""

import pytest

GOOD = "G21 G90\nG1 F3000 X20\nM2\n"


@pytest.fixture(autouse=True)
def by_name(monkeypatch):
    """The plug-in is loaded once, by its name, installed or not."""
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")


def run(pytester, text):
    pytester.makefile(".ngc", part=GOOD)
    pytester.makepyfile(text)
    return pytester.runpytest_inprocess("-p", "takt.pytest_plugin", "-p", "no:cacheprovider")


def test_a_marker_gives_the_run(pytester):
    run(pytester, """
        import pytest
        @pytest.mark.takt("part.ngc")
        def test_part(takt_run):
            assert takt_run.summary.program_time_s < 10
    """).assert_outcomes(passed=1)


def test_paths_are_those_beside_the_test(pytester):
    pytester.mkdir("sub").joinpath("part.ngc").write_text(GOOD)
    pytester.path.joinpath("sub", "test_it.py").write_text("""
import pathlib
import pytest
@pytest.mark.takt("part.ngc")
def test_word(takt_run):
    assert takt_run.held
@pytest.mark.takt(pathlib.Path("part.ngc"))
def test_path(takt_run):
    assert takt_run.held
""")
    words = ["-p", "takt.pytest_plugin", "-p", "no:cacheprovider", "--strict-markers"]
    pytester.runpytest_inprocess(*words).assert_outcomes(passed=2)


def test_a_broken_run_fails(pytester):
    text = """
        import pytest
        @pytest.mark.takt("part.ngc", inject="enabled+0.2s drive 1 jam\\n")
        def test_part(takt_run):
            pass
        def test_call(takt_run):
            takt_run("part.ngc", inject="enabled+0.2s drive 1 jam\\n")
        def test_judged_here(takt_run):
            assert not takt_run("part.ngc", inject="enabled+0.2s drive 1 jam\\n", verify=False).held
    """
    run(pytester, text).assert_outcomes(passed=1, failed=1, errors=1)
