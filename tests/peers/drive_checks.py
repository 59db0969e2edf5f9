"""What a stranger does with `takt drives`: canopen's BaseNode402 and its SDO client, on any bus python-can knows."""

import atexit
import logging
import os
import re
import subprocess
import time

import canopen
from canopen.profiles.p402 import BaseNode402

TAKT = os.environ["TAKT"]
NODE = 2
PER_MM = 100000
HOMED = f"node {NODE}: homing attained, method 34"

# A machine under load answers late. The library's own limits suit an idle one; nothing below is measured by them.
PATIENCE_S = 10.0
BaseNode402.TIMEOUT_CHECK_TPDO = PATIENCE_S
BaseNode402.TIMEOUT_SWITCH_OP_MODE = PATIENCE_S
BaseNode402.TIMEOUT_SWITCH_STATE_SINGLE = PATIENCE_S
BaseNode402.TIMEOUT_SWITCH_STATE_FINAL = PATIENCE_S
canopen.sdo.SdoClient.RESPONSE_TIMEOUT = PATIENCE_S
# In a fast scan a bit that is one has no answer: each costs this time.
canopen.lss.LssMaster.RESPONSE_TIMEOUT = 2.5

# It warns of every object that it reads by SDO for want of a PDO.
logging.getLogger("canopen.profiles.p402").setLevel(logging.ERROR)

held = 0


def check(claim, is_true, *details):
    global held
    if not is_true:
        raise SystemExit(f"FAILED: {claim} {details}")
    held += 1


def expect(claim, found, expected):
    check(claim, found == expected, "found", found, "expected", expected)


def until(claim, condition):
    """Waits for what a drive does in its own time."""
    end = time.monotonic() + PATIENCE_S
    while not condition():
        check(claim, time.monotonic() < end)
        time.sleep(0.002)


class Drives:
    """`takt drives` as a process; address is where clients find it."""

    def __init__(self, bus, *options):
        if os.path.exists("drives.log"):
            os.remove("drives.log")
        self.process = subprocess.Popen([TAKT, "drives", "--bus", bus, "--log", "drives.log", *options],
                                        stderr=subprocess.PIPE, text=True)
        atexit.register(self.process.kill)
        self.address = None
        while self.address is None and self.process.poll() is None:
            time.sleep(0.002)
            found = re.search(r"^0\.000000 bus (\S+)$", read("drives.log"), re.MULTILINE)
            self.address = found.group(1) if found else None
        check("the drives start", self.address is not None, self.process.poll())

    def stop(self):
        self.process.terminate()
        message = self.process.communicate()[1]
        expect("the drives end well when asked to", (self.process.returncode, message), (0, ""))


def read(path):
    if not os.path.exists(path):
        return ""
    with open(path, encoding="ascii") as file:
        return file.read()


def entries(dictionary):
    """All variables of a data sheet."""
    for item in dictionary.values():
        if isinstance(item, canopen.objectdictionary.ODVariable):
            yield item
        else:
            yield from item.values()


def raw(node, entry):
    item = node.sdo[entry.index]
    return (item if isinstance(item, canopen.sdo.SdoVariable) else item[entry.subindex])


# Reading or writing these has an effect of its own, or they hold no number.
SPECIAL = {0x1003, 0x1010, 0x1011, 0x1021, 0x2000, 0x2001, 0x6040, 0x6060}


def check_dictionary(node):
    """Every number of the data sheet is read; those that may be written are, with what they had."""
    reads = writes = 0
    for entry in entries(node.object_dictionary):
        is_process_data = 0x1400 <= entry.index < 0x1C00
        if entry.index < 0x1000 or entry.index in SPECIAL or not entry.readable:
            continue
        value = raw(node, entry).raw
        reads += 1
        if entry.default is not None:
            expect(f"{entry.name}, {entry.index:04X}:{entry.subindex}, has its default", value, entry.default)
        if entry.writable and not is_process_data:
            raw(node, entry).raw = value
            writes += 1
    check("the data sheet is read and written", reads > 150 and writes > 40, reads, writes)
    expect("the device type", node.sdo[0x1000].raw, 0x00020192)
    for index, sub, value, code in ((0x6041, 0, 1, 0x06010002), (0x5000, 0, 1, 0x06020000), (0x6099, 3, 1, 0x06090011),
                                    (0x605C, 0, 7, 0x06090031)):
        try:
            node.sdo.download(index, sub, value.to_bytes(2, "little"))
            check(f"{index:04X}:{sub} is refused", False)
        except canopen.SdoAbortedError as error:
            expect(f"the refusal of {index:04X}:{sub}", error.code, code)


