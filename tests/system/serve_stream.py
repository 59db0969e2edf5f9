"""A program that is run while it is uploaded: UPLOAD_COMMAND 4 of takt serve."""

import json
import math
import zlib

import panel_client as p
import takt_test as t

STREAM = 4


def wave(count):
    lines = "".join(f"X{0.2 * i:.3f} Y{2 * math.sin(0.05 * i):.3f}\n" for i in range(1, count + 1))
    return "G21 G90 G17 G64 P0.01\nG1 F6000\n" + lines + "G0 X0 Y0\nM2\n"


def run_file(text):
    t.write("part.ngc", text)
    status, out, err = t.run("run", "part.ngc", "--quiet", "--json", "-")
    t.check(status == 0, "the program runs", err)
    return json.loads(out)["setpoint_digest"]


def begin(client, data):
    client.put("UPLOAD_SIZE", len(data))
    client.put("UPLOAD_CRC", zlib.crc32(data))
    return client.refusal("UPLOAD_COMMAND", STREAM)


def bring(client, data, end):
    while (at := client.counts("UPLOAD_RECEIVED")) < end:
        client.send_chunk(at, data[at : min(at + 238, end)])


def runs_while_it_comes(client, text):
    """More lines than are looked ahead, so that it moves before the last has come."""
    data = text.encode()
    t.check(begin(client, data) == (0, 0), "a program can be streamed")
    runs = client.counts("RUNS")
    client.put("CYCLE_START", 1)
    bring(client, data, len(data) * 3 // 4)
    client.wait_above("BLOCK", 2)
    t.check(begin(client, data)[0] == 4, "and no other while it runs")
    bring(client, data, len(data))
    client.wait_while("RUNS", runs)
    t.check(client.counts("OUTCOME") == p.COMPLETED, "it comes to its end", client.text("ALARM_TEXT"))
    t.check(client.digest() == run_file(text), "its setpoints are those of takt run")
    runs = client.counts("RUNS")
    client.put("CYCLE_START", 1)
    client.wait_while("RUNS", runs)
    t.check(client.digest() == run_file(text), "and can be started again")


def is_given_up(client, text):
    data = text.encode()
    client.put("RESET", 1)
    client.wait_for("STATE", p.IDLE)
    begin(client, data)
    client.put("CYCLE_START", 1)
    bring(client, data, len(data) // 2)
    client.put("UPLOAD_COMMAND", 3)
    client.wait_for("STATE", p.ALARM)
    client.put("RESET", 1)
    client.wait_for("STATE", p.IDLE)


def no_other_upload_ends_it(client, other, text):
    data = text.encode()
    t.check(begin(client, data) == (0, 0), "a program is streamed")
    runs = client.counts("RUNS")
    client.put("CYCLE_START", 1)
    bring(client, data, len(data) * 3 // 4)
    try:
        other.begin_upload(b"M2\n")
        t.check(False, "another upload is refused while it runs")
    except p.Refused as refused:
        t.check(refused.code == 4, "another upload is refused while it runs", refused.code)
    bring(client, data, len(data))
    client.wait_while("RUNS", runs)
    t.check(client.counts("OUTCOME") == p.COMPLETED, "it comes to its end", client.text("ALARM_TEXT"))


def is_not_read_after_an_emergency_stop(client, text):
    first = b"G21 G90 F600\nG1 X20\n"
    data = first + b"G10 L2 P1 X5\n" * 30 + b"M2\n"
    begin(client, data)
    bring(client, data, len(first))
    client.put("CYCLE_START", 1)
    client.wait_for("STATE", p.RUNNING)
    client.put("EMERGENCY_STOP", 1)
    bring(client, data, len(data) - 10)
    t.check(begin(client, text.encode())[0] == 4, "nothing is streamed in an emergency stop")
    client.wait_for("STATE", p.EMERGENCY)
    p.until(lambda: client.refusal("EMERGENCY_STOP", 0) == (0, 0), lambda: "the button stays in")
    client.reset()
    t.check(client.get("WORK_OFFSET_X") == 0, "what comes after the stop is not read", client.get("WORK_OFFSET_X"))


service = p.serve()
one = service.client()
one.wait_for("STATE", p.IDLE)
runs_while_it_comes(one, wave(900))
is_given_up(one, wave(900))
is_not_read_after_an_emergency_stop(one, wave(900))
no_other_upload_ends_it(one, service.client(), wave(900))
status, _, err, _ = service.stop()
t.check(status == 0, "the service ends in order", err)
t.finish()
