"""Runs: the same as those of the command."""

import csv
import json
import pickle
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
from conftest import EXAMPLES

import takt

ENGRAVING = EXAMPLES / "engraving.ngc"
SHORT = "G21 G90 G64 P0.01\nG1 F3000 X20\nY20\nX0 Y0\nM2\n"


@pytest.mark.parametrize("words, options", [
    ([], {}),
    (["--exact-path"], {"plan": "exact"}),
    (["--plan", "ahead"], {"plan": "ahead"}),
    (["--set", "axis.X.max_jerk_mm_s3=20000.5"], {"machine": {"axis.X.max_jerk_mm_s3": 20000.5}}),
    (["--until", "1.5"], {"until": 1.5}),
])  # fmt: skip
def test_a_run_has_the_digest_of_the_command(command, words, options):
    status, summary = command(ENGRAVING, *words)
    result = takt.run(ENGRAVING, trace=False, **options)
    assert result.status == status
    assert result.digest == summary["setpoint_digest"]
    assert [vars(c) for c in result.checks] == summary["checks"]


def test_overrides_and_faults_in_memory_are_those_of_files(command, tmp_path):
    (tmp_path / "over").write_text("0 100\n1 30\n2.5 120\n")
    (tmp_path / "faults").write_text("enabled+1s bus corrupt ratio=0.05 seed=3 for=1s\n")
    (tmp_path / "short.ngc").write_text(SHORT)
    _, summary = command(
        tmp_path / "short.ngc", "--override", tmp_path / "over", "--inject", tmp_path / "faults"
    )
    result = takt.run(
        SHORT, overrides=[(0, 100), (1, 30), (2.5, 120)], inject=["enabled+1s bus corrupt ratio=0.05 seed=3 for=1s"]
    )
    assert result.digest == summary["setpoint_digest"]


def test_the_trace_is_that_of_the_command(command, tmp_path):
    subprocess.run([command.path, "run", ENGRAVING, "--quiet", "--trace", tmp_path / "t.csv"], check=True)
    with open(tmp_path / "t.csv") as file:
        rows = csv.reader(file)
        names = next(rows)
        values = np.array(list(rows), dtype=float).T
    trace = takt.run(ENGRAVING).trace
    assert list(trace) == names
    for name, column in zip(names, values):
        assert trace[name].shape == column.shape
        np.testing.assert_allclose(trace[name], column, rtol=0, atol=6e-7)


def test_peaks_of_the_summary_are_those_of_the_trace():
    result = takt.run(SHORT)
    for axis in result.summary.axes:
        for order, peak in ((1, axis.max_velocity), (2, axis.max_acceleration), (3, axis.max_jerk)):
            assert np.abs(result.trace.differences(axis.name, order)).max() == pytest.approx(peak, rel=1e-6, abs=1e-6)


def test_the_trace_outlives_everything_else():
    column = takt.run(SHORT).trace["set_X_mm"]
    assert column.max() == pytest.approx(20, abs=0.01)
    assert not column.flags.owndata


def test_an_error_names_file_line_and_column():
    with pytest.raises(takt.InputError) as caught:
        takt.run("G21 G90\nG1 F100 X1 Q\n")
    assert (caught.value.file, caught.value.line) == ("<program>", 2)
    assert caught.value.column > 0
    again = pickle.loads(pickle.dumps(caught.value))
    assert (again.line, str(again)) == (caught.value.line, str(caught.value))


@pytest.mark.parametrize("options, name", [
    ({"inject": "power+1s drive 9 jam\n"}, "<faults>"),
    ({"overrides": [(0, 200)]}, "<overrides>"),
    ({"machine": "[axis X]\nmax_jrk_mm_s3 = 1\n"}, "<machine>"),
    ({"program": "nowhere.ngc"}, "nowhere.ngc"),
])  # fmt: skip
def test_an_error_in_any_input_is_an_exception(options, name):
    with pytest.raises(takt.InputError) as caught:
        takt.run(**{"program": SHORT, **options})
    assert caught.value.file == name


def test_nothing_is_printed(capfd):
    with pytest.raises(takt.InputError):
        takt.run("G1 X F\nM2\n")
    takt.run("(MSG, hello)\n" + SHORT, inject="enabled+0.1s drive 1 emcy code=4310\n")
    assert capfd.readouterr() == ("", "")


def test_what_a_program_says_is_kept():
    messages = takt.run("(MSG, hello)\n" + SHORT).messages
    assert [(m.kind, m.text) for m in messages] == [("message", "hello")]


def test_a_fault_of_a_drive_is_a_result():
    result = takt.run(SHORT, inject="enabled+0.2s drive 1 emcy code=4310\n")
    assert result.summary.outcome == "faulted"
    assert "4310" in result.summary.fault
    with pytest.raises(takt.ChecksFailed, match="4310"):
        result.verify()


