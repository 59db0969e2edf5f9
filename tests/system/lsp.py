"""`takt lsp` speaks the language server protocol: what check and lint find, what words mean and which modes are in effect,
where subroutines are; and stays whole whatever an editor sends."""

import json
import os
import subprocess

import takt_test as t


class Editor:
    """The other end of the protocol."""

    def __init__(self, *arguments):
        self.server = subprocess.Popen([t.TAKT, "lsp", *arguments], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                       stderr=subprocess.PIPE)
        self.asked = 0
        self.published = {}

    def send(self, message):
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self.send_bytes(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))

    def send_bytes(self, sent):
        self.server.stdin.write(sent)
        self.server.stdin.flush()

    def hear(self):
        length = 0
        while (line := self.server.stdout.readline().strip()) != b"":
            name, value = line.split(b":")
            length = int(value) if name.lower() == b"content-length" else length
        message = json.loads(self.server.stdout.read(length))
        t.check(message["jsonrpc"] == "2.0", "jsonrpc", message)
        if message.get("method") == "textDocument/publishDiagnostics":
            self.published[message["params"]["uri"]] = message["params"]["diagnostics"]
        return message

    def ask(self, method, params=None):
        """The answer, or the error's code."""
        self.asked += 1
        self.send({"id": self.asked, "method": method, "params": params})
        while (message := self.hear()).get("id") != self.asked:
            pass
        return message["result"] if "result" in message else message["error"]["code"]

    def tell(self, method, params):
        self.send({"method": method, "params": params})

    def open(self, uri, text):
        self.tell("textDocument/didOpen", {"textDocument": {"uri": uri, "languageId": "gcode", "version": 1, "text": text}})
        return self.diagnostics(uri)

    def change(self, uri, text):
        self.tell("textDocument/didChange", {"textDocument": {"uri": uri, "version": 2}, "contentChanges": [{"text": text}]})
        return self.diagnostics(uri)

    def diagnostics(self, uri):
        """Severity, first and last place, and text, as they are published next."""
        self.published.pop(uri, None)
        while uri not in self.published:
            self.hear()
        return [(d["severity"], d["range"]["start"]["line"], d["range"]["start"]["character"],
                 d["range"]["end"]["character"], d["message"]) for d in self.published[uri]]

    def place(self, method, uri, line, character):
        return self.ask(method, {"textDocument": {"uri": uri}, "position": {"line": line, "character": character}})

    def hover(self, uri, line, character):
        return self.place("textDocument/hover", uri, line, character)

    def definition(self, uri, line, character):
        return self.place("textDocument/definition", uri, line, character)

    def end(self, *, shutdown=True):
        if shutdown:
            t.check(self.ask("shutdown") is None, "shutdown")
        self.tell("exit", None)
        self.server.stdin.close()
        status = self.server.wait()
        return status, self.server.stderr.read().decode()


def uri_of(name):
    return "file://" + os.path.abspath(name)


def begin(*arguments):
    editor = Editor(*arguments)
    can = editor.ask("initialize", {"processId": None, "rootUri": None, "capabilities": {}})["capabilities"]
    t.check(can["hoverProvider"] and can["definitionProvider"] and can["textDocumentSync"]["change"] == 1, "capabilities", can)
    editor.tell("initialized", {})
    return editor


PART = uri_of("part.ngc")

# Errors, as check finds them, with what to do about them; positions count UTF-16 code units.
editor = begin()
found = editor.open(PART, "G21 G90\nG1 X10\nG1 X20 F300 (\U0001f527) M31\n")
t.check([d[:4] for d in found] == [(1, 1, 0, 2), (1, 2, 17, 20)], "errors", found)
t.check("needs a feed" in found[0][4] and "M31 = ignore" in found[1][4], "what to do", found)

# A message about half a character is still a text.
found = editor.change(PART, "G0 X1 é\nG0 X1 \u20ac\n(\U0001f527 €) G0 X1 €\n")
t.check([d[1:4] for d in found] == [(0, 6, 7), (1, 6, 7), (2, 13, 14)], "characters", found)

# Findings, as lint finds them; none is left when they are mended.
found = editor.change(PART, "G21 G90 F300\nG0 Z5\nG1 X1\nM2\n")
t.check(len(found) == 1 and found[0][:4] == (2, 2, 0, 5) and "spindle stands" in found[0][4], "findings", found)
t.check(editor.change(PART, "G21 G90 F300 S1000 M3\nG0 Z5\nG1 X1\nM2\n") == [], "nothing wrong")

# Another dialect says which; messages count in the text as it stands.
found = editor.change(PART, "(Fanuc 0i)\nG91.1 G90 G21 F300 S1000 M3\n#1=1\nWHILE [#1 LT 3] DO 1\nG1 X#1\n#1=[#1+1]\nEND 1\nG4 X1\nG81 X\nM30\n")
t.check(any(d[0] == 3 and "fanuc" in d[4] for d in found) and any(d[0] == 1 and d[1] == 8 for d in found), "a dialect", found)

