"""Campaigns: resumed after any kill, the same on any number of workers."""

import json
import signal
import subprocess
import sys
import time
from dataclasses import fields, replace
from pathlib import Path

import pytest

pytest.importorskip("pyarrow")
pytest.importorskip("distributed")

import takt  # noqa: E402
from takt.campaign import __main__ as command  # noqa: E402
from takt.campaign.engine import run_missing  # noqa: E402
from takt.campaign.scenario import Scenario, execute, in_moves, is_bad  # noqa: E402
from takt.campaign.shrink import shrink  # noqa: E402
from takt.campaign.spec import latin_hypercube, plan  # noqa: E402
from takt.campaign.store import Store, results  # noqa: E402

PROGRAM = "G21 G90 G64 P0.01\nG1 F3000 X2\nY2\nM2\n"
SPEC = f"""
programs = [{json.dumps(PROGRAM)}]
seeds = 2
samples = 2
[overrides]
none = []
storm = {{ changes = 4, within_s = 0.2, low = 20 }}
[faults]
none = ""
noise = "enabled+0.05s bus corrupt ratio=0.02 seed={{seed}} for=1s"
[variables]
"axis.X.max_acceleration_mm_s2" = {{ low = 300, high = 3000, log = true }}
"""


@pytest.fixture
def spec(tmp_path):
    path = tmp_path / "spec.toml"
    path.write_text(SPEC)
    return path


def run_here(spec, folder):
    """Without Dask."""
    store = Store(folder)
    planned = command.read(spec)
    digest = takt.load().digest
    store.add({p.scenario.key(digest): execute(p.scenario) for p in planned if p.scenario.key(digest) not in store.rows})
    store.finish(planned, digest)
    return (folder / "results.parquet").read_bytes()


def test_a_hypercube_has_one_value_in_every_stratum():
    points = latin_hypercube({"a": {"low": 0, "high": 10}, "b": {"low": 1, "high": 1000, "log": True}}, 10, 1)
    assert sorted(int(p["a"]) for p in points) == list(range(10))
    assert points == latin_hypercube({"b": {"low": 1, "high": 1000, "log": True}, "a": {"low": 0, "high": 10}}, 10, 1)


GOOD = 'programs = ["""\nG1 F100 X1\nM2\n"""]\n'


