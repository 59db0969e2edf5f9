"""takt resonance finds modes nobody told it, in noise: how many there are, frequency, damping and part."""

import random
import re
import sys

import takt_test as t

MACHINES = int(sys.argv[1]) if len(sys.argv) > 1 else 3
NUMBER = r"([-+\d.e]+)"
MODE = re.compile(rf"# (\w): {NUMBER} \+- {NUMBER} Hz, damping {NUMBER} \+- {NUMBER}, part {NUMBER} \+- {NUMBER}")


def found(*options):
    status, out, err = t.run("resonance", *options)
    t.check(status == 0 and err == "", f"resonance {' '.join(options)}", status, err)
    return out, [(m[0], [float(x) for x in m[1:]]) for m in MODE.findall(out)]


def log_uniform(rng, low, high):
    return low * (high / low) ** rng.random()


def modes(rng):
    """One, or two that are a quarter apart at least and both at least a quarter of what the tool sees."""
    first = [log_uniform(rng, 10, 60), log_uniform(rng, 0.02, 0.1), 1.0]
    if rng.random() < 0.5:
        return [first]
    share = rng.uniform(0.25, 0.75)
    apart = log_uniform(rng, 1.25, 3)
    other = [first[0] * apart, log_uniform(rng, 0.02, 0.1), 1 - share]
    return [[*first[:2], share], other]


def options_of(rng, true):
    numbers = " ".join(f"{x:.9g}" for mode in (true + [[0, 0, 0]])[:2] for x in mode)
    limits = {"max_velocity_mm_s": log_uniform(rng, 50, 500), "max_acceleration_mm_s2": log_uniform(rng, 300, 5000)}
    limits["max_jerk_mm_s3"] = limits["max_acceleration_mm_s2"] * log_uniform(rng, 15, 150)
    words = [f"geometry.mode_x={numbers}", *(f"axis.X.{key}={value:.6g}" for key, value in limits.items())]
    return [word for setting in words for word in ("--set", setting)]


worst = [0.0, 0.0]
for seed in range(MACHINES):
    rng = random.Random(seed)
    true = modes(rng)
    out, got = found("--axes", "X", "--seed", str(seed), *options_of(rng, true))
    if not t.check(len(got) == len(true), f"seed {seed}: as many modes as there are", true, out):
        continue
    for (hz, damping, part), (_, (f, df, d, dd, p, dp)) in zip(sorted(true), got):
        worst = [max(worst[0], abs(f / hz - 1)), max(worst[1], abs(d / damping - 1))]
        t.check(abs(f / hz - 1) < 0.01 and abs(d / damping - 1) < 0.2, f"seed {seed}: frequency within 1 %, damping within 20 %", true, out)
        t.check(abs(p - part) < 0.1, f"seed {seed}: and its part", true, out)
print(f"{MACHINES} machines: frequency off by {100 * worst[0]:.2f} % at most, damping by {100 * worst[1]:.1f} %")

# What the frequency is uncertain by stands ready for the machine file, two standard deviations in per cent.
out, got = found("--axes", "X", "--set", "geometry.mode_x=30 0.05 1 0 0 0", "--noise", "500")
percent = [float(x) for x in re.search(r"# mode_uncertainty_percent = (.*)", out)[1].split()]
t.check(abs(percent[0] - 100 * got[0][1][1] / got[0][1][0]) < 0.1 * percent[0] and percent[1:] == [0, 0], "uncertainty of the frequency", out)

# More noise is less sure, and nothing is seen in noise alone.
sure = ["--axes", "X", "--set", "geometry.mode_x=30 0.05 1 0 0 0"]
spans = [found(*sure, "--noise", noise)[1][0][1][1] for noise in ("20", "500")]
t.check(spans[1] > 10 * spans[0], "deviations grow with the noise", spans)
out, got = found("--noise", "500")
t.check(got == [] and out.count("no mode") == 3, "a stiff machine has no mode", out)
t.check(found(*sure) == found(*sure), "the same seed gives the same")

# A mode that changes along another axis is measured where that one stands, at 0.
table = ["--set", "geometry.mode_x=30 0.05 1 0 0 0", "--set", "geometry.mode_x_along=Y", "--set", "geometry.mode_x_ratio=1 0.9 0.8 0.7 0.6"]
for places, hz in (("-125 75", 22.5), ("-100 0", 18)):
    _, got = found("--axes", "X", *table, "--set", f"geometry.mode_x_places_mm={places}")
    t.check(len(got) == 1 and abs(got[0][1][0] / hz - 1) < 0.01, f"{hz} Hz at 0 of {places}", got)

# What is printed is a machine file.
t.write("modes.ini", found(*sure)[0])
status, _, err = t.run("machine", "modes.ini")
t.check(status == 0, "what is printed is a machine file", err)
for words, told in ((("--axes", "A"), "axis A is no linear axis"), (("--noise", "-1"), "--noise"), (("--axes", "U"), "letters of axes")):
    status, _, err = t.run("resonance", *words)
    t.check(status == 2 and told in err, f"refused: {' '.join(words)}", status, err)
t.finish()
