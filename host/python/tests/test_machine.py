"""Machines as dictionaries."""

import pickle

import pytest
from conftest import EXAMPLES

import takt


def test_keys_are_read_and_set():
    mill = takt.Machine()
    assert mill.axes == ["X", "Y", "Z"]
    mill["axis.X.max_jerk_mm_s3"] = 12345.678901234567
    assert mill["axis.X.max_jerk_mm_s3"] == 12345.678901234567
    assert len(dict(mill)) == len(mill) > 200


def test_a_wrong_key_is_refused_and_changes_nothing():
    mill = takt.Machine()
    before = mill.text
    with pytest.raises(takt.InputError, match="did you mean max_jerk_mm_s3"):
        mill["axis.X.max_jrk_mm_s3"] = 1
    with pytest.raises(takt.InputError):
        mill["axis.X.travel_min_mm"] = 1e5
    assert mill.text == before


def test_a_text_that_no_file_can_hold_is_refused():
    mill = takt.Machine()
    for name in ("a\n[axis A]", "a ; b"):
        with pytest.raises(takt.InputError, match="name"):
            mill["machine.name"] = name
    assert mill.text == takt.Machine().text


def test_its_text_is_the_same_machine():
    mill = takt.Machine(None, {"axis.Y.max_acceleration_mm_s2": 0.1 + 0.2 + 500})
    for again in (takt.Machine(mill.text), takt.Machine(mill), pickle.loads(pickle.dumps(mill))):
        assert dict(again) == dict(mill) and again.text == mill.text


def test_files_are_read():
    for path in sorted(EXAMPLES.glob("*.ini")):
        machine = takt.Machine(path)
        assert takt.Machine(machine.text).text == machine.text


def test_a_new_axis_comes_by_its_name():
    assert takt.Machine(None, {"axis.A.max_velocity_deg_s": 90}).axes == ["X", "Y", "Z", "A"]


def test_more_keys_at_once_than_a_command_takes():
    mill = takt.Machine()
    doubled = {k: v * 2 for k, v in mill.items() if k.startswith("axis.") and "max_" in k and isinstance(v, float)}
    same = {k: v for k, v in mill.items() if k.startswith(("drive.", "axis.")) and isinstance(v, (int, float))}
    mill.update(same)
    assert len(same) > 64
    assert mill.text == takt.Machine().text and doubled is not None
