"""The virtual spindle behind its converter's registers, on TCP and on a serial line."""

import panel_client as p
import takt_test as t

FAST = "--set", "spindle.ramp_rpm_s=200000"
COMMAND, FREQUENCY, CONTROL, ERROR, STATUS, OUTPUT, TORQUE, RPM = 0x2000, 0x2001, 0x2002, 0x2100, 0x2101, 0x2103, 0x210B, 0x210C
CUT, TRIP = 0x3000, 0x3001
STOP, FORWARD, REVERSE = 1, 0x12, 0x22


def word(client, address):
    return client.read_words(3, address, 1)[0]


def wait_for(client, address, least, most):
    p.until(
        lambda: least <= word(client, address) <= most,
        lambda: f"register {address:x} stays {word(client, address)}",
    )


service = p.Service("--spindle", "127.0.0.1:0", *FAST, command="drives")
client = service.client()
t.check(client.read_words(3, ERROR, 3) == [0, 0x0500, 0], "it stands")
client.write_words(COMMAND, [FORWARD, 20000])  # 200 Hz: 12,000 rpm
wait_for(client, RPM, 11990, 12010)
t.check(word(client, STATUS) & 0x1B == 0x03, "it runs forward", hex(word(client, STATUS)))
t.check(abs(word(client, OUTPUT) - 20000) < 20, "at the frequency asked for", word(client, OUTPUT))
client.write_words(COMMAND, [REVERSE])
wait_for(client, STATUS, 0x051B, 0x051B)
wait_for(client, RPM, 11990, 12010)
t.check(True, "it turns round")
wait_for(client, TORQUE, 0, 100)
client.write_words(CUT, [500])
wait_for(client, TORQUE, 480, 560)
t.check(True, "a cut takes torque")
client.write_words(CUT, [0])
client.write_words(TRIP, [3])
t.check(word(client, ERROR) == 3, "it trips")
wait_for(client, RPM, 0, 11900)
client.write_words(CONTROL, [2])
t.check(word(client, ERROR) == 0, "and is reset")
client.write_words(COMMAND, [STOP])
wait_for(client, RPM, 0, 0)
for function, address in ((4, ERROR), (1, 0), (3, 0x5000)):
    try:
        client.read_words(function, address, 1)
        refused = False
    except p.Refused:
        refused = True
    t.check(refused, f"function {function} at {address:x} is refused")
status, _, err, _ = service.stop()
t.check(status == 0 and err == "", "SIGTERM is status 0", status, err)

line = p.Line()
service = p.Service("--spindle", line.path, *FAST, command="drives")
t.check(line.path in service.ready, "it says where it is", service.ready)
line.ask(b"\x10\x20\x00\x00\x02\x04\x00\x12\x27\x10", 5)
p.until(lambda: line.ask(b"\x03\x21\x0c\x00\x01", 4)[2:] >= (5900).to_bytes(2, "big"), lambda: "it is too slow")
t.check(True, "it is commanded on a serial line too")
service.stop()
line.close()
t.finish()
