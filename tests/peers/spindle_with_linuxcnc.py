#!/usr/bin/env python3
"""LinuxCNC's own programs, unmodified: vfdb_vfd turns the virtual spindle, mb2hal reads the panel and writes to it."""

import atexit
import os
import shutil
import subprocess
import sys
import time

sys.path.insert(0, os.path.join(os.environ["TAKT_SOURCE"], "tests", "system"))

import panel_client as p
import serial_pair
import takt_test as t

VFD_INI = """[VFD-B]
DEVICE = {path}
BAUD = 115200
PARITY = None
STOPBITS = 2
TARGET = 1
POLLCYCLES = 1
MOTOR_HZ = 400
MOTOR_RPM = 24000
"""

MB2HAL_INI = """[MB2HAL_INIT]
INIT_DEBUG=0
VERSION=1.1
HAL_MODULE_NAME={name}
SLOWDOWN=0.0
TOTAL_TRANSACTIONS=2

[TRANSACTION_00]
LINK_TYPE=tcp
TCP_IP=127.0.0.1
TCP_PORT={port}
MB_SLAVE_ID=1
FIRST_ELEMENT=1
NELEMENTS=1
MAX_UPDATE_RATE=0.0
DEBUG=0
MB_TX_CODE=fnct_04_read_input_registers
HAL_TX_NAME=state

[TRANSACTION_01]
MB_TX_CODE=fnct_06_write_single_register
FIRST_ELEMENT=0
NELEMENTS=1
HAL_TX_NAME=override
"""

# LinuxCNC's memory is one for all of a user's processes, and it refuses the superuser without this.
VFD, MB2HAL = f"vfd{os.getpid()}", f"mb2hal{os.getpid()}" # so names are our own
ENVIRONMENT = {**os.environ, "RTAPI_UID": "1000"}


def halcmd(*words):
    done = subprocess.run(["halcmd", *words], capture_output=True, text=True, env=ENVIRONMENT, check=False)
    return done.stdout.strip() if done.returncode == 0 else None


class Component:
    """A running program of LinuxCNC, and its pins."""

    def __init__(self, *command):
        self.process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=ENVIRONMENT)
        atexit.register(self.process.kill)

    def wait_for(self, pin, test):
        until = time.monotonic() + p.PATIENCE_S
        while (value := halcmd("getp", pin)) is None or not test(value):
            if time.monotonic() > until or self.process.poll() is not None:
                return t.check(False, f"{pin} stays {value}", self.process.poll())
        return True

    def stop(self):
        self.process.terminate()
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()


class Late(Exception):
    """vfdb_vfd waits for an answer for half a second (libmodbus), takes what comes after that for the answer to its next
    request, and reads nothing more. A busy computer is that late now and then: then nothing is said of the spindle."""


def wait_for_vfd(component, pin, test):
    def is_done(value):
        if int(halcmd("getp", VFD + ".error-count")) > 0:
            raise Late
        return test(value)

    return component.wait_for(VFD + pin, is_done)


def check_turning(component):
    wait_for_vfd(component, ".modbus-ok", lambda value: value == "TRUE")
    t.check(float(halcmd("getp", VFD + ".max-rpm")) == 24000, "vfdb_vfd knows the highest speed")
    halcmd("setp", VFD + ".enable", "1")
    for speed, direction in ((9000, 0), (-6000, 0x18)):
        halcmd("setp", VFD + ".speed-command", str(speed))
        halcmd("setp", VFD + ".spindle-on", "1")
        # The direction first: on its way to the other one the spindle passes this speed too. Each pin is read by a request
        # of its own, so one follows the other.
        t.check(wait_for_vfd(component, ".status", lambda value: int(value) & 0x18 == direction), "in the direction told")
        t.check(wait_for_vfd(component, ".motor-RPM", lambda value: abs(float(value) - abs(speed)) < 20), f"vfdb_vfd turns it at {speed} rpm")
        t.check(wait_for_vfd(component, ".frequency-out", lambda value: abs(float(value) - abs(speed) / 60) < 1), "and reads its frequency")
        if speed > 0:  # vfdb_vfd never says so of a negative speed
            t.check(wait_for_vfd(component, ".at-speed", lambda value: value == "TRUE"), "and sees it at speed")
    halcmd("setp", VFD + ".spindle-on", "0")
    t.check(wait_for_vfd(component, ".is-stopped", lambda value: value == "TRUE"), "and stops it")


ROUNDS = 5


def turns_in_time():
    """Whether every request was answered in time; a takt that loses answers never gets here."""
    pair = serial_pair.Pair()
    service = p.Service("--spindle", pair.paths[0] + ",115200,none", "--set", "spindle.ramp_rpm_s=100000", command="drives")
    component = Component("vfdb_vfd", "-I", t.write("vfd.ini", VFD_INI.format(path=pair.paths[1])), "-n", VFD)
    try:
        check_turning(component)
        return True
    except Late:
        return False
    finally:
        component.stop()
        service.stop()
        pair.close()


def check_spindle():
    t.check(any(turns_in_time() for _ in range(ROUNDS)), f"without an error on the line in one of {ROUNDS} rounds")


def check_panel():
    service = p.serve()
    client = service.client()
    client.wait_for("STATE", p.IDLE)
    component = Component("mb2hal", "config=" + t.write("mb2hal.ini", MB2HAL_INI.format(name=MB2HAL, port=service.port)))
    t.check(component.wait_for(MB2HAL + ".state.00.int", lambda value: int(value) == p.IDLE), "mb2hal reads the state")
    halcmd("setp", MB2HAL + ".override.00.int", "750")
    client.wait_for("FEED_OVERRIDE", 750)
    t.check(int(halcmd("getp", MB2HAL + ".override.num_errors"), 0) == 0, "and writes an override")
    client.put("EMERGENCY_STOP", 1)
    t.check(component.wait_for(MB2HAL + ".state.00.int", lambda value: int(value) == p.EMERGENCY), "and sees it change")
    component.stop()
    service.stop()


for program in ("halcmd", "vfdb_vfd", "mb2hal"):
    if shutil.which(program) is None:
        t.skip(f"{program} is not installed (Debian: linuxcnc-uspace); tests/run --all does it")
check_spindle()
check_panel()
t.finish()
