"""A page as the service sees it: HTTP and a WebSocket made of the standard library."""

import base64
import json
import os
import select
import socket
import struct
import zlib

import panel_client as p
import takt_test as t

# So many frames at most have been sent and not been read when something is asked of the next one.
FRAMES_BEHIND = 300

TEXT, BINARY, CLOSE, PING, PONG = 1, 2, 8, 9, 10


def serve(*options):
    """A service with a page; page_port says where. Without libwebsockets the test is skipped."""
    try:
        service = p.serve("--http", "127.0.0.1:0", *options)
    except AssertionError as error:
        if "without libwebsockets" in str(error):
            t.skip("this takt is built without libwebsockets")
        raise
    service.page_port = int(service.process.stdout.readline().rstrip("/\n").rsplit(":", 1)[1])
    return service


def connect(port):
    connection = socket.create_connection(("127.0.0.1", port), timeout=p.PATIENCE_S)
    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return connection


def read_head(connection):
    """Up to the empty line; the rest of the bytes too."""
    data = b""
    while b"\r\n\r\n" not in data:
        part = connection.recv(4096)
        if not part:
            return data, b""
        data += part
    head, rest = data.split(b"\r\n\r\n", 1)
    return head, rest


def get(port, path="/", host=None, method="GET", extra=""):
    """Status, headers by name, body."""
    connection = connect(port)
    connection.sendall(f"{method} {path} HTTP/1.1\r\nHost: {host or f'127.0.0.1:{port}'}\r\n{extra}\r\n".encode())
    head, body = read_head(connection)
    if not head:
        return 0, {}, b""
    lines = head.decode().split("\r\n")
    headers = {name.lower(): value.strip() for name, value in (line.split(":", 1) for line in lines[1:])}
    while len(body) < int(headers.get("content-length", 0)) and (part := connection.recv(65536)):
        body += part
    connection.close()
    return int(lines[0].split()[1]), headers, body


def upgrade(port, host=None, origin=None, path="/live", protocol="takt"):
    """The connection, and the status the service answers with; 0: it hung up."""
    connection = connect(port)
    host = host or f"127.0.0.1:{port}"
    lines = [f"GET {path} HTTP/1.1", f"Host: {host}", "Upgrade: websocket", "Connection: Upgrade", "Sec-WebSocket-Version: 13",
             f"Sec-WebSocket-Key: {base64.b64encode(os.urandom(16)).decode()}", f"Sec-WebSocket-Protocol: {protocol}"]
    if origin != "":
        lines.append(f"Origin: {origin or f'http://{host}'}")
    connection.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
    try:
        head, rest = read_head(connection)
    except ConnectionResetError:
        head, rest = b"", b""
    return connection, rest, int(head.split()[1]) if head else 0


class Page:
    """A page that is open."""

    def __init__(self, port):
        self.socket, self.buffer, status = upgrade(port)
        assert status == 101, status
        self.last = 0
        self.frame = None
        self.other = {}
        self.hello = self.wait_other("hello")["hello"]
        self.names = {row[0]: i for i, row in enumerate(self.hello["registers"])}
        self.decimals = {row[0]: row[1] for row in self.hello["registers"]}

    def close(self):
        self.socket.close()

    def send(self, data, kind=None):
        if isinstance(data, (dict, list)):
            data = json.dumps(data).encode()
        kind = kind or TEXT
        mask = os.urandom(4)
        size = len(data)
        head = bytes([0x80 | kind])
        head += bytes([0x80 | size]) if size < 126 else struct.pack(">BH", 0xFE, size) if size < 65536 else struct.pack(">BQ", 0xFF, size)
        repeated = mask * (size // 4 + 1)
        body = (int.from_bytes(data, "big") ^ int.from_bytes(repeated[:size], "big")).to_bytes(size, "big")
        self.socket.sendall(head + mask + body)

    def take(self, size):
        while len(self.buffer) < size:
            part = self.socket.recv(65536)
            if not part:
                raise ConnectionError("the service has closed the page")
            self.buffer += part
        data, self.buffer = self.buffer[:size], self.buffer[size:]
        return data

    def receive(self):
        """The next message; frames are remembered."""
        data = b""
        while True:
            first, second = self.take(2)
            size = second & 0x7F
            size = struct.unpack(">H", self.take(2))[0] if size == 126 else struct.unpack(">Q", self.take(8))[0] if size == 127 else size
            body = self.take(size)
            if first & 15 == CLOSE:
                raise ConnectionError("the service has closed the page")
            data += body
            if first & 0x80:
                break
        message = json.loads(data)
        if "n" in message:
            self.frame = message
        else:
            self.other.update({name: message for name in message})
        return message

    def wait_other(self, name):
        """The next message of this name, or one that has come meanwhile."""
        while name not in self.other:
            self.receive()
        return self.other.pop(name)

    def is_readable(self):
        return bool(self.buffer) or bool(select.select([self.socket], [], [], 0)[0])

    def next_frame(self):
        while "n" not in self.receive():
            pass
        return self.frame

    def counts(self, name):
        return self.frame["v"][self.names[name]]

    def value(self, name):
        return self.counts(name) / 10 ** self.decimals[name]

    def wait_for(self, name, *values):
        """The frame under way when this is called may be older than the last order."""
        self.next_frame()
        self.next_frame()
        while self.counts(name) not in values:
            self.next_frame()

    def sees_control(self, expected):
        """Frames that were sent before may be read first."""
        return any(self.next_frame()["c"] == expected for _ in range(FRAMES_BEHIND))

    def order(self, message):
        """The refusal; empty: done."""
        self.last += 1
        self.send({**message, "id": self.last})
        while True:
            answer = self.receive()
            if answer.get("reply") == self.last:
                return answer["refused"]

    def write(self, *pairs):
        return self.order({"write": pairs})

    def upload(self, program, piece=32768):
        refused = self.order({"upload": [len(program), zlib.crc32(program)]})
        for at in range(0, len(program), piece):
            self.send(program[at:at + piece], BINARY)
        return refused or self.order({"commit": 1})
