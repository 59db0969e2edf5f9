"""A CiA 402 drive made of python-canopen's own LocalNode: dictionary, SDO server, PDO maps and NMT are the library's; the
drive profile is written here from the standard, independently of takt's. Time is counted in SYNCs."""

import struct
import threading

import can
import canopen
from canopen import objectdictionary as od

RW, RO, CONST = "rw", "ro", "const"
U8, U16, U32 = od.UNSIGNED8, od.UNSIGNED16, od.UNSIGNED32
I8, I16, I32 = od.INTEGER8, od.INTEGER16, od.INTEGER32

VENDOR, PRODUCT = 0x00F00D, 0x0BEE

VARIABLES = [
    (0x0007, U32, RW, 0), (0x1000, U32, RO, 0x00020192), (0x1001, U8, RO, 0), (0x1006, U32, RW, 0),
    (0x100C, U16, RW, 0), (0x100D, U8, RW, 0), (0x1017, U16, RW, 0), (0x603F, U16, RO, 0), (0x6040, U16, RW, 0), (0x6041, U16, RO, 0x0250),
    (0x6060, I8, RW, 0), (0x6061, I8, RO, 0), (0x6064, I32, RO, 0), (0x607A, I32, RW, 0),
    (0x60F4, I32, RO, 0), (0x6502, U32, RO, 0xA0), (0x605A, I16, RW, 2), (0x607C, I32, RW, 0),
    (0x6083, U32, RW, 0), (0x6084, U32, RW, 0), (0x6098, I8, RW, 0), (0x609A, U32, RW, 0), (0x60FF, I32, RW, 0),
]
TARGETS = {3: 0x60FF, 7: 0x60C1, 8: 0x607A, 9: 0x60FF}  # of modes
RECORDS = [
    (0x1016, [(1, U32, RW, 0)]),
    (0x1018, [(1, U32, RO, VENDOR), (2, U32, RO, PRODUCT), (3, U32, RO, 1), (4, U32, RO, 99)]),
    (0x60C1, [(1, I32, RW, 0)]),
    (0x60C2, [(1, U8, RW, 1), (2, I8, RW, -3)]),
    (0x6099, [(1, U32, RW, 0), (2, U32, RW, 0)]),
]

# State: (mask, value) of the statusword, and the state each command leads to.
STATUS = {"off": 0x0250, "ready": 0x0231, "on": 0x0233, "enabled": 0x0237, "stopping": 0x0217, "fault": 0x0218}


def variable(index, sub, kind, access, default):
    entry = od.ODVariable(f"{index:04X}:{sub:02X}", index, sub)
    entry.data_type, entry.access_type, entry.default = kind, access, default
    return entry


class Habits:
    """What a drive does otherwise than takt's own. Objects are indices, or (index, sub-index). With a sheet, the path of an EDS,
    its objects, access, limits, dummies and PDOs are those of that."""

    def __init__(self, absent=(), read_only=(), not_mappable=(), limits=(), entries=8, maps=None, dummies=True, pdos=2,
                 modes=0xA0, boots_after=0.0, code=0x06090030, sheet=None, starts_itself=False, resets=0, brake=0,
                 tells_following=True, emergencies=0, slow=0):
        self.sheet = sheet
        self.absent, self.read_only, self.not_mappable = set(absent), set(read_only), set(not_mappable)
        self.limits = dict(limits)  # highest value of an object
        self.entries, self.maps, self.dummies, self.pdos = entries, maps, dummies, pdos
        self.modes, self.boots_after, self.code = modes, boots_after, code
        self.starts_itself = starts_itself  # operational from its boot-up on, where it takes no mapping
        self.resets = resets  # edges of fault reset that it needs after power-on
        self.brake = brake  # SYNCs from "operation enabled" until it follows
        self.tells_following = tells_following  # bit 12 of the statusword
        self.emergencies = emergencies  # sent with its boot-up
        self.slow = slow  # SYNCs from a controlword to its state

    def has(self, index, sub):
        return index not in self.absent and (index, sub) not in self.absent

    def access(self, index, sub, access):
        return RO if index in self.read_only or (index, sub) in self.read_only else access


