"""A program planned ahead, brought to takt serve through the panel's mailbox while it runs: takt panel stream, and chunk by
chunk by a client that is late."""

import subprocess
import zlib

import panel_client as p
import takt_test as t

STARVED = 7
PROGRAM, PLAN = 0, 2
STREAM, ABANDON = 4, 3

# The controller keeps so many bytes of a plan that is not running yet: one that is shorter cannot be late.
KEPT_BYTES = 4096


def squares(count):
    return "G21 G90 G17 G64 P0.01 F3000\n" + "".join(f"G1 X{a} Y{-a}\nG1 X{a} Y{a}\nG1 X{-a} Y{a}\nG1 X{-a} Y{-a - 1}\n" for a in range(1, count + 1)) + "M2\n"


TEXT, SHORT = squares(5), squares(2)


def compiled(text, *options):
    t.write("part.ngc", text)
    status, _, err = t.run("compile", "part.ngc", "-o", "part.plan", "--quiet", *options)
    t.check(status == 0, "the program is compiled", err)
    with open("part.plan", "rb") as file:
        return file.read()


def ready(text=TEXT):
    service = p.serve()
    client = service.client()
    client.wait_for("STATE", p.IDLE)
    client.upload(text.encode())
    return service, client


def begin(client, plan):
    client.put("UPLOAD_KIND", PLAN)
    client.put("UPLOAD_SIZE", len(plan))
    client.put("UPLOAD_CRC", zlib.crc32(plan))
    return client.refusal("UPLOAD_COMMAND", STREAM)


def bring(client, plan, end):
    """What there is room for, up to a place; the exception that the last chunk gets."""
    while (at := client.counts("UPLOAD_RECEIVED")) < end:
        chunk = plan[at : min(at + 238, end)]
        try:
            client.send_chunk(at, chunk)
        except p.Refused as refused:
            return refused.code
        if client.counts("UPLOAD_ROOM") < 238:
            break
    return 0


def run_to_end(client, plan, runs):
    while client.counts("RUNS") == runs:
        if client.counts("UPLOAD_RECEIVED") < len(plan):
            bring(client, plan, len(plan))
        p.time.sleep(p.PAUSE_S)


def check_setpoints():
    """A plan that is all there when it is started: the setpoints of takt run --plan."""
    plan = compiled(SHORT)
    t.check(len(plan) <= KEPT_BYTES, "the whole plan has room", len(plan))
    status, _, err = t.run("run", "part.ngc", "--plan", "part.plan", "--quiet", "--json", "s.json")
    t.check(status == 0, "the compiled program runs", err)
    service, client = ready(SHORT)
    status, out, err = t.run("panel", "stream", "part.plan", "--connect", f"127.0.0.1:{service.port}")
    t.check(status == 0 and f"{len(plan)} bytes" in out, "the command brings all of it", status, out, err)
    runs = client.counts("RUNS")
    client.put("CYCLE_START", 1)
    client.wait_while("RUNS", runs)
    t.check(client.counts("OUTCOME") == p.COMPLETED, "it runs to its end", client.text("ALARM_TEXT"))
    t.check(client.digest() == t.load_json("s.json")["setpoint_digest"], "its setpoints are those of takt run --plan")
    service.stop()


def check_command(plan):
    """takt panel stream beside CYCLE_START, of more than is kept anywhere."""
    service, client = ready()
    runs = client.counts("RUNS")
    streaming = subprocess.Popen([t.TAKT, "panel", "stream", "part.plan", "--connect", f"127.0.0.1:{service.port}"], stdout=subprocess.PIPE, text=True)
    client.wait_for("UPLOAD_KIND", PLAN)
    client.wait_above("UPLOAD_RECEIVED", 1000)
    client.put("CYCLE_START", 1)
    client.wait_while("RUNS", runs)
    out, _ = streaming.communicate(timeout=p.PATIENCE_S)
    t.check(streaming.returncode == 0 and f"{len(plan)} bytes" in out, "the command brings all of it", streaming.returncode, out)
    t.check(client.counts("OUTCOME") == p.COMPLETED, "a streamed plan runs to its end", client.text("ALARM_TEXT"))
    service.stop()


