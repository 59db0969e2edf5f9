"""The page in the browser, as anything on its port sees it: what is shown, orders and their rules, dead-man, strangers."""

import json
import os
import random
import struct
import sys
import zlib

import page_client as w
import panel_client as p
import takt_test as t

PROGRAM = b"G21 G90 G61 F1800\nG1 X3 Y2\nG2 X5 Y0 I0 J-2\nG1 X0\nG0 Z1\nM2\n"

# A page that is gone moves nothing after so many cycles of 1 ms: the watchdog of the page (jog.js), and braking.
WATCHDOG_MS = 120
REST_MS = 300

# More connections than the page takes at once.
CROWD = 700

STRANGERS = int(sys.argv[1]) if len(sys.argv) > 1 else 25


def digest_of(program):
    """Of takt run."""
    path = t.write("program.ngc", program)
    return json.loads(t.run("run", path, "--json", "-", "--quiet")[1])["setpoint_digest"]


def check_files(port):
    status, headers, body = w.get(port)
    t.check(status == 200 and b"main.js" in body, "the page is there", status)
    policy = headers["content-security-policy"]
    t.check("default-src 'none'" in policy and "frame-ancestors 'none'" in policy, "with a content security policy", policy)
    for path in ("/main.js", "/view.js", "/style.css", "/link.js"):
        t.check(w.get(port, path)[0] == 200, f"{path} is there")
    t.check(b"http://" not in body and b"https://" not in body, "the page asks nothing of others")
    for path in ("/nothing", "/../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd", "/main.js/"):
        t.check(w.get(port, path)[0] in (400, 403, 404), f"there is no {path}")
    for method in ("POST", "PUT", "DELETE", "OPTIONS"):
        t.check(w.get(port, method=method, extra="Content-Length: 0\r\n")[0] in (0, 403, 404, 405), f"{method} does nothing")


def check_names(port):
    for host in ("evil.example", "evil.example:8080", "localhost.evil.example", "127.0.0.1.evil.example", "x" * 300):
        t.check(w.get(port, host=host)[0] in (0, 403), f"nothing for {host[:40]}")
        connection, _, status = w.upgrade(port, host=host)
        t.check(status != 101, f"no connection for {host[:40]}", status)
        connection.close()
    t.check(w.get(port, host=f"localhost:{port}")[0] == 200, "localhost is a name of this computer")
    for origin in ("", "null", "http://evil.example", f"http://127.0.0.1:{port + 1}", f"http://127.0.0.1:{port}.evil.example"):
        connection, _, status = w.upgrade(port, origin=origin)
        t.check(status != 101, f"no connection for a page of '{origin}'", status)
        connection.close()


def check_frames(service, page, client):
    """All registers, as Modbus has them."""
    page.wait_for("STATE", p.IDLE)
    for name in ("STATE", "AXES", "POSITION_X", "WORK_POSITION_Z", "FEED_OVERRIDE", "MODES", "PROGRAM_SIZE"):
        t.check(page.counts(name) == client.counts(name), f"{name} as Modbus has it", page.counts(name))
    numbers = [page.next_frame()["n"] for _ in range(20)]
    t.check(all(b > a for a, b in zip(numbers, numbers[1:])), "frames follow each other", numbers)
    t.check(page.hello["axes"][0][0] == 100 and page.hello["axes"][3] is None, "limits of the axes that are there")
    tables = page.wait_other("tables")["tables"]
    t.check(len(tables["systems"]) == 9, "nine work offsets")
    responses = page.wait_other("bus")["bus"]["responses"]
    t.check(len(responses) > 3 and all(0 < us < 1000 for _, us in responses), "response times of the bus", responses)