# What words mean, and the modes before their line.
TEXT = "G21 G90 F600 S900 M3\nG2 X2 I1\nG91 G20\nO1 if [0]\n  G1 Z-1\nO1 endif\nG1 X1 (é) Y#5220\nM100\n"
editor.change(PART, TEXT)
said = editor.hover(PART, 1, 1)
t.check(said["contents"]["value"].startswith("**G2**: arc clockwise") and said["range"]["end"]["character"] == 2, "G2", said)
t.check("G17 G21 G90 G91.1 G40" in said["contents"]["value"] and "F600 S900 T0 X0.0000" in said["contents"]["value"], "modes", said)
t.check("G20 G91" in editor.hover(PART, 6, 0)["contents"]["value"], "modes later")
t.check("X0.0787" in editor.hover(PART, 6, 0)["contents"]["value"], "the position is in the units of the program")
t.check(editor.hover(PART, 6, 10)["range"]["start"]["character"] == 10, "behind a character of two bytes")
t.check("goes on if the condition" in editor.hover(PART, 3, 4)["contents"]["value"], "O-words")
t.check("never reached" in editor.hover(PART, 4, 3)["contents"]["value"], "not reached")
t.check(editor.hover(PART, 0, 400) is None and editor.hover(PART, 90, 0) is None and editor.hover(PART, 6, 7) is None, "nowhere")

# Where subroutines are: here, below other numbers and names, and in files.
t.write("bore.ngc", "(hole)\no<bore> sub\nG0 X#1\no<bore> endsub\nM2\n")
CALLS = "o100 sub\no100 endsub\nO <Bore> CALL [3]\nO100 call\nM98 P0200\nM2\nO0200\nM99\n"
editor.change(PART, CALLS)
for line, uri, at in (2, uri_of("bore.ngc"), 1), (3, PART, 0), (4, PART, 6):
    where = editor.definition(PART, line, 1)
    t.check(where and where["uri"] == uri and where["range"]["start"]["line"] == at, "definition", line, where)
t.check(editor.definition(PART, 0, 1) is None and editor.definition(PART, 5, 1) is None, "no call")

# An error in a subroutine's file stands on the first line, with its place.
t.write("bore.ngc", "o<bore> sub\nG1 X#1 Q7\no<bore> endsub\n")
editor.tell("textDocument/didSave", {"textDocument": {"uri": PART}})
found = editor.diagnostics(PART)
t.check(len(found) == 1 and found[0][1] == 0 and "bore.ngc:2:" in found[0][4], "elsewhere", found)

# Files whose names need quoting; texts that are no files; what is closed has no diagnostics.
SPACED = uri_of("a part ü.ngc").replace(" ", "%20").replace("ü", "%C3%BC")
editor.open(SPACED, "O <Bore> CALL [3]\nM2\n")
t.check(editor.definition(SPACED, 0, 1)["uri"] == uri_of("bore.ngc"), "quoted")
t.check(editor.open("untitled:1", "G1 X1\n")[0][1] == 0, "untitled")
editor.tell("textDocument/didClose", {"textDocument": {"uri": "untitled:1"}})
t.check(editor.diagnostics("untitled:1") == [], "closed")
t.check(editor.hover("untitled:1", 0, 0) == -32602, "not open")

# An endless program is an error, not an end.
t.check(any("again" in d[4] for d in editor.change(PART, "o1 do\n#1=0\no1 while [1]\n")), "endless")

# What it does not have, and what is wrong.
t.check(editor.ask("textDocument/completion", {}) == -32601, "unknown method")
t.check(editor.ask("initialize", {}) == -32600, "twice")
t.check(editor.ask("textDocument/hover", {"textDocument": 7, "position": []}) == -32602, "wrong parameters")
editor.tell("$/setTrace", {"value": "off"})
editor.send({"id": 1, "result": None})
editor.send_bytes(b"content-length:2\r\nContent-Type: x\r\n\r\n{}")
t.check(editor.hear()["error"]["code"] == -32600, "no request")
editor.send_bytes(b"Content-Length: 3\r\n\r\n{]}")
t.check(editor.hear()["error"]["code"] == -32700, "no JSON")
status, said = editor.end()
t.check(status == 0 and said == "", "end", status, said)

# The machine and the tools are those of the command line; a machine file with an error is told.
t.write("small.ini", "[axis X]\ntravel_max_mm = 5\n")
editor = begin("--machine", "small.ini")
t.check("X" in editor.open(PART, "G0 X6\nM2\n")[0][4], "travel")
t.write("small.ini", "[axis X]\ntravel_max_mm = five\n")
t.check("small.ini:2" in editor.change(PART, "M2\n")[0][4], "machine file")
t.check(editor.end(shutdown=False)[0] == 1, "exit without shutdown")

editor = Editor()
t.check(editor.ask("textDocument/hover", {}) == -32002, "not initialized")
editor.server.stdin.close()
t.check(editor.server.wait() == 1, "the input ends")
for wrong in b"hello\r\n\r\n", b"Content-Length: 99999999999\r\n\r\n", b"Content-Length: x\r\n\r\n{}", b"x" * 5000:
    done = subprocess.run([t.TAKT, "lsp"], input=wrong, capture_output=True, check=False)
    t.check(done.returncode == 2 and b"language server protocol" in done.stderr, "not the protocol", wrong[:30], done)

t.finish()
