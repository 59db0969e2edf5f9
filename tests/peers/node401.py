"""A CiA 401 I/O node made of python-canopen's own LocalNode: dictionary, SDO server, PDO maps and NMT are the library's; the
device profile is written here from the standard, independently of takt's. Two bytes of outputs, and of inputs."""

import canopen
from canopen import objectdictionary as od
from node402 import RO, RW, U8, U16, U32, variable

BYTES = 2


def dictionary(node):
    """As it comes from its maker: outputs in the first RPDO, inputs in the first TPDO, sent when they change."""
    result = od.ObjectDictionary()
    for index, kind, access, default in ((0x1000, U32, RO, 0x00030191), (0x1001, U8, RO, 0), (0x1017, U16, RW, 0)):
        result.add_object(variable(index, 0, kind, access, default))
    for index, subs in (
        (0x1016, [(1, U32, RW, 0)]),
        (0x1018, [(1, U32, RO, 0xF00D), (2, U32, RO, 0x401), (3, U32, RO, 1), (4, U32, RO, 7)]),
        (0x1400, [(1, U32, RW, 0x200 + node), (2, U8, RW, 255)]),
        (0x1600, [(sub, U32, RW, 0x62000008 | sub << 8) for sub in range(1, BYTES + 1)]),
        (0x1800, [(1, U32, RW, 0x40000180 + node), (2, U8, RW, 255), (3, U16, RW, 0), (5, U16, RW, 0)]),
        (0x1A00, [(sub, U32, RW, 0x60000008 | sub << 8) for sub in range(1, BYTES + 1)]),
        (0x6000, [(sub, U8, RO, 0) for sub in range(1, BYTES + 1)]),
        (0x6200, [(sub, U8, RW, 0) for sub in range(1, BYTES + 1)]),
    ):
        record = od.ODRecord(f"{index:04X}", index)
        record.add_member(variable(index, 0, U8, RO, BYTES if index in (0x1600, 0x1A00) else subs[-1][0]))
        for sub, kind, access, default in subs:
            record.add_member(variable(index, sub, kind, access, default))
        result.add_object(record)
    return result


class Io:
    """The node; its inputs are its outputs, but for those that are held."""

    def __init__(self, network, number, takes_sync=True, held=0):
        self.node = network.create_node(canopen.LocalNode(number, dictionary(number)))
        self.node.add_write_callback(self.on_write)
        self.network, self.number, self.takes_sync = network, number, takes_sync
        self.outputs, self.levels = 0, []  # as they are, and as they were
        self.held = held  # inputs that are high whatever the outputs are
        self.release_after = None  # so many SYNCs: then they are not
        self.syncs = 0
        network.subscribe(0x000, self.on_nmt)
        network.subscribe(0x080, self.on_sync)

    def get(self, index, sub=0):
        return int.from_bytes(self.node.get_data(index, sub), "little")

    def on_write(self, index, subindex, od, data):  # names of the library
        if (index, subindex) == (0x1800, 2) and not self.takes_sync:
            raise canopen.SdoAbortedError(0x06090030)

    def on_nmt(self, _, data, __):
        if data[1] not in (0, self.number):
            return
        if data[0] in (129, 130):
            self.node.nmt.send_command(130)  # sends the boot-up message
            self.node.nmt.send_command(128)
        elif data[0] == 1:
            self.connect()

    def connect(self):
        """Operational: what stands in the dictionary is in force; the inputs are told."""
        for pdo in (self.node.rpdo[1], self.node.tpdo[1]):
            pdo.read()
        self.node.rpdo[1].add_callback(self.on_outputs)
        self.tell_inputs()

    def on_outputs(self, pdo):
        self.outputs = sum(var.raw << 8 * byte for byte, var in enumerate(pdo.map))
        if self.levels[-1:] != [self.outputs]:
            self.levels.append(self.outputs)
            if self.node.tpdo[1].trans_type == 255:
                self.tell_inputs()

    def tell_inputs(self):
        inputs = self.outputs | self.held
        for byte, var in enumerate(self.node.tpdo[1].map):
            var.raw = inputs >> 8 * byte & 0xFF
        self.node.tpdo[1].transmit()

    def on_sync(self, *_):
        if self.node.nmt.state != "OPERATIONAL":
            return
        self.syncs += 1
        if self.syncs == self.release_after:
            self.held = 0
            self.tell_inputs()
        elif self.node.tpdo[1].trans_type == 1:
            self.tell_inputs()