def check_program(service, page):
    digest = digest_of(PROGRAM)
    t.check(page.upload(PROGRAM) == "", "a program is taken")
    t.check(w.get(service.page_port, "/program")[2] == PROGRAM, "its text is there")
    path = page.wait_other("path")["path"]
    while path[:2] != [len(PROGRAM), zlib.crc32(PROGRAM)]:
        path = page.wait_other("path")["path"]
    points = list(struct.iter_unpack("<fffII", w.get(service.page_port, "/path")[2]))
    t.check(len(points) == path[2] and points[-1][:4] == (0, 0, 1, 5) and points[1][:4] == (3, 2, 0, 2), "its way is there", points[-1])
    peaks = run(page)
    t.check(page.counts("OUTCOME") == p.COMPLETED, "it runs")
    got = f"{page.counts('DIGEST_HIGH') << 32 | page.counts('DIGEST_LOW'):016x}"
    t.check(got == digest, "with the setpoints of takt run", got)
    limits = page.hello["axes"]
    for axis in range(3):
        for kind, slack in ((0, 1.0001), (1, 1.0001), (2, 1.001)):
            t.check(0 < peaks[axis][kind] <= slack * limits[axis][kind], f"axis {axis}: peak {kind} within its limit", peaks[axis][kind])
    t.check(page.upload(b"G1 X") == "" and w.get(service.page_port, "/program")[2] == b"G1 X", "another one replaces it")
    t.check(page.order({"upload": [5, 1]}) == "" and page.order({"commit": 1}) == "not in this state", "half an upload is none")


def run(page):
    """CYCLE_START to the end; the peaks of each axis over all frames."""
    runs = page.counts("RUNS")
    t.check(page.write(["MODE", 0], ["CYCLE_START", 1]) == "", "it starts")
    peaks = [[0] * 4 for _ in range(6)]
    while page.counts("RUNS") == runs:
        page.next_frame()
        peaks = [[max(a, abs(b)) for a, b in zip(*pair)] for pair in zip(peaks, page.frame["x"])]
    return peaks


def check_orders(page, client):
    t.check(page.write(["MODE", 1], ["MDI_TEXT", "G0 X1 Y2"], ["MDI_START", 1]) == "", "a line by hand")
    page.wait_for("STATE", p.IDLE)
    t.check((page.value("POSITION_X"), page.value("POSITION_Y")) == (1, 2), "it moves")
    t.check(page.write(["WORK_SYSTEM", 2], ["WORK_OFFSET_X", 1500]) == "" and client.get("WORK_OFFSET_X") == 1.5, "a work offset")
    tables = page.wait_other("tables")["tables"]
    while tables["systems"][1][0] != 1.5:
        tables = page.wait_other("tables")["tables"]
    for pairs, reason in (
        ([["CYCLE_START", 1]], "not in this state"), ([["FEED_OVERRIDE", 1201]], "the value is out of range"), ([["FEED_OVERRIDE", 1.5]], "the value is out of range"),
        ([["FEED_OVERRIDE", -1]], "the value is out of range"), ([["MODE", 1e300]], "the value is out of range"), ([["MODE", "1"]], "the text is too long"), ([["NOTHING", 1]], "no such register"), ([["STATE", 1]], "no such register"),
        ([["MDI_TEXT", "x" * 241]], "the text is too long"), ([["UPLOAD_DATA", 1]], "the value is out of range"), ([[]], "no such register"), ([5], "no such register"),
    ):
        t.check(page.write(*pairs) == reason, f"{pairs}: {reason}", page.write(*pairs))
    t.check(page.order({"sing": 1}) == "this order is not known", "an order that is not known")


def check_operators(service, page, client):
    other = w.Page(service.page_port)
    t.check(page.write(["WATCHDOG", 5000]) == "", "control is claimed")
    t.check(other.write(["FEED_OVERRIDE", 500]) == "another panel has control", "another page is refused")
    t.check(other.order({"fault": "drive 1 warn code=4310"}) == "another panel has control", "its faults, too")
    t.check(client.refusal("FEED_OVERRIDE", 50) == (6, 3), "another panel is refused")
    t.check(page.sees_control(1) and other.sees_control(2), "each knows who has control", (page.frame["c"], other.frame["c"]))
    t.check(other.write(["EMERGENCY_STOP", 1]) == "", "anybody may stop at once")
    page.wait_for("STATE", p.EMERGENCY)
    t.check(page.write(["EMERGENCY_STOP", 0], ["WATCHDOG", 0]) == "", "released by who has control")
    client.reset()
    other.close()


