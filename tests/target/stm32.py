"""The STM32F405's images in QEMU's netduinoplus2, with what that models: USARTs and timers; everything else reads 0."""

import os
import re
import struct
import subprocess
import zlib

import target
import serial_pair
import takt_test as t

MACHINE = "netduinoplus2"
SETTINGS_ADDRESS = 0x080C0000


def for_qemu(name):
    """The image for this QEMU: before version 8 it has the memory beside the core elsewhere."""
    target.need_qemu()
    said = subprocess.run([target.QEMU, "--version"], capture_output=True, text=True, check=True).stdout
    return image(name if int(re.search(r"version (\d+)", said)[1]) >= 8 else name + "-qemu-7")


def image(name, chip="stm32f405"):
    path = os.path.join(target.folder(chip), "hal", chip, name + ".elf")
    if not os.path.exists(path):
        t.skip(f"there is no image for {chip}: the cross-compiler is not installed (gcc-arm-none-eabi, picolibc-arm-none-eabi)")
    return path


def sector(settings):
    """Settings as they lie in flash, with a head that is right for them whatever they are."""
    head = b"TKS1" + struct.pack("<III", 1, len(settings), zlib.crc32(settings))
    return head + struct.pack("<I", zlib.crc32(head)) + b"\xff" * 12 + settings


class Board:
    """An image at work; its log is a file, its panel, if it has one, a serial line."""

    def __init__(self, path, flash=None, panel=False, log="log.txt", debugger=None):
        target.need_qemu()
        self.log_path = log
        self.line = serial_pair.Pair() if panel else None
        command = [target.QEMU, "-M", MACHINE, "-kernel", path, "-display", "none", "-monitor", "none",
                   "-chardev", f"file,id=log,path={log}", "-serial", "chardev:log"]
        if panel:
            command += ["-chardev", f"serial,id=panel,path={self.line.paths[0]}", "-serial", "chardev:panel"]
        if debugger is not None:
            command += ["-chardev", f"socket,id=debugger,path={debugger},server=on,wait=off", "-gdb", "chardev:debugger"]
        if flash is not None:
            with open("flash.bin", "wb") as file:
                file.write(flash)
            command += ["-device", f"loader,file=flash.bin,addr={SETTINGS_ADDRESS:#x},force-raw=on"]
        self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL)
        self.panel = target.Panel(self.line.paths[1]) if panel else None

    def log(self):
        if not os.path.exists(self.log_path):
            return []
        with open(self.log_path, errors="replace") as file:
            return file.read().split("\n")[:-1]  # whole lines

    def wait_for(self, text):
        target.wait_for(lambda: any(text in line for line in self.log()), f"'{text}' on the log: {self.log()}")

    def stop(self):
        self.process.terminate()
        self.process.wait()
        if self.line is not None:
            self.line.close()
        if os.path.exists(self.log_path):
            os.remove(self.log_path)
