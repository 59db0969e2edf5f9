"""Simulations in steps."""

import copy
import os
import pickle
import threading

import numpy as np
import pytest
from conftest import EXAMPLES

import takt

SHORT = "G21 G90\nG1 F3000 X40\nM2\n"


@pytest.mark.parametrize("cycles", [1, 7, 1000, 10**6])
def test_steps_of_any_length_give_the_same_setpoints(cycles):
    sim = takt.Simulation(SHORT)
    while sim.step(cycles):
        pass
    result = sim.finish()
    assert result.digest == takt.run(SHORT).digest
    assert result.held and sim.state.state is takt.State.COMPLETED


def test_a_run_of_the_command_has_this_digest(command):
    sim = takt.Simulation(EXAMPLES / "engraving.ngc")
    while sim.step(1000):
        pass
    assert sim.finish().digest == command(EXAMPLES / "engraving.ngc")[1]["setpoint_digest"]


def test_an_override_between_two_steps_is_obeyed():
    sim = takt.Simulation(SHORT, trace=True)
    while sim.state.cycles < 300:
        sim.step(1)
    sim.feed_override = 50
    while sim.step(100):
        pass
    feed = sim.finish().verify().trace["feed_mm_min"]
    assert feed[:300].max() == pytest.approx(3000) and feed[600] == pytest.approx(1500)
    with pytest.raises(ValueError, match="0 ... 120"):
        takt.Simulation(SHORT).feed_override = 121


def test_a_hold_stops_on_the_path_and_goes_on():
    sim = takt.Simulation(SHORT)
    sim.step(500)
    sim.feed_hold = True
    sim.step(1000)
    at = sim.state
    assert at.feed_mm_min == 0 and at.state is takt.State.RUNNING and 0 < at.set["X"] < 40
    sim.feed_hold = False
    while sim.step(1000):
        pass
    assert sim.finish().verify().summary.outcome == "completed"


def test_an_input_ends_a_wait():
    sim = takt.Simulation("G21\nM66 P3 L3 Q100\nG1 F600 X1\nM2\n")
    sim.step(2000)
    assert sim.state.set["X"] == 0
    sim.set_digital(3, True)
    sim.step(2000)
    assert sim.finish().summary.outcome == "completed" and sim.state.set["X"] == 1


def test_objects_of_drives_are_read_and_written():
    sim = takt.Simulation(SHORT)
    while sim.step(100):
        pass
    drive = sim.drives[1]
    assert drive[0x6064] / 100000 == pytest.approx(40, abs=0.01)
    assert drive.position_mm == pytest.approx(40, abs=0.01)
    assert drive[0x1018, 1] >= 0
    drive[0x6065] = 12345
    assert drive[0x6065] == 12345
    with pytest.raises(KeyError):
        drive[0x5FFF]


def test_faults_are_given_between_two_steps():
    sim = takt.Simulation(SHORT)
    sim.step(400)
    sim.inject(f"power+{sim.state.cycles_since_power}ms drive 1 emcy code=4310\n")
    while sim.step(1000):
        pass
    assert sim.state.state is takt.State.FAULTED
    assert "4310" in sim.finish().summary.fault
    with pytest.raises(takt.InputError) as caught:
        takt.Simulation(SHORT).inject("power+1s drive 8 jam\n")
    assert caught.value.line == 1


def test_faults_of_the_bus_join_those_of_the_script():
    both = ["enabled+0.1s bus drop id=181 frames=1", "enabled+0.4s bus cut node=2"]
    whole = takt.run(SHORT, inject=both)
    sim = takt.Simulation(SHORT, inject=both[:1])
    sim.step(300)
    sim.inject(both[1] + "\n")
    while sim.step(1000):
        pass
    assert sim.finish().digest == whole.digest
    assert sim.finish().summary.fault == whole.summary.fault


def test_a_simulation_that_is_finished_early_is_interrupted():
    sim = takt.Simulation(SHORT)
    sim.step(400)
    assert sim.finish().summary.outcome == "interrupted"


