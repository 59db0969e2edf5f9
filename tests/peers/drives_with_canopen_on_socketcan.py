#!/usr/bin/env python3
"""python-canopen drives takt's virtual drives over SocketCAN, of the kernel or of user-mode Linux."""

import os
import subprocess
import sys

import packages

packages.require("can", "canopen")

if os.environ.get("TAKT_WITH_CAN") != "yes":
    with_can = os.path.join(os.environ["TAKT_SOURCE"], "tests", "with_can")
    done = subprocess.run([with_can, sys.executable, *sys.argv], env=dict(os.environ, TAKT_WITH_CAN="yes"), check=False)
    sys.exit(done.returncode)

import drive_checks


def connect(network, _):
    network.connect(interface="socketcan", channel="vcan0")


drive_checks.check_bus("socketcan:vcan0", connect)
