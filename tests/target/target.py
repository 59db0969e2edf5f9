"""What the tests of images share: where they are, QEMU, and the ends of its serial lines."""

import os
import shutil
import subprocess
import sys
import time

sys.path.insert(0, os.path.join(os.environ["TAKT_SOURCE"], "tests", "system"))
sys.path.insert(0, os.path.join(os.environ["TAKT_SOURCE"], "tests", "peers"))

import takt_test as t

BOARDS = {"m4f": "mps2-an386", "m7": "mps2-an500"}
QEMU = "qemu-system-arm"

# What waits for another process gives up after so long; nothing is measured by it.
PATIENCE_S = 300


def folder(target):
    return os.path.join(os.environ["TAKT_IMAGES"], target)


def image(target, name):
    """The path of an image, or the test is skipped."""
    path = os.path.join(folder(target), "hal", "mps2", name + ".elf")
    if not os.path.exists(path):
        t.skip(f"there is no image for {target}: the cross-compiler is not installed (gcc-arm-none-eabi, picolibc-arm-none-eabi)")
    return path


def need_qemu():
    if shutil.which(QEMU) is None:
        t.skip("QEMU is not installed (Debian and Ubuntu: qemu-system-arm)")


def run(target, program, *options):
    """takt run on a target; its summary."""
    status, _, err = t.run("run", program, "--target", target, "--image", image(target, "takt-desk"), "--json", "run.json",
                           "--quiet", *options)
    t.check(status in (0, 1, 4), f"{program} runs on {target}", err)
    return t.load_json("run.json") if status in (0, 1, 4) else None


def wait_for(condition, what):
    """Until condition() is true."""
    end = time.monotonic() + PATIENCE_S
    while not condition():
        if time.monotonic() > end:
            raise TimeoutError(what)
        time.sleep(0.02)


class Board:
    """An image with all of its serial lines: panel, bus and console, if there is one, are paths of serial ports, the log is a file."""

    def __init__(self, target, path, panel, bus, log, console=None):
        need_qemu()
        self.log_path = log
        if os.path.exists(log):
            os.remove(log)
        more = ["-chardev", f"serial,id=console,path={console}", "-serial", "chardev:console"] if console else []
        self.process = subprocess.Popen(
            [QEMU, "-M", BOARDS[target], "-kernel", path, "-display", "none", "-monitor", "none",
             "-chardev", f"serial,id=panel,path={panel}", "-serial", "chardev:panel",
             "-chardev", f"serial,id=bus,path={bus}", "-serial", "chardev:bus",
             "-chardev", f"file,id=log,path={log}", "-serial", "chardev:log", *more,
             "-semihosting-config", "enable=on,target=native"],
            stdin=subprocess.DEVNULL)

    def log(self):
        if not os.path.exists(self.log_path):
            return []
        with open(self.log_path, errors="replace") as file:
            return file.read().split("\n")

    def stop(self):
        self.process.terminate()
        self.process.wait()


class Panel:
    """The operator's panel, by `takt panel` on a serial line: libmodbus."""

    def __init__(self, path):
        self.options = ("--serial", path + ",115200", "--timeout", "60")

    def read(self, *names):
        status, out, err = t.run("panel", "read", *names, *self.options)
        t.check(status == 0, "the panel is read", err)
        return dict(line.split(" = ") for line in out.splitlines())

    def number(self, name):
        return float(self.read(name)[name].split()[0])

    def write(self, name, value):
        status, _, err = t.run("panel", "write", name, str(value), *self.options)
        return t.check(status == 0, f"{name} {value} is taken", err)

    def upload(self, path):
        status, _, err = t.run("panel", "upload", path, "--quiet", *self.options)
        return t.check(status == 0, f"{path} is uploaded", err)

    def digest(self):
        words = self.read("DIGEST_HIGH", "DIGEST_LOW")
        return f"{int(words['DIGEST_HIGH']):08x}{int(words['DIGEST_LOW']):08x}"
