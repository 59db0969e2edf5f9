"""A serial line with two ends that both have a path: two ptys, and a thread that carries bytes between them. Or a pty in
front of a line there is: for programs that know what to do with a pty."""

import os
import pty
import select
import threading
import tty


class Pair:
    def __init__(self, line=None):
        """line: the path of the second end, if it is not a pty to be made."""
        ptys = [pty.openpty() for _ in range(1 if line else 2)]
        self.slaves = [slave for _, slave in ptys]
        self.paths = [os.ttyname(slave) for slave in self.slaves]
        self.masters = [master for master, _ in ptys]
        if line:
            self.masters.append(os.open(line, os.O_RDWR | os.O_NOCTTY))
            tty.setraw(self.masters[-1])
        for slave in self.slaves:
            tty.setraw(slave)
        self.ends = False
        self.is_cut = False
        self.thread = threading.Thread(target=self.carry, daemon=True)
        self.thread.start()

    def carry(self):
        while not self.ends:
            for master in select.select(self.masters, [], [], 0.1)[0]:
                data = os.read(master, 1024)
                if not self.is_cut:
                    os.write(self.masters[master == self.masters[0]], data)

    def close(self):
        self.ends = True
        self.thread.join()
        for file in (*self.masters, *self.slaves):
            os.close(file)
