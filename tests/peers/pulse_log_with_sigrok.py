"""sigrok reads the pulses of step drives: its decoder of step and direction comes to the positions of the motors."""

import os
import re
import shutil
import subprocess
import sys

sys.path.insert(0, os.path.join(os.environ["TAKT_SOURCE"], "tests", "system"))

import takt_test as t

if not shutil.which("sigrok-cli"):
    t.skip("sigrok-cli is not installed; tests/run --all does it")

PROGRAM = t.write("part.ngc", "G21 G90 F3000\nG0 X10.0004 Y-2\nG1 X12.1 Y5 Z-3.017\nG2 X12.1 Y5 I1 J0\nM2\n")
EVERY_NS = 100  # of the samples it takes; a step line is high for 2500 ns

for form in "even", "improved", "plain":
    status, _, err = t.run("run", PROGRAM, "--drive-type", "step", "--set", f"machine.step_form={form}", "--quiet",
                           "--pulse-log", "part.vcd", "--json", "run.json")
    t.check(status == 0, f"{form}: a log is written", err)
    for motor in t.load_json("run.json")["step_drives"]:
        lines = f"stepper_motor:step={motor['name']}_step:dir={motor['name']}_dir"
        done = subprocess.run(["sigrok-cli", "-I", f"vcd:downsample={EVERY_NS}", "-i", "part.vcd", "-P", lines, "-A", "stepper_motor=position"],
                              capture_output=True, text=True, check=False)
        # It tells the position at each step but the first: what the steps before have made.
        found = [int(place) for place in re.findall(r": (-?\d+) steps", done.stdout)]
        t.check(done.returncode == 0 and len(found) == motor["steps"] - 1, f"{form}: sigrok sees every step", motor, len(found), done.stderr)
        near = found and abs(found[-1] - motor["position_steps"]) == 1
        t.check(near, f"{form}: and comes to where the motor stands, but for the last step", motor, found[-1:])
t.finish()
