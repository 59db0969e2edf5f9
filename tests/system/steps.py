"""Step drives and named interpolators: the same programs and the same feed, and what they make of it."""

import takt_test as t

PROGRAM = t.write(
    "part.ngc",
    "G21 G17 G90 F3000\nG0 X10 Y0\nG3 X10 Y0 I-10 J0\nG1 X20 Y5 Z-3\nG2 X20 Y5 I3 J4 Z5 P3\nG2 X23 Y9 R8\n"
    "G19 G3 Y9 Z5 J2 K0\nG17 G1 X0 Y0 Z0\nG64 P0.05\nG1 X5 Y5\nX10 Y0\nG0 X-3.3333 Y1.7\nM2\n")


def summary_of(*arguments, status=0):
    found, out, err = t.run("run", PROGRAM, "--json", "s.json", *arguments)
    t.check(found == status, f"{arguments}: status {status}", found, out, err)
    with open("s.json") as file:
        return t.json.load(file), out, err


# The setpoints do not depend on how they are carried; all motors end on the nearest step and miss none.
can, _, _ = summary_of()
t.check(can["step_drives"] == [] and can["interpolator"]["name"] == "exact", "no step drives by default")
for form, lag in (("even", 0.00051), ("improved", 0.004), ("plain", 0.004)):
    steps, out, _ = summary_of("--drive-type", "step", "--set", f"machine.step_form={form}")
    t.check(steps["setpoint_digest"] == can["setpoint_digest"], f"{form}: the same setpoints")
    motors = {motor["name"]: motor for motor in steps["step_drives"]}
    ends = [motors[name]["position_steps"] for name in "XYZ"]
    t.check(ends == [-3333, 1700, 0], f"{form}: they end on the nearest step", ends)
    t.check(all(motor["missed"] == 0 for motor in motors.values()), f"{form}: no step is missed", motors)
    t.check("missed_steps.X" in [check["name"] for check in steps["checks"]], f"{form}: that is a check")
    t.check(all(axis["max_following_error_mm"] < lag for axis in steps["axes"]), f"{form}: they follow", steps["axes"])
    t.check("0 missed, at most" in out, f"{form}: the summary tells of steps", out)
    # The even form steps no faster than the axis moves.
    if form == "even":
        for axis in steps["axes"]:
            rate = motors[axis["name"]]["rate_peak_hz"]
            t.check(abs(rate / (1000 * axis["max_velocity_mm_s"]) - 1) < 0.001, f"{axis['name']}: steps come evenly", rate)

# Drives of both kinds in one machine stay together.
mixed, _, _ = summary_of("--drive-type", "Y=step")
t.check([motor["name"] for motor in mixed["step_drives"]] == ["Y"], "one axis can be a step drive alone")
t.check(mixed["setpoint_digest"] == can["setpoint_digest"], "mixed: the same setpoints")
t.check(mixed["axes"][0]["max_following_error_mm"] == can["axes"][0]["max_following_error_mm"], "mixed: X as before")
t.check(mixed["bus"]["load_percent"] < can["bus"]["load_percent"], "mixed: the bus carries less")

# A motor that cannot follow: without an encoder the run ends and the check fails, with one the controller sees it.
lost, out, err = summary_of("--drive-type", "step", "--set", "stepper.X.rate_max_hz=40000", status=1)
t.check(lost["outcome"] == "faulted" and "axis X lags" in lost["fault"], "missed steps are seen by the encoder", err)
lost, out, err = summary_of("--drive-type", "step", "--set", "stepper.X.rate_max_hz=40000", "--set",
                            "stepper.X.encoder=0", status=1)
t.check(lost["outcome"] == "completed", "without an encoder nothing is seen", lost["fault"])
held = {check["name"]: check["held"] for check in lost["checks"]}
t.check(not held["missed_steps.X"] and held["missed_steps.Y"], "but the check fails", held)
t.check(lost["step_drives"][0]["missed"] > 0, "missed steps are counted", lost["step_drives"])

# Interpolators: the exact one is the default, the others say what they err by, and the judge says what that costs.
exact, _, _ = summary_of("--interpolator", "exact")
t.check(exact["setpoint_digest"] == can["setpoint_digest"], "exact is the default")
whole, _, _ = summary_of("--interpolator", "integrate")
errors = whole["interpolator"]
t.check(0 < errors["along_max_mm"] <= errors["along_bound_mm"] < 1e-6, "integrate is below its bound", errors)
t.check(all(check["held"] for check in whole["checks"]), "integrate keeps every check", whole["checks"])
turned, out, _ = summary_of("--interpolator", "rotate", status=1)
errors = turned["interpolator"]
t.check(1e-4 < errors["along_max_mm"] <= errors["along_bound_mm"] * 1.0001, "rotate: along the path", errors)
t.check(0 < errors["contour_max_mm"] <= errors["contour_bound_mm"] * 1.0001, "rotate: the contour", errors)
t.check(errors["contour_max_mm"] < errors["along_max_mm"] / 50, "the contour errs by far less", errors)
held = {check["name"]: check["held"] for check in turned["checks"]}
t.check(held["landing"] and not held["jerk.X"], "ends are set right, at the cost of a jerk", held)

for words, said in (
    (["--drive-type", "stp"], "can or step is expected"),
    (["--drive-type", "Q=step"], "the machine has no axis 'Q'"),
    (["--drive-type", "A=step"], "the machine has no axis 'A'"),
    (["--drive-type", "=step"], "the machine has no axis ''"),
    (["--drive-type", "X="], "can or step is expected"),
    (["--interpolator", "rotat"], "exact, integrate or rotate"),
    (["--set", "machine.step_form=fancy"], "even, improved or plain"),
    (["--drive-type", "step", "--set", "axis.X.steps_per_mm=2500"], "250000 Hz, above its step_rate_max_hz"),
    (["--set", "axis.X.steps_per_mm=0"], "above 0"),
    (["--set", "stepper.A.encoder=0"], "comes after its axis"),
    (["--set", "stepper.X.encoder=2"], "at most 1"),
):
    status, out, err = t.run("run", PROGRAM, *words)
    t.check(status == 2 and said in err, f"{' '.join(words)}: refused", status, err)

# What is printed reads as the same machine.
status, out, _ = t.run("machine", "--set", "axis.Y.drive_type=step", "--set", "machine.interpolator=rotate")
t.check("drive_type = step" in out and "interpolator = rotate" in out and "[stepper Y]" in out, "keys are printed", out)
t.check(t.run("machine", t.write("again.ini", out))[1] == out, "and read again")
t.finish()
