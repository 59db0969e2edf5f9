#!/usr/bin/env python3
"""python-canopen drives the firmware of drives in QEMU, over slcan: what it does with the drives of a PC, unchanged."""

import sys

import target
import packages

packages.require("can", "canopen", "serial")

import drive_checks

target.need_qemu()
for processor in sys.argv[1:] or ("m4f",):
    drive_checks.check_bus("slcan:pty", drive_checks.by_slcan, "--target", processor, "--image", target.image(processor, "takt-drive"))
