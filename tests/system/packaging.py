#!/usr/bin/env python3
"""What a package brings beside the command: completions, manual pages, release notes. packaging.py [--deb BUILD]

--deb: the package itself too, made of the build folder BUILD; lintian must find nothing, and what it unpacks must run.
"""

import glob
import os
import platform
import re
import shutil
import subprocess
import sys

import takt_test as t

PACKAGE = os.path.join(t.SOURCE, "host", "package")


def output(*command, **options):
    done = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    t.check(done.returncode == 0, " ".join(command[:3]), done.stdout + done.stderr)
    return done.stdout


def commands():
    return [name for name in re.findall(r"^  ([\w-]+) ", output(t.TAKT, "help"), re.M) if name != "help"]


def completed(*lines):
    """What bash offers for the last word of each of these lines."""
    script = ['source takt.bash; try() { COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _takt; echo "${COMPREPLY[@]}"; }']
    script += ["try " + " ".join(f"'{word}'" for word in line) for line in lines]
    return [set(answer.split()) for answer in output("bash", "-c", "\n".join(script)).splitlines()]


def check_completions():
    for shell in ("bash", "zsh", "fish"):
        t.write(f"takt.{shell}", output(t.TAKT, "completion", shell))
        if shutil.which(shell):
            output(shell, "-n", f"takt.{shell}")
    t.write("part.ngc", "M2\n")
    first, files, number, *by_command = completed(("takt", ""), ("takt", "run", "pa"), ("takt", "run", "--until", ""),
                                                  *(("takt", name, "--") for name in commands()))
    t.check(first == {*commands(), "help", "--version"}, "bash completes the commands", first)
    t.check(files == {"part.ngc"} and number == set(), "and files, but none for a number")
    for command, bash in zip(commands(), by_command):
        options = set(re.findall(r"^  (--[\w-]+)", output(t.TAKT, "help", command), re.M))
        zsh = re.search(rf"^    {command}\) _arguments(.*?);;", open("takt.zsh").read(), re.S | re.M)
        fish = re.findall(rf"subcommand_from {command}' -l ([\w-]+)", open("takt.fish").read())
        t.check(bash == options, f"bash completes the options of {command}")
        t.check(zsh and set(re.findall(r"'\*?(--[\w-]+)", zsh.group(1))) == options, f"zsh has the options of {command}")
        t.check({"--" + name for name in fish} == options, f"fish has the options of {command}")
    status, _, err = t.run("completion", "csh")
    t.check(status == 2 and "bash, zsh or fish" in err, "another shell is refused", err)


def check_manual(thoroughly):
    output(sys.executable, os.path.join(PACKAGE, "make_man.py"), t.TAKT, "man1")
    wanted = {"takt.1", *(f"takt-{name}.1" for name in commands())}
    t.check(set(os.listdir("man1")) == wanted, "every command has its page", os.listdir("man1"))
    if thoroughly and shutil.which("man") and shutil.which("troff"):
        for name in sorted(wanted):
            done = subprocess.run(["man", "--warnings=w", "-l", f"man1/{name}"], capture_output=True, text=True, check=False, env={**os.environ, "MANWIDTH": "200"})
            t.check(done.returncode == 0 and not done.stderr, f"{name} is well formed", done.stderr)


def check_notes():
    notes = os.path.join(PACKAGE, "release_notes.py")
    version = output(t.TAKT, "--version").split()[1]
    t.check("### Added" in output(sys.executable, notes, version), "the version has release notes")
    entry = output(sys.executable, notes, "--debian", "0", "A <a@b.c>")
    t.check(entry.startswith(f"takt ({version}) ") and entry.rstrip().endswith("Thu, 01 Jan 1970 00:00:00 -0000"), "and Debian's changelog", entry[-80:])


def check_bill():
    """Every library has a licence and the distribution's name; the plotting library is in it where it is told of."""
    if "libasan" in output("objdump", "-p", t.TAKT):
        return  # nobody packs a build with sanitizers, whose libraries are linked with it
    sbom = os.path.join(PACKAGE, "sbom.py")
    bill, with_plotly = (t.json.loads(output(sys.executable, sbom, t.TAKT, "1.2.3", *more)) for more in ((), ("3.7.0",)))
    here = platform.freedesktop_os_release()["ID"]
    for part in bill["components"]:
        t.check(part["version"] and part.get("licenses"), f"{part['name']} has a version and a licence", part)
        t.check(part["purl"].startswith(f"pkg:deb/{here}/{part['name']}@"), f"{part['name']} is of this distribution", part)
    t.check({"libcjson", "libinih"} <= {part["name"].rstrip("0123456789") for part in bill["components"]}, "all libraries", bill)
    t.check(len(with_plotly["components"]) == len(bill["components"]) + 1, "and the plotting library, if there is one")


def check_package(build):
    for program in ("cpack", "dpkg-deb", "dpkg-shlibdeps"):
        if not shutil.which(program):
            t.skip(f"{program} is not installed")
    output("cmake", "--build", build, "--target", "takt_package_files")
    output("cpack", "--config", os.path.join(build, "CPackConfig.cmake"), "-B", os.getcwd())
    package, = glob.glob("takt_*.deb")
    output("dpkg-deb", "-x", package, "root")
    example = "root/usr/share/doc/takt/examples/engraving.ngc"
    done = subprocess.run(["root/usr/bin/takt", "run", example, "--report", "r.html"], capture_output=True, text=True, check=False)
    t.check("checks        19 of 19 held" in done.stdout, "the installed command runs an installed example", done.stderr)
    with open("root/usr/share/doc/takt/takt.cdx.json") as bill:
        t.check(("plotly" in bill.read()) == ("without the plotting library" not in done.stderr), "the bill has the plotting library if it is in")
    readme = open(os.path.join(os.path.dirname(example), "README.md")).read()
    for link in re.findall(r"\]\((\w[^):#]*)\)", readme):
        t.check(os.path.exists(os.path.join(os.path.dirname(example), link)), f"the examples' page finds {link}")
    if not shutil.which("lintian"):
        t.skip("lintian is not installed")
    found = output("lintian", "--allow-root", package)
    t.check(found == "", "lintian finds nothing", found)


check_completions()
check_manual(len(sys.argv) > 1)
check_notes()
check_bill()
if len(sys.argv) > 1:
    check_package(sys.argv[2])
t.finish()
