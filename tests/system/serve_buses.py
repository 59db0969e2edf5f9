"""takt serve on two buses: programs run as on one; either bus is lost, which is an alarm of its own axes, and comes back."""

import socket
import threading

import bus_pair
import panel_client as p
import takt_test as t

# In real time a computer that is busy elsewhere is a drive that is silent: then the program is tried again.
TURNS = 30

MACHINE = t.write("two.ini", "".join(
    f"[axis {axis}]\ndrive_node = {node}\ndrive_bus = {bus}\nfollowing_error_max_{unit} = 0\n"
    for axis, node, bus, unit in (("X", 1, 0, "mm"), ("Y", 2, 0, "mm"), ("Z", 1, 1, "mm"), ("A", 2, 1, "deg"))))
PROGRAM = b"G21 G90 G61 F3000\nG1 X3 Y2 Z-1 A5\nG2 X5 Y0 I0 J-2\nG0 X0 Y0 Z0 A0\nM2\n"


class Cable:
    """Between the service and the drives of one bus: it can be cut, and mended."""

    def __init__(self, drives_address):
        host, port = drives_address.rsplit(":", 1)
        self.drives_place = host, int(port)
        self.place = "127.0.0.1", 0
        self.ends = []
        self.mend()

    def mend(self):
        self.listener = socket.create_server(self.place)
        self.place = self.listener.getsockname()
        self.address = "%s:%d" % self.place
        threading.Thread(target=self.carry, args=(self.listener,), daemon=True).start()

    def carry(self, listener):
        try:
            near = listener.accept()[0]
        except OSError:
            return
        far = socket.create_connection(self.drives_place)
        self.ends = [near, far]
        for end in self.ends:
            end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        threading.Thread(target=self.pass_on, args=(far, near), daemon=True).start()
        self.pass_on(near, far)

    def pass_on(self, source, sink):
        try:
            while data := source.recv(65536):
                sink.sendall(data)
        except OSError:
            pass

    def cut(self):
        self.listener.close()
        for end in self.ends:
            end.shutdown(socket.SHUT_RDWR)


def enable(client):
    """RESET until all drives are enabled."""
    def is_idle():
        if client.counts("STATE") == p.ALARM:
            client.refusal("RESET", 1)
        return client.counts("STATE") == p.IDLE

    p.until(is_idle, lambda: f"the drives are not enabled: state {client.counts('STATE')}, {client.text('ALARM_TEXT')}")


def is_disturbed(client):
    text = client.text("ALARM_TEXT")
    return "has sent no position" in text or "heartbeat of the controller lost" in text


def start(client, program):
    """Whether it has been taken and begun; drives that are silent at rest are an alarm, too."""
    try:
        client.upload(program)
        client.put("CYCLE_START", 1)
    except p.Refused:
        return False
    return True


def run(client):
    """Whether the program comes to its end."""
    runs = client.counts("RUNS")
    if not start(client, PROGRAM):
        return False
    client.wait_while("RUNS", runs)
    return client.counts("OUTCOME") == p.COMPLETED


def check_program(client, digest, what):
    """It runs to its end; behind a disturbance once more, since it ended where it begins, but began elsewhere."""
    elsewhere = False
    for _ in range(TURNS):
        if completes := run(client):
            if not elsewhere:
                break
            elsewhere = False
        elif is_disturbed(client):
            enable(client)
            elsewhere = True
        else:
            break
    t.check(completes, what + ": the program runs", client.text("ALARM_TEXT"))
    t.check(digest is None or client.digest() == digest, what + ": the setpoints of takt run", client.digest(), digest)


def check_inside(digest):
    service = p.serve("--machine", MACHINE)
    client = service.client()
    client.wait_for("STATE", p.IDLE)
    check_program(client, digest, "embedded")
    status, _, err, _ = service.stop()
    t.check(status == 0 and err == "", "it ends well", status, err)


def lose(client, cable, bus, axes):
    """In motion: an alarm about that bus, and nothing moves. Mended, RESET enables the drives."""
    if start(client, b"G21 G90 F600\nG1 X200 Y100 Z-20 A90\nM2\n"):
        p.until(lambda: client.get("FEED") >= 1 or client.counts("STATE") == p.ALARM, lambda: "nothing moves")
    cable.cut()
    client.wait_for("STATE", p.ALARM)
    if is_disturbed(client):
        cable.mend()
        enable(client)
        return False
    t.check(client.text("ALARM_TEXT") == f"the bus {bus} is gone", axes + ": the alarm names the bus", client.text("ALARM_TEXT"))
    client.wait_for("FEED", 0)
    t.check(client.refusal("CYCLE_START", 1) == (4, 1), axes + ": nothing starts meanwhile")
    cable.mend()
    enable(client)
    return True


def check_losses(client, cables):
    for cable, bus, axes in zip(cables, ("can0", "can1"), ("XY", "ZA")):
        for _ in range(TURNS):
            check_program(client, None, "before the bus of " + axes + " is lost")
            if lose(client, cable, bus, axes):
                break
        check_program(client, None, "after the bus of " + axes + " is back")


def check_outside(digest):
    """Drives of two processes."""
    drives = [bus_pair.Drives("slcan:listen:0", "--machine", MACHINE, "--can", str(bus)) for bus in (0, 1)]
    cables = [Cable(one.address.removeprefix("slcan:")) for one in drives]
    service = p.serve("--machine", MACHINE, "--bus", ",".join("slcan:" + cable.address for cable in cables))
    client = service.client()
    enable(client)
    check_program(client, digest, "two processes")
    check_losses(client, cables)
    status, _, err, _ = service.stop()
    t.check(status == 0, "the service ends well", status, err)
    for cable in cables:
        t.check(f"{cable.address}: the other side has closed the connection; it is looked for" in err, "told when lost", err)
        t.check(f"the bus is back: slcan:{cable.address}" in err, "and when back", err)
    for one in drives:
        one.stop()


def main():
    with open("part.ngc", "wb") as file:
        file.write(PROGRAM)
    status, out, err = t.run("run", "part.ngc", "--machine", MACHINE, "--json", "-", "--quiet")
    t.check(status == 0, "takt run", err)
    digest = t.json.loads(out)["setpoint_digest"]
    check_inside(digest)
    check_outside(digest)
    t.finish()


main()
