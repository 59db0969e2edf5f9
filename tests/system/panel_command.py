"""takt panel: the panel of a running controller by the names of its registers; its table as documentation."""

import os
import struct
import subprocess

import data_sheets
import panel_client as p
import takt_test as t

for form, name in (("markdown", "registers.md"), ("csv", "registers.csv")):
    status, out, err = t.run("panel", "table", form)
    with open(os.path.join(t.SOURCE, "firmware", "panel", name)) as file:
        t.check(status == 0 and out == file.read(), f"firmware/panel/{name} is what takt panel table {form} prints", err)
status, out, err = t.run("panel", "list")
t.check(status == 0 and all(name in out for name in p.REGISTERS), "list names every register", err)

line = p.Line()
service = p.Service("--listen", "127.0.0.1:0", "--serial", line.path + ",9600,odd")
service.client().wait_for("STATE", p.IDLE)
PLACE = "--connect", f"127.0.0.1:{service.port}"


def panel(*words):
    return t.run("panel", *words, *PLACE)


def check_says(words, said, status=0):
    got, out, err = panel(*words)
    t.check(got == status and said in (out if status == 0 else err), f"panel {' '.join(words)}: {said}", got, out, err)


check_says(["read", "STATE", "feed_override", "POSITION_X"], "STATE = 1\nFEED_OVERRIDE = 100.0 %\nPOSITION_X = 0.000 mm\n")
check_says(["write", "FEED_OVERRIDE", "82.5"], "")
check_says(["read", "FEED_OVERRIDE"], "FEED_OVERRIDE = 82.5 %")
check_says(["write", "MDI_TEXT", "G0 X7"], "")
check_says(["read", "MDI_TEXT"], "MDI_TEXT = G0 X7\n")
check_says(["watch", "STATE", "AXES", "--count", "2", "--interval", "0.01"], "STATE=1  AXES=7\nSTATE=1  AXES=7\n")
check_says(["watch", "--count", "1"], "STATE=1  ACTIVE_LINE=0  POSITION_X=0.000")

t.write("part.ngc", "G21 G90 F3000\nG1 X2\nM2\n" + "(" + "x" * 200 + ")\n" * 20)
check_says(["upload", "part.ngc"], "part.ngc: ")
check_says(["read", "PROGRAM_SIZE"], f"PROGRAM_SIZE = {os.path.getsize('part.ngc')} byte")
check_says(["write", "CYCLE_START", "1"], "")
service.client().wait_for("RUNS", 1)
check_says(["read", "OUTCOME", "POSITION_X"], "OUTCOME = 1\nPOSITION_X = 2.000 mm")

check_says(["read", "FEED_OVERIDE"], "did you mean FEED_OVERRIDE?", 2)
check_says(["write", "FEED_OVERRIDE", "130"], "from 0.0 to 120.0 is expected", 2)
check_says(["write", "FEED_OVERRIDE", "much"], "a number", 2)
check_says(["write", "STATE", "1"], "cannot be written", 2)
check_says(["write", "RESUME", "1"], "exception 04: not in the state", 2)
check_says(["write", "MODE"], "a value", 2)
check_says(["read"], "missing", 2)
check_says(["raed", "STATE"], "did you mean read?", 2)
check_says(["upload", "nothing.ngc"], "nothing.ngc", 2)
check_says(["table", "html"], "markdown or csv", 2)
check_says(["read", "STATE", "--unit", "300"], "--unit", 2)
status, _, err = t.run("panel", "read", "STATE", "--connect", "127.0.0.1:1", "--timeout", "1")
t.check(status == 3 and "no panel at 127.0.0.1:1" in err, "where no panel is: status 3", status, err)
status, _, err = t.run("panel", "read", "STATE", "--connect", "nowhere")
t.check(status == 2 and "HOST:PORT" in err, "a place that is none", status, err)
service.stop()

# What is given up is told in words.
t.check(t.run("drives", "--nodes", "1", "--eds", "own.eds")[0] == 0, "our own data sheet is written")
sheet = data_sheets.read("own.eds")
data_sheets.velocity_only(sheet, None)
data_sheets.no_event_timer(sheet, None)
service = p.Service("--listen", "127.0.0.1:0", "--set", "drive.1.eds=" + data_sheets.write("velocity.eds", sheet))
service.client().wait_for("STATE", p.IDLE)
PLACE = "--connect", f"127.0.0.1:{service.port}"
check_says(["read", "DRIVES_GIVEN_UP"], "\n  1801:05         the error code is told once, when it changes\n"
           "  6502            a mode of velocity: the controller closes the position loop\n")
service.stop()
line.close()



def check_pause():
    """A controller that pauses within its answer is waited for, and the rest is not taken for the next answer."""
    line = p.Line()
    asking = subprocess.Popen([t.TAKT, "panel", "read", "STATE", "--serial", line.path + ",115200,none", "--timeout", "60"],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    t.check(line.receive(8)[:2] == b"\1\4", "a register is asked for")
    answer = b"\1\4\2\0\1"
    answer += struct.pack("<H", p.crc16(answer))
    line.send(answer[:4])
    try:
        asking.wait(1)  # s; libmodbus waits half of it if it is not told
    except subprocess.TimeoutExpired:
        pass
    line.send(answer[4:])
    out, err = asking.communicate()
    t.check(asking.returncode == 0 and out == "STATE = 1\n", "a pause within an answer is borne", asking.returncode, out, err)
    line.close()


check_pause()

for options, status, said in (
    (["--listen", "nowhere"], 2, "HOST:PORT"),
    (["--listen", "127.0.0.1:1502x"], 3, "127.0.0.1"),
    (["--serial", "/no/such/line"], 2, "/no/such/line"),
    (["--serial", "/dev/null,77"], 2, "PATH,BAUD"),
    (["--unit", "0.5"], 2, "--unit"),
    (["--set", "panel.allow=somewhere"], 2, "'somewhere' is no address"),
    (["--program", "nothing.ngc"], 2, "nothing.ngc"),
    (["--bus", "canbus:0"], 2, "unknown kind"),
    (["extra"], 2, "one argument too many"),
):
    got, out, err = t.run("serve", *options)
    t.check(got == status and out == "" and said in err, f"serve {' '.join(options)}: refused", got, out, err)
t.finish()