def check_long_values(node, sheet):
    """Segments and blocks, both ways."""
    node.sdo[0x2000].raw = "the axis on the left"
    expect("a text goes and comes back in segments", node.sdo[0x2000].raw, "the axis on the left")
    data = bytes(n * 7 % 256 for n in range(1000))
    with node.sdo[0x2001].open("wb", size=len(data), block_transfer=True) as file:
        file.write(data)
    with node.sdo[0x2001].open("rb", block_transfer=True) as file:
        expect("a thousand bytes go and come back in blocks", file.read(), data)
    with node.sdo[0x1021].open("rb", block_transfer=True) as file:
        uploaded = file.read().decode("ascii")
    ours = [line for line in uploaded.splitlines() if not line.startswith("FileName")]
    theirs = [line for line in sheet.splitlines() if not line.startswith("FileName")]
    expect("the drive gives its own data sheet away", ours, theirs)


def check_enabling(node):
    node.nmt.state = "PRE-OPERATIONAL"
    node.setup_402_state_machine()
    node.nmt.state = "OPERATIONAL"
    node.state = "OPERATION ENABLED"
    expect("the drive is enabled", node.state, "OPERATION ENABLED")
    node.state = "SWITCHED ON"
    node.state = "READY TO SWITCH ON"
    node.state = "OPERATION ENABLED"
    expect("and again by way of other states", node.state, "OPERATION ENABLED")


def actual(node):
    return node.sdo[0x6064].raw


def go(node, target):
    """A set-point of profile position, by its handshake."""
    node.sdo[0x607A].raw = target
    node.controlword = 0x0F
    until("the set-point before is taken back", lambda: not node.check_statusword() & 0x1000)
    node.controlword = 0x1F
    until("the set-point is acknowledged", lambda: node.check_statusword() & 0x1000)
    node.controlword = 0x0F
    until("the target is reached", lambda: node.check_statusword() & 0x0400)


def check_profile_position(node):
    node.op_mode = "PROFILED POSITION"
    expect("profile position", node.op_mode, "PROFILED POSITION")
    node.sdo[0x6081].raw = 50 * PER_MM
    for target_mm in (3, -2, 0.5):
        go(node, round(target_mm * PER_MM))
        until("the drive stands at its target", lambda: abs(actual(node) - target_mm * PER_MM) < 0.001 * PER_MM)


def check_velocity_and_torque(node):
    node.op_mode = "PROFILED VELOCITY"
    node.sdo[0x60FF].raw = 5 * PER_MM
    until("the velocity is reached", lambda: abs(node.sdo[0x606C].raw - 5 * PER_MM) < 0.5 * PER_MM)
    until("and that is told", lambda: node.check_statusword() & 0x0400)
    node.sdo[0x60FF].raw = 0
    until("the axis stands", lambda: node.check_statusword() & 0x1000)
    node.sdo[0x6071].raw = 0
    node.op_mode = "PROFILED TORQUE"
    node.sdo[0x6071].raw = 10
    until("the torque is reached", lambda: node.sdo[0x6074].raw == 10)
    until("the motor turns by it", lambda: node.sdo[0x606C].raw > PER_MM)
    node.sdo[0x6071].raw = 0
    node.op_mode = "PROFILED VELOCITY"
    until("and stands again", lambda: node.check_statusword() & 0x1400 == 0x1400)


