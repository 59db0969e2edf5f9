"""A serial line with two ends that both have a path: two ptys, and a thread that carries bytes between them."""

import os
import pty
import select
import threading
import tty


class Pair:
    def __init__(self):
        self.masters, self.slaves = zip(*(pty.openpty() for _ in range(2)))
        for slave in self.slaves:
            tty.setraw(slave)
        self.paths = [os.ttyname(slave) for slave in self.slaves]
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
