"""A drive that its maker's tool has set up, by a configuration file (DCF), is looked at and told nothing."""

import os
import re

import data_sheets
import takt_test as t

POCKET = os.path.join(t.EXAMPLES, "pocket.ngc")
NODES = (1, 2, 3)

# What the tool has set, beside PDOs of their own: a target in RPDO2, statusword and position in TPDO1 of every SYNC.
SET = {"1006": "1000", "1016sub1": str(127 << 16 | 300), "1017": "100", "1402sub2": "1", "1802sub2": "1"}


def configuration(name, values):
    """Our own data sheet as a DCF: defaults that are of no use, and what the tool has set."""
    sheet = data_sheets.read("own.eds")
    sheet["DeviceComissioning"] = {"NodeID": "1", "NodeName": "axis"}
    for section, value in values.items():
        sheet[section]["DefaultValue"] = "0"
        sheet[section]["ParameterValue"] = value
    return data_sheets.write(name, sheet)


def run(name, path, *settings):
    words = [f"drive.{node}.eds={path}" for node in NODES] + [f"axis.{axis}.drive_is_set_up=1" for axis in "XYZ"] + list(settings)
    options = [word for setting in words for word in ("--set", setting)]
    status, _, err = t.run("run", POCKET, "--quiet", "--json", name + ".json", "--bus-log", name + ".log", *options)
    return status, err, t.load_json(name + ".json") if os.path.exists(name + ".json") else None


def written(path):
    """Objects that the controller has written by SDO."""
    frames = (line.split()[2] for line in open(path))
    requests = (m for m in (re.fullmatch(r"60[1-3]#2([0-9A-F])(..)(..)(..)........", frame) for frame in frames) if m)
    return {m[3] + m[2] for m in requests}


t.check(t.run("drives", "--nodes", "1", "--eds", "own.eds")[0] == 0, "our own data sheet is written")
status, _, _ = t.run("run", POCKET, "--quiet", "--json", "plain.json")
digest = t.load_json("plain.json")["setpoint_digest"]

status, err, summary = run("configured", configuration("set.dcf", SET))
if t.check(status == 0 and summary, "drives of a configuration run", err):
    t.check(summary["setpoint_digest"] == digest, "with the setpoints of our own")
    t.check(written("configured.log") <= {"6040", "6060"}, "nothing is written but controlword and mode", written("configured.log"))
    lost = {name for drive in summary["drives"] for name in drive["given_up"]}
    t.check("heartbeat" not in lost and "watch" not in lost, "what the tool has set is found", lost)

status, err, summary = run("bare", configuration("bare.dcf", {**SET, "1016sub1": "0"}))
if t.check(status == 0 and summary, "drives that do not watch the controller run", err):
    lost = {name for drive in summary["drives"] for name in drive["given_up"]}
    t.check("watch" in lost, "what the tool has not set is told", lost)

status, err, _ = run("wrong", configuration("wrong.dcf", {**SET, "60C2sub1": "5"}))
t.check(status == 1 and "60C2" in err, "what does not fit is refused by its object", status, err)
t.finish()
