"""takt friction measures what the virtual motors have; fed forward, it leaves nothing of the spikes at reversals (takt circle)."""

import math
import random
import re

import takt_test as t

AXES = "XYZ"


def measured(*options):
    status, out, err = t.run("friction", *options)
    t.check(status == 0 and err == "", f"friction {' '.join(options)}", status, err)
    torques = {node: [float(word) for word in words.split()]
               for node, words in re.findall(r"\[drive ([\d:]+)\]\nfriction_forward_nm =(.*)\n", out)}
    steps = [float(word) for word in re.findall(r"friction_forward_step_\w+ = (.*)\n", out)]
    return out, torques, steps


def circle(*options):
    status, _, err = t.run("circle", "--json", "circle.json", "--quiet", *options)
    t.check(status == 0, "the circle is measured", err)
    return t.load_json("circle.json")


def sets(values):
    return [word for key, value in values.items() for word in ("--set", f"{key}={value:.9g}")]


def log_uniform(rng, low, high):
    return low * (high / low) ** rng.random()


def machine(rng):
    """Frictions by what a motor of 1.27 Nm can have, screws, loops and limits of axes, evenly over their decades."""
    values = {}
    for node, axis in enumerate(AXES, 1):
        values[f"drive.{node}.coulomb_friction_nm"] = log_uniform(rng, 0.02, 0.5)
        values[f"drive.{node}.viscous_friction_nm_s_per_rad"] = log_uniform(rng, 1e-4, 3e-3)
        values[f"drive.{node}.travel_per_revolution_mm"] = log_uniform(rng, 5, 20)
        values[f"drive.{node}.velocity_integral_time_s"] = log_uniform(rng, 0.01, 0.05)
        values[f"axis.{axis}.max_velocity_mm_s"] = log_uniform(rng, 20, 200)
    return values


# What is measured is dry friction and what grows with the motor's velocity, within two thousandths of the rated torque.
worst = 0.0
for seed in range(6):
    values = machine(random.Random(seed))
    out, torques, steps = measured(*sets(values))
    t.check(len(torques) == 3, "three drives", out)
    for node, step in zip("123", steps):
        dry, viscous = (values[f"drive.{node}.{key}"] for key in ("coulomb_friction_nm", "viscous_friction_nm_s_per_rad"))
        lead = values[f"drive.{node}.travel_per_revolution_mm"]
        for k, torque in enumerate(torques[node]):
            worst = max(worst, abs(torque - dry - viscous * k * step * 2 * math.pi / lead))
    # Fed forward, the circle is round.
    t.write("forward.ini", out)
    before, after = circle(*sets(values)), circle(*sets(values), "--machine", "forward.ini")
    off = [1000 * test["both"]["deviation_mm"] for test in (before, after)]
    spike = max(abs(1000 * r["spike_mm"]) for way in ("ccw", "cw") for r in after[way]["reversals"])
    print(f"seed {seed}: G {off[0]:.2f} um, friction fed forward {off[1]:.2f}; largest spike {spike:.2f}")
    t.check(spike <= 2, f"seed {seed}: no spike of more than 2 um is left", spike)
    t.check(off[1] < off[0], f"seed {seed}: the circle gets rounder", off)
print(f"friction is off by {1e3 * worst:.2f} mNm at most")
t.check(worst <= 2e-3 * 1.27, "friction is what the motors have", worst)

# The figures of the page.
rubbed = ("--set", "drive.1.coulomb_friction_nm=0.3", "--set", "drive.2.coulomb_friction_nm=0.3")
t.write("forward.ini", measured(*rubbed)[0])
before, after = circle(*rubbed), circle(*rubbed, "--machine", "forward.ini")
spikes = [max(abs(1000 * r["spike_mm"]) for way in ("ccw", "cw") for r in test[way]["reversals"]) for test in (before, after)]
print(f"R 50, F3000, 0.3 Nm: spikes of {spikes[0]:.1f} um, with friction fed forward {spikes[1]:.2f}")
t.check(spikes[0] > 20 and spikes[1] < 0.1, "spikes of more than 20 um go", spikes)

# Axes of all kinds.
rotary = ("--set", "axis.A.drive_node=4", "--set", "drive.4.coulomb_friction_nm=0.1")
out, torques, _ = measured("--axes", "A", *rotary)
t.check(list(torques) == ["4"] and "friction_forward_step_deg_s" in out and abs(torques["4"][0] - 0.1) < 0.003, "a rotary axis", out)
t.write("rotary.ini", "[axis A]\ndrive_node = 4\n" + out)
status, _, err = t.run("machine", "rotary.ini")
t.check(status == 0, "what is printed can stand in a machine file", err)
t.check("[drive 2]" not in measured("--axes", "XZ")[0], "axes can be chosen")
for words, told in (
    (("--axes", "Q"), "letters of axes are expected"),
    (("--axes", "B"), "axis B has no drive on CAN"),
    (("--axes", "X", "--set", "axis.X.drive_type=step"), "axis X has no drive on CAN"),
    (("-o", "no/folder/x.ini"), "no/folder"),
):
    status, _, err = t.run("friction", *words)
    t.check(status in (2, 3) and told in err, f"refused: {' '.join(words)}", status, err)
t.finish()
