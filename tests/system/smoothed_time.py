"""How long a path within a tolerance (G64 P) takes: smoothed_time.py [PROGRAMS].

It should not take longer than the exact path, which is inside every tolerance, nor for a wider tolerance. Some strokes and some
random programs on random machines (tests/bench/hunting; seeds are fixed) still do: how many, and by how much at most, is
bounded here.
"""

import copy
import json
import os
import random
import re
import subprocess
import sys
import tempfile

import takt_test as t

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(t.SOURCE, "tests", "bench", "hunting"))
# pylint: disable=wrong-import-position
import hunt_path
import hunt_programs

FIRST = 880001
# Strokes are longer by this at most.
STROKES_MOST = 1.15
# Of random programs this part is slower, and by this at most.
SLOWER_PART = 0.05
SLOWER_MOST = 1.6
WIDER_PART = 0.15
WIDER_MOST = 2.0

CORNERS = ((4, 1), (1, 3), (6, 4), (2, 6), (7, 7))


def time_of(program, machine, *arguments):
    """Program time, s."""
    with tempfile.TemporaryDirectory() as folder:
        paths = [os.path.join(folder, name) for name in ("p.ngc", "m.ini", "s.json")]
        for path, text in zip(paths, (program, machine.text())):
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
        done = subprocess.run([t.TAKT, "run", paths[0], "--machine", paths[1], "--quiet", "--json", paths[2], *arguments],
                              capture_output=True, text=True, check=False)
        if done.returncode != 0:
            return None
        with open(paths[2], encoding="utf-8") as file:
            return json.load(file)["program_time_s"]


def draw(seed):
    rng = random.Random(seed)
    machine = hunt_programs.random_machine(rng) if seed % 3 else hunt_programs.built_in()
    return hunt_programs.random_program(rng, machine, rng.choice(list(hunt_programs.FAMILIES))), machine


def wider(program):
    return re.sub(r"G64 P([0-9.]+)", lambda p: f"G64 P{2 * float(p.group(1)):.6f}", program)


def strokes(tolerance, size=1.0):
    """Some mm long, times a size."""
    return f"G21 G90 G17 G64 P{tolerance} F6000\n" + "".join(f"G1 X{size * x:.5f} Y{size * y:.5f}\n" for x, y in CORNERS) + "M2\n"


def strokes_take_no_longer(acceleration):
    machine = hunt_programs.Machine({a: (100.0, acceleration, 50000.0) for a in "XYZ"}, 1000)
    exact_s = time_of(strokes(0.01), machine, "--exact-path")
    times = [(p, time_of(strokes(p), machine)) for p in (0.001, 0.01, 0.05, 0.1, 0.2, 0.5, 1, 2)]
    slow = [(p, s) for p, s in times if s is None or s > STROKES_MOST * exact_s]
    t.check(not slow, f"no tolerance makes strokes of some mm much slower at {acceleration} mm/s2", exact_s, slow)


def small_strokes_have_no_use_for_more_tolerance(acceleration, jerk):
    """The interval between samples grew with it, and a chain has seven at least."""
    machine = hunt_programs.Machine({a: (100.0, acceleration, jerk) for a in "XYZ"}, 1000)
    for size in (0.01, 0.05, 0.2, 1.0):
        times = [time_of(strokes(part * size, size), machine) for part in (2, 5, 10, 50)]
        falls = all(later <= 1.01 * before + 0.003 for before, later in zip(times, times[1:]))
        t.check(falls, f"strokes of {size} mm are no slower for more tolerance: {acceleration} mm/s2, {jerk} mm/s3", times)


def compare(pairs, part, most, claim):
    """(time, the one it should not exceed, cycle) each."""
    ratios = sorted((time / least for time, least, cycle in pairs if time > 1.01 * least + 3 * cycle), reverse=True)
    t.check(len(ratios) <= part * len(pairs) and max(ratios, default=1) <= most, claim, len(pairs), ratios)


