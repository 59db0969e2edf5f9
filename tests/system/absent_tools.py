"""Each optional tool in turn is not installed: takt is configured all the same, and the tests that need the tool are skipped,
with a reason. Nothing is built: they have to find out before they use anything."""

import os
import re
import subprocess

import takt_test as t

WITHOUT = os.path.join(t.SOURCE, "tests", "without")

# The tests that are skipped without a tool.
TESTS = {
    "browser": "report_in_browser",
    "busybox": "socketcan|drives_with_canopen_on_socketcan",
    "can-utils": "frame_lengths_against_can_utils",
    "clang": "fuzz_short|fuzz_modbus_short|style_tidy|style_format",
    "cross-compiler": "build_image_.*|target_.*",
    "linuxcnc": "canon_against_linuxcnc|events_against_linuxcnc|spindle_with_linuxcnc",
    "packages": "controller_with_canopen|drives_with_canopen|panel_with_pymodbus|python_api",
    "sigrok": "pulse_log_with_sigrok",
    "qemu": "target_(digests|arithmetic|cost|refusal|storage_stops|live|grbl|stm32_start|stm32_rehearsal)",
    "user-mode-linux": "socketcan|drives_with_canopen_on_socketcan",
}

# Where the kernel has CAN their tests run without them.
CAN = ("busybox", "user-mode-linux")

RESULT = re.compile(r"Test +#\d+: (\S+) \.*(?:\*\*\*| *)(Passed|Skipped|\S.*?) +[\d.]+ sec")


def run(*command):
    return subprocess.run(command, capture_output=True, text=True, check=False)


def results(tool, tests):
    """What CTest says of each test without the tool, and all it printed."""
    folder = os.path.abspath(tool)
    done = run(WITHOUT, tool, "--", "cmake", "--preset", "host", "-S", t.SOURCE, "-B", folder, "-DTAKT_TESTS=ON")
    t.check(done.returncode == 0, f"without {tool} takt is configured", done.stdout[-2000:], done.stderr[-2000:])
    done = run(WITHOUT, tool, "--", "ctest", "--test-dir", folder, "--verbose", "--fixture-exclude-setup", "target_images", "-R", f"^({tests})$")
    return RESULT.findall(done.stdout), done.stdout


def check_reasons(tool, printed):
    """The last line a skipped test printed says why."""
    for number in re.findall(r"Test +#(\d+): \S+ \.*\*\*\*Skipped", printed):
        t.check(re.search(rf"^{number}: .*\S", printed, re.MULTILINE), f"a test that is skipped without {tool} says why", number)


listed = run(WITHOUT, "--list").stdout.split()
t.check(sorted(TESTS) == listed, "every optional tool is tried", listed)
for tool, tests in TESTS.items():
    found, printed = results(tool, tests)
    t.check(len(found) >= tests.count("|") + 1, f"the tests that need {tool} are registered", found)
    t.check(all(result in ("Passed", "Skipped") for _, result in found), f"without {tool} nothing fails", found)
    t.check(tool in CAN or all(result == "Skipped" for _, result in found), f"without {tool} its tests are skipped", found)
    check_reasons(tool, printed)
t.finish()