def process_data(node, habits):
    """Records of the PDOs; with maps (of 1600 ff. and 1A00 ff.) they are valid and fixed."""
    records = []
    for number in range(habits.pdos):
        fixed = habits.maps is not None
        objects = {first: (habits.maps or {}).get(first + number, []) for first in (0x1600, 0x1A00)}
        invalid = {first: 0 if fixed and objects[first] else 0x80000000 for first in objects}
        types = {first: 1 if {0x607A0020, 0x60640020} & set(objects[first]) else 255 for first in objects}
        records.append((0x1400 + number, [(1, U32, RW, invalid[0x1600] | 0x200 + 0x100 * number + node), (2, U8, RW, types[0x1600])]))
        records.append((0x1800 + number, [(1, U32, RW, invalid[0x1A00] | 0x40000180 + 0x100 * number + node),
                                          (2, U8, RW, types[0x1A00]), (3, U16, RW, 0), (5, U16, RW, 0)]))
        for first, mapped in objects.items():
            records.append((first + number, [(sub, U32, RO if fixed else RW, mapped[sub - 1] if sub <= len(mapped) else 0)
                                             for sub in range(1, habits.entries + 1)]))
    return records


def check_by_sheet(objects, index, subindex, value):
    """What the data sheet says of a value; access is the library's."""
    entry = objects[index][subindex] if isinstance(objects[index], (od.ODRecord, od.ODArray)) else objects[index]
    is_mapping = (0x1600 <= index < 0x1800 or 0x1A00 <= index < 0x1C00) and subindex > 0
    is_signed = entry.data_type in od.SIGNED_TYPES
    if not is_signed and not (entry.min or 0) <= value <= (0xFFFFFFFF if entry.max is None else entry.max):
        raise canopen.SdoAbortedError(0x06090030)
    if not is_mapping or value == 0:
        return
    mapped, sub = value >> 16, value >> 8 & 0xFF
    if mapped not in objects:
        raise canopen.SdoAbortedError(0x06040041 if mapped < 0x1000 else 0x06020000)
    found = objects[mapped][sub] if isinstance(objects[mapped], (od.ODRecord, od.ODArray)) else objects[mapped]
    if mapped >= 0x1000 and not found.pdo_mappable:
        raise canopen.SdoAbortedError(0x06040041)


def dictionary(node, habits):
    if habits.sheet is not None:
        return canopen.import_od(habits.sheet, node)
    result = od.ObjectDictionary()
    for index, kind, access, default in VARIABLES:
        if habits.has(index, 0) and (index != 0x0007 or habits.dummies):
            value = habits.modes if index == 0x6502 else default
            result.add_object(variable(index, 0, kind, habits.access(index, 0, access), value))
    for index, subs in list(RECORDS) + process_data(node, habits):
        subs = [(sub, kind, habits.access(index, sub, access), default) for sub, kind, access, default in subs
                if habits.has(index, sub)]
        if not subs:
            continue
        record = od.ODRecord(f"{index:04X}", index)
        counts_are_set = 0x1600 <= index < 0x1800 or 0x1A00 <= index < 0x1C00
        mapped = sum(1 for sub in subs if sub[3]) if habits.maps is not None else 0
        record.add_member(variable(index, 0, U8, RW if counts_are_set and habits.maps is None else RO,
                                   mapped if counts_are_set else subs[-1][0]))
        for sub, kind, access, default in subs:
            record.add_member(variable(index, sub, kind, access, default))
        result.add_object(record)
    return result


class Guarded(can.Listener):
    """Answers remote frames, which the library passes over: node guarding."""

    def __init__(self, drive):
        super().__init__()
        self.drive, self.toggle, self.answers = drive, 0, 0

    def on_message_received(self, msg):
        node = self.drive.node
        if not msg.is_remote_frame or msg.arbitration_id != 0x700 + self.drive.number:
            return
        state = {"OPERATIONAL": 5, "PRE-OPERATIONAL": 127}.get(node.nmt.state, 4)
        self.drive.network.send_message(msg.arbitration_id, bytes([state | self.toggle]))
        self.toggle ^= 0x80
        self.answers += 1