def jog(page):
    """Whether it has come to its feed; on a busy computer a sign of life may come later than the watchdog."""
    pairs = (["WATCHDOG", WATCHDOG_MS], ["MODE", 2], ["JOG_AXIS", 0], ["JOG_FEED", 6000], ["JOG_DISTANCE", 0], ["JOG_PLUS", 1])
    t.check(page.write(*pairs) == "", "jog")
    page.next_frame()
    page.next_frame()  # the one under way may be older
    while page.counts("AXIS_FEED_X") < 5990000 and page.counts("ALARM") == 0:
        page.send({"alive": 1})
        page.next_frame()
    return page.counts("ALARM") == 0


def look_at_motion(client):
    """Cycles and the feed of X, of one cycle."""
    first = int(p.REGISTERS["CYCLES"]["address"])
    at = int(p.REGISTERS["AXIS_FEED_X"]["address"]) - first
    words = client.read_words(4, first, at + 2)
    return words[0] << 16 | words[1], words[at] << 16 | words[at + 1]


def moves_for(client, began):
    """Cycles from then to the last in which the axis is seen in motion. Who looks late, on a busy computer, sees no more of it."""
    last, feed = began, 1
    while feed != 0:
        cycles, feed = look_at_motion(client)
        last = cycles if feed != 0 else last
    return last - began


def back_to_the_start(client):
    client.wait_for("STATE", p.IDLE, p.HELD)
    client.wait_for("CONTROL", 0)
    client.reset()
    client.run_line("G0 X0")


def check_dead_man(service, client):
    for how in "the page is closed", "the network is cut":
        page = w.Page(service.page_port)
        while not jog(page):
            back_to_the_start(client)
        began, _ = look_at_motion(client)
        if how == "the page is closed":
            page.close()
        moved = moves_for(client, began)
        t.check(moved <= REST_MS, f"{how}: the axis rests within {REST_MS} ms", moved)
        print(f"{how} while jogging at 100 mm/s: in motion for {moved} ms")
        page.close()
        back_to_the_start(client)


def check_drives(service, page, client):
    page.send({"watch": 0})
    rows = page.wait_other("objects")["rows"]
    page.other.pop("values", None)
    values = page.wait_other("values")["v"]
    objects = {(row[0], row[1]): value for row, value in zip(rows, values)}
    t.check(len(rows) > 80 and objects[(0x6041, 0)] & 0x6F == 0x27, "a drive's dictionary, with its statusword", len(rows))
    t.check(page.order({"set": [0, 0x1017, 0, 777]}) == "", "an object is written")
    t.check(page.order({"set": [0, 0x6041, 0, 0]}) == "the drive does not take it", "one that can only be read is not")
    for wrong in ([9, 0x1017, 0, 1], [0, 0x9999, 0, 1], [-1, 0, 0, 0], ["x"], [0, 0x1017, 0, 1e99], []):
        t.check(page.order({"set": wrong}) != "", f"{wrong} is refused")
    t.check("wet" in page.order({"fault": "drive 1 wet"}), "a fault that is not known is refused")
    t.check(page.order({"fault": "drive 1 emcy code=4310\npower drive 2 emcy code=4310"}) == "one fault is expected", "one at a time")
    t.check(page.order({"fault": "drive 2 emcy code=4310"}) == "", "a drive fails")
    page.wait_for("STATE", p.ALARM)
    t.check("Y" in page.frame["a"], "the alarm says which", page.frame["a"])
    faults = page.wait_other("bus")["bus"]["faults"]
    while not faults:
        faults = page.wait_other("bus")["bus"]["faults"]
    t.check(faults == [["emcy", 2, True]], "faults are listed", faults)
    client.reset()
    t.check(page.order({"fault": "bus corrupt ratio=0.01 seed=3 for=60s"}) == "" and page.order({"clear": 1}) == "", "faults of the bus come and go")
    page.send({"watch": -1})


HEAD = b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n"
MASK = b"\0\0\0\0"


