"""takt serve with correction tables: the position shown stays that of the program, the drives go where the tables say, and layers
are switched by panel, program and machine file."""

import os

import panel_client as p
import takt_test as t

WORN = os.path.join(t.EXAMPLES, "worn_mill.ini")
VOLUME = ("--machine", WORN, "--set", "correction.volume_table=volume.csv", "--set", "correction.fade_s=0.4")
PLACE = {"X": 150, "Y": 100, "Z": 50}


def ready(*options):
    service = p.serve(*options)
    client = service.client()
    client.wait_for("STATE", p.IDLE)
    return service, client


def correction(client):
    """What the drives are off the position shown, mm."""
    return [client.get(f"ACTUAL_{axis}") - client.get(f"POSITION_{axis}") for axis in "XYZ"]


def wait_for_correction(client, wanted, claim):
    """Until it is there, to the resolution of the registers; drives rest within theirs."""
    p.until(
        lambda: all(abs(a - b) <= 0.0021 for a, b in zip(correction(client), wanted)),
        lambda: f"{claim}: {correction(client)}, {wanted} expected",
    )


def go(client):
    runs = client.counts("RUNS")
    client.put("MODE", 1)
    client.put_text("MDI_TEXT", "G0 " + " ".join(f"{axis}{value}" for axis, value in PLACE.items()))
    client.put("MDI_START", 1)
    client.wait_while("RUNS", runs)


status, _, err = t.run("calibrate", "--machine", WORN, "--grid", "5x4x4", "-o", "volume.csv")
t.check(status == 0, "the volume is measured", err)
t.write("place.ngc", "G0 " + " ".join(f"{axis}{value}" for axis, value in PLACE.items()) + "\nM2\n")
status, out, err = t.run("correct", "place.ngc", "--machine", WORN, "--table", "volume.csv", "--quiet")
t.check(status == 0, "the offline way tells what to expect", err)
k = [float(word[1:]) - PLACE[word[0]] for word in out.splitlines()[0].split()[1:]]
t.check(max(map(abs, k)) > 0.01, "which is more than the resolution", k)
NONE = [0, 0, 0]

# ---- a table named by the machine file, switched by the panel and by a program

service, client = ready(*VOLUME)
t.check(client.counts("CORRECTION_VOLUME") == 1, "a layer is on unless somebody switches it off")
go(client)
wait_for_correction(client, k, "the drives go where the table says")
t.check(client.get("POSITION_X") == PLACE["X"], "the position shown is that of the program")
client.put("CORRECTION_VOLUME", 0)
wait_for_correction(client, NONE, "the panel takes the layer out while the axes stand")
client.put("CORRECTION_VOLUME", 1)
wait_for_correction(client, k, "and brings it back")
client.put("MODE", 0)
t.check(client.run(b"G21\nM121 P4\nG1 X149 F6000\nG1 X150\nG4 P1.5\nM2\n") == p.COMPLETED, "a program runs without a layer")
t.check(all(abs(value) <= 0.0021 for value in correction(client)), "which it has taken out", correction(client))
t.check(client.run(b"G21\nG1 X149 F6000\nG1 X150\nG4 P1.5\nM2\n") == p.COMPLETED, "the next one has it again")
wait_for_correction(client, k, "with all layers on")
client.put("MODE", 2)
client.put("JOG_AXIS", 0)
client.put("JOG_FEED", 1000)
client.put("JOG_DISTANCE", 0.002)
runs = client.counts("RUNS")
client.put("JOG_PLUS", 1)
client.wait_while("RUNS", runs)
wait_for_correction(client, k, "a jog changes nothing about it")
status, _, err, _ = service.stop()
t.check(status == 0 and err == "", "it ends without a complaint", status, err)

# ---- switched off by the machine file until somebody switches it on

service, client = ready(*VOLUME, "--set", "correction.off=volume")
t.check(client.counts("CORRECTION_VOLUME") == 0, "the panel shows what the machine file has switched off")
go(client)
wait_for_correction(client, NONE, "nothing is corrected then")
client.put("CORRECTION_VOLUME", 1)
wait_for_correction(client, k, "until the panel switches it on")
service.stop()

# ---- a broken table

with open("volume.csv") as file:
    lines = file.read().splitlines()
lines[40] = lines[40].rsplit(",", 1)[0] + ",nan"
t.write("volume.csv", "\n".join(lines[:-1]) + "\n")
status, out, err = t.run("serve", "--listen", "127.0.0.1:0", *VOLUME)
t.check(status == 2 and out == "" and "volume.csv:41:" in err and "nan" in err, "a broken table is refused with its cell", status, err)
t.finish()