def check_time(node, network):
    node.sdo[0x1012].raw = 0x80000100
    network.time.transmit(1e9)  # s since 1970
    until("the time of day is taken", lambda: node.sdo[0x2002][2].raw == 1000000000 // 86400 - 5113)  # days to 1984


def check_lss(bus, connect, *options):
    """A drive as it comes from its maker is found, gets its node id and boots."""
    drives = Drives(bus, "--nodes", str(NODE), "--unconfigured", *options)
    network = canopen.Network()
    connect(network, drives.address)
    found, identity = network.lss.fast_scan()
    check("a drive without a node id is found", found and identity[1:] == [0x402, 0x10000, NODE], found, identity)
    expect("it has none", network.lss.inquire_node_id(), 255)
    network.lss.configure_node_id(NODE)
    network.lss.store_configuration()
    network.lss.send_switch_state_global(network.lss.WAITING_STATE)
    node = network.add_node(NODE, f"takt-drive-{NODE}.eds")
    network.nmt.send_command(130)
    expect("it answers by its new id", node.sdo[0x1018][4].raw, NODE)
    network.disconnect()
    drives.stop()


def check_homing(node):
    node.sdo[0x6098].raw = 34  # the next index pulse, at 10 mm
    check("homing succeeds", node.homing(timeout=PATIENCE_S))
    # The library takes an idle drive for a homed one, and may look before the drive has begun; the log tells when it is.
    until("homing is attained", lambda: HOMED in read("drives.log"))
    expect("homing is over", node.op_mode, "HOMING")
    until("the drive is homed", node.is_homed)
    until("homing has reached its target", lambda: node.check_statusword() & 0x3400 == 0x1400)
    check("0 is where the pulse was", abs(actual(node)) < PER_MM, actual(node))


def stream(node, network, targets):
    """Targets by RPDO2, one with every SYNC."""
    for target in targets:
        node.rpdo[2]["Target position"].raw = target
        node.rpdo[2].transmit()
        network.sync.transmit()
        time.sleep(0.01)


def check_cyclic_position(node, network):
    node.sdo[0x60C2][1].raw = 10
    node.op_mode = "CYCLIC SYNCHRONOUS POSITION"
    network.sync.stop()
    start = actual(node)
    targets = [start + round(0.03 * PER_MM * k) for k in range(1, 101)]
    stream(node, network, targets)
    until("the drive follows its targets", lambda: abs(actual(node) - targets[-1]) < 0.001 * PER_MM)
    stream(node, network, [start + 20 * PER_MM])
    network.sync.start(0.01)


def check_fault(node, network):
    """A target out of reach is a following error; it is told, shown and reset."""
    until("a jump of the target trips the drive", lambda: node.check_statusword() & 0x4F == 0x08)
    expect("the drive is in fault", node.state, "FAULT")
    until("the emergency has come", lambda: node.emcy.log)
    expect("its code", node.emcy.log[-1].code, 0x8611)
    expect("603F", node.sdo[0x603F].raw, 0x8611)
    expect("the history", node.sdo[0x1003][1].raw & 0xFFFF, 0x8611)
    expect("the error register", node.sdo[0x1001].raw, 0x21)
    node.reset_from_fault()
    expect("the fault is reset", node.state, "OPERATION ENABLED")
    until("the emergency is taken back", lambda: node.emcy.log[-1].code == 0)
    expect("the error register is clear", node.sdo[0x1001].raw, 0)


def check_remapping(node):
    """A TPDO mapped anew by the library while the node is operational."""
    tpdo = node.tpdo[4]
    tpdo.read()
    tpdo.clear()
    tpdo.add_variable("Modes of operation display")
    tpdo.add_variable("Velocity actual value")
    tpdo.trans_type = 1
    tpdo.enabled = True
    tpdo.save()
    check("the new TPDO comes", tpdo.wait_for_reception(PATIENCE_S))
    expect("with what is mapped", tpdo["Modes of operation display"].raw, 8)


def check_heartbeat(node):
    node.sdo[0x1017].raw = 50
    node.nmt.wait_for_heartbeat(PATIENCE_S)
    expect("the heartbeat shows the state", node.nmt.state, "OPERATIONAL")
    node.nmt.state = "PRE-OPERATIONAL"
    until("and its change", lambda: node.nmt.wait_for_heartbeat(PATIENCE_S) == "PRE-OPERATIONAL")


def check_guarding(node):
    """By the library's remote frames; it takes the toggle bit off."""
    seen = []
    node.sdo[0x1017].raw = 0
    node.nmt.add_heartbeat_callback(seen.append)
    node.nmt.start_node_guarding(0.02)
    until("a guarded node answers", lambda: len(seen) > 4)
    node.nmt.stop_node_guarding()
    expect("by its state", {state & 0x7F for state in seen}, {0x7F})


def by_slcan(network, address):
    network.connect(interface="slcan", channel=os.path.realpath(address), bitrate=1000000, sleep_after_open=0.1)


def check_bus(bus, connect, *options):
    """Drives on a bus; connect(network, address) brings the library there. options: of takt drives."""
    expect("data sheets are written", subprocess.run([TAKT, "drives", "--eds", "."], check=False).returncode, 0)
    sheet = f"takt-drive-{NODE}.eds"
    drives = Drives(bus, *options)
    network = canopen.Network()
    connect(network, drives.address)
    node = BaseNode402(NODE, sheet)
    network.add_node(node)
    check_dictionary(node)
    check_long_values(node, read(sheet))
    network.sync.start(0.01)
    check_enabling(node)
    check_profile_position(node)
    check_velocity_and_torque(node)
    check_time(node, network)
    check_homing(node)
    check_cyclic_position(node, network)
    check_fault(node, network)
    check_remapping(node)
    check_heartbeat(node)
    if not bus.startswith("socketcand"):  # python-can has no remote frames there
        check_guarding(node)
    network.sync.stop()
    network.disconnect()
    drives.stop()
    log = read("drives.log")
    for line in ("node 2: EMCY 8611", HOMED, "node 2: mode profile position",
                 "node 2: fault -> switch on disabled"):
        check(f"the log has '{line}'", line in log, log)
    check_lss(bus, connect, *options)
    print(f"{bus}: {held} claims held")
