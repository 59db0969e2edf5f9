"""A service in real time whose clients come, go and die, and runs of many hours in virtual time: soak.py SECONDS.

Half of the time a program runs again and again on takt serve beside 50 clients that read, send rubbish, stop in the middle of
a request, or vanish. Setpoints must be those of takt run, and memory must stay flat; how late cycles began is printed. The
other half random machines of tests/bench/hunt run a program in virtual time: as many hours of each as there is time for;
memory must not grow with them.
"""

import json
import os
import random
import re
import subprocess
import sys
import threading
import time

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path += [os.path.join(SOURCE, "tests", "system"), os.path.join(SOURCE, "tests", "bench", "hunting")]

import hunt_programs
import panel_client as p
import takt_test as t

SECONDS = float(sys.argv[1])
CLIENTS = 50
MACHINES = 20
GROWTH_MAX_KIB = 1024
LOOK_S = 10
BYTES_MAX = 300
ROUND_S = 12  # of MOVES at their feed, about

MOVES = "\n".join(f"G1 X{10 * (i % 2)} Y{i % 7}" for i in range(60))


def memory_kib(process):
    with open(f"/proc/{process.pid}/status") as file:
        return int(re.search(r"VmRSS:\s+(\d+)", file.read())[1])


def behave(client, draw):
    """One thing that a client does. False: it is gone."""
    what = draw.randrange(8)
    if what < 5:
        client.counts(draw.choice(READABLE))
    elif what == 5:
        client.socket.sendall(bytes(draw.randrange(256) for _ in range(draw.randrange(1, BYTES_MAX))))
        return False
    elif what == 6:
        client.socket.sendall(b"\0\1\0\0\0\6\1")
        time.sleep(draw.random())
        return False
    else:
        return draw.random() < 0.9
    return True


READABLE = [name for name, row in p.REGISTERS.items() if row["table"] == "holding" and row["form"] not in ("text", "bytes")]


def come_and_go(port, seed, is_over):
    draw = random.Random(seed)
    while not is_over.is_set():
        try:
            client = p.Client(port)
            while not is_over.is_set() and behave(client, draw):
                time.sleep(0.02 * draw.random())
            client.close()
        except (OSError, p.Refused, AssertionError):
            pass


def watch(service, client, end):
    """Memory over time; runs over and over."""
    sizes, runs = [], 0
    while time.monotonic() < end:
        if client.counts("STATE") == p.IDLE:
            runs += 1
            client.put("CYCLE_START", 1)
        time.sleep(1)
        sizes.append(memory_kib(service.process))
        if len(sizes) % LOOK_S == 0:
            print(f"service: {len(sizes)} s, {runs} runs, {sizes[-1]} KiB", flush=True)
    return sizes, runs


def soak_service(seconds):
    t.write("part.ngc", "G21 G90 G61 F6000\n" + MOVES + "\nG0 X0 Y0\nM2\n") # every run begins where it ends
    expected = json.loads(t.run("run", "part.ngc", "--json", "-", "--quiet")[1])["setpoint_digest"]
    service = p.serve("--program", "part.ngc")
    client = service.client()
    client.wait_for("STATE", p.IDLE)
    is_over = threading.Event()
    crowd = [threading.Thread(target=come_and_go, args=(service.port, seed, is_over)) for seed in range(CLIENTS)]
    for one in crowd:
        one.start()
    sizes, runs = watch(service, client, time.monotonic() + seconds)
    is_over.set()
    for one in crowd:
        one.join()
    client.wait_for("STATE", p.IDLE)
    t.check(client.digest() == expected, "the setpoints are those of takt run", client.digest())
    later = sizes[len(sizes) // 2 :]
    t.check(not later or later[-1] - later[0] <= GROWTH_MAX_KIB, "the service's memory is flat", sizes[:: max(1, len(sizes) // 20)])
    status, out, err, _ = service.stop()
    t.check(status == 0, "the service ends well", status, err)
    print(out, end="")


def most_kib(*arguments):
    """A run's largest memory, and its program time."""
    process = subprocess.Popen([t.TAKT, "run", *arguments, "--quiet", "--json", "soak.json"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    err = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    summary = t.load_json("soak.json")
    limits = [c["name"] for c in summary["checks"] if not c["held"] and c["name"].startswith(("velocity", "acceleration", "jerk"))]
    t.check(not limits, "every limit is kept", limits, err)
    return usage.ru_maxrss, summary["program_time_s"]


def soak_machine(seed, seconds):
    """Ever longer runs of one machine while there is time."""
    machine = hunt_programs.random_machine(random.Random(seed))
    t.write("soak.ini", machine.text())
    end, until_s, total_s, least = time.monotonic() + seconds, 600.0, 0.0, None
    while time.monotonic() < end:
        began = time.monotonic()
        t.write("long.ngc", f"G21 G90 G64 P0.05 F3000\nO1 repeat [{1 + int(until_s / ROUND_S)}]\n{MOVES}\nO1 endrepeat\nM2\n")
        most, ran_s = most_kib("long.ngc", "--machine", "soak.ini", "--until", str(until_s))
        least = most if least is None else least
        total_s += ran_s
        t.check(most - least <= GROWTH_MAX_KIB, f"machine {seed}: memory does not grow with time", least, most, until_s)
        until_s *= min(4.0, max(1.0, (end - time.monotonic()) / max(time.monotonic() - began, 0.1)))
    print(f"machine {seed}: {total_s / 3600:.2f} h of virtual time, {most} KiB", flush=True)
    return total_s


soak_service(SECONDS / 2)
hours = sum(soak_machine(seed, SECONDS / 2 / MACHINES) for seed in range(1, MACHINES + 1)) / 3600
print(f"{hours:.1f} h of virtual time on {MACHINES} machines")
t.finish()