def random_programs(number):
    slower, widened = [], []
    for seed in range(FIRST, FIRST + number):
        program, machine = draw(seed)
        if "G64" not in program or not hunt_path.read(program, machine, False):
            continue
        cycle_s = machine.cycle_us * 1e-6
        exact_s, time_s, wide_s = (time_of(program, machine, "--exact-path"), time_of(program, machine), time_of(wider(program), machine))
        t.check(None not in (exact_s, time_s, wide_s), f"a random program runs to its end: {seed}", exact_s, time_s, wide_s)
        slower.append((time_s, exact_s, cycle_s))
        widened.append((wide_s, time_s, cycle_s))
    compare(slower, SLOWER_PART, SLOWER_MOST, "few paths within a tolerance are slower than exact ones, none much")
    compare(widened, WIDER_PART, WIDER_MOST, "few paths are slower within a wider tolerance, none much")


def what_a_change_of_rate_is_left_is_told_by_the_axes_on_the_path():
    """The rate took 5 s to rise where a quick axis went a short way. Parts of the exact path's time."""
    for seed, part in ((330004, 1.75), (550114, 0.92), (330007, 1.45)):
        program, machine = draw(seed)
        exact_s, time_s = time_of(program, machine, "--exact-path"), time_of(program, machine)
        t.check(time_s <= part * exact_s, f"the rate rises as quickly as the axes allow: {seed}", time_s, exact_s)


def joints_that_are_not_worth_passing_are_rests():
    """As the exact path has them: counted as passed they made a slow stretch seem quick. Parts of the exact path's time."""
    for seed, part in ((880027, 0.33), (880032, 0.60), (990083, 0.89)):
        program, machine = draw(seed)
        exact_s, time_s = time_of(program, machine, "--exact-path"), time_of(program, machine)
        t.check(time_s <= part * exact_s, f"the quicker of curve and path is taken: {seed}", time_s, exact_s)


def what_is_found_in_a_part_of_the_tolerance_is_taken_where_it_is_quicker():
    """In all of it only a slower curve is found: so a doubled tolerance made them up to 1.9 times slower."""
    for seed in (110083, 110170, 330059, 330266, 550099, 550101, 550119, 660303, 880036, 880252):
        program, machine = draw(seed)
        time_s, wide_s = time_of(program, machine), time_of(wider(program), machine)
        t.check(wide_s <= 1.01 * time_s + 3e-6 * machine.cycle_us, f"a doubled tolerance makes it no slower: {seed}", wide_s, time_s)


def short_chains_stand_no_longer_by_a_higher_acceleration():
    """At both ends they stood for A/J, however short: with A doubled they took up to 1.57 times as long."""
    for seed in (120118, 120123, 120159, 120195, 120285):
        program, machine = draw(seed)
        higher = copy.deepcopy(machine)
        higher.axes = {axis: (v, 2 * a, j) for axis, (v, a, j) in machine.axes.items()}
        time_s, higher_s = time_of(program, machine), time_of(program, higher)
        t.check(higher_s <= 1.01 * time_s + 3e-6 * machine.cycle_us, f"a doubled acceleration makes it no slower: {seed}", higher_s, time_s)


def the_path_is_timed_from_rest_to_rest():
    """A change of feed on a line was counted as a rest of the path: so a slower curve was taken."""
    program = "G21 G90 G17 G64 P0.02 F6000\nG1 X10\nG1 X20 F3000\nM2\n"
    exact_s, time_s = time_of(program, hunt_programs.built_in(), "--exact-path"), time_of(program, hunt_programs.built_in())
    t.check(time_s <= exact_s, "a line of two feeds is as quick as on the exact path", time_s, exact_s)


what_is_found_in_a_part_of_the_tolerance_is_taken_where_it_is_quicker()
short_chains_stand_no_longer_by_a_higher_acceleration()
the_path_is_timed_from_rest_to_rest()
joints_that_are_not_worth_passing_are_rests()
what_a_change_of_rate_is_left_is_told_by_the_axes_on_the_path()
for mm_s2 in (250.0, 500.0, 1000.0, 5000.0):
    strokes_take_no_longer(mm_s2)
for limits in ((1000.0, 50000.0), (250.0, 1e6), (4000.0, 1e4)):
    small_strokes_have_no_use_for_more_tolerance(*limits)
random_programs(int(sys.argv[1]) if len(sys.argv) > 1 else 50)
t.finish()
