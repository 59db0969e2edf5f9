"""What tests of the console share: a sender of lines as Grbl's senders are, on a socket or a pseudo terminal."""

import os
import select
import socket
import termios
import time
import tty

import panel_client as p
import takt_test as t

# What a sender counts on when it keeps count of characters.
WINDOW = 1000

RESET = b"\x18"

# So often a text is sent anew that a busy computer has broken in two.
TURNS = 30


class Socket:
    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=p.PATIENCE_S)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def write(self, data):
        self.socket.sendall(data)

    def read(self):
        return self.socket.recv(4096)

    def has_data(self):
        return bool(select.select([self.socket], [], [], 0)[0])

    def close(self):
        self.socket.close()


class Terminal:
    """A pseudo terminal as a serial line of so many baud: bytes go out no faster than they would there; None: as fast as can be."""

    def __init__(self, link, baud=None):
        self.file = os.open(link, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self.file, termios.TCSANOW)
        self.byte_s = 10.0 / baud if baud else 0.0
        self.free = time.monotonic()

    def write(self, data):
        now = time.monotonic()
        self.free = max(self.free, now) + self.byte_s * len(data)
        if self.free - now > 0.002:
            time.sleep(self.free - now)
        os.write(self.file, data)

    def read(self):
        assert select.select([self.file], [], [], p.PATIENCE_S)[0], "the console answers"
        return os.read(self.file, 4096)

    def has_data(self):
        return bool(select.select([self.file], [], [], 0)[0])

    def close(self):
        os.close(self.file)


class Sender:
    def __init__(self, line):
        self.line = line
        self.text = b""
        self.others = []  # lines that are neither answers nor reports
        self.expect("Grbl 1.1h ['$' for help]")

    def close(self):
        self.line.close()

    def next(self):
        while b"\n" not in self.text:
            self.text += self.line.read()
        line, self.text = self.text.split(b"\n", 1)
        return line.decode().strip()

    def expect(self, wanted):
        """Reads until this line."""
        while (line := self.next()) != wanted:
            self.others.append(line)

    def answer(self):
        while True:
            line = self.next()
            if line == "ok" or line.startswith("error:"):
                return line
            self.others.append(line)

    def ask(self, text):
        """One line: what it says before its answer, and that."""
        self.others = []
        self.line.write(text.encode() + b"\n")
        return self.answer()

    def realtime(self, data):
        self.line.write(data)

    def status(self):
        """State and fields of a report."""
        self.line.write(b"?")
        while not (line := self.next()).startswith("<"):
            self.others.append(line)
        state, *fields = line.strip("<>").split("|")
        return state, dict(field.split(":", 1) for field in fields)

    def wait_for(self, *states):
        p.until(lambda: self.status()[0].split(":")[0] in states, lambda: f"{self.status()}, {states} expected")

    def stream(self, text, window=WINDOW):
        """Counting characters; window 0: one line at a time. Returns the answers that are not ok."""
        waiting, wrong = [], []
        for line in text.splitlines():
            data = line.encode() + b"\n"
            while waiting and (window == 0 or sum(waiting) + len(data) > window or self.line.has_data()):
                answer = self.answer()
                waiting.pop(0)
                wrong += [answer] if answer != "ok" else []
            self.line.write(data)
            waiting.append(len(data))
        wrong += [answer for answer in (self.answer() for _ in waiting) if answer != "ok"]
        return wrong


def send_whole(runs, back, send):
    """back() to the start, then send() a text as one program; both return at rest. A sender that the computer keeps from sending
    for 0.1 s has ended its program by that, and what comes then is the next one: then all again. runs(): so many have ended."""
    for _ in range(TURNS):
        back()
        before = runs()
        send()
        if runs() == before + 1:
            return
    t.check(False, f"one of {TURNS} times a text is sent without a pause")


def serve(where, *options):
    """A service with a console; returns it, and where the console is: a port or a path."""
    service = p.serve("--grbl", where, *options)
    told = service.process.stdout.readline()
    assert told.startswith("Grbl console on "), told
    place = told[len("Grbl console on ") :].strip()
    return service, int(place.rsplit(":", 1)[1]) if where.startswith("tcp:") else place
