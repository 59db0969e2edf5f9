"""Campaigns: resumed after any kill, the same on any number of workers."""

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

pytest.importorskip("pyarrow")
pytest.importorskip("distributed")

import takt  # noqa: E402
from takt.campaign import __main__ as command  # noqa: E402
from takt.campaign.engine import run_missing  # noqa: E402
from takt.campaign.scenario import Scenario, execute, is_bad  # noqa: E402
from takt.campaign.shrink import shrink  # noqa: E402
from takt.campaign.spec import SpecError, latin_hypercube, plan  # noqa: E402
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


@pytest.mark.parametrize("wrong", [
    {}, {"programs": ["nothing*.ngc"]}, {"programs": [PROGRAM], "machnes": {}},
    {"programs": [PROGRAM], "machines": {"m": {"fil": "x"}}}, {"programs": [PROGRAM], "variables": {"a": []}},
])  # fmt: skip
def test_a_wrong_specification_is_refused(wrong, tmp_path):
    with pytest.raises(SpecError):
        list(plan(wrong, tmp_path))


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


def test_a_failed_scenario_is_repeated_by_its_line(command_line, spec, tmp_path):
    spec.write_text(SPEC.replace('none = ""', 'none = ""\nwrong = "enabled+1s drive 9 jam"'))
    run_here(spec, tmp_path / "c")
    rows = results(tmp_path / "c")
    bad = [r for r in rows if is_bad(r, r["has_faults"])]
    assert {r["outcome"] for r in bad} == {"refused"} and {r["faults"] for r in bad} == {"wrong"}
    good = next(r for r in rows if r["overrides"] == "storm" and r["faults"] == "noise")
    for row in (bad[0], good):
        scenario = {p.scenario.identity: p.scenario for p in command.read(spec)}[row["identity"]]
        status, digest = command_line(scenario.write(tmp_path / row["key"]))
        assert (status, digest) == (row["status"], row["digest"])


@pytest.fixture
def command_line(command, tmp_path):
    import shlex

    call = command.path

    def repeat(line):
        words = [call, *shlex.split(line)[1:], "--json", "-", "--quiet"]
        done = subprocess.run(words, capture_output=True, text=True)
        return done.returncode, json.loads(done.stdout)["setpoint_digest"] if done.stdout else ""

    return repeat


def test_shrinking_leaves_what_fails():
    lines = [f"G1 F1000 X{i % 7} Y{i % 3}" for i in range(40)]
    program = "G21 G90\n" + "\n".join(lines[:20] + ["Z-3"] + lines[20:]) + "\nM2\n"
    scenario = Scenario(program, faults="enabled+9s drive 1 jam\nenabled+8s drive 2 jam\n", overrides="0 100\n1 50\n")

    def fails(s):
        return "Z-3" in s.program and "drive 2" in s.faults

    small = shrink(scenario, fails)
    assert (small.program, small.faults, small.overrides) == ("Z-3\n", "enabled+8s drive 2 jam\n", "")


def test_comparison_tells_what_became_worse(spec, tmp_path, capsys):
    for name in ("before", "after"):
        assert run_here(spec, tmp_path / name)
        Store(tmp_path / name).note({"spec": str(spec), "library": str(takt.load().path)})
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
        while not scheduler_file.exists():
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