@pytest.mark.parametrize("wrong, line, key", [
    ("seeds = 2\n", 1, "programs"),
    ('seeds = 2\nprograms = ["nothing*.ngc"]\n', 2, "programs.0"),
    ('programs = ["/nowhere/*.ngc"]\n', 1, "programs.0"),
    ("programs = 5\n", 1, "programs"),
    ("programs = [5]\n", 1, "programs.0"),
    (GOOD + "[machnes]\n", 5, "machnes"),
    (GOOD + 'machines = "mill"\n', 5, "machines"),
    (GOOD + '\n[machines]\ngood = {}\n\nm = { fil = "x" }\n', 9, "machines.m.fil"),
    (GOOD + '[machines.m]\nfile = "nowhere.ini"\n', 5, "machines.m"),
    (GOOD + '[machines.m.set]\n"axis.X.max_jrk_mm_s3" = 5\n', 5, "machines.m"),
    (GOOD + "seeds = 0\n", 5, "seeds"),
    (GOOD + "seeds = [1,\n  -2]\n", 5, "seeds.1"),
    (GOOD + 'samples = "5"\n', 5, "samples"),
    (GOOD + "until = -1\n", 5, "until"),
    (GOOD + "until = nan\n", 5, "until"),
    (GOOD + 'plans = ["board", "bord"]\n', 5, "plans.1"),
    (GOOD + 'tools = "nowhere.tbl"\n', 5, "tools"),
    (GOOD + "[overrides]\nnone = []\nhalf = [[0, 50], [1]]\n", 7, "overrides.half"),
    (GOOD + "[overrides]\nhigh = [[0, 121]]\n", 6, "overrides.high"),
    (GOOD + "[overrides]\ns = { changes = 5 }\n", 6, "overrides.s.within_s"),
    (GOOD + "[overrides]\ns = { changes = 5, within_s = 2, hgh = 5 }\n", 6, "overrides.s.hgh"),
    (GOOD + "[overrides]\ns = { changes = 5, within_s = 2, low = 50, high = 20 }\n", 6, "overrides.s.high"),
    (GOOD + "[faults]\nf = 5\n", 6, "faults.f"),
    (GOOD + '[faults]\nf = """\npower+1s drive 1 jam\n# {ratoi}\n"""\n', 6, "faults.f"),
    (GOOD + "[variables]\na = []\n", 6, "variables.a"),
    (GOOD + "[variables]\na = [[1]]\n", 6, "variables.a"),
    (GOOD + "[variables]\na = { low = 1 }\n", 6, "variables.a.high"),
    (GOOD + "[variables]\na = { low = 0, high = 5, log = true }\n", 6, "variables.a"),
    (GOOD + "[variables]\na = { low = 5, high = 1 }\n", 6, "variables.a"),
    (GOOD + '[variables]\nok = [1]\n"axis.X.max_jrk_mm_s3" = [5]\n', 7, "variables.axis.X.max_jrk_mm_s3"),
])  # fmt: skip
def test_a_wrong_specification_names_line_and_key(wrong, line, key, tmp_path, capsys):
    path = tmp_path / "wrong.toml"
    path.write_text(wrong)
    assert command.main([str(path)]) == 2
    told = capsys.readouterr().err
    assert told.startswith(f"takt-campaign: {path}:{line}: {key}: "), told
    assert not (tmp_path / "wrong").exists()


def test_what_is_no_toml_names_line_and_column(tmp_path, capsys):
    path = tmp_path / "wrong.toml"
    path.write_text(GOOD + "seeds = = 2\n")
    assert command.main([str(path)]) == 2
    assert capsys.readouterr().err.startswith(f"takt-campaign: {path}:5:9: ")
    path.write_bytes(b"\xff")
    assert command.main([str(path)]) == 2
    assert command.main([str(tmp_path / "nowhere.toml")]) == 2


def test_variables_are_words_of_programs_and_keys_of_machines(tmp_path):
    (tmp_path / "tools.tbl").write_text("T1 P1 D6.0 Z5.0\n")
    planned = list(plan({
        "programs": ["G21 {mode}\nG1 F100 X{x} Y{y}\nM2\n"], "tools": "tools.tbl",
        "variables": {
            "x": [0.00001, 1e7], "mode": ["G61", "G64"], "y": {"low": 1e-6, "high": 2e-6},
            "machine.look_ahead_blocks": {"low": 4, "high": 64, "log": True, "whole": True},
        },
        "samples": 3,
    }, tmp_path))  # fmt: skip
    assert len(planned) == 12
    assert all(execute(p.scenario)["outcome"] in ("completed", "refused") for p in planned)
    first = planned[0].scenario
    assert "X0.00001 Y0.00000" in first.program and first.program.startswith("G21 G61\n")
    assert first.tools == "T1 P1 D6.0 Z5.0\n" and execute(first)["outcome"] == "completed"


def test_a_part_of_a_scenario_makes_another_one():
    base = Scenario(PROGRAM)
    parts = {"program": "M2\n", "machine": "x", "sets": ("a.b=1",), "overrides": "0 5\n", "faults": "#\n", "plan": "exact",
             "until": 1.0, "tools": "auto", "dialect": "fanuc"}  # fmt: skip
    others = [replace(base, **{name: value}) for name, value in parts.items()]
    assert len(parts) == len(fields(Scenario))
    assert len({s.identity for s in [base, *others]}) == len(parts) + 1