def test_many_stand_side_by_side():
    sims = [takt.Simulation(SHORT, machine={"axis.X.max_jerk_mm_s3": 10000.0 + i}) for i in range(20)]
    while any([sim.step(37) for sim in sims]):  # all of them, not only up to the first
        pass
    alone = [takt.run(SHORT, machine={"axis.X.max_jerk_mm_s3": 10000.0 + i}).digest for i in range(20)]
    assert [sim.finish().digest for sim in sims] == alone


USES = {
    "step": lambda sim, drive: sim.step(),
    "state": lambda sim, drive: sim.state,
    "finish": lambda sim, drive: sim.finish(),
    "read": lambda sim, drive: sim.feed_override,
    "set": lambda sim, drive: setattr(sim, "feed_override", 50),
    "digital": lambda sim, drive: sim.set_digital(0, True),
    "inject": lambda sim, drive: sim.inject("power+9s drive 1 jam\n"),
    "messages": lambda sim, drive: sim.messages,
    "trace": lambda sim, drive: sim.trace,
    "drive": lambda sim, drive: drive.position_mm,
    "object": lambda sim, drive: drive[0x6041],
    "write": lambda sim, drive: drive.write(0x6065, 1),
}


@pytest.mark.parametrize("use", USES)
def test_a_closed_simulation_is_refused_and_not_touched(use):
    sim = takt.Simulation(SHORT, trace=True)
    drive = sim.drives[1]
    sim.step(10)
    sim.close()
    sim.close()
    with pytest.raises(ValueError, match="closed"):
        USES[use](sim, drive)


def test_a_result_outlives_its_simulation():
    with takt.Simulation(SHORT, trace=True) as sim:
        while sim.step(1000):
            pass
        result = sim.finish()
        assert len(sim.trace["cycle"]) == result.summary.cycles
    assert sim.finish() is result and sim.state.state is takt.State.COMPLETED
    assert result.trace["set_X_mm"].max() == pytest.approx(40, abs=0.01)


def test_threads_take_turns_at_one_simulation():
    sim = takt.Simulation(SHORT)
    threads = [threading.Thread(target=lambda: [sim.step(3) for _ in range(400)]) for _ in range(4)]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    assert sim.finish().digest == takt.run(SHORT).digest


def test_a_simulation_goes_on_on_both_sides_of_a_fork():
    sim = takt.Simulation(SHORT)
    sim.step(500)
    child = os.fork()
    while sim.step(100):
        pass
    same = sim.finish().digest == takt.run(SHORT).digest
    if child == 0:
        os._exit(0 if same else 1)
    assert same and os.waitpid(child, 0)[1] == 0


def test_what_would_be_lost_in_silence_is_an_error():
    sim = takt.Simulation(SHORT)
    with pytest.raises(AttributeError):
        sim.feedhold = True
    for wrong in (float("nan"), float("inf")):
        with pytest.raises(ValueError):
            sim.feed_override = wrong
        with pytest.raises(ValueError, match="E2"):
            sim.set_analogue(2, wrong)
    with pytest.raises(ValueError):
        sim.step(-1)
    with pytest.raises(ValueError, match="trace=True"):
        sim.trace
    for copied in (copy.copy, copy.deepcopy, pickle.dumps):
        with pytest.raises(TypeError, match="another one"):
            copied(sim)


def test_an_error_tells_of_its_own_call_alone():
    sim = takt.Simulation(SHORT)
    with pytest.raises(ValueError, match="500"):
        sim.feed_override = 500
    with pytest.raises(takt.InputError, match="jamm") as raised:
        sim.inject("power drive 1 jamm\n")
    assert raised.value.line == 1 and len(raised.value.messages) == 1
    with pytest.raises(takt.InputError, match="mute_"):
        sim.inject("\npower drive 1 mute_\n")
    assert [m.line for m in sim.messages] == [0, 1, 2]


def test_objects_take_what_fits_alone():
    drive = takt.Simulation(SHORT).drives[1]
    for index in (0x16065, 1 << 16):
        with pytest.raises(KeyError):
            drive[index]
        with pytest.raises(KeyError):
            drive[index] = 1
    for value in (1 << 32, -(1 << 31) - 1):
        with pytest.raises(KeyError):
            drive[0x6065] = value
    drive[0x6098] = -1  # 8 bits
    assert drive.read(0x6098, signed=True) == -1
    drive[0x6065] = np.int64(77)
    assert drive[0x6065] == 77