class Drive:
    """The node, and a motor that is where its target says one SYNC later."""

    def __init__(self, network, number, at=0, habits=None):
        self.habits = habits or Habits()
        self.node = network.create_node(canopen.LocalNode(number, dictionary(number, self.habits)))
        self.node.add_write_callback(self.on_write)
        self.network, self.number = network, number
        self.state, self.mode, self.controlword = "off", 0, 0
        self.resets, self.opening, self.waits, self.asked = 0, self.habits.brake, 0, 0
        self.at = self.goal = at
        self.velocity = 0  # increments per second
        self.home_at = None  # increments the home has on the motor's own scale
        self.targets = []  # latched, in order
        self.homed_after, self.is_homed, self.homing_syncs = 5, False, 0
        self.fail_at = None  # (number of targets, error code)
        self.silent_after = None  # number of targets
        self.offset_is_position = False # of its home; CiA 402: minus it
        self.pending = None
        self.guarded = Guarded(self)
        network.notifier.add_listener(self.guarded)
        network.subscribe(0x000, self.on_nmt)
        network.subscribe(0x080, self.on_sync)

    def get(self, index, sub=0):
        return int.from_bytes(self.node.get_data(index, sub), "little")

    def on_write(self, index, subindex, od, data):  # names of the library
        """What may not be written, or not to this value. Mode and controlword act at once."""
        value, habits = int.from_bytes(data, "little"), self.habits
        if habits.sheet is not None:
            check_by_sheet(self.node.object_dictionary, index, subindex, value)
        if habits.starts_itself and 0x1400 <= index < 0x1C00 and self.node.nmt.state == "OPERATIONAL":
            raise canopen.SdoAbortedError(0x08000022)
        is_entry = (0x1600 <= index < 0x1800 or 0x1A00 <= index < 0x1C00) and subindex > 0
        if index in habits.read_only or (index, subindex) in habits.read_only:
            raise canopen.SdoAbortedError(0x06010002)
        if value > habits.limits.get(index, 0xFFFFFFFF):
            raise canopen.SdoAbortedError(habits.code)
        if is_entry and value and value >> 16 >= 0x1000 and value >> 16 not in self.node.object_dictionary:
            raise canopen.SdoAbortedError(0x06020000)
        if is_entry and value >> 16 < 0x1000 and value and not habits.dummies:
            raise canopen.SdoAbortedError(0x06040041)
        if is_entry and value >> 16 in habits.not_mappable:
            raise canopen.SdoAbortedError(0x06040041)
        if index == 0x6060:
            self.set_mode(value)
        elif index == 0x6040:
            self.set_control(value)

    def on_nmt(self, _, data, __):
        if data[1] not in (0, self.number):
            return
        if data[0] in (129, 130):
            self.boot_later()
        elif data[0] == 1:
            self.connect()

    def boot_later(self):
        """It hears nothing until it has booted."""
        if not self.habits.boots_after:
            self.reset()
            return
        self.network.unsubscribe(0x600 + self.number)
        threading.Timer(self.habits.boots_after, self.boot).start()

    def boot(self):
        self.network.subscribe(0x600 + self.number, self.node.sdo.on_request)
        self.reset()

    def reset(self):
        for index in [i for i in self.node.data_store if 0x1000 <= i < 0x2000]:
            del self.node.data_store[index]
        self.guarded.toggle, self.resets = 0, self.habits.resets
        self.state = "fault" if self.resets else "off"
        self.node.nmt.send_command(130)  # sends the boot-up message
        self.node.nmt.send_command(1 if self.habits.starts_itself else 128)
        for number in range(self.habits.emergencies):
            self.node.emcy.send(0x3220 if number % 2 == 0 else 0, 0x04)

    def connect(self):
        """Operational: PDOs are what the master has written into the dictionary."""
        for pdos in (self.node.rpdo, self.node.tpdo):
            for pdo in pdos.map.values():
                for cob_id in [pdo.cob_id] if pdo.cob_id in self.network.subscribers else []:
                    self.network.unsubscribe(cob_id)
                pdo.read()
        for pdo in self.node.rpdo.map.values():
            pdo.add_callback(self.on_rpdo)

    def set_mode(self, mode):
        self.mode = mode
        self.node.data_store.setdefault(0x6061, {})[0] = struct.pack("<b", mode)

    def set_control(self, word):
        if self.habits.slow and word != self.asked:
            self.asked, self.waits = word, self.habits.slow
        if self.waits == 0:
            before, self.controlword = self.controlword, word
            self.obey(before)

    def on_rpdo(self, pdo):
        values = {var.index: var.raw for var in pdo.map}
        if 0x6060 in values:
            self.set_mode(values[0x6060])
        if 0x6040 in values:
            self.set_control(values[0x6040])
        target = values.get(TARGETS.get(self.mode))
        if target is not None and (self.mode != 7 or self.controlword & 0x10):
            self.pending = target

    def obey(self, before):
        word = self.controlword
        if self.state == "fault":
            if word & 0x80 and not before & 0x80:
                self.resets -= 1
                self.state = "fault" if self.resets > 0 else "off"
        elif not word & 0x02:
            self.state = "off"
        elif not word & 0x04:
            self.state = "off" if self.state != "enabled" else "stopping"
        elif not word & 0x01:
            self.state = "ready"
        elif self.state in ("ready", "on", "enabled"):
            self.state = "enabled" if word & 0x08 and self.state != "ready" else "on"
        if self.mode == 6 and self.state == "enabled" and word & 0x10 and not before & 0x10:
            self.is_homed, self.homing_syncs = False, self.homed_after

    def statusword(self):
        word = STATUS[self.state]
        if self.mode == 6:
            word |= 0x0400 if self.homing_syncs == 0 else 0
            word |= 0x1000 if self.is_homed else 0
        elif self.is_following() and self.habits.tells_following:
            word |= 0x1000
        return word

    def is_following(self):
        return self.state == "enabled" and self.opening == 0 and (self.mode != 7 or self.controlword & 0x10)

    def on_sync(self, *_):
        if self.node.nmt.state != "OPERATIONAL":
            return
        if self.waits > 0:
            self.waits -= 1
            if self.waits == 0:
                self.set_control(self.asked)
        self.move()
        if self.silent_after is not None and len(self.targets) >= self.silent_after:
            return
        for tpdo in self.node.tpdo.map.values():
            if not tpdo.enabled or not self.is_due(tpdo):
                continue
            for var in tpdo.map:
                var.raw = {0x6041: self.statusword(), 0x6064: self.at, 0x6061: self.mode}.get(var.index, 0)
            tpdo.transmit()

    @staticmethod
    def is_due(tpdo):
        """By SYNC, or by an event timer of its period."""
        return tpdo.trans_type == 1 or (tpdo.trans_type >= 254 and tpdo.event_timer == 1)

    def move(self):
        if self.state == "stopping":
            self.state = "off"
        if self.state != "enabled":
            self.opening = self.habits.brake
            return
        if self.opening > 0:
            self.opening -= 1
            self.pending = None
            return
        if self.mode == 6:
            self.home()
            return
        if TARGETS.get(self.mode) == 0x60FF:
            self.turn()
        else:
            self.follow()
        if self.fail_at and len(self.targets) == self.fail_at[0]:
            self.state = "fault"
            self.node.emcy.send(self.fail_at[1], 0x01)

    def follow(self):
        self.at = self.goal
        if self.pending is not None:
            self.goal, self.pending = self.pending, None
            self.targets.append(self.goal)

    def turn(self):
        """At its velocity from SYNC to SYNC, a millisecond."""
        self.goal += self.velocity * 1e-3
        self.at = round(self.goal)
        if self.pending is not None:
            self.velocity, self.pending = self.pending, None
            self.targets.append(self.at)

    def home(self):
        if self.homing_syncs == 0:
            return
        self.homing_syncs -= 1
        if self.homing_syncs == 0:
            offset = struct.unpack("<i", self.node.get_data(0x607C, 0))[0]
            self.at = self.goal = offset if self.offset_is_position else -offset
            self.is_homed = True