def test_scenarios_differ_where_their_inputs_do(spec):
    scenarios = [p.scenario for p in command.read(spec)]
    assert len(scenarios) == 16
    assert len({s.identity for s in scenarios}) == 2 * (1 + 2 + 2 + 2)
    assert scenarios[0].key("a") != scenarios[0].key("b")


def test_workers_and_order_make_no_difference(spec, tmp_path):
    alone = run_here(spec, tmp_path / "alone")
    assert command.main([str(spec), "-o", str(tmp_path / "two"), "--workers", "2", "--batch", "3", "--no-report"]) == 0
    assert (tmp_path / "two" / "results.parquet").read_bytes() == alone


def test_what_is_there_is_not_run_again(spec, tmp_path):
    whole = run_here(spec, tmp_path / "c")
    parts = list((tmp_path / "c" / "parts").iterdir())
    store = Store(tmp_path / "c")
    costs = run_missing(
        store, [p.scenario for p in command.read(spec)], scheduler="tcp://127.0.0.1:1", workers=1, batch=1, library=None
    )
    assert costs.runs_s == 0
    parts[0].write_bytes(parts[0].read_bytes()[:100])  # a power cut
    assert Store(tmp_path / "c").rows == {}
    assert run_here(spec, tmp_path / "c") == whole


def repeat(line):
    """The line as a shell takes it."""
    assert " run " in line and " takt " in line
    done = subprocess.run(f"{line} --json - --quiet", shell=True, capture_output=True, text=True)
    return done.returncode, json.loads(done.stdout)["setpoint_digest"] if done.stdout else ""


def test_a_failed_scenario_is_repeated_by_its_line(spec, tmp_path):
    spec.write_text(SPEC.replace('none = ""', 'none = ""\nwrong = "enabled+1s drive 9 jam"'))
    run_here(spec, tmp_path / "c")
    rows = results(tmp_path / "c")
    bad = [r for r in rows if is_bad(r, r["has_faults"])]
    assert {r["outcome"] for r in bad} == {"refused"} and {r["faults"] for r in bad} == {"wrong"}
    good = next(r for r in rows if r["overrides"] == "storm" and r["faults"] == "noise")
    for row in (bad[0], good):
        scenario = {p.scenario.identity: p.scenario for p in command.read(spec)}[row["identity"]]
        status, digest = repeat(scenario.write(tmp_path / row["key"], takt.load()))
        assert (status, digest) == (row["status"], row["digest"])


def test_shrinking_leaves_what_fails():
    lines = [f"G1 F1000 X{i % 7} Y{i % 3}" for i in range(40)]
    program = "G21 G90\n" + "\n".join(lines[:20] + ["Z-3"] + lines[20:]) + "\nM2\n"
    scenario = Scenario(program, faults="enabled+9s drive 1 jam\nenabled+8s drive 2 jam\n", overrides="0 100\n1 50\n")

    def fails(s):
        return "Z-3" in s.program and "drive 2" in s.faults

    small = shrink(scenario, fails)
    assert (small.program, small.faults, small.overrides) == ("Z-3\n", "enabled+8s drive 2 jam\n", "")


def test_a_program_with_loops_is_shrunk_as_moves():
    program = "o1 repeat [5]\n#1 = [#1 + 1]\nG1 F1000 X#1\nY[#1]\nG4 P0.1\no1 endrepeat\nM2\n"
    scenario = Scenario(program)

    def fails(s):
        found = execute(s)
        return found["outcome"] == "completed" and found["path_length_mm"] > 3

    moves = in_moves(scenario)
    assert "o1" not in moves.program.lower() and fails(moves)
    assert len(shrink(scenario, fails, moves=moves).program.splitlines()) <= 3
    assert in_moves(Scenario("nonsense\n")).program == "nonsense\n"


