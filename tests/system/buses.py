"""Drives and controller as two processes on SLCAN and socketcand; what goes wrong on the way; logs and their replay."""

import os
import re
import signal
import socket
import subprocess

import bus_pair
import takt_test as t


def check_lockstep():
    bus_pair.check_pair("slcan_pty", "slcan:pty", "slcan:")
    bus_pair.check_pair("slcan_tcp", "slcan:listen:0", "slcan:")
    bus_pair.check_pair("socketcand", "socketcand:listen:0", "socketcand:")


def check_log_and_replay():
    """The frames of a controller, replayed from the log onto another bus, arrive there in order."""
    drives = bus_pair.Drives("slcan:pty", "--bus-log", "drives.log")
    status, summary, err = bus_pair.run_controller("log", "--bus", "slcan:" + drives.address, "--bus-log", "bus.log")
    drives.stop()
    t.check(status == 0, "a run on an outside bus is logged", err)
    bus_pair.check_logs_agree("slcan", "bus.log", "drives.log")
    with open("bus.log") as file:
        lines = file.read().splitlines()
    t.check(len(lines) == summary["bus"]["frames"], "the log has a line for each frame of the summary", len(lines))
    t.check(all(re.fullmatch(r"\(\d{10}\.\d{6}\) can0 [0-9A-F]{3}#[0-9A-F]*", line) for line in lines), "as candump -L writes them")
    targets = [line.split()[2] for line in lines if line.split()[2].startswith("301#")]

    replay = subprocess.Popen(
        [t.TAKT, "replay", "bus.log", "--bus", "socketcand:listen:0", "--ids", "301", "--fast"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    seen = watch(replay.stderr.readline().split()[-1])
    out, err = replay.communicate()
    t.check(replay.returncode == 0 and out.startswith(f"{len(targets)} frames sent"), "the replay counts what it sends", out, err)
    t.check(seen == targets, "the frames asked for come in order", len(seen), len(targets))


def watch(address):
    """A client of a socketcand server; returns the frames it has seen until the server closes."""
    host, port = address.rsplit(":", 1)
    connection = socket.create_connection((host, int(port)))
    connection.settimeout(20)
    for expected, answer in (("< hi >", "< open can0 >"), ("< ok >", "< rawmode >")):
        t.check(connection.recv(256).decode() == expected, "each answer is a packet of its own")
        connection.sendall(answer.encode())

    text = connection.recv(65536).decode() # frames follow soon: whoever is slow finds them in the same packet
    t.check(text.startswith("< ok >"), "frames begin after the answer", text)
    while part := connection.recv(65536).decode():
        text += part
    connection.close()
    return ["#".join(m) for m in re.findall(r"< frame (\w+) [\d.]+ (\w*) >", text)]


def check_refusals():
    for options, status, part in (
        (["--bus", "canbus:0"], 2, "unknown kind"),
        (["--bus", "slcan:localhost"], 2, "expected slcan:PATH"),
        (["--drives", "external"], 2, "needs a bus"),
        (["--drives", "elsewhere"], 2, "internal, external, or m4f or m7 is expected"),
        (["--drives", "rv64"], 2, "internal, external, or m4f or m7 is expected"),
        (["--drives", "internal", "--bus", "slcan:/dev/null"], 2, "are on the embedded bus"),
        (["--bus", "slcan:/no/such/device"], 3, "cannot be used"),
        (["--bus", "socketcand:127.0.0.1:1"], 3, "no connection"),
        (["--bus", "socketcan:nosuch0"], 3, "socketcan:nosuch0"),
    ):
        got, _, err = bus_pair.run_controller("refused", *options)
        t.check(got == status and part in err, "refused: " + " ".join(options), got, err)
    t.check(not os.path.exists("refused.csv"), "nothing is written when a bus is refused")
    for arguments, part in (
        (["replay", "bus.log"], "--bus is missing"),
        (["replay", "bus.log", "--bus", "slcan:pty", "--ids", "80-"], "hexadecimal"),
        (["replay", "bus.log", "--bus", "slcan:pty", "--ids", "900"], "hexadecimal"),
        (["replay", t.write("bad.log", "(1.000000) can0 123#00\n(1.000001) can0 12#\n"), "--bus", "slcan:pty"], "bad.log:2:17: error"),
    ):
        status, _, err = t.run(*arguments)
        t.check(status == 2 and part in err, "refused: " + " ".join(arguments), status, err)


def check_overload():
    """More drives than the bus carries are refused before anything moves, with the figures."""
    axes = [f"--set=axis.{axis}.drive_node={node}" for axis, node in zip("ABC", (4, 5, 6))]
    status, summary, err = bus_pair.run_controller("overload", *axes)
    t.check(status == 2 and summary is None, "six axes at 1 kHz and 1 Mbit/s are refused", status)
    t.check(re.search(r"cannot carry .* \d+ of 1000 bits .* 1000000 bit/s and 1000 us", err), "with the figures", err)
    status, summary, err = bus_pair.run_controller("slower", *axes, "--set=machine.cycle_us=2000")
    t.check(status == 0, "at half the rate they run", err)


def check_responses():
    """What the bus has done is within what was predicted of it."""
    status, summary, err = bus_pair.run_controller("responses")
    t.check(status == 0, "the embedded bus runs", err)
    for frame in summary["bus"]["responses"]:
        t.check(0 < frame["observed_us"] <= frame["predicted_us"], f"{frame['name']} {frame['id']:03x} is within its bound", frame)
    names = [check["name"] for check in summary["checks"]]
    t.check("bus_response" in names, "it is one of the checks", names)


def check_realtime():
    """Paced by the clock, the same setpoints; on the embedded bus and with drives outside."""
    short = t.write("short.ngc", "G21 G90 F3000\nG1 X5 Y2\nM2\n")
    _, fast, _ = bus_pair.run_controller("fast", program=short)
    status, summary, err = bus_pair.run_controller("paced", "--realtime", program=short)
    t.check(status == 0, "a paced run completes", err)
    t.check(fast["realtime"] is None and summary["realtime"]["lateness_max_ns"] >= 0, "the summary tells how late cycles were")
    t.check(summary["setpoint_digest"] == fast["setpoint_digest"], "pacing changes no setpoint")
    t.check(summary["wall_time_s"] >= 0.99 * summary["program_time_s"], "a second takes a second", summary["wall_time_s"])


def controller_in_the_middle(drives, *options):
    """A long run whose drives have just been enabled."""
    program = t.write("long.ngc", "G21 G90 F3000\n" + "G1 X50\nG1 X0\n" * 200 + "M2\n")
    command = [t.TAKT, "run", program, "--bus", "slcan:" + drives.address, "--quiet", *options]
    controller = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    drives.wait_for("operation enabled")
    return controller


def check_death():
    """The other end of the bus dies: that is the end of the run; its files show it up to there."""
    drives = bus_pair.Drives("slcan:listen:0")
    controller = controller_in_the_middle(drives, "--trace", "dead.csv")
    drives.process.kill()
    drives.process.wait()
    err = controller.communicate()[1]
    t.check(controller.returncode == 3 and "closed the connection" in err, "a bus that dies ends the run", controller.returncode, err)
    with open("dead.csv") as file:
        t.check(file.read().endswith("\n"), "and its trace is whole")


def check_silence():
    """Drives that hang: after a while the controller gives them up, says so, and ends as faulted."""
    drives = bus_pair.Drives("slcan:listen:0")
    controller = controller_in_the_middle(drives, "--json", "silent.json")
    drives.process.send_signal(signal.SIGSTOP)
    err = controller.communicate()[1]
    drives.process.send_signal(signal.SIGCONT)
    drives.stop()
    t.check(controller.returncode == 1, "drives that hang fail the run", controller.returncode, err)
    t.check("has not answered SYNC for 5 s" in err, "the warning names the drive and the time", err)
    t.check(t.load_json("silent.json")["outcome"] == "faulted", "the outcome is a fault")


def main():
    check_lockstep()
    check_log_and_replay()
    check_refusals()
    check_overload()
    check_responses()
    check_realtime()
    check_death()
    check_silence()
    t.finish()


main()
