"""Every example of every --help does what it says: all are run, in the order in which they stand there.

Services are started with ports of their own, and ended once they serve. What needs something that no test has, a kernel with
CAN or a program of somebody else, is named below, so that an example is never left out unseen.
"""

import os
import re
import shutil
import signal
import subprocess

import panel_client as p
import takt_test as t
from torque_record import recorded

ELSEWHERE = {
    "socketcan:": "a kernel with CAN",
    "sender part.ngc": "a sender",
    "vim.lsp.start": "an editor",
    "takt panel settings": "a controller that keeps settings in flash",
}
# Some take most of a minute with sanitizers on a busy computer.
HANGS_AFTER_S = 500

SERVICES = "takt serve", "takt view", "takt drives", "takt lsp"
PREPARED = "takt compile part.ngc -o part.plan", "takt machine > my-mill.ini", "takt run part.ngc --trace before.csv", "cp before.csv after.csv", "takt calibrate --machine worn_mill.ini --grid 3x3x3 -o volume.csv"


def examples(command):
    """Command lines, without what stands behind them in parentheses or in words."""
    text = t.run("help", command)[1].partition("Examples:\n")[2]
    return [re.split(r"  +(?=\(|in )", line.strip())[0] for line in text.splitlines() if line.startswith("  ") and line[2] != " "]


def prepare():
    for name in "mill3.ini", "worn_mill.ini", "tools.tbl":
        shutil.copy(os.path.join(t.EXAMPLES, name), name)
    for name in "mill.ini", "soft.ini":
        shutil.copy("mill3.ini", name)
    for name in "part.ngc", "part.nc":
        t.write(name, "G21 G90 G17 F1200\nM3 S1000\nG1 X5\nG3 X10 Y5 I0 J5\nG1 X0 Y0\nM2\n")
    t.write("x.comp", "0 0 0\n100 100.01 100.02\n")
    t.write("x.txt", "".join(f"{torque} {x}\n" for torque, x in recorded()))
    t.write("faults.inject", "")
    os.makedirs("data-sheets", exist_ok=True)
    os.makedirs("stored", exist_ok=True)
    os.makedirs("bin", exist_ok=True)
    if not os.path.exists("bin/takt"):
        os.symlink(t.TAKT, "bin/takt")
    os.environ["PATH"] = os.path.abspath("bin") + ":" + os.environ["PATH"]


def run(line):
    return subprocess.run(["bash", "-e", "-o", "pipefail", "-c", line], capture_output=True, text=True, check=False, timeout=HANGS_AFTER_S)


def check_command(line):
    done = run(line)
    t.check(done.returncode == 0, "an example runs: " + line, done.returncode, done.stdout[-500:], done.stderr)


def on_free_ports(line, page):
    line = re.sub(r"(\d+\.\d+\.\d+\.\d+|listen):\d{4,5}", r"\1:0", line)
    line = re.sub(r"/tmp/", "", line)
    if line.startswith("takt serve") and "--listen" not in line:
        line += " --listen 127.0.0.1:0"
    return line if line.startswith(("takt drives", "takt lsp")) else f"{line} --http {page}"


def check_service(line, page="127.0.0.1:0"):
    """It serves, or has nothing more to do, and ends when it is told to. A build without libwebsockets says so, and has no page."""
    before, _, last = line.rpartition("&& ")
    if before:
        check_command(before.rstrip("& "))
    with open("told.txt", "w") as told:
        service = subprocess.Popen(["bash", "-c", "exec " + on_free_ports(last, page)], stdin=subprocess.PIPE, stdout=told, stderr=told)

    log = re.search(r"--log (\S+)", line)

    def text():
        with open(log[1] if log and os.path.exists(log[1]) else "told.txt") as file:
            return file.read()

    if not line.startswith("takt lsp"):  # which ends with its input
        p.until(lambda: service.poll() is not None or text(), lambda: f"{line} says nothing")
        service.send_signal(signal.SIGTERM)
    service.communicate()
    if "built without libwebsockets" in text():
        t.check(service.returncode == 3 and page != "off", "no page is told: " + line, service.returncode, text())
        if last.startswith("takt serve"):
            check_service(last, "off")
        return
    ends = (1,) if line.startswith("takt lsp") else (0, 128 + signal.SIGTERM)  # 1: without "shutdown"
    t.check(service.returncode in ends and "error" not in text(), "an example serves: " + line, service.returncode, text())


def check_panel(lines):
    """Each on a service with a program that is ready."""
    for line in lines:
        service = p.serve("--state", "none", "--program", "part.ngc")
        service.client().wait_for("STATE", p.IDLE)
        if "watch" in line:
            line += " --count 2"
        if "stream" in line:
            line += " --start"
        line = line.replace(" --connect mill.local:1502", "")
        check_command(line.replace("takt panel", f"takt panel --connect 127.0.0.1:{service.port}"))
        service.stop()


prepare()
for line in PREPARED:
    check_command(line)
for command in re.findall(r"^  ([a-z-]+)", t.run("help")[1], flags=re.MULTILINE):
    lines = [line for line in examples(command) if not any(word in line for word in ELSEWHERE)]
    if command == "panel":
        check_panel(lines)
        continue
    for line in lines:
        if any(word in line for word in SERVICES):
            check_service(line)
        else:
            check_command(line)
t.finish()