def test_threads_run_side_by_side():
    jerks = [10000.0 * (1 + i) for i in range(6)]
    one_by_one = [takt.run(SHORT, machine={"axis.X.max_jerk_mm_s3": j}, trace=False).digest for j in jerks]
    found = {}

    def run(i):
        for _ in range(3):
            found[i] = takt.run(SHORT, machine={"axis.X.max_jerk_mm_s3": jerks[i]}, trace=False).digest

    threads = [threading.Thread(target=run, args=(i,)) for i in range(len(jerks))]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    assert [found[i] for i in range(len(jerks))] == one_by_one
    assert len(set(one_by_one)) == len(jerks)


def test_a_report_stands_in_a_notebook():
    result = takt.run(SHORT, report=True)
    assert result.report.startswith("<!DOCTYPE html>") and result.digest in result.report
    assert "srcdoc" in result._repr_html_()
    assert result.digest in takt.run(SHORT)._repr_html_()


def test_programs_are_read_and_planned_as_by_the_command(command, tmp_path):
    out = subprocess.run([command.path, "canon", ENGRAVING], capture_output=True, text=True, check=True).stdout
    assert takt.canon(ENGRAVING) == out.splitlines()
    subprocess.run([command.path, "plan", ENGRAVING, "--json", tmp_path / "plan.json", "--quiet"], check=True)
    assert takt.plan(ENGRAVING)["totals"] == json.loads((tmp_path / "plan.json").read_text())["totals"]


def test_a_compiled_program_is_replayed():
    compiled = takt.compile(SHORT)
    assert takt.run(SHORT, plan=compiled).digest == takt.run(SHORT, plan="ahead").digest
    with pytest.raises(takt.InputError):
        takt.run(SHORT + "\n", machine={"axis.X.max_jerk_mm_s3": 1000}, plan=compiled)


@pytest.mark.parametrize("options", [
    {"overrides": np.float32(50)}, {"overrides": np.int64(50)}, {"overrides": np.array([[0, 50]])},
    {"overrides": b"0 50\n"}, {"overrides": bytearray(b"0 50\n")},
])  # fmt: skip
def test_numbers_of_numpy_and_bytes_are_taken(options):
    assert takt.run(SHORT, **options).digest == takt.run(SHORT, overrides=50).digest


@pytest.mark.parametrize("value", [np.float64(20000.5), np.float32(20000.5)])
def test_keys_take_numbers_of_numpy(value):
    expected = takt.run(SHORT, machine={"axis.X.max_jerk_mm_s3": 20000.5})
    assert takt.run(SHORT, machine={"axis.X.max_jerk_mm_s3": value}) == expected
    assert takt.run(SHORT, set={"axis.X.max_jerk_mm_s3": value}) == expected
    assert takt.run(SHORT, machine=takt.Machine({"axis.X.max_jerk_mm_s3": value})) == expected
    assert takt.Machine({"machine.look_ahead_blocks": np.int64(32)})["machine.look_ahead_blocks"] == 32


@pytest.mark.parametrize("name", ["program", "machine", "overrides", "inject", "plan", "probe", "tools"])
@pytest.mark.parametrize("value", [5j, object()])
def test_a_value_of_another_kind_is_a_type_error_that_names_it(name, value):
    with pytest.raises(TypeError, match=name):
        takt.run(**{"program": SHORT, name: value})


@pytest.mark.parametrize("path", ["--help", "-", "-h"])
def test_a_path_is_never_an_option(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(takt.InputError, match="no such file"):
        takt.run(path)
    Path(path).write_text(SHORT)
    assert takt.run(path).digest == takt.run(SHORT).digest


def test_a_text_without_line_end_is_told_from_a_path():
    with pytest.raises(takt.InputError, match="line end"):
        takt.run("G1 F100 X1")
    with pytest.raises(takt.InputError, match="line end"):
        takt.run(SHORT, inject="power+1s drive 1 jam")


def test_results_are_compared_without_wall_time():
    a, b = takt.run(SHORT), takt.run(SHORT, report=True)
    assert a == b and hash(a) == hash(b) and pickle.loads(pickle.dumps(a)) == a
    assert a != takt.run(SHORT, overrides=50)


def test_the_module_is_the_command(tmp_path):
    (tmp_path / "part.ngc").write_text(SHORT)

    def takt_command(*words):
        return subprocess.run([sys.executable, "-m", "takt", *map(str, words)], capture_output=True, text=True)

    done = takt_command("run", tmp_path / "part.ngc", "--json", "-", "--quiet")
    assert done.returncode == 0
    assert json.loads(done.stdout)["setpoint_digest"] == takt.run(SHORT).digest
    assert "usage: takt run" in takt_command("run", "--help").stdout
    assert takt_command("run", "nowhere.ngc").returncode == 2
    assert takt_command("serve").returncode == 2


def test_a_campaign_without_its_packages_says_what_to_install():
    code = "import runpy, sys; sys.modules['pyarrow'] = None; runpy.run_module('takt.campaign', run_name='__main__')"
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert ended.returncode == 2 and ended.stderr.startswith("takt-campaign: not installed: ")
    assert "pyarrow" in ended.stderr and ended.stderr.count("\n") == 1