def check_start(plan):
    """By the command itself, as on a line that has one client."""
    service, client = ready()
    runs = client.counts("RUNS")
    status, out, err = t.run("panel", "stream", "part.plan", "--start", "--connect", f"127.0.0.1:{service.port}")
    t.check(status == 0 and f"{len(plan)} bytes" in out, "--start brings and starts it", status, out, err)
    client.wait_while("RUNS", runs)
    t.check(client.counts("OUTCOME") == p.COMPLETED, "it runs to its end", client.text("ALARM_TEXT"))
    service.stop()


def check_late(plan):
    service, client = ready()
    t.check(begin(client, plan) == (0, 0), "a plan is announced")
    bring(client, plan, len(plan) // 3)
    runs = client.counts("RUNS")
    client.put("CYCLE_START", 1)
    while client.counts("UPLOAD_RECEIVED") < 2 * len(plan) // 3:
        bring(client, plan, 2 * len(plan) // 3)
        p.time.sleep(p.PAUSE_S)
    client.wait_for("ALARM", STARVED)
    t.check(client.counts("STATE") == p.RUNNING, "a late plan holds nothing")
    client.wait_for("FEED", 0)
    run_to_end(client, plan, runs)
    t.check(client.counts("OUTCOME") == p.COMPLETED, "and goes on", client.text("ALARM_TEXT"))
    service.stop()


def check_single_block(plan):
    """Each block ends in a hold, near its corner; CYCLE_START goes on."""
    service, client = ready()
    begin(client, plan)
    bring(client, plan, len(plan))
    client.put("SINGLE_BLOCK", 1)
    runs = client.counts("RUNS")
    client.put("CYCLE_START", 1)
    for number, (x, y) in enumerate(((1, -1), (1, 1), (-1, 1), (-1, -2), (2, -2)), 1):
        client.wait_for("STATE", p.HELD)
        client.wait_for("FEED", 0)
        at = client.get("POSITION_X"), client.get("POSITION_Y")
        t.check(client.counts("HOLD_REASON") == 2 and client.counts("BLOCK") == number, "a block ends in a hold", number, client.counts("BLOCK"))
        t.check(abs(at[0] - x) < 0.02 and abs(at[1] - y) < 0.02, "at its corner", number, at)
        client.put("CYCLE_START", 1)
    client.put("SINGLE_BLOCK", 0)
    if client.counts("STATE") == p.HELD:
        client.put("CYCLE_START", 1)
    run_to_end(client, plan, runs)
    t.check(client.counts("OUTCOME") == p.COMPLETED, "without it the program runs on to its end", client.text("ALARM_TEXT"))
    service.stop()


def check_refused(plan):
    service, client = ready()
    for wrong, words in ((compiled(TEXT.replace("X5", "X6")), "another program"), (compiled(TEXT, "--set", "axis.Z.max_jerk_mm_s3=30000"), "Z jerk is 30000 there and 50000 here"), (b"%" * 400, "no compiled program"), (plan[:12] + b"\1" + plan[13:], "damaged")):
        t.check(begin(client, wrong) == (0, 0), "a plan is announced", words)
        t.check(bring(client, wrong, 238) == 3, "what does not fit is refused at its header", words)
        t.check(words in client.text("UPLOAD_TEXT"), "with the reason", words, client.text("UPLOAD_TEXT"))
        t.check(client.refusal("CYCLE_START", 1) == (4, 1), "and is not started", words)
    compiled(TEXT.replace("X5", "X6"))
    status, _, err = t.run("panel", "stream", "part.plan", "--connect", f"127.0.0.1:{service.port}")
    t.check(status == 2 and "another program" in err, "takt panel stream tells it too", status, err)
    t.check(begin(client, plan) == (0, 0) and bring(client, plan, 1000) == 0, "the right one is taken then")
    client.put("UPLOAD_COMMAND", ABANDON)
    t.check(client.refusal("CYCLE_START", 1) == (4, 1), "one that has been given up is not started")
    runs = client.counts("RUNS")
    client.put("RESET", 1)
    client.put("CYCLE_START", 1)
    client.wait_while("RUNS", runs)
    t.check(client.counts("OUTCOME") == p.COMPLETED, "after RESET the program is planned as it runs")
    service.stop()


check_setpoints()
the_plan = compiled(TEXT)
t.check(len(the_plan) > 2 * KEPT_BYTES, "the other plan is more than is kept anywhere", len(the_plan))
check_command(the_plan)
check_start(the_plan)
check_late(the_plan)
check_single_block(the_plan)
check_refused(the_plan)
t.finish()
