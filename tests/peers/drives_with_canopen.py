#!/usr/bin/env python3
"""python-canopen drives takt's virtual drives, over socketcand and over slcan."""

import re

import packages

packages.require("can", "canopen", "serial")

import drive_checks


def by_socketcand(network, address):
    host, port = re.fullmatch(r"(.+):(\d+)", address).groups()
    network.connect(interface="socketcand", host=host, port=int(port), channel="can0", tcp_tune=True)


drive_checks.check_bus("socketcand:listen:0", by_socketcand)
drive_checks.check_bus("slcan:pty", drive_checks.by_slcan)