def hostile_request(random_numbers):
    """Bytes in place of a request; none of them is one that is answered with more than a page."""
    return random_numbers.choice((
        random_numbers.randbytes(random_numbers.randrange(1, 3000)),
        HEAD + b"X: " + b"y" * random_numbers.choice((5000, 70000)),
        HEAD + b"".join(b"X%d: y\r\n" % i for i in range(random_numbers.choice((100, 3000)))) + b"\r\n",
        HEAD[: random_numbers.randrange(1, len(HEAD))],  # and no more
        HEAD + b"Host: evil.example\r\nHost: 127.0.0.1\r\n\r\n",
        (HEAD + b"\r\n") * 200,  # one behind the other
        b"POST /live HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 99999999999999999999\r\n\r\n" + b"z" * 5000,
        b"POST / HTTP/1.1\r\nHost: 127.0.0.1\r\nTransfer-Encoding: chunked\r\n\r\nffffffffffffffff\r\n" + b"z" * 500,
        b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" + random_numbers.randbytes(100),
        b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc" + random_numbers.randbytes(500),  # TLS
        HEAD + b"Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 7\r\nSec-WebSocket-Key: ?\r\n\r\n",
        b"GET /" + b"../" * 2000 + b" HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n",
    ))


def hostile_frames(random_numbers):
    """Bytes in place of the frames of a WebSocket."""
    data = bytearray(json.dumps({"id": 1, "write": [["JOG_FEED", 5], ["MDI_TEXT", "G0 X1"]]}).encode())
    for _ in range(3):
        data[random_numbers.randrange(len(data))] = random_numbers.randrange(256)
    size = len(data)
    return random_numbers.choice((
        bytes([random_numbers.choice((0x81, 0x82, 0x01, 0x80, 0xF1)), 0x80 | size]) + MASK + bytes(data),
        bytes([0x81, size]) + bytes(data),  # not masked
        b"\x81\xff" + b"\xff" * 8 + MASK + bytes(data),  # 2^64 - 1 bytes
        b"\x81\xff\0\0\0\1\0\0\0\0" + MASK + bytes(data),  # 4 GiB
        b"\x01\x81" + MASK + b"{" + (b"\x00\x81" + MASK + b" ") * 5000,  # one byte a piece, without an end
        (b"\x01\x80" + MASK) * 500,  # a message in a message
        b"\x89\xfe\x04\x00" + MASK + b"p" * 1024,  # a ping that is too long
        (b"\x89\x84" + MASK + b"ping") * 3000,
        b"\x88\x82" + MASK + random_numbers.randbytes(2) + b"\x81\x82" + MASK + b"{}",  # closed, and goes on
        b"\x81\x84" + MASK + b"\xff\xfe\xc0\x80",  # no UTF-8
        b"\x83\x80" + MASK + b"\x8b\x80" + MASK,  # opcodes that are not used
        random_numbers.randbytes(random_numbers.randrange(1, 2000)),
    ))


def hostile(port, random_numbers):
    """Something no browser sends. Returns the connection: it may stay open."""
    kind = random_numbers.randrange(5)
    if kind < 2:
        connection = w.connect(port)
        connection.sendall(hostile_request(random_numbers))
        return connection
    page = w.Page(port)
    if kind == 2:
        page.send(random_numbers.choice((b"[" * random_numbers.choice((10, 5000, 60000)), b"{" + b" " * 200000)))
    else:
        page.socket.sendall(hostile_frames(random_numbers))
    return page.socket


def check_strangers(service, client):
    """Beside a program: it sees nothing of them."""
    program = b"G64\nG21 F6000\n" + b"G1 X8 Y1\nG1 X0 Y0\nG2 X0 Y0 I2 J0\n" * 3 + b"M2\n"
    digest = digest_of(program)
    client.run_line("G0 X0 Y0 Z0")
    client.upload(program)
    client.put("FEED_OVERRIDE", 100)
    client.put("MODE", 0)
    runs = client.counts("RUNS")
    client.put("CYCLE_START", 1)
    random_numbers = random.Random(22)
    open_ones = []
    for _ in range(STRANGERS):
        try:
            open_ones.append(hostile(service.page_port, random_numbers))
        except (ConnectionError, OSError, AssertionError):
            pass
        if len(open_ones) > 30:
            open_ones.pop(0).close()
        client.put("FEED_OVERRIDE", 100)
    client.wait_while("RUNS", runs)
    t.check(client.counts("OUTCOME") == p.COMPLETED, "the program ends well beside strangers")
    for connection in open_ones:
        connection.close()
    page = w.Page(service.page_port)
    t.check(page.next_frame() is not None, "the service still shows the machine")
    page.close()
    t.check(client.digest() == digest, "and its setpoints are those of takt run", client.digest())


