"""What can be read but not run in full says so: probing where there is nothing to touch, threads without an encoder."""

import json

import takt_test as t

path = t.write("probe.ngc", "G21 F600\nG0 X1\nG38.2 Z-2\nG0 X5\nM2\n")
status, _, err = t.run("check", path)
t.check(status == 0, "probing can be checked", err)
status, _, err = t.run("run", path, "--json", "probe.json")
t.check(status == 1, "probing that must make contact fails without a probe", status)
t.check("probe.ngc:3:1: error: the probing move ended without contact" in err, "and says where", err)
with open("probe.json") as file:
    summary = json.load(file)
t.check(summary["outcome"] == "faulted", "the run is faulted", summary["outcome"])
t.check(abs(summary["path_length_mm"] - 3.0) < 1e-9, "after the probing move", summary["path_length_mm"])

path = t.write("thread.ngc", "G21 M3 S300\nG0 Z5\nG33 Z-5 K1\nG33 Z-6 K1\nM2\n")
status, _, err = t.run("run", path, "--quiet")
t.check(status == 0 and err == "", "threads follow the spindle's encoder", status, err)
status, _, err = t.run("run", path, "--quiet", "--set", "spindle.encoder_counts_per_revolution=0")
t.check(status == 2 and "thread.ngc:3:1: error: 'G33' needs a spindle with an encoder" in err, "or are refused", status, err)

t.finish()