def test_comparison_tells_what_became_worse(spec, tmp_path, capsys):
    for name in ("before", "after"):
        assert run_here(spec, tmp_path / name)
        Store(tmp_path / name).note(spec, takt.load())
    assert command.main(["compare", str(tmp_path / "before"), str(tmp_path / "after")]) == 0
    store = Store(tmp_path / "after")
    key, row = sorted(store.rows.items())[0]
    store.rows[key] = {**row, "digest": "0" * 16, "program_time_s": row["program_time_s"] + 1}
    store.finish(command.read(spec), takt.load().digest)
    words = ["compare", str(tmp_path / "before"), str(tmp_path / "after"), "--shrink", "0", "--html", str(tmp_path / "c.html")]
    assert command.main(words) == 1
    assert "instead of" in capsys.readouterr().out
    assert "became worse" in (tmp_path / "c.html").read_text()


@pytest.mark.long
def test_a_campaign_killed_three_times_is_the_undisturbed_one(spec, tmp_path):
    spec.write_text(SPEC.replace("seeds = 2", "seeds = 20").replace("samples = 2", "samples = 10"))
    words = [sys.executable, "-m", "takt.campaign", str(spec), "--workers", "2", "--batch", "4", "--no-report", "-o"]
    subprocess.run([*words, tmp_path / "a"], check=True)
    for _ in range(3):
        before = len(list((tmp_path / "b" / "parts").glob("*.parquet"))) if (tmp_path / "b").exists() else 0
        process = subprocess.Popen([*words, tmp_path / "b"])
        while len(list((tmp_path / "b" / "parts").glob("*.parquet"))) < before + 10 and process.poll() is None:
            time.sleep(0.01)
        process.send_signal(signal.SIGKILL)
        process.wait()
    assert not (tmp_path / "b" / "results.parquet").exists()
    subprocess.run([*words, tmp_path / "b"], check=True)
    assert (tmp_path / "b" / "results.parquet").read_bytes() == (tmp_path / "a" / "results.parquet").read_bytes()


@pytest.mark.long
def test_workers_may_die(spec, tmp_path):
    """A scheduler and four workers as processes of their own; two are killed while they work."""
    spec.write_text(SPEC.replace("seeds = 2", "seeds = 20").replace("samples = 2", "samples = 10"))
    folder = Path(tmp_path)
    scheduler_file = folder / "scheduler.json"
    dask = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--port", "0", "--no-dashboard"]
    worker = [sys.executable, "-m", "distributed.cli.dask_worker", "--nthreads", "1", "--no-nanny", "--no-dashboard"]
    there = ["--scheduler-file", str(scheduler_file)]
    processes = [subprocess.Popen([*dask, *there], cwd=folder)]
    try:
        processes += [subprocess.Popen([*worker, *there], cwd=folder) for _ in range(4)]
        while not (scheduler_file.exists() and scheduler_file.read_text().endswith("}")):  # whole
            time.sleep(0.05)
        address = json.loads(scheduler_file.read_text())["address"]
        words = ["-m", "takt.campaign", str(spec), "--scheduler", address, "--batch", "4", "--no-report", "-o", "c"]
        campaign = subprocess.Popen([sys.executable, *words], cwd=folder)
        for victim in processes[1:3]:
            before = len(list((folder / "c" / "parts").glob("*.parquet"))) if (folder / "c").exists() else 0
            while len(list((folder / "c" / "parts").glob("*.parquet"))) < before + 10:
                assert campaign.poll() is None
                time.sleep(0.01)
            victim.kill()
        assert campaign.wait() == 0
    finally:
        for process in processes:
            process.kill()
            process.wait()
    rows = [row["key"] for row in results(folder / "c")]
    kept = [key for part in (folder / "c" / "parts").iterdir() for key in keys_of(part)]
    assert len(kept) == len(set(kept)) and set(kept) == set(rows)
    assert (folder / "c" / "results.parquet").read_bytes() == run_here(spec, folder / "alone")


def keys_of(part):
    import pyarrow.parquet as pq

    return pq.read_table(part, columns=["key"])["key"].to_pylist()