def check_crowd(service):
    """Of those who only connect there are so many at most that others of the service have files left."""
    page = w.Page(service.page_port)
    crowd = [w.connect(service.page_port) for _ in range(CROWD)]
    for connection in crowd:
        connection.sendall(HEAD[:9])
    p.until(lambda: open_files(service) > CROWD / 2, lambda: f"{open_files(service)} files are open")
    page.next_frame()
    panel = service.client()
    t.check(panel.counts("STATE") == p.IDLE, "a panel that comes is answered")
    t.check(open_files(service) < CROWD, "the page has taken no more than its part of the files", open_files(service))
    for connection in (*crowd, panel, page):
        connection.close()
    again = w.Page(service.page_port)
    t.check(again.next_frame() is not None, "a page that comes after them is shown the machine")
    again.close()


def open_files(service):
    return len(os.listdir(f"/proc/{service.process.pid}/fd"))


def check_view():
    """A trace played back: faster, with the peaks of the run; nothing else is taken."""
    t.run("run", t.write("program.ngc", PROGRAM), "--trace", "program.csv", "--quiet")
    columns = t.read_trace("program.csv")
    viewer = p.Service("program.csv", "program.ngc", "--http", "127.0.0.1:0", "--speed", "20", command="view")
    page = w.Page(viewer.port)
    page.wait_for("STATE", p.IDLE)
    t.check(abs(page.value("POSITION_Z") - columns["set_Z_mm"][-1]) < 1e-3, "it comes to the end of the trace", page.value("POSITION_Z"))
    peaks = run(page)
    most = t.peaks(columns["set_X_mm"], 0.001)
    t.check(all(abs(a - b) <= 1e-4 * b for a, b in zip(peaks[0], most)), "with the peaks of the run", peaks[0], most)
    t.check(page.write(["MDI_START", 1]) == "not in this state" and page.write(["MODE", 2]) == "not in this state", "there is nothing to move")
    t.check(page.upload(PROGRAM) == "the value is out of range", "nor to load")
    status, _, _ = w.get(viewer.port, "/path")
    t.check(status == 200, "its way is there")
    page.close()
    t.check(viewer.stop()[0] == 0, "a signal ends it")
    for bad in (b"", b"cycle,time_s\n", b"cycle,time_s\n0,0\n1,0\n", b"cycle,time_s\n0,x\n"):
        status, _, err = t.run("view", t.write("bad.csv", bad), "--http", "127.0.0.1:0")
        t.check(status == 2 and "bad.csv" in err, f"{bad} is refused", status, err)


service = w.serve()
client = service.client()
client.wait_for("STATE", p.IDLE)
check_files(service.page_port)
check_names(service.page_port)
page = w.Page(service.page_port)
check_frames(service, page, client)
check_program(service, page)
check_orders(page, client)
check_operators(service, page, client)
check_drives(service, page, client)
page.close()
check_dead_man(service, client)
check_strangers(service, client)
check_crowd(service)
status = service.stop()
t.check(status[0] == 0, "it ends in order", status)

locked = w.serve("--set", "panel.password=4711")
page = w.Page(locked.page_port)
page.wait_for("STATE", p.IDLE)
t.check(page.write(["FEED_OVERRIDE", 500]) == "the password is needed first", "the password is asked for")
t.check(page.order({"fault": "drive 1 warn code=1000"}) == "the password is needed first", "for faults, too")
t.check(page.write(["FEED_HOLD", 1]) == "", "but not to hold")
t.check(page.write(["PASSWORD", 4711]) == "" and page.write(["FEED_OVERRIDE", 500]) == "", "the right one unlocks")
page.close()
locked.stop()
check_view()
t.finish()
